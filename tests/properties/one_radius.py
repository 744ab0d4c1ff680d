"""One radius at a time: how a single larger bead changes contact forces, and so their variance.

The radii are independent, so that σ_f² is the sum over beads of their squared weights times σ².
Beads of one layer are alike: one bead a layer is enough, seen from all contacts.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache

import sympy
from force_diffusion.symbolic.symbols import i, j

from tests.properties.drawn import exactly
from tests.properties.orders import ROUNDING, STRENGTHS
from tests.properties.packing import Number, Packing, Site
from tests.properties.reading import Plane, Value, place

QUOTIENT_ROUNDING = ROUNDING / min(STRENGTHS)
"""Of a change over the strength that has made it."""


@lru_cache(maxsize=16)
def one_larger_each(
    cosine: Fraction, r: Fraction, height: int, epsilon: Number
) -> tuple[Packing, ...]:
    """For each layer the packing in which one bead of it has the radius r + ε r; W > M."""

    def having(change: Mapping[Site, Number]) -> Packing:
        return Packing(exactly(cosine), height + 1, height, exactly(r), change)

    beads = (next(having({}).sites(layer)) for layer in range(height + 1))
    return tuple(having({bead: epsilon * exactly(r)}) for bead in beads)


def loaded(packing: Packing, load: str, weight: Number) -> Plane:
    """Under a surface or a bulk load."""
    loads = packing.surface_load(weight) if load == "surface" else packing.bulk_load(weight)
    return Plane(packing, loads)


def mean_force(packing: Packing, load: str, weight: Number, layer: int) -> Number:
    """⟨f⟩ = f_load/2n_y under a surface load, (M − j) mg/2n_y under a bulk load."""
    above = 1 if load == "surface" else packing.height - layer
    return above * weight / (2 * packing.base[0][1])


def variance(planes: tuple[Plane, ...], name: str, layer: int, mean: Number) -> Number:
    """Σ (f/⟨f⟩ − 1)² of the contacts of a layer, over beads of all layers that are larger."""
    forces = (plane.quantity(name, *at) for plane in planes for at in places(plane, layer))
    return sum((force / mean - 1) ** 2 for force in forces)


def left_out(
    equation: sympy.Eq, planes: tuple[Plane, ...], layer: int, at: Mapping[sympy.Symbol, Value]
) -> Number:
    """Σ (left-hand side − right-hand side)² in the same way: what a printed form leaves out."""
    return sum(
        plane.rest(equation, {i: across, j: layer, **at}) ** 2
        for plane in planes
        for across, _ in places(plane, layer)
    )


def places(plane: Plane, layer: int) -> Iterator[tuple[int, int]]:
    """The lower beads of the contacts of a layer, as (i, j)."""
    return map(place, plane.packing.sites(layer))
