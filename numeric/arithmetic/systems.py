"""Number systems: the one place that knows floats, balls and big floats apart.

Every formula of the packing is written once, on NumPy arrays. What differs between number
systems is how a rational enters, how a square root is taken where the elements need help,
what is certain about a sign, and which global precision must be set and put back.
"""

import copyreg
import threading
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cache, reduce
from typing import Any, Protocol

import flint
import mpmath
import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class NumberSystem(Protocol):
    """What the sweeps ask of numbers; see the four implementations below."""

    def __hash__(self) -> int: ...

    @property
    def name(self) -> str:
        """How plans and results call this arithmetic."""

    @property
    def dtype(self) -> Any:
        """NumPy's element type; ``object`` for everything but float64."""

    def number(self, value: Fraction) -> Any:
        """Turn a rational into the nearest number (balls: into an enclosure)."""

    def from_float(self, value: float) -> Any:
        """Turn a float64 into a number, exactly."""

    def from_ball(self, value: Any) -> Any:
        """Turn an arb ball into a number: its midpoint, or the ball itself for balls."""

    @property
    def bits(self) -> int:
        """Bits of working precision."""

    def scalar(self, value: Fraction) -> Any:
        """Turn a rational into a factor that arrays can be multiplied by."""

    def sqrt(self, values: Array) -> Array:
        """Square roots, element by element."""

    def root(self, value: Fraction) -> Any:
        """Give the square root of a rational, as a ``scalar``."""

    def signs(self, values: Array) -> tuple[Array, Array]:
        """Give two boolean arrays: surely positive, surely not (balls may be neither)."""

    def active(self) -> AbstractContextManager[None]:
        """Set the global precision, if any, and put it back at the end."""


def like_array(values: Any) -> Array:
    """Say that numbers are an array to whoever calculates with them, also ``Carried`` ones."""
    found: Array = values
    return found


def array(system: NumberSystem, values: Iterable[Fraction]) -> Array:
    """Turn rationals into a one-dimensional array of the number system."""
    if hasattr(system, "array"):  # numbers that carry their errors
        return like_array(system.array(values))
    listed = [system.number(value) for value in values]
    result = np.empty(len(listed), dtype=system.dtype)
    for q, value in enumerate(listed):  # one by one: a power series looks like a sequence to NumPy
        result[q] = value
    return result


def zeros(system: NumberSystem, *shape: int) -> Array:
    """Give an array of exact zeros."""
    if hasattr(system, "zeros"):
        return like_array(system.zeros(*shape))
    result = np.empty(shape, dtype=system.dtype)
    result.fill(system.number(Fraction(0)))
    return result


def from_floats(system: NumberSystem, values: Array) -> Array:
    """Turn float64 values into the number system, exactly (balls: of radius zero)."""
    if hasattr(system, "from_floats"):
        return like_array(system.from_floats(values))
    if system.dtype is not object:
        return values
    result = np.empty(values.shape, dtype=object)
    flat = result.reshape(-1)
    for q, value in enumerate(values.reshape(-1).tolist()):
        flat[q] = system.from_float(value)
    return result


def as_floats(values: Array) -> Array:
    """Round numbers of any arithmetic to float64 (balls: their midpoints); the same shape."""
    if values.dtype != object:
        return values.astype(np.float64)
    return np.array([float(v) for v in values.reshape(-1)]).reshape(values.shape)


@dataclass(frozen=True)
class Float64:
    """Doubles."""

    name: str = "float64"
    dtype: Any = np.float64
    bits: int = 53

    def number(self, value: Fraction) -> Any:
        """Round to nearest even."""
        return np.float64(value.numerator / value.denominator)

    def from_float(self, value: float) -> Any:
        """Keep it."""
        return np.float64(value)

    def from_ball(self, value: Any) -> Any:
        """Round the midpoint."""
        return self.number(midpoint(value))

    def scalar(self, value: Fraction) -> Any:
        """Give the same as ``number``."""
        return self.number(value)

    def sqrt(self, values: Array) -> Array:
        """Square roots, correctly rounded."""
        return np.asarray(np.sqrt(values))

    def root(self, value: Fraction) -> Any:
        """Round the rational, then its root."""
        return np.sqrt(self.number(value))

    def signs(self, values: Array) -> tuple[Array, Array]:
        """Compare; what is no finite number is not positive."""
        good = np.asarray((values > 0) & np.isfinite(values), dtype=bool)
        return good, ~good

    def __reduce__(self) -> str:
        """Stay the one that there is: a plan asks whether a system *is* that of float64."""
        return "FLOAT64"

    @contextmanager
    def active(self) -> Iterator[None]:
        """Silence floating-point warnings: the sweeps check for what is not finite themselves."""
        with np.errstate(all="ignore"):
            yield


FLOAT64 = Float64()


def midpoint(ball: Any) -> Fraction:
    """Give the exact midpoint of an arb ball.

    >>> midpoint(flint.arb(0.375))
    Fraction(3, 8)
    """
    mantissa, exponent = ball.mid().man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


def as_ball(value: Any) -> Any:
    """Give a number of any arithmetic as an exact arb (a ball, as it is).

    Raises ``ValueError`` or ``OverflowError`` where it is not finite.
    """
    if isinstance(value, flint.arb):
        return value
    if hasattr(value, "_mpf_"):
        if not mpmath.isfinite(value):
            raise ValueError("not a finite number")
        sign, mantissa, exponent, _ = value._mpf_
        return flint.arb((int(-mantissa if sign else mantissa), int(exponent)))
    numerator, denominator = value.as_integer_ratio()
    return flint.arb((int(numerator), 1 - int(denominator).bit_length()))


_flint = threading.RLock()


