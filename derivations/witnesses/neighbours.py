"""Sums over neighbouring contacts or beads of one layer, from the weights of exact packings."""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache
from itertools import product
from typing import TYPE_CHECKING

from force_diffusion.symbolic.kernel.decisions import Ruling

from . import modular
from .draws import Site, SmallPacking
from .squared_weights import (
    compare,
    weights_by_layer,
    weights_of_forces,
)

if TYPE_CHECKING:
    from force_diffusion.numeric.mechanics.taylor import TaylorPacking

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

    def vertical(packing: "TaylorPacking", across: int, layer: int) -> Fraction:
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


Stated = Callable[[int, int, int, Fraction], Fraction]
"""A closed form, of M, j, N and φ, for r = σ = 1."""


def agree_in_small_ones(quantity: str, stated: Stated, packing: SmallPacking) -> Ruling:
    """A closed form against exact packings of M ≤ 4, every layer, N from 2 to 7."""
    phi = packing.n[1] ** 2 - packing.n[0] ** 2

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for height, count in product(range(1, 5), range(2, 8)):
            for layer in range(height):
                true = mean_variance(quantity, height, layer, count, packing.n)
                where = f"M = {height}, j = {layer}, N = {count}"
                yield where, stated(height, layer, count, phi), true

    return compare(pairs())


def agree_in_high_ones(quantity: str, stated: Stated, packing: SmallPacking) -> Ruling:
    """A closed form against packings of 12 ≤ M ≤ 15, every layer and N ≤ 2M, modulo a prime."""
    phi = packing.n[1] ** 2 - packing.n[0] ** 2

    def pairs() -> Iterator[tuple[str, int, int]]:
        height = 9 + packing.height
        for layer in range(height):
            true = modular.mean_variances(quantity, height, layer, phi)
            for count in range(2, 2 * height + 1):
                where = f"M = {height}, j = {layer}, N = {count}"
                form = stated(height, layer, count, phi)
                yield where, modular.residue(form), true[count - 1]

    return compare(pairs(), modular.EQUAL)
