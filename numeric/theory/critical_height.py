"""The height beyond which the theory does not hold."""

import math
from fractions import Fraction


def critical_height(relative_std: Fraction) -> float:
    """Give M* = (σ/r)^(−2/3), where contacts begin to pull (Eq. 15); inf beyond a float's range.

    >>> critical_height(Fraction(1, 1000))
    100.0
    """
    if not relative_std:
        return math.inf
    # The exponents of numerator and denominator may lie outside a float's range.
    log = _log10(relative_std.numerator) - _log10(relative_std.denominator)
    return round(10 ** (-2 * log / 3), 9) if log > -460 else math.inf


def _log10(n: int) -> float:
    shift = max(n.bit_length() - 60, 0)
    return math.log10(n >> shift) + shift * math.log10(2)
