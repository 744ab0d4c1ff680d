"""How sure an ensemble is of σ_f, and when it may stop.

The unit is the packing: the contacts of one are correlated, packings are independent. Stopping as
soon as an error looks small favours errors that look too small. So the sums are looked at only at
fixed sizes, and look k may be wrong with probability α/(k (k + 1)), of which all looks together
have α: whenever the run stops, its statement holds with at least the confidence 1 − α that was
asked, as far as means over packings are normal (Student's t, at least 32 packings). The share of a
look is divided among the groups, so that the statement is about all of them at once.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import flint
from force_diffusion.numeric.arithmetic.systems import Balls
from force_diffusion.numeric.ensemble.estimates import Estimates

FIRST_LOOK = 32
_BALLS = Balls(128)


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


@dataclass(frozen=True)
class Rule:
    """Stop when every σ_f is known to ``relative`` of itself, with ``confidence``."""

    relative: float
    confidence: float


def half_width(estimates: Estimates, confidence: float, look: int) -> float:
    """Give the half-width of the intervals of all σ_f together, relative to σ_f; the largest.

    ``look`` counts looks from 1; 0 is for an ensemble that was of a fixed size from the start.
    Groups that do not vary at all are left out.
    """
    spread = estimates.relative_errors()
    if not spread:
        return 0.0
    wrong = (1 - confidence) / len(spread) / (look * (look + 1) if look else 1)
    return max(spread) * student(wrong, estimates.realisations - 1)


def student(wrong: float, freedom: int) -> float:
    """Give t with P(|T| > t) = ``wrong`` for Student's T with ``freedom`` degrees of freedom.

    >>> f"{student(0.05, 10):.4f} {student(0.05, 10**6):.4f}"
    '2.2281 1.9600'
    """
    if freedom < 1:
        return math.inf
    with _BALLS.active():
        half = flint.arb(freedom) / 2

        def likelier(t: float) -> bool:
            x = freedom / (freedom + flint.arb(t) ** 2)
            return bool(x.beta_lower(half, flint.arb(1) / 2, True) > wrong)

        low, high = 0.0, 1.0
        while likelier(high):
            low, high = high, 2 * high
        while low < (middle := (low + high) / 2) < high:  # until doubles end: alike everywhere
            low, high = (middle, high) if likelier(middle) else (low, middle)
        return high
