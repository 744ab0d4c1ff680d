"""Estimated errors under a tolerance: what is expected beforehand, and what a repeat measured.

The repeat solves the same packings with a longer significand. Its own error is bounded where balls
did it, and allowed for by ``floor`` where hardware floats did.
"""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np
from force_diffusion.numeric.accuracy.enclosed import Accuracy
from force_diffusion.numeric.arithmetic.systems import Balls, NumberSystem, as_ball, midpoint
from force_diffusion.numeric.planning.plan import Plan, Way
from force_diffusion.numeric.quantities.answers import Table

# A measured error is doubled: what repeats it is not exact.
SAFETY = 2
# Realisations that nobody repeated. Rounding errors of independent packings are alike, and near
# normal: of N numbers the largest is below 6 standard deviations for every N that is allowed, and
# that the largest of four is below 6/1000 of one has a chance of 5e-10.
UNSEEN = 1000
# Room for printing: see ``accuracy.SWALLOWED``, and what digits that are cut off add.
PRINTED = 2


def usual_units(system: NumberSystem, height: int) -> Fraction:
    """Give the largest rounding error to be expected, in units 2^-bits of the largest change.

    Measured up to height 128, in all quantities, loads and geometries, from σ/r = 1e-3 down to
    1e-100: at most 17, growing with the height. Hardware floats sum forces with compensation, big
    floats do not.
    """
    return Fraction(8) + (Fraction(height, 4) if system.dtype is not object else 2 * height)


def expected(way: Way, height: int, realisations: int, lost: int = 0) -> Fraction:
    """Give the error that an answer is expected to be printed with, relative to its largest change.

    For balls, what they should certify: they lose some bits for the depth of the packing, and those
    that the plain form has ``lost``.
    """
    bits = way.system.bits
    if way.certified:
        return Fraction(max(height, 4) ** 2 * 2**12, 2 ** (bits - lost))
    seen = way.repeated >= realisations
    units = usual_units(way.system, height) * (SAFETY if seen else UNSEEN)
    return (PRINTED * units + _merging(way, realisations)) * Fraction(1, 2**bits)


def _merging(way: Way, realisations: int) -> int:
    """Bound the roundings of merged statistics, in units 2^-bits: a few for each realisation."""
    return 0 if way.repeated >= realisations else 8 * realisations


def of_repeat(table: Table, again: Table, whole: Table, plan: Plan) -> Accuracy:
    """Estimate the error of a whole answer, as printed.

    ``table`` and ``again`` are the solutions of the repeated realisations, in the arithmetic of the
    plan and in the longer one.
    """
    way = plan.way
    assert way.longer is not None
    unit = Fraction(1, 2**way.system.bits)
    apart = Fraction(0)
    for name in table.small:
        difference = _apart(table.numbers[name], again.numbers[name], way.longer)
        if difference is None:
            return Accuracy(math.inf, False, way.system.name, float(way.system.bits))
        apart = max(apart, difference)
    largest = max((_largest(whole.numbers[name]) for name in whole.small), default=Fraction(0))
    if not largest:
        note = "every change is zero here, and only balls can tell whether that is exact"
        return Accuracy(math.inf, False, way.system.name, 0.0, note)
    seen = way.repeated >= plan.realisations
    factor = SAFETY if seen else UNSEEN
    absolute = factor * apart + SAFETY * _floor(plan, whole, largest)
    ratio = max(absolute / largest, 4 * unit) + _merging(way, plan.realisations) * unit
    lost = max(way.system.bits + _log2(ratio), 0.0)
    note = f"estimated, not certified, from {way.repeated} of {plan.realisations} realisations"
    return Accuracy(_bound(PRINTED * ratio), False, way.system.name, round(lost, 1), note)


def _floor(plan: Plan, whole: Table, largest: Fraction) -> Fraction:
    """Allow for the error of a repeat in hardware floats, which balls say of themselves.

    It is relative to the terms that changes are sums of, σ/r times the forces (positions: the
    radius): a change that is left over where these cancel may be far smaller.
    """
    longer = plan.way.longer
    if longer is None or isinstance(longer, Balls):
        return Fraction(0)
    if plan.needs_forces:
        loads = (max(abs(x), abs(y)) for x, y in plan.load.single.values())
        scale = max(max(loads, default=Fraction(1)), Fraction(1))
        for name, values in whole.numbers.items():
            if name not in whole.small:
                scale = max(scale, _largest(values))
    else:
        scale = plan.scene.packing.radius
    terms = max(largest, scale * plan.radii.relative_std())
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
