"""The certified reference of a study of cost: balls far smaller than every error shown."""

from collections.abc import Iterator
from decimal import ROUND_CEILING, Context, Decimal
from fractions import Fraction
from typing import Any

import flint

from ...accuracy.accuracy import ToleranceError
from ...arithmetic.errors import NOT_REACHED, ForceDiffusionError, UndecidedError
from ...arithmetic.systems import MOST_BITS, Balls, as_ball, largest_of
from ...mechanics.sweep import NotStandingError
from ...planning.methods import initial_bits
from ...planning.plan import Plan
from ...quantities.base import Table
from ...scene.sections import SceneError
from .ways import DIGITS, answer

# The reference's radius has to lie this far below the last digit of the most precise way.
BEYOND = Fraction(1, 10 ** (max(DIGITS) + 20))


class IncomparableError(ForceDiffusionError, ArithmeticError):
    """An answer has not the rows of the reference, or is not finite."""

    exit_status = NOT_REACHED


class CertifiedReference:
    """A certified reference: balls so small that no error shown depends on them."""

    def __init__(self, plan: Plan) -> None:
        """Raise the precision until the largest radius, relative to the largest change, fits."""
        bits = initial_bits(BEYOND, plan.scene.packing.height)
        why = ""
        while bits <= MOST_BITS:
            self.system = Balls(bits)
            bits *= 2
            try:
                self.table = answer(plan, self.system, [0])
            except (UndecidedError, NotStandingError) as error:
                why = f"at {self.system.bits} bits: {error}"
                continue
            with self.system.active():
                self.largest = largest_of(v.abs_lower() for v in self._entries(self.table))
                radius = largest_of(v.rad() for v in self._entries(self.table))
                if not radius.is_zero() and not self.largest > 0:
                    why = f"at {self.system.bits} bits no change can be told from zero"
                    continue
                if self.largest.is_zero():
                    raise SceneError("ask.quantity", plan.scene.ask.quantity, "it is exactly zero")
                self.radius = decimal((radius / self.largest).upper())
                if radius / self.largest < Balls(self.system.bits).number(BEYOND):
                    return
                why = f"at {self.system.bits} bits its radius is still {self.radius:.1e}"
        raise ToleranceError(f"no certified reference was found: {why}")

    def _entries(self, table: Table) -> Iterator[Any]:
        for name in self.table.small:
            yield from table.numbers[name]

    def error(self, table: Table, largest: Any = None) -> Decimal:
        """Bound the distance of a table from the enclosure, relative to the largest change."""
        if any(len(table.numbers[n]) != len(self.table.numbers[n]) for n in self.table.small):
            raise IncomparableError("it stopped at another contact than the reference")
        with self.system.active():
            pairs = zip(self._entries(table), self._entries(self.table), strict=True)
            worst = largest_of((exactly(value) - ball).abs_upper() for value, ball in pairs)
            return decimal((worst / (largest or self.largest)).upper())

    def bound(self, table: Table) -> Decimal | None:
        """Give what a table in balls certifies of itself; None for other arithmetic."""
        with self.system.active():
            radii = [v.rad() for v in self._entries(table) if isinstance(v, flint.arb)]
            return decimal((largest_of(radii) / self.largest).upper()) if radii else None


def exactly(value: Any) -> Any:
    """Give a number (of a ball, its midpoint) as an exact arb."""
    try:
        ball = as_ball(value)
    except (ValueError, OverflowError) as error:
        raise IncomparableError("a number is not finite") from error
    if not ball.is_finite():
        raise IncomparableError("its enclosure is infinite")
    return ball.mid()


def decimal(value: Any, digits: int = 5) -> Decimal:
    """Round an arb up to so many digits; a Decimal's exponent has no end where a float's has.

    >>> decimal(flint.arb(1) / 3 * flint.arb(10) ** -400)
    Decimal('3.3334E-401')
    """
    # Twenty digits are within one unit of the last place, which the factor makes up for.
    shown = Decimal(value.upper().str(20, radius=False)) * (1 + Decimal("1e-18"))
    return Context(prec=digits, rounding=ROUND_CEILING).create_decimal(shown)
