"""Standard deviations of contact forces, exact to first order, from the closed forms of variances.

All are for σ = r = 1.
"""

import math
from functools import lru_cache

from .. import closed_forms


@lru_cache(maxsize=4096)
def stds_of_discs(
    load: str, M: int, j: int, phi: float, components: tuple[float, float]
) -> tuple[float, float]:
    """Give σ of f⁺ and f⁻ of layer j (Eqs. 13, 14, B2 and B3 at finite M).

    ``load``: "surface" or "bulk"; ``phi``: n⁺·n⁻; ``components``: (L⁺, L⁻) of the load, the unit of
    the result. Under a bulk load it is per layer above the contact.
    """
    bulk = load == "bulk"
    plus, minus = components
    if plus == minus:  # straight down
        vertical = closed_forms.bulk_variance if bulk else closed_forms.surface_variance
        std = math.sqrt(float(vertical(M, j, phi, 1, 1))) * plus
        return std, std
    tilted = closed_forms.bulk_variance_at_angle if bulk else closed_forms.surface_variance_at_angle
    # own² times a polynomial of degree 2 in t = other/own, where own may vanish
    none, one, turned = (float(tilted(M, j, t, phi, 1, 1)) for t in (0, 1, -1))
    mixed, last = (one - turned) / 2, (one + turned) / 2 - none

    def std_of(own: float, other: float) -> float:
        return math.sqrt(max(0.0, none * own**2 + mixed * own * other + last * other**2))

    return std_of(plus, minus), std_of(minus, plus)


@lru_cache(maxsize=4096)
def std_of_spheres(load: str, M: int, j: int, phi: float) -> float:
    """Give σ_f/⟨f⟩ of layer j in three dimensions, alike along all axes (Eqs. B13 and B14)."""
    bulk = load == "bulk"
    form = (
        closed_forms.bulk_variance_of_spheres if bulk else closed_forms.surface_variance_of_spheres
    )
    return math.sqrt(float(form(M, j, phi, 1, 1)))
