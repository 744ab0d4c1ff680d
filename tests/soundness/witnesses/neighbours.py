"""Sums over neighbouring contacts or beads of one layer, from the weights of exact packings."""

from fractions import Fraction
from functools import cache

from tests.numeric.mechanics import taylor

from .draws import Site
from .squared_weights import (
    weights_by_layer,
    weights_of_forces,
)

Direction = tuple[Fraction, Fraction]


@cache
def weights(quantity: str, height: int, layer: int, n: Direction) -> dict[Site, Fraction]:
    """First-order weights of what ``quantity`` names in a layer: "force" f⁺/⟨f⟩, or "bead".

    "bulk" is f⁺/⟨f⟩ under a bulk load.
    "bead" is the vertical force that a bead gets from both upper contacts, over the load. Keys are
    (offset, layer) of the radius, as in ``weights_of_forces``; a surface load.
    """
    if quantity in ("force", "bulk"):
        load = "bulk" if quantity == "bulk" else "surface"
        return weights_of_forces(height, n, load)[layer]

    def vertical(packing: taylor.TaylorPacking, across: int, layer: int) -> Fraction:
        total = Fraction(0)
        for branch in "+-":
            ordered, slope = packing.force(across, layer, branch)
            total += slope * n[1] + ordered * packing.direction(across, layer, branch)[1][1]
        return total

    above = {height: (Fraction(0), Fraction(-1))}
    (found,) = weights_by_layer(height, n, above, vertical, (layer,))
    return found


def mean_variance(quantity: str, height: int, layer: int, count: int, n: Direction) -> Fraction:
    """Variance of the mean over ``count`` neighbours, for r = σ = 1."""
    summed: dict[Site, Fraction] = {}
    for (offset, source), weight in weights(quantity, height, layer, n).items():
        for place in range(count):
            key = (offset + 2 * place, source)
            summed[key] = summed.get(key, Fraction(0)) + weight
    return sum((w**2 for w in summed.values()), Fraction(0)) / count**2


def between_layers(height: int, lower: int, upper: int, n: Direction) -> Fraction:
    """Covariance of f⁺/⟨f⟩ in two layers, on one diagonal, for r = σ = 1."""
    around = 2 * (height + 2)  # columns of the periodic packings that these are from
    above = {
        ((offset + upper - lower) % around, at): w
        for (offset, at), w in weights("force", height, upper, n).items()
    }
    below = weights("force", height, lower, n).items()
    return sum((w * above.get((o % around, at), 0) for (o, at), w in below), Fraction(0))
