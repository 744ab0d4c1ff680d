"""First-order weights and variances of exact packings, as fractions.

What the nonlinear packing says at order ε¹ is compared with what the derivations state in closed
form.
"""

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import product

from tests.numeric.mechanics import taylor

from .draws import Site


@lru_cache(maxsize=64)
def weights_of_forces(
    height: int,
    n: tuple[Fraction, Fraction],
    load: str,
    *,
    ratio: Fraction = Fraction(1),
    branch: str = "+",
) -> tuple[dict[Site, Fraction], ...]:
    """Exact first-order weights of f^±_ij/⟨f^±⟩ for every layer j, from the exact packing.

    One bead of each layer in turn is enlarged; by translation the response of every contact of a
    layer is the weight of a bead at the opposite offset. ``load`` is "surface" or "bulk",
    ``ratio`` is t = L⁻/L⁺. Keys are (offset i' − i, layer of the bead); one mapping a layer j.
    """
    carrying = range(1, height + 1) if load == "bulk" else (height,)

    def over_ordered(packing: taylor.TaylorPacking, across: int, layer: int) -> Fraction:
        ordered, slope = packing.force(across, layer, branch)
        return slope / ordered

    # each load adds 1 to the ordered f⁺ and t to f⁻ below it
    carried = (ratio - 1) * n[0], -(1 + ratio) * n[1]
    return weights_by_layer(height, n, dict.fromkeys(carrying, carried), over_ordered)


def weights_by_layer(
    height: int,
    n: tuple[Fraction, Fraction],
    loads: Mapping[int, tuple[Fraction, Fraction]],
    slope: Callable[[taylor.TaylorPacking, int, int], Fraction],
    layers: Sequence[int] | None = None,
) -> tuple[dict[Site, Fraction], ...]:
    """First-order weights of a quantity in some layers; each bead of a layer has the same load.

    All layers below the surface are asked for if none is named. ``slope`` is its order ε¹ at
    (i, j) in a packing in which one bead has radius r + ε.
    """
    width = height + 2
    on_beads = {
        (across, layer): load
        for layer, load in loads.items()
        for across in range(layer % 2, 2 * width, 2)
    }
    asked = range(height) if layers is None else layers
    weights: tuple[dict[Site, Fraction], ...] = tuple({} for _ in asked)
    for source in range(height + 1):
        rho = {(source % 2, source): Fraction(1)}
        solved = taylor.solve(width, height, n=n, rho=rho, loads=on_beads, order=1)
        for layer, found in zip(asked, weights, strict=True):
            for across in range(layer % 2, 2 * width, 2):
                if weight := slope(solved, across, layer):
                    offset = (source % 2 - across + width) % (2 * width) - width
                    found[offset, source] = weight
    return weights


Offset = tuple[int, int]
"""Columns i − k to the right of a loaded bead, and a layer."""


@lru_cache(maxsize=64)
def weights_below_a_load(
    level: int, n: tuple[Fraction, Fraction]
) -> tuple[dict[tuple[Offset, str], dict[Offset, Fraction]], ...]:
    """Exact first-order weights of what a load on a bead of layer ``level`` does, f_load = 1.

    Two mappings from ((i − k, j), branch) to weights of beads (i' − k, j'): the vertical component
    of the contact's force, and its magnitude. Many equal loads share one packing, so far apart
    that none feels the bead that is enlarged below another; below each, it is another bead.
    """
    reach = level + 2
    apart = 2 * reach + 2
    vertical: dict[tuple[Offset, str], dict[Offset, Fraction]] = {}
    magnitude: dict[tuple[Offset, str], dict[Offset, Fraction]] = {}
    for source in range(level + 1):
        offsets = [o for o in range(-reach, reach + 1) if (o + level - source) % 2 == 0]
        tops = [level % 2 + apart * place for place in range(len(offsets))]
        width = apart * len(offsets) // 2
        solved = taylor.solve(
            width,
            level,
            n=n,
            rho={
                ((top + o) % (2 * width), source): Fraction(1)
                for top, o in zip(tops, offsets, strict=True)
            },
            loads={(top, level): (Fraction(0), Fraction(-1)) for top in tops},
        )
        for top, offset in zip(tops, offsets, strict=True):
            for layer in range(level):
                for across in range(-(level - layer), level - layer + 1, 2):
                    for branch in "+-":
                        force, slope = solved.force(top + across, layer, branch)
                        tilt = solved.direction(top + across, layer, branch)[1][1]
                        contact, bead = ((across, layer), branch), (offset, source)
                        magnitude.setdefault(contact, {})[bead] = slope
                        vertical.setdefault(contact, {})[bead] = slope * n[1] + force * tilt
    return vertical, magnitude


@lru_cache(maxsize=4096)
def mean_response(
    level: int, bead: Offset, pairs: tuple[tuple[int, int], ...], n: tuple[Fraction, Fraction]
) -> Fraction:
    """Variance of p/f_load averaged over pairs of a load and a bead, both by their places.

    p is the vertical force of both upper contacts, ``bead`` the (i − k, j) of the first one below
    the first load; the others are so many places to the right. From exact packings, r = σ = 1.
    """
    vertical, _ = weights_below_a_load(level, n)
    total: dict[Offset, Fraction] = {}
    for (load, place), branch in product(pairs, "+-"):
        contact = (bead[0] + 2 * (place - load), bead[1]), branch
        for (offset, source), weight in vertical[contact].items():
            radius = offset + 2 * load, source
            total[radius] = total.get(radius, Fraction(0)) + weight
    return sum((w**2 for w in total.values()), Fraction(0)) / len(pairs) ** 2
