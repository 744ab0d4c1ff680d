"""How many contacts of a packing are expected to pull, and from which height on (Eqs. 13 and 14).

Estimates: to first order in δr, with Gaussian forces. M* (Eq. 15) is where forces scatter as widely
as they are large; in a packing of many contacts some pull far below it.
"""

import math
from dataclasses import dataclass

from .. import closed_forms

# A typical packing has tension: the chance of none, exp(−number), is below one half.
TYPICAL = math.log(2)
# Layers that are looked at, spread evenly, of packings that are higher.
LAYERS = 400
HIGHEST = 10_000_000

_VARIANCES = {"surface": closed_forms.surface_variance, "bulk": closed_forms.bulk_variance}


@dataclass(frozen=True)
class ExpectedTension:
    """About so many ``contacts`` pull, in one packing.

    ``height_of_one``: the height from which on it is one or more, at the same width; None beyond
    the highest packings.
    """

    contacts: float
    height_of_one: int | None

    @property
    def typical(self) -> bool:
        """Whether more than half of such packings have a contact that pulls."""
        return self.contacts > TYPICAL


def expected_tension(
    height: int, width: int, phi: float, relative_std: float, load: str
) -> ExpectedTension:
    """Estimate how many of the 2 W M contacts of a packing pull under a load straight down.

    ``height``: M; ``width``: W; ``phi``: n⁺·n⁻; ``relative_std``: σ/r; ``load``: "surface" or
    "bulk".

    >>> found = expected_tension(16, 32, -1 / 8, 0.0055, "surface")
    >>> round(found.contacts, 1), found.height_of_one
    (7.0, 14)
    """

    def contacts(M: int) -> float:
        return 2 * width * _pulling(M, phi, relative_std, load)

    low, high = 0, 1
    while contacts(high) < 1:
        low, high = high, 2 * high
        if low > HIGHEST:
            return ExpectedTension(contacts(height), None)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if contacts(middle) >= 1 else (middle, high)
    return ExpectedTension(contacts(height), high)


def _pulling(M: int, phi: float, relative_std: float, load: str) -> float:
    """Sum the chance to pull over the layers 0 … M − 1."""
    layers = min(M, LAYERS)
    chosen = ((2 * k + 1) * M // (2 * layers) for k in range(layers))
    variances = (float(_VARIANCES[load](M, j, phi, relative_std, 1.0)) for j in chosen)
    return M / layers * sum(math.erfc(1 / math.sqrt(2 * v)) / 2 if v else 0.0 for v in variances)
