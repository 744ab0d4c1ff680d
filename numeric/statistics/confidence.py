"""How sure an ensemble is of σ_f, and when it may stop.

The unit is the packing: the contacts of one are correlated, packings are independent. Stopping as
soon as an error looks small favours errors that look too small. So the sums are looked at only at
fixed sizes, and look k may be wrong with probability α/(k (k + 1)), of which all looks together
have α: whenever the run stops, its statement holds with at least the confidence 1 − α that was
asked, as far as ln σ_f is normal (Student's t, at least 32 packings). The share of a look is
divided among the groups, so that the statement is about all of them at once.

Intervals are those of ln σ_f: squares of few contacts are skewed, and σ_f and its error are small
together. Of single σ_f of strips six to eight beads wide, 48 to 64 packings, σ_f ± t errors holds
98.5 % where 99 % were asked, and ln σ_f ± t errors 98.9 to 99.1 %.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

FIRST_LOOK = 32


def looks(end: int) -> Iterator[int]:
    """Give the sizes at which sums are looked at, up to ``end``.

    >>> list(looks(200))
    [32, 48, 64, 96, 128, 192]
    """
    size = FIRST_LOOK
    while size <= end:
        yield size
        if 3 * size // 2 <= end:
            yield 3 * size // 2
        size *= 2


def half_width(log_errors: Sequence[float], samples: int, confidence: float, look: int) -> float:
    """Give the half-width of the intervals of all σ_f together, relative to σ_f; the largest.

    ``log_errors``: standard errors of the ln σ_f that vary, from ``samples`` independent packings.
    ``look`` counts looks from 1; 0 is for an ensemble that was of a fixed size from the start.
    """
    from scipy.special import stdtrit

    if not log_errors:
        return 0.0
    if samples < 2:
        return math.inf
    wrong = (1 - confidence) / len(log_errors) / (look * (look + 1) if look else 1)
    with np.errstate(over="ignore"):
        return float(np.expm1(-stdtrit(samples - 1, wrong / 2) * max(log_errors)))
