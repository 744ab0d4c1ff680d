"""Estimated errors: what a repeat with a longer significand measured.

The repeat solves the same packings. Its own error is bounded where balls did it, and allowed for by
``_floor`` where hardware floats did.
"""

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import (
    FLOAT64,
    Balls,
    Hardware,
    NumberSystem,
    as_ball,
    as_floats,
    midpoint,
)
from ..mechanics.work import Work
from ..planning.expected_error import (
    PRINTED,
    SAFETY,
    UNSEEN,
    merging,
    usual_units,
)
from ..planning.plan import ESTIMATE, Plan
from ..quantities.answer import Answer, answer
from ..quantities.base import Table
from .accuracy import Accuracy

ESTIMATED = "estimated, not certified"


def repeated(plan: Plan, work: Work) -> tuple[Answer, Accuracy]:
    """Answer, and solve the first realisations again with a longer significand to compare."""
    quantity, problem, longer = plan.quantity, plan.problem, plan.method.longer
    found = answer(quantity, problem, range(problem.realisations), plan.system, work)
    few = range(plan.method.repeated)
    part = replace(problem, realisations=len(few))
    assert longer is not None
    with work.repeat(ESTIMATE):
        table = found.table
        if len(few) < problem.realisations:
            table = answer(quantity, part, few, plan.system, work).table
        again = answer(quantity, part, few, longer, work).table
        if plan.tolerance is None and plan.system is FLOAT64:
            return found, of_floats(table, again, found.table, FLOAT64)
        with longer.active():
            return found, of_repeat(table, again, found.table, plan)


def shortfall(found: Answer, accuracy: Accuracy, tolerance: Fraction) -> str:
    """Say why an estimated answer does not meet the tolerance; an empty string where it does."""
    if not accuracy.within(tolerance):
        return accuracy.still if accuracy.bits_lost else accuracy.note
    if found.bins:
        edges = [found.bins[0][0], *(high for _, high, _ in found.bins)]
        if edge_in_doubt(found.table, edges, accuracy):
            return "a change lies within its error of the edge of a bin"
    return ""


def of_floats(table: Table, longer: Table, whole: Table, system: Hardware) -> Accuracy:
    """Estimate the error of a float solution from one with a longer significand.

    ``table`` and ``longer`` are the two solutions of some realisations out of ``whole``.
    """
    found = of_distances([distances(table, longer)], system)
    if not found.error_bound and any(np.any(whole.numbers[name]) for name in whole.small):
        # what was compared is exactly zero, the rest of the answer is not
        return replace(found, error_bound=_unit(system))
    return found


def distances(table: Table, longer: Table) -> tuple[float, float]:
    """Give the largest change of a float solution, and its largest distance from a longer one."""
    pairs = [(table.numbers[name], longer.numbers[name]) for name in table.small]
    largest = np.max([np.abs(a).max(initial=0) for a, _ in pairs])
    return float(largest), float(np.max([abs(as_floats(b - a)).max(initial=0) for a, b in pairs]))


def of_distances(parts: Sequence[tuple[float, float]], system: Hardware) -> Accuracy:
    """Estimate the error of a float solution from the ``distances`` of its parts."""
    largest, error = map(float, np.max(parts, axis=0))
    if not largest:
        bound = math.inf if error else 0.0
        return Accuracy(bound, False, system.name, 0.0, ESTIMATED)
    if not math.isfinite(largest) or not math.isfinite(error):
        return Accuracy(math.inf, False, system.name, float(system.bits))
    ratio = max(2 * error / largest, _unit(system))
    lost = max(system.bits + math.log2(ratio), 0.0)
    return Accuracy(ratio, False, system.name, round(lost, 1), ESTIMATED)


def _unit(system: Hardware) -> float:
    """No estimate can promise less than a few roundings."""
    return 4 * 2.0**-system.bits


def of_repeat(table: Table, again: Table, whole: Table, plan: Plan) -> Accuracy:
    """Estimate the error of a whole answer, as printed.

    ``table`` and ``again`` are the solutions of the repeated realisations, in the arithmetic of the
    plan and in the longer one.
    """
    method = plan.method
    assert method.longer is not None
    unit = Fraction(1, 2**method.system.bits)
    apart = Fraction(0)
    for name in table.small:
        difference = _apart(table.numbers[name], again.numbers[name], method.longer)
        if difference is None:
            return Accuracy(math.inf, False, method.system.name, float(method.system.bits))
        apart = max(apart, difference)
    largest = max((_largest(whole.numbers[name]) for name in whole.small), default=Fraction(0))
    if not largest:
        note = "every change is zero here, and only balls can tell whether that is exact"
        return Accuracy(math.inf, False, method.system.name, 0.0, note)
    seen = method.repeated >= plan.problem.realisations
    factor = SAFETY if seen else UNSEEN
    absolute = factor * apart + SAFETY * _floor(plan, whole, largest)
    ratio = max(absolute / largest, 4 * unit) + merging(method, plan.problem.realisations) * unit
    lost = max(method.system.bits + _log2(ratio), 0.0)
    of_all = f"{method.repeated} of {plan.problem.realisations} realisations"
    note = f"{ESTIMATED}, from {of_all}"
    return Accuracy(_bound(PRINTED * ratio), False, method.system.name, round(lost, 1), note)


def _floor(plan: Plan, whole: Table, largest: Fraction) -> Fraction:
    """Allow for the error of a repeat in hardware floats, which balls say of themselves.

    It is relative to the terms that changes are sums of, σ/r times the forces (positions: the
    radius): a change that is left over where these cancel may be far smaller.
    """
    longer = plan.method.longer
    if longer is None or isinstance(longer, Balls):
        return Fraction(0)
    if plan.problem.needs_forces:
        loads = (max(map(abs, force)) for force in plan.problem.load.single.values())
        scale = max(max(loads, default=Fraction(1)), Fraction(1)) * plan.scene.load.magnitude
        for name, values in whole.numbers.items():
            if name not in whole.small:
                scale = max(scale, _largest(values))
    else:
        scale = plan.scene.packing.radius
    terms = max(largest, scale * plan.problem.radii.relative_std())
    return Fraction(usual_units(longer, plan.scene.packing.height) * terms / 2**longer.bits)


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
