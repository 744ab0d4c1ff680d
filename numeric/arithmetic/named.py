"""Number systems by the names that users write."""

import math

from .carried import PAIRS
from .systems import FLOAT64, LONGDOUBLE, MOST_DIGITS, Balls, BigFloat, NumberSystem


def system_of(name: str) -> NumberSystem:
    """Give a number system by its name; ``ValueError`` says which there are.

    >>> [system_of(name).name for name in ("float64", "mpmath 50", "balls 50")]
    ['float64', 'mpmath, 50 digits', 'arb balls, 167 bits']
    """
    if name == "pairs":
        return PAIRS
    kind, _, digits = str(name).partition(" ")
    if name in (FLOAT64.name, LONGDOUBLE.name):
        return FLOAT64 if name == FLOAT64.name else LONGDOUBLE
    if kind in ("mpmath", "balls") and digits.isdecimal() and 15 <= int(digits) <= MOST_DIGITS:
        if kind == "mpmath":
            return BigFloat(int(digits))
        return Balls(math.ceil(int(digits) * math.log2(10)))
    raise ValueError(
        'must be "float64", "pairs", "longdouble", "mpmath N" or "balls N" with N decimal digits, '
        f"from 15 to {MOST_DIGITS}"
    )
