"""Answers in any arithmetic, and how far they are from those that balls enclose."""

from collections.abc import Sequence
from decimal import ROUND_CEILING, Context, Decimal
from typing import Any

import numpy as np

from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError, UndecidedError
from ..arithmetic.systems import Array, Balls, NumberSystem, as_ball, largest_of
from ..disorder.radii import RadiusError
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import Work
from ..planning.plan import Plan
from ..quantities.answer import answer as whole_answer
from ..quantities.base import Table


class IncomparableError(ForceDiffusionError, ArithmeticError):
    """An answer has not the rows of the reference, or is not finite."""

    exit_status = NOT_REACHED


class Enclosed:
    """Numbers in balls, ``best``, and how far others are from them, relative to the largest one."""

    def __init__(self, best: Array, system: Balls) -> None:
        self.best, self.system = best, system
        with system.active():
            self.largest = largest_of(value.abs_lower() for value in best)
            self.radius = largest_of(value.rad() for value in best)

    @property
    def sound(self) -> bool:
        """Whether all are finite, and the largest can be told from zero."""
        return bool(self.largest > 0 and self.radius.is_finite())

    def off(self, found: Array, meant: Array | None = None) -> Decimal:
        """Bound the largest distance from what was ``meant``, by default the best."""
        meant = self.best if meant is None else meant
        if found is meant:
            return Decimal(0)
        with self.system.active():
            pairs = zip(found, meant, strict=True)
            return self.relative(largest_of((exactly(a) - b).abs_upper() for a, b in pairs))

    def relative(self, size: Any) -> Decimal:
        """Give a size over that of the largest of the numbers, rounded up."""
        with self.system.active():
            return decimal((size / self.largest).upper())

    def errors(self, found: Array, meant: Array | None = None) -> dict[str, Any]:
        """Give the errors of ``Way``; ``meant`` is what the way computes, by default the best."""
        meant = self.best if meant is None else meant
        return {
            "error": self.off(found),
            "model_error": self.off(meant),
            "rounding_error": self.off(found, meant),
        }


FAILURES = (UnbuildableError, UndecidedError, NotStandingError, RadiusError, IncomparableError)
"""What is raised where a packing has no answer in some arithmetic."""


def answer(plan: Plan, system: NumberSystem, realisations: Sequence[int]) -> Table:
    """Answer a plan's question for some realisations, and nothing beside it.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    problem, work = plan.problem, Work(repeating=True)  # what is physical was judged before
    return whole_answer(plan.quantities, problem, realisations, system, work).table


def changes(table: Table) -> Array:
    """Give all numbers of an answer that vanish without disorder."""
    return np.concatenate([table.numbers[name] for name in table.small])


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

    >>> import flint
    >>> decimal(flint.arb(1) / 3 * flint.arb(10) ** -400)
    Decimal('3.3334E-401')
    """
    # Twenty digits are within one unit of the last place, which the factor makes up for.
    shown = Decimal(value.upper().str(20, radius=False)) * (1 + Decimal("1e-18"))
    return Context(prec=digits, rounding=ROUND_CEILING).create_decimal(shown)
