"""Estimated errors: what sweeps carried along, or a repeat with a longer significand measured.

Numbers of float64 are corrected by the errors that their sweep carried and rounded once; what is
stated is what that rounding left. Other arithmetics are repeated, in balls, which know their error.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import (
    FLOAT64,
    NumberSystem,
    as_ball,
    midpoint,
)
from ..mechanics.kept import Kept
from ..mechanics.work import ESTIMATE, Work
from ..planning.plan import Plan
from ..planning.planner import PRINTED, SAFETY, UNSEEN, merging, usual_units
from ..quantities.answer import Answer, answer
from ..quantities.base import Table
from .accuracy import Accuracy

CARRIED = "estimated, as the sweep carried it, not certified"


def repeated(plan: Plan, work: Work, kept: Kept | None = None) -> tuple[Answer, Accuracy]:
    """Answer, and say how large the error is: as sweeps carried it, or a repeat measured it.

    ``kept``: what an earlier run has kept of a sweep by segments.
    """
    quantity, problem, method = plan.quantity, plan.problem, plan.method
    longer = method.longer
    assert longer is not None
    few = range(method.repeated)
    if method.carries and len(few) >= problem.realisations:
        beside = longer if plan.system is FLOAT64 else None
        found = answer(quantity, problem, few, plan.system, work, longer=beside, kept=kept)
        with longer.active():
            return found, of_carried(found, plan)
    found = answer(quantity, problem, range(problem.realisations), plan.system, work)
    part = replace(problem, realisations=len(few))
    with work.repeat(ESTIMATE):
        table = found.table
        if len(few) < problem.realisations:
            table = answer(quantity, part, few, plan.system, work).table
        if plan.system is FLOAT64:
            right = answer(quantity, part, few, FLOAT64, work, longer=longer)
            again = right.table if right.exact is None else right.exact
        else:
            again = answer(quantity, part, few, longer, work).table
        with longer.active():
            return found, of_repeat(table, again, found.table, plan)


def of_carried(found: Answer, plan: Plan) -> Accuracy:
    """State the error of an answer whose sweeps carried it, from the table that holds both."""
    apart: Fraction | None = Fraction(0)
    if found.left is not None:
        apart = Fraction(found.left) if math.isfinite(found.left) else None
    elif found.exact is not None:
        apart = _farthest(found.table, found.exact, plan.system)
    return _unknown(plan.system) if apart is None else stated(found, apart, plan)


def stated(found: Answer, apart: Fraction, plan: Plan) -> Accuracy:
    """State the error of an answer whose sweeps carried it.

    ``apart`` is what one rounding left; to it comes what the carried errors leave out themselves
    (``Sizes.unseen``).
    """
    system, table = plan.system, found.table
    largest = max((_largest(table.numbers[name]) for name in table.small), default=Fraction(0))
    unseen = _unseen(found, plan, largest)
    if unseen is None:
        return _unknown(system)
    if not largest:
        exact = not apart and not found.sizes.changed and not found.sizes.moved
        return _of_zeros(plan, CARRIED, exact=exact)
    ratio = (apart + unseen) / largest
    if plan.tolerance is not None:
        ratio = PRINTED * max(ratio, Fraction(1, 2**system.bits))
    lost = max(system.bits + _log2(ratio), 0.0) if ratio else 0.0
    return Accuracy(_bound(ratio), False, system.name, round(lost, 1), CARRIED)


def _unseen(found: Answer, plan: Plan, largest: Fraction) -> Fraction | None:
    """Give what carried errors leave out, in the unit of the answer; None where that is no number.

    It is doubled for sums of a few numbers. Gathering them in the longer arithmetic rounds, too,
    relative to the terms that changes are sums of, σ/r times the forces (positions: the radius): a
    change that is left over where these cancel may be far smaller.
    """
    scene, longer = plan.scene, plan.method.longer
    assert longer is not None
    force, moved = found.sizes.unseen(scene.packing.height)
    if not math.isfinite(force + moved):
        return None
    if plan.problem.needs_forces:
        size = Fraction(force) * scene.load.magnitude
        scale = max(Fraction(found.sizes.force), Fraction(1)) * scene.load.magnitude
    else:
        size = Fraction(moved * float(1 / plan.problem.n_x)) * scene.packing.radius
        scale = scene.packing.radius
    terms = max(largest, scale * plan.problem.radii.relative_std())
    rounding: Fraction = usual_units(longer, 1) * terms / 2**longer.bits
    unseen: Fraction = 2 * size + rounding
    return unseen


def shortfall(found: Answer, accuracy: Accuracy, tolerance: Fraction) -> str:
    """Say why an estimated answer does not meet the tolerance; an empty string where it does."""
    if not accuracy.within(tolerance):
        return accuracy.still if accuracy.bits_lost else accuracy.note
    if found.bins:
        edges = [found.bins[0][0], *(high for _, high, _ in found.bins)]
        if edge_in_doubt(found.table, edges, accuracy):
            return "a change lies within its error of the edge of a bin"
    return ""


def of_repeat(table: Table, again: Table, whole: Table, plan: Plan) -> Accuracy:
    """Estimate the error of a whole answer, as printed.

    ``table`` and ``again`` are the solutions of the repeated realisations, in the arithmetic of the
    plan and in the longer one.
    """
    method = plan.method
    assert method.longer is not None
    unit = Fraction(1, 2**method.system.bits)
    apart = _farthest(table, again, method.longer)
    if apart is None:
        return _unknown(method.system)
    largest = max((_largest(whole.numbers[name]) for name in whole.small), default=Fraction(0))
    if not largest:
        return _of_zeros(plan, "estimated, not certified", exact=not apart)
    seen = method.repeated >= plan.problem.realisations
    factor = SAFETY if seen else UNSEEN
    ratio = max(factor * apart / largest, 4 * unit)
    ratio += merging(method, plan.problem.realisations) * unit
    lost = max(method.system.bits + _log2(ratio), 0.0)
    of_all = f"{method.repeated} of {plan.problem.realisations} realisations"
    note = f"estimated, not certified, from {of_all}"
    printed = ratio if plan.tolerance is None else PRINTED * ratio
    return Accuracy(_bound(printed), False, method.system.name, round(lost, 1), note)


def _unknown(system: NumberSystem) -> Accuracy:
    """Say that an error is not finite."""
    return Accuracy(math.inf, False, system.name, float(system.bits))


def _of_zeros(plan: Plan, note: str, *, exact: bool) -> Accuracy:
    """State the error where every change is zero; ``exact``: as far as was seen."""
    if exact and plan.tolerance is None:
        return Accuracy(0.0, False, plan.system.name, 0.0, note)
    note = "every change is zero here, and only balls can tell whether that is exact"
    return Accuracy(math.inf, False, plan.system.name, 0.0, note)


def _farthest(table: Table, other: Table, system: NumberSystem) -> Fraction | None:
    """Bound how far small columns of two tables are apart; None where a number is not finite."""
    found = Fraction(0)
    for name in table.small:
        one = _apart(table.numbers[name], other.numbers[name], system)
        if one is None:
            return None
        found = max(found, one)
    return found


def _apart(values: Any, longer: Any, system: NumberSystem) -> Fraction | None:
    """Bound the largest distance of two columns; None where a number is not finite."""
    if not len(values):
        return Fraction(0)
    if longer.dtype != object:
        worst = np.abs(longer - values).max()
        return Fraction(*worst.as_integer_ratio()) if np.isfinite(worst) else None
    worst_ball = Fraction(0)
    try:
        for value, ball in zip(values, longer, strict=True):
            distance = abs(as_ball(value) - as_ball(ball)).upper()
            if not distance.is_finite():
                return None
            worst_ball = max(worst_ball, midpoint(distance))
    except (ValueError, OverflowError):  # not a number, or infinite
        return None
    return worst_ball


def _largest(values: Any) -> Fraction:
    if not len(values):
        return Fraction(0)
    if values.dtype != object:
        most = np.abs(values).max()
        return Fraction(*most.as_integer_ratio()) if np.isfinite(most) else Fraction(0)
    return max(abs(midpoint(as_ball(value))) for value in values)


def edge_in_doubt(table: Table, edges: Sequence[Fraction], accuracy: Accuracy) -> bool:
    """Say whether a change lies within its error of the edge of a bin: counts may be off."""
    values = table.numbers["change"]
    largest = _largest(values)
    # bins are counted in float64, whatever the arithmetic
    error = Fraction(accuracy.error_bound) * largest + largest / 2**52
    sorted_values = np.sort(np.array([float(v) for v in values]))
    for edge in edges:
        near = np.searchsorted(sorted_values, float(edge))
        for value in sorted_values[max(near - 1, 0) : near + 1].tolist():
            if abs(Fraction(value) - edge) <= error:
                return True
    return False


def _bound(ratio: Fraction) -> float | Fraction:
    """Round up to a float; below the range of floats, keep the fraction."""
    return ratio if ratio < Fraction(1, 10**300) else float(ratio) * (1 + 1e-15)


def _log2(value: Fraction) -> float:
    shift = value.numerator.bit_length() - value.denominator.bit_length()
    return shift + math.log2(value / Fraction(2) ** shift)
