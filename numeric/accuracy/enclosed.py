"""The certified error of an answer in balls."""

import math
from fractions import Fraction
from typing import Any

import flint

from ..arithmetic.systems import Balls, midpoint
from ..quantities.base import Table
from .accuracy import Accuracy

# A decimal that a ball's radius cuts off is wrong by at most one unit in its last digit: 20 radii.
PRINTED = 20


def most_digits(system: Balls) -> int:
    """Give the digits to which even an exact number is printed."""
    return int(system.bits * 0.30103) + 1


def of_balls(table: Table, system: Balls, floor: Fraction) -> Accuracy:
    """Judge an answer in balls; ``floor`` is the size below which a change counts as zero."""
    largest, radius = flint.arb(0), flint.arb(0)
    for name in table.small:
        for value in table.numbers[name]:
            if not value.is_finite():
                return Accuracy(math.inf, True, system.name, float(system.bits))
            largest = largest.max(value.abs_lower())
            radius = radius.max(value.rad())
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
