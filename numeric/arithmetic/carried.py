"""Numbers in float64 that carry their rounding error along: true ≈ value + error.

Errors are signed, and of first order.

The error of every operation is known exactly, by two-sum and by a product's residual (Dekker, or a
fused multiply-add), and is added to what the operands carry along. What is left out are products
of two errors. Values are those of plain float64, to the bit.
"""

from collections.abc import Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np

from .systems import FLOAT64, Array, midpoint

_SPLIT = 2.0**27 + 1


def residual(a: Any, b: Any, product: Any) -> Any:
    """Give a b − product exactly, ``product`` being a b rounded (Dekker): arrays or floats."""
    a_high, b_high = a * _SPLIT, b * _SPLIT
    a_high, b_high = a_high - (a_high - a), b_high - (b_high - b)
    a_low, b_low = a - a_high, b - b_high
    return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


class Carried:
    """A value and its error (None: it has none), both arrays, numbers, or names of a recording."""

    __slots__ = ("error", "value")
    __array_ufunc__ = None  # NumPy leaves operations with its arrays to us

    def __init__(self, value: Any, error: Any = None) -> None:
        """Both alike."""
        self.value, self.error = value, error

    def __add__(self, other: Any) -> "Carried":
        other = _carried(other)
        a, b = self.value, other.value
        found = a + b
        part = found - a
        own = (a - (found - part)) + (b - part)
        return Carried(found, _sum(own, _sum(self.error, other.error)))

    def __sub__(self, other: Any) -> "Carried":
        other = _carried(other)
        a, b = self.value, other.value
        found = a - b
        part = found - a
        own = (a - (found - part)) - (b + part)
        return Carried(found, _sum(own, _difference(self.error, other.error)))

    def __mul__(self, other: Any) -> "Carried":
        if _shifts(other):
            return Carried(self.value * other, _product(self.error, other))
        other = _carried(other)
        a, b = self.value, other.value
        found = a * b
        along = _sum(_product(other.error, a), _product(self.error, b))
        return Carried(found, _sum(_left(a, b, found), along))

    def __truediv__(self, other: Any) -> "Carried":
        if _shifts(other):
            return Carried(self.value / other, _product(self.error, 1 / other))
        other = _carried(other)
        a, b = self.value, other.value
        found = a / b
        off = _sum(-_left_of_quotient(found, b, a), self.error)
        return Carried(found, _difference(off, _product(other.error, found)) / b)

    def __neg__(self) -> "Carried":
        return Carried(-self.value, None if self.error is None else -self.error)

    def __radd__(self, other: Any) -> "Carried":
        return Carried(other).__add__(self)

    def __rsub__(self, other: Any) -> "Carried":
        return Carried(other).__sub__(self)

    def __rmul__(self, other: Any) -> "Carried":
        return self.__mul__(other)

    def __rtruediv__(self, other: Any) -> "Carried":
        return Carried(other).__truediv__(self)

    def __len__(self) -> int:
        return len(self.value)

    def __iter__(self) -> "Iterator[Carried]":
        pairs = zip(self.value.tolist(), self.error.tolist(), strict=True)
        return (Carried(value, error) for value, error in pairs)

    def sqrt(self) -> "Carried":
        """Square root."""
        found = _sqrt(self.value)
        off = _sum(-_left_of_quotient(found, found, self.value), self.error)
        return Carried(found, off / (found + found))

    @property
    def nearest(self) -> Any:
        """The value with its error, rounded."""
        return self.value + self.error


def scalar(value: Fraction) -> Carried:
    """Round a rational, and keep what that lost."""
    near = float(FLOAT64.number(value))
    if not np.isfinite(near):
        return Carried(near, 0.0)
    return Carried(near, float(FLOAT64.number(value - Fraction(near))))


def _carried(value: Any) -> Carried:
    return value if isinstance(value, Carried) else Carried(value)


def _shifts(value: Any) -> bool:
    """Whether a factor is a power of two, which makes no error."""
    return isinstance(value, int) and value > 0 and value & (value - 1) == 0


