"""Weights of single radii in a contact force at any height, in floats, by ``numeric`` alone."""

from fractions import Fraction
from functools import lru_cache
from types import SimpleNamespace

import numpy as np
from force_diffusion.numeric.mechanics.first_order import (
    beads_read,
    contact_change,
    crossing_layers,
)
from force_diffusion.numeric.mechanics.loads import LoadSpec

Site = tuple[int, int]
FLOATS = SimpleNamespace(scalar=float, number=float)


@lru_cache(1000)
def of_force(
    height: int, layer: int, n: tuple[Fraction, Fraction], load: str, branch: str = "+"
) -> dict[Site, float]:
    """Change of f^±_ij over its ordered value for each δr/r alone, by (i' − i, j').

    The height is only limited by time: three diagonals decide.
    """
    spec = LoadSpec(load, height, None)
    contact = (layer, layer, branch)
    sites: dict[Site, int] = {}
    every = np.eye(beads_read(contact, spec))

    def radius_at(i: int, j: int) -> np.ndarray:
        return every[sites.setdefault((i - layer, j), len(sites))]

    # ordered forces below layer m: of the load on one layer, or on all from m up
    carried = {m: float(height - m if load == "bulk" else 1) for m in range(height)}
    above, below = crossing_layers(contact, spec)
    change, count = contact_change(
        contact,
        own=carried[layer],
        above={m: carried[m] for m in above},
        below={m: carried[m - 1] for m in below},
        radius_at=radius_at,
        n_x=n[0],
        system=FLOATS,
    )
    assert count == len(sites) == len(every)
    return {site: change[place] / carried[layer] for site, place in sites.items()}
