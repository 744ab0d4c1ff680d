"""Answers in balls: certified, and bits are added until the enclosure is small enough."""

import math
from dataclasses import replace
from fractions import Fraction
from typing import Any

import flint

from ..arithmetic.decimals import short
from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import MOST_BITS, Balls, largest_of, midpoint
from ..mechanics.sweep import NotStandingError
from ..mechanics.work import Work
from ..planning.plan import CERTIFY, Plan
from ..planning.planner import initial_bits
from ..quantities.answer import Answer, answer
from ..quantities.base import Table
from ..theory.expected import critical_height
from .accuracy import Accuracy, ToleranceError, most_digits

# A decimal that a ball's radius cuts off is wrong by at most one unit in its last digit: 20 radii.
PRINTED = 20


def of_balls(table: Table, system: Balls, floor: Fraction) -> Accuracy:
    """Judge an answer in balls; ``floor`` is the size below which a change counts as zero."""
    values = [value for name in table.small for value in table.numbers[name]]
    if not all(value.is_finite() for value in values):
        return Accuracy(math.inf, True, system.name, float(system.bits))
    largest = largest_of(value.abs_lower() for value in values)
    radius = largest_of(value.rad() for value in values)
    if radius == 0 and largest == 0:
        return Accuracy(0.0, True, system.name, 0.0)
    note = ""
    if not largest > 0:
        if not floor:
            return Accuracy(math.inf, True, system.name, float(system.bits))
        largest = system.number(floor)
        note = "no change can be told from zero; the error is relative to σ/r instead"
    ratio = (radius / largest).upper()
    lost = 0.0
    if ratio > 0:
        lost = max(system.bits + float(ratio.log() / flint.arb.const_log2()), 0.0)
    printed = ratio * PRINTED + flint.arb(10) ** (1 - most_digits(system))
    return Accuracy(_up(printed), True, system.name, round(lost, 1), note)


def _up(value: Any) -> float | Fraction:
    """Round a small positive ball up to a float; below the range of floats, to a fraction."""
    upper = midpoint(value.upper())
    if upper < Fraction(1, 10**300):
        return upper
    return float(upper) * (1 + 1e-15) if upper < 10**300 else math.inf


def enclosed(plan: Plan, work: Work) -> tuple[Plan, Answer, Accuracy]:
    """Raise the precision until the enclosure is small enough.

    Gives the plan with the precision that was. Raises ``ToleranceError``, which says why more bits
    do not help.
    """
    problem, spread = plan.problem, plan.problem.radii.relative_std()
    floor = spread * (plan.scene.load.magnitude if problem.needs_forces else 1)
    system = plan.system
    assert isinstance(system, Balls)
    if system.bits > MOST_BITS:
        raise ToleranceError(
            f"the tolerance can't be reached: {short(plan.tolerance or floor)} at height "
            f"{problem.height} needs {system.bits} bits or more, and {MOST_BITS} are "
            f"the most; ask for about {_least_tolerance(problem.height)} at best"
        )
    while True:
        try:
            found = answer(plan.quantity, problem, range(problem.realisations), system, work)
            with work.timed(CERTIFY), system.active():
                accuracy = of_balls(found.table, system, floor)
            if plan.tolerance is None or accuracy.within(plan.tolerance):
                return replace(plan, method=replace(plan.method, system=system)), found, accuracy
            why = f"at {system.bits} bits {accuracy.still}"
        except (UndecidedError, NotStandingError) as error:
            why = f"at {system.bits} bits: {error}"
        if system.bits == MOST_BITS:
            break
        system = Balls(min(2 * system.bits, MOST_BITS))
    message = f"the tolerance can't be reached: {why}, and more than {MOST_BITS} are not tried"
    highest = critical_height(spread)
    if problem.height > highest / 2:
        message += (
            f"; the height is {problem.height}, and the theory holds well below "
            f"M* = (σ/r)^(-2/3) = {highest:.3g}"
        )
    raise ToleranceError(message)


def _least_tolerance(height: int) -> str:
    """Give the power of ten that the highest precision starts with, at this height."""
    digits = MOST_BITS - initial_bits(Fraction(1), height)
    return f"1e-{int(digits * 0.30102)}"
