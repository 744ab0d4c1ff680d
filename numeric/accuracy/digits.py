"""Numbers printed with the digits that their error leaves."""

import math
from fractions import Fraction
from typing import Any

import flint
import numpy as np

from ..arithmetic.systems import FLOAT64, Array, Balls, NumberSystem, as_ball
from ..quantities.base import Table
from .accuracy import Accuracy
from .enclosed import most_digits

# An estimated bound is twice what was measured or more: a number within half of it is printed as 0,
# which is then off by its size and by its own error, together no more than the bound.
SWALLOWED = 2


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
