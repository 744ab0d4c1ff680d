"""How accurate an answer is, and how many digits of it may be printed."""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np
from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    Balls,
    Hardware,
    NumberSystem,
    as_ball,
    midpoint,
)
from force_diffusion.numeric.lattice.layers import Array
from force_diffusion.numeric.quantities.answers import Table

# A decimal that a ball's radius cuts off is wrong by at most one unit in its last digit: 20 radii.
PRINTED = 20
# An estimated bound is twice what was measured or more: a number within half of it is printed as 0,
# which is then off by its size and by its own error, together no more than the bound.
SWALLOWED = 2


def most_digits(system: Balls) -> int:
    """Give the digits to which even an exact number is printed."""
    return int(system.bits * 0.30103) + 1


@dataclass(frozen=True)
class Accuracy:
    """Error of the answer's small columns, relative to the largest entry of them.

    ``certified``: a rigorous bound (balls). Otherwise it is estimated from a second solution with a
    longer significand. ``bits_lost``: bits of the arithmetic that the answer lacks. A bound below
    what a float can hold is a fraction.
    """

    error_bound: float | Fraction
    certified: bool
    arithmetic: str
    bits_lost: float
    note: str = ""


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


def of_floats(table: Table, longer: Table, whole: Table, system: Hardware) -> Accuracy:
    """Estimate the error of a float solution from one with a longer significand.

    ``table`` and ``longer`` are the two solutions of some realisations out of ``whole``.
    """
    largest, error = 0.0, 0.0
    for name in table.small:
        a, b = table.numbers[name], longer.numbers[name]
        if not len(a):
            continue
        largest = max(largest, float(np.abs(a).max()))
        error = max(error, float(max(abs(float(y - x)) for x, y in zip(a, b, strict=True))))
    unit = 4 * 2.0**-system.bits  # no estimate can promise less than a few roundings
    if not largest:
        bound = math.inf if error else 0.0
        if not error and any(np.any(whole.numbers[name]) for name in whole.small):
            bound = unit  # what was compared is exactly zero, the rest of the answer is not
        return Accuracy(bound, False, system.name, 0.0, "estimated, not certified")
    if not math.isfinite(largest) or not math.isfinite(error):
        return Accuracy(math.inf, False, system.name, float(system.bits))
    ratio = max(2 * error / largest, unit)
    lost = max(system.bits + math.log2(ratio), 0.0)
    return Accuracy(ratio, False, system.name, round(lost, 1), "estimated, not certified")


def strings(table: Table, accuracy: Accuracy, system: NumberSystem) -> dict[str, list[str]]:
    """Print the number columns, each number with the digits that its error leaves."""
    if isinstance(system, Balls):
        most = most_digits(system)
        return {k: [_ball_string(v, most) for v in c] for k, c in table.numbers.items()}
    if system is not FLOAT64:
        return _long_strings(table, accuracy, system)
    largest = max(
        (float(np.abs(table.numbers[k]).max()) for k in table.small if len(table.numbers[k])),
        default=0.0,
    )
    error = (
        float(accuracy.error_bound) * largest if math.isfinite(accuracy.error_bound) else math.inf
    )
    return {k: _float_strings(column, error) for k, column in table.numbers.items()}


def _long_strings(table: Table, accuracy: Accuracy, system: NumberSystem) -> dict[str, list[str]]:
    """Print numbers that a float can't hold, two digits beyond their error."""
    exact = {k: [as_ball(value) for value in column] for k, column in table.numbers.items()}
    error, unit = flint.arb(0), flint.arb((1, 1 - system.bits))
    for name in table.small:
        for value in exact[name]:
            error = error.max(abs(value))
    bound = Fraction(accuracy.error_bound)
    error = error * flint.arb(flint.fmpq(bound.numerator, bound.denominator))
    return {
        k: [_two_beyond(value, error + abs(value) * unit) for value in c] for k, c in exact.items()
    }


def _two_beyond(value: Any, error: Any) -> str:
    if not SWALLOWED * abs(value) > error:
        return "0"
    # powers of two, from which the digits follow within one
    digits = (_power(value) - _power(error)) * 0.30103
    return str(value.str(math.ceil(digits) + 3, radius=False))


def _power(value: Any) -> int:
    mantissa, exponent = value.mid().man_exp()
    return int(mantissa).bit_length() + int(exponent)


def _ball_string(value: Any, most: int) -> str:
    if value.contains(0):
        return "0"
    return str(value.str(most, radius=False))


def _float_strings(column: Array, error: float) -> list[str]:
    result = []
    for value in column.tolist():
        off = error + abs(value) * 2.0**-52
        if not value or not math.isfinite(value) or not SWALLOWED * abs(value) > off:
            result.append("0" if math.isfinite(value) else str(value))
            continue
        # two digits beyond the error: cutting the rest off adds at most a twentieth of it
        digits = math.floor(math.log10(abs(value))) - math.floor(math.log10(off)) + 2
        result.append(f"{value:.{min(max(digits, 1), 17)}g}")
    return result
