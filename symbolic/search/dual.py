"""Dual numbers a + bε with ε² = 0 over fractions, and vectors of two of them."""

from dataclasses import dataclass
from fractions import Fraction

Number = Fraction | int

_LONGEST = 20_000  # bits of a numerator or denominator; what is longer would take for ever


class TooLargeError(ValueError):
    """A number or a packing is larger than what is computed here."""


class Dual:
    """a + bε: what a quantity is to first order in the disorder."""

    __slots__ = ("slope", "value")

    def __init__(self, value: Number, slope: Number = 0) -> None:
        self.value = value
        self.slope = slope

    def __add__(self, other: "Dual") -> "Dual":
        return Dual(self.value + other.value, self.slope + other.slope)

    def __sub__(self, other: "Dual") -> "Dual":
        return Dual(self.value - other.value, self.slope - other.slope)

    def __neg__(self) -> "Dual":
        return Dual(-self.value, -self.slope)

    def __mul__(self, other: "Dual") -> "Dual":
        slope: Number = self.value * other.slope if other.slope else 0
        if self.slope:
            slope += self.slope * other.value
        return Dual(_short(self.value * other.value), slope)

    def __truediv__(self, other: "Dual") -> "Dual":
        return self * other.inverse()

    def inverse(self) -> "Dual":
        """1/(a + bε).

        Raises:
            ZeroDivisionError: a is 0.
        """
        above = Fraction(1, self.value)
        return Dual(above, -self.slope * above * above if self.slope else 0)

    def __pow__(self, power: int) -> "Dual":
        if power < 0:
            return self.inverse() ** -power
        _short(self.value, times=power)
        below = self.value ** max(power - 1, 0)
        return Dual(below * self.value if power else 1, power * below * self.slope)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Dual) and self.value == other.value and self.slope == other.slope

    __hash__ = None  # type: ignore[assignment]

    def __bool__(self) -> bool:
        return bool(self.value or self.slope)

    def thousands_of_bits(self) -> int:
        """How long it is, in full thousands of bits.

        Raises:
            TooLargeError: too long to go on with.
        """
        bits = max(_bits(self.value), _bits(self.slope) if self.slope else 0)
        if bits > _LONGEST:
            raise TooLargeError(f"a number has more than {_LONGEST} bits")
        return bits // 1000

    def __repr__(self) -> str:
        return f"{self.value} + ({self.slope})ε"


def _bits(number: Number) -> int:
    return number.numerator.bit_length() + number.denominator.bit_length()


def _short(number: Number, times: int = 1) -> Number:
    if _bits(number) * times > _LONGEST:
        raise TooLargeError(f"a number has more than {_LONGEST} bits")
    return number


@dataclass(slots=True)
class Vector:
    """Cartesian components, x across and y up."""

    x: Dual
    y: Dual

    def __add__(self, other: "Vector") -> "Vector":
        return Vector(self.x + other.x, self.y + other.y)

    def __sub__(self, other: "Vector") -> "Vector":
        return Vector(self.x - other.x, self.y - other.y)

    def __neg__(self) -> "Vector":
        return Vector(-self.x, -self.y)

    def times(self, factor: Dual) -> "Vector":
        """The vector, so many times as long."""
        return Vector(self.x * factor, self.y * factor)

    def dot(self, other: "Vector") -> Dual:
        """The dot product."""
        return self.x * other.x + self.y * other.y

    def cross(self, other: "Vector") -> Dual:
        """The determinant of both, as columns."""
        return self.x * other.y - self.y * other.x

    def __bool__(self) -> bool:
        return bool(self.x) or bool(self.y)


ZERO = Dual(0)
NOWHERE = Vector(ZERO, ZERO)