def _sum(a: Any, b: Any) -> Any:
    return b if a is None else a if b is None else a + b


def _difference(a: Any, b: Any) -> Any:
    return a if b is None else -b if a is None else a - b


def _product(error: Any, factor: Any) -> Any:
    return None if error is None else error * factor


def _left(a: Any, b: Any, product: Any) -> Any:
    fused = getattr(a, "residual", None) or getattr(b, "residual", None)
    return residual(a, b, product) if fused is None else fused(a, b, product)


def _left_of_quotient(a: Any, b: Any, near: Any) -> Any:
    """Give a b − near exactly, where a b is near enough that this has no more than 53 bits."""
    fused = getattr(a, "residual", None)
    if fused is not None:
        return fused(a, b, near)
    product = a * b
    return (product - near) + residual(a, b, product)


def _sqrt(value: Any) -> Any:
    return value.sqrt() if hasattr(value, "sqrt") else np.sqrt(value)


@dataclass(frozen=True)
class Carrying:
    """float64, with the error of each number carried along: the system of ``Carried``."""

    name: str = "float64 with errors"
    dtype: Any = np.float64
    bits: int = 106

    def number(self, value: Fraction) -> Carried:
        """Round a rational, and keep what that lost."""
        return scalar(value)

    def scalar(self, value: Fraction) -> Carried:
        """Give the same as ``number``."""
        return scalar(value)

    def from_float(self, value: float) -> Carried:
        """Give an exact number."""
        return Carried(value, 0.0)

    def from_ball(self, value: Any) -> Carried:
        """Round the midpoint, and keep what that lost."""
        return scalar(midpoint(value))

    def sqrt(self, values: Any) -> Any:
        """Square roots."""
        return values.sqrt()

    def root(self, value: Fraction) -> Carried:
        """Give the square root of a rational."""
        return scalar(value).sqrt()

    def signs(self, values: Any) -> tuple[Array, Array]:
        """Look at the values."""
        return FLOAT64.signs(values.value)

    def zeros(self, *shape: int) -> Any:
        """Give exact zeros."""
        return Carried(np.zeros(shape), np.zeros(shape))

    def from_floats(self, values: Array) -> Any:
        """Give exact numbers."""
        return Carried(values, np.zeros(values.shape))

    def array(self, values: Iterable[Fraction]) -> Any:
        """Round rationals, and keep what that lost."""
        found = [scalar(value) for value in values]
        return self.column(found)

    def column(self, values: Sequence[Carried]) -> Any:
        """Give an array of numbers."""
        return Carried(np.array([v.value for v in values], dtype=np.float64),
                       np.array([v.error for v in values], dtype=np.float64))  # fmt: skip

    def active(self) -> AbstractContextManager[None]:
        """Silence floating-point warnings."""
        return FLOAT64.active()


CARRYING = Carrying()


@dataclass(frozen=True)
class Sizes:
    """The largest errors that a sweep carried: of c, of δn and of changes; the largest force.

    Of a force in units of the load; of all beads, since errors may cancel on the way.
    """

    moved: float = 0.0
    turned: float = 0.0
    changed: float = 0.0
    force: float = 0.0

    def __or__(self, other: "Sizes") -> "Sizes":
        """Give the larger ones."""
        return Sizes(
            max(self.moved, other.moved),
            max(self.turned, other.turned),
            max(self.changed, other.changed),
            max(self.force, other.force),
        )

    def unseen(self, height: int) -> tuple[float, float]:
        """Allow for what the carried errors leave out: of forces, and of displacements.

        These are the roundings of the errors themselves, a few in each layer, some more of a low
        packing, and products of two errors: a changed direction changes how all others go on.
        """
        unit = (height + 4) * 2.0**-52
        again = height**2 * self.turned
        force = self.changed * (unit + again) + self.force * self.turned * again
        moved = self.moved * (unit + again) + self.turned * again
        least = 64 * height * 2.0**-1074  # where errors are below what a float can hold
        return force + least, moved + least


NONE = Sizes()