def largest_of(balls: Iterable[Any]) -> Any:
    """Give the largest of balls that are not negative, 0 of none."""
    return reduce(flint.arb.max, balls, flint.arb(0))


@contextmanager
def in_flint(**settings: int) -> Iterator[None]:
    """Set what python-flint has once for all threads, and put it back; other threads wait."""
    with _flint:
        before = {name: getattr(flint.ctx, name) for name in settings}
        try:
            for name, value in settings.items():
                setattr(flint.ctx, name, value)
            yield
        finally:
            for name, value in before.items():
                setattr(flint.ctx, name, value)


@dataclass(frozen=True)
class BigFloat:
    """mpmath floats of ``dps`` decimal digits, in a context of their own (no global state)."""

    dps: int
    context: Any = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Make the private mpmath context."""
        context = mpmath.MPContext()
        context.dps = self.dps
        converted = context.npconvert

        def npconvert(value: Any) -> Any:
            if isinstance(value, np.ndarray):  # mpmath would first write out all of it
                raise TypeError("an array is no number")
            return converted(value)

        context.npconvert = npconvert
        # mpmath's own would look for the class where it was not made
        context.mpf.__reduce__ = lambda number: (_number_of, (self.dps, number._mpf_))
        object.__setattr__(self, "context", context)

    def __reduce__(self) -> tuple[type["BigFloat"], tuple[int]]:
        """Leave the context out of pickles."""
        return type(self), (self.dps,)

    dtype: Any = field(default=object, init=False, repr=False)

    @property
    def name(self) -> str:
        """Such as ``mpmath, 60 digits``."""
        return f"mpmath, {self.dps} digits"

    def number(self, value: Fraction) -> Any:
        """Divide numerator by denominator, rounded once."""
        return self.context.mpf(value.numerator) / value.denominator

    @property
    def bits(self) -> int:
        """Bits of the significand."""
        return int(self.context.prec)

    def from_float(self, value: float) -> Any:
        """Convert without loss."""
        return self.context.mpf(value)

    def from_ball(self, value: Any) -> Any:
        """Round the midpoint."""
        return self.number(midpoint(value))

    def scalar(self, value: Fraction) -> Any:
        """Give the same as ``number``."""
        return self.number(value)

    def sqrt(self, values: Array) -> Array:
        """Square roots by mpmath."""
        return np.asarray(np.sqrt(values))

    def root(self, value: Fraction) -> Any:
        """Round the rational, then its root."""
        return self.context.sqrt(self.number(value))

    def signs(self, values: Array) -> tuple[Array, Array]:
        """Compare; what is not a number is not positive."""
        good = np.asarray(values > 0, dtype=bool)
        return good, ~good

    @contextmanager
    def active(self) -> Iterator[None]:
        """Balls that these are compared with have a float's bits; the precision of these is theirs.

        It lives in the context.
        """
        with in_flint(prec=53):
            yield


@cache
def _context_of(dps: int) -> Any:
    return BigFloat(dps).context


def _number_of(dps: int, parts: tuple[int, int, int, int]) -> Any:
    """Make a number of mpmath's again that was pickled."""
    return _context_of(dps).make_mpf(parts)


def _pickled(ball: Any) -> tuple[Any, tuple[Any, ...]]:
    """Say how a ball is made again: the same midpoint and radius, bit by bit."""
    if not ball.is_finite():
        return flint.arb, ("nan",)
    middle, (mantissa, exponent) = (_dyadic(one) for one in (ball.mid(), ball.rad()))
    if not mantissa:
        return flint.arb, (middle,)
    # A radius is rounded up when a ball is made, by a unit in its last of 30 digits at least.
    less = 30 - mantissa.bit_length() + 1
    just_below = ((mantissa << less) - 1, exponent - less)
    for radius in (just_below, (mantissa, exponent)):
        made = _ball(middle, radius)
        if made.rad() == ball.rad():
            break
    return _ball, (middle, radius)


def _dyadic(value: Any) -> tuple[int, int]:
    mantissa, exponent = value.man_exp()
    return int(mantissa), int(exponent)


def _ball(middle: tuple[int, int], radius: tuple[int, int]) -> Any:
    return flint.arb(flint.arb(middle), flint.arb(radius))


copyreg.pickle(flint.arb, _pickled)

# No balls of more bits are tried: what they leave open stays open.
MOST_BITS = 8192


@dataclass(frozen=True)
class Balls:
    """Arb balls: every operation gives a rigorous enclosure, at ``bits`` of working precision."""

    bits: int
    dtype: Any = field(default=object, init=False, repr=False)

    @property
    def name(self) -> str:
        """Such as ``arb balls, 128 bits``."""
        return f"arb balls, {self.bits} bits"

    def number(self, value: Fraction) -> Any:
        """Enclose a rational."""
        return flint.arb(flint.fmpq(value.numerator, value.denominator))

    def from_float(self, value: float) -> Any:
        """Give a ball of radius zero."""
        return flint.arb(value)

    def from_ball(self, value: Any) -> Any:
        """Keep the ball."""
        return value

    def scalar(self, value: Fraction) -> Any:
        """Give the same as ``number``."""
        return self.number(value)

    def sqrt(self, values: Array) -> Array:
        """Enclosures of the square roots."""
        return np.asarray(np.sqrt(values))

    def root(self, value: Fraction) -> Any:
        """Enclose the root."""
        return self.number(value).sqrt()

    def signs(self, values: Array) -> tuple[Array, Array]:
        """Decide where the ball lies on one side of zero; elsewhere both are False."""
        return np.asarray(values > 0, dtype=bool), np.asarray(values <= 0, dtype=bool)

    @contextmanager
    def active(self) -> Iterator[None]:
        """Set flint's global precision and put it back."""
        with in_flint(prec=self.bits):
            yield
