"""Numbers in float64 that carry their rounding error along: true ≈ value + error.

Errors are signed, and of first order. The error of every operation is known exactly, by two-sum and
by a product's residual (Dekker's, or by a fused multiply-add where this is compiled), and is added
to what the operands carry along. What is left out are products of two errors. Values are those of
plain float64, to the bit.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from .systems import Array, Float64

_SPLIT = 2.0**27 + 1
# Room for printing: a number that its error swallows is printed as 0, and digits are cut off.
PRINTED = 2
# A float64 is off by so much of itself when it was rounded.
UNIT = Fraction(1, 2**53)


class Carried:
    """A value and its error, both arrays or both numbers."""

    __slots__ = ("error", "value")
    __array_ufunc__ = None  # NumPy leaves operations with its arrays to us

    def __init__(self, value: Any, error: Any) -> None:
        """Both alike."""
        self.value, self.error = value, error

    def __add__(self, other: Any) -> "Carried":
        return added(self, carried(other))

    def __sub__(self, other: Any) -> "Carried":
        return subtracted(self, carried(other))

    def __mul__(self, other: Any) -> "Carried":
        return multiplied(self, carried(other))

    def __truediv__(self, other: Any) -> "Carried":
        return divided(self, carried(other))

    __radd__, __rmul__ = __add__, __mul__  # the same bits

    def __neg__(self) -> "Carried":
        return Carried(-self.value, -self.error)

    def __rsub__(self, other: Any) -> "Carried":
        return subtracted(carried(other), self)

    def __rtruediv__(self, other: Any) -> "Carried":
        return divided(carried(other), self)

    def __getitem__(self, at: Any) -> "Carried":
        return Carried(self.value[at], self.error[at])

    def __setitem__(self, at: Any, other: Any) -> None:
        other = carried(other)
        self.value[at], self.error[at] = other.value, other.error

    def __len__(self) -> int:
        return len(self.value)

    @property
    def shape(self) -> tuple[int, ...]:
        """That of the values."""
        shape: tuple[int, ...] = np.shape(self.value)
        return shape

    @property
    def nearest(self) -> Any:
        """The value with its error, rounded."""
        return self.value + self.error


def carried(number: Any) -> Any:
    """Take a number without an error as one whose error is 0."""
    return number if isinstance(number, Carried) else Carried(number, 0.0)


def residual(a: Any, b: Any, product: Any) -> Any:
    """Give a b − product exactly, where ``product`` is near a b."""
    a_high, b_high = a * _SPLIT, b * _SPLIT
    a_high, b_high = a_high - (a_high - a), b_high - (b_high - b)
    a_low, b_low = a - a_high, b - b_high
    near = a * b
    off = ((a_high * b_high - near) + a_high * b_low + a_low * b_high) + a_low * b_low
    return (near - product) + off


def added(x: Any, y: Any) -> Carried:
    """Give x + y."""
    value = x.value + y.value
    part = value - x.value
    own = (x.value - (value - part)) + (y.value - part)
    return Carried(value, own + (x.error + y.error))


def subtracted(x: Any, y: Any) -> Carried:
    """Give x − y."""
    value = x.value - y.value
    part = value - x.value
    own = (x.value - (value - part)) - (y.value + part)
    return Carried(value, own + (x.error - y.error))


def multiplied(x: Any, y: Any) -> Carried:
    """Give x y."""
    value = x.value * y.value
    along = x.error * y.value + y.error * x.value
    return Carried(value, residual(x.value, y.value, value) + along)


def divided(x: Any, y: Any) -> Carried:
    """Give x/y."""
    value = x.value / y.value
    off = x.error - residual(value, y.value, x.value)
    return Carried(value, (off - y.error * value) / y.value)


def sqrt(x: Any) -> Any:
    """Give a square root, of numbers of any system or of arrays of them."""
    if not isinstance(x, Carried):
        return np.sqrt(x)
    value = np.sqrt(x.value)
    return Carried(value, (x.error - residual(value, value, x.value)) / (value + value))


def accumulated(x: Any) -> Any:
    """Give the sums of the first 1, 2, … numbers of an array, in any system."""
    if not isinstance(x, Carried):
        return np.add.accumulate(x)
    value = np.add.accumulate(x.value)
    before = Carried(np.append(0.0, value[:-1]), 0.0)
    return Carried(value, np.add.accumulate(added(before, x).error))


@dataclass(frozen=True)
class Carrying(Float64):
    """float64, with the error of each number carried along: the system of ``Carried``."""

    name: str = "float64 with errors"

    def __reduce__(self) -> str:
        """Stay the one that there is."""
        return "CARRYING"

    def number(self, value: Fraction) -> Carried:
        """Round a rational, and keep what that lost."""
        near = value.numerator / value.denominator
        top, bottom = near.as_integer_ratio()
        off = value.numerator * bottom - top * value.denominator
        return Carried(near, off / (value.denominator * bottom))

    def root(self, value: Fraction) -> Any:
        """Give the square root of a rational."""
        return sqrt(self.number(value))

    def signs(self, values: Any) -> tuple[Array, Array]:
        """Look at the values."""
        return super().signs(values.value)

    def zeros(self, *shape: int) -> Any:
        """Give exact zeros."""
        return Carried(np.zeros(shape), np.zeros(shape))

    def from_floats(self, values: Array) -> Any:
        """Give exact numbers."""
        return Carried(values, np.zeros(values.shape))

    def filled(self, numbers: list[Any]) -> Any:
        """Put numbers into an array of values and one of errors."""
        return Carried(*(np.array([getattr(x, part) for x in numbers], np.float64)
                         for part in ("value", "error")))  # fmt: skip


CARRYING = Carrying()


class Sizes(NamedTuple):
    """The largest errors that a sweep carried: of c, of δn and of changes; the largest force.

    Of a force in units of the load; of all beads, since errors may cancel on the way.
    """

    moved: float = 0.0
    turned: float = 0.0
    changed: float = 0.0
    force: float = 0.0

    def __or__(self, other: "Sizes") -> "Sizes":
        """Give the larger ones."""
        return Sizes(*map(max, self, other))

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


def bound_error(roundings: int, unseen: Fraction | float) -> float:
    """Bound the error of numbers that were rounded so often after their errors were carried.

    Both are relative to the largest change; ``unseen`` is what the carried errors leave out.
    """
    ratio = PRINTED * (roundings * UNIT + 2 * unseen)
    return float(min(ratio, 10**300)) * (1 + 1e-15)
