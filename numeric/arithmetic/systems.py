"""Number systems: the only module that tells floats, balls and big floats apart.

Every formula of the packing is written once, on NumPy arrays. What differs between number
systems is how a rational enters, what is certain about a sign, and which global precision must be
set and put back. Libraries of long numbers are loaded when the first such number is made.
"""

import copyreg
import threading
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, reduce
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class NumberSystem(ABC):
    """What the sweeps ask of numbers. ``dtype``: NumPy's, ``object`` for all but float64.

    ``name``: how plans and results call this arithmetic.
    """

    name: str
    dtype: Any = object

    @abstractmethod
    def number(self, value: Fraction) -> Any:
        """Turn a rational into the nearest number (balls: into an enclosure)."""

    def from_float(self, value: float) -> Any:
        """Turn a float64 into a number, exactly."""
        return self.number(Fraction(value))

    def root(self, value: Fraction) -> Any:
        """Give the square root of a rational."""
        return np.sqrt(self.number(value))

    def signs(self, values: Any) -> tuple[Array, Array]:
        """Give two boolean arrays: surely positive, surely not (balls may be neither)."""
        good = np.asarray(values > 0, dtype=bool)
        return good, ~good if good.all() else np.asarray(values <= 0, dtype=bool)

    def array(self, values: Iterable[Fraction]) -> Any:
        """Turn rationals into a one-dimensional array."""
        return self.filled([self.number(value) for value in values])

    def filled(self, numbers: list[Any]) -> Array:
        """Put numbers of this system into an array."""
        array = np.empty(len(numbers), dtype=self.dtype)
        for q, number in enumerate(numbers):  # NumPy takes a power series for a sequence
            array[q] = number
        return array

    def zeros(self, *shape: int) -> Any:
        """Give an array of exact zeros."""
        return np.full(shape, self.number(Fraction(0)), dtype=self.dtype)

    def from_floats(self, values: Array) -> Any:
        """Turn float64 values into numbers, exactly (balls: of radius zero)."""
        numbers = list(map(self.from_float, values.reshape(-1).tolist()))
        return self.filled(numbers).reshape(values.shape)

    def active(self) -> AbstractContextManager[None]:
        """Set the global precision, if any, and put it back at the end."""
        return nullcontext()


def as_floats(values: Array) -> Array:
    """Round numbers of any arithmetic to float64 (balls: their midpoints); the same shape."""
    return values.astype(np.float64)


@dataclass(frozen=True)
class Float64(NumberSystem):
    """Doubles."""

    name: str = "float64"
    dtype: Any = np.float64

    def number(self, value: Fraction) -> Any:
        """Round to nearest even."""
        return np.float64(value.numerator / value.denominator)

    def from_floats(self, values: Array) -> Any:
        """Keep them."""
        return values

    def signs(self, values: Any) -> tuple[Array, Array]:
        """Compare; what is no finite number is not positive."""
        good = np.asarray((values > 0) & np.isfinite(values), dtype=bool)
        return good, ~good

    def __reduce__(self) -> str:
        """Stay the one that there is: a plan asks whether a system *is* that of float64."""
        return "FLOAT64"

    def active(self) -> AbstractContextManager[None]:
        """Silence floating-point warnings: the sweeps check for what is not finite themselves."""
        return np.errstate(all="ignore")


FLOAT64 = Float64()


@cache
def flint() -> Any:
    """Load python-flint, and let its balls be pickled."""
    library = import_module("flint")
    copyreg.pickle(library.arb, _pickled)
    return library


def _pickled(ball: Any) -> tuple[Any, tuple[Any, ...]]:
    """Say how a ball is made again: the same midpoint, and hardly a larger radius."""
    if not ball.is_finite():
        return type(ball), ("nan",)
    parts = (part.man_exp() for part in (ball.mid(), ball.rad()))
    return _ball, tuple((int(mantissa), int(exponent)) for mantissa, exponent in parts)


def _ball(middle: tuple[int, int], radius: tuple[int, int]) -> Any:
    arb = flint().arb
    return arb(arb(middle), arb(radius))


def midpoint(ball: Any) -> Fraction:
    """Give the exact midpoint of an arb ball.

    >>> midpoint(flint().arb(0.375))
    Fraction(3, 8)
    """
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def as_ball(value: Any) -> Any:
    """Give a number of any arithmetic as an exact arb (a ball, as it is).

    Raises ``ValueError`` or ``OverflowError`` where it is not finite.
    """
    arb = flint().arb
    if isinstance(value, arb):
        return value
    if hasattr(value, "_mpf_"):
        sign, mantissa, exponent, _ = value._mpf_
        if exponent and not mantissa:
            raise ValueError("not a finite number")
        return arb((int(-mantissa if sign else mantissa), int(exponent)))
    numerator, denominator = value.as_integer_ratio()
    return arb((int(numerator), 1 - int(denominator).bit_length()))


def largest_of(balls: Iterable[Any]) -> Any:
    """Give the largest of balls that are not negative, 0 of none; it is no number if one is none.

    >>> largest_of(map(flint().arb, (1, 2))), largest_of(map(flint().arb, (1, "nan", 2)))
    (2.00000000000000, nan)
    """
    return reduce(flint().arb.max, balls, flint().arb(0))


_precision = threading.RLock()


@dataclass(frozen=True)
class Balls(NumberSystem):
    """Arb balls: every operation gives a rigorous enclosure, at ``bits`` of working precision."""

    bits: int

    @property
    def name(self) -> str:  # type: ignore[override]
        """Such as ``arb balls, 128 bits``."""
        return f"arb balls, {self.bits} bits"

    def number(self, value: Fraction) -> Any:
        """Enclose a rational."""
        made = flint()
        return made.arb(made.fmpq(value.numerator, value.denominator))

    def from_float(self, value: float) -> Any:
        """Give a ball of radius zero."""
        return flint().arb(value)

    @contextmanager
    def active(self) -> Iterator[None]:
        """Set python-flint's precision, the same for all threads, and put it back; others wait."""
        context = flint().ctx
        with _precision:
            before = context.prec
            context.prec = self.bits
            try:
                yield
            finally:
                context.prec = before


@dataclass(frozen=True)
class BigFloat(NumberSystem):
    """mpmath floats of ``dps`` decimal digits, in a context of their own (no global state)."""

    dps: int
    context: Any = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Make the private mpmath context."""
        context = import_module("mpmath").MPContext()
        context.dps = self.dps
        converted = context.npconvert

        def npconvert(value: Any) -> Any:
            if isinstance(value, np.ndarray):  # mpmath would first write out all of it
                raise TypeError("an array is no number")
            return converted(value)

        context.npconvert = npconvert
        object.__setattr__(self, "context", context)

    @property
    def name(self) -> str:  # type: ignore[override]
        """Such as ``mpmath, 60 digits``."""
        return f"mpmath, {self.dps} digits"

    def number(self, value: Fraction) -> Any:
        """Divide numerator by denominator, rounded once."""
        return self.context.mpf(value.numerator) / value.denominator

    def from_float(self, value: float) -> Any:
        """Convert without loss."""
        return self.context.mpf(value)
