"""Witnesses of another kind than whole equations: zeros, weights and variances.

What the nonlinear packing says at order ε¹ is compared, as fractions, with what the derivations
state in closed form.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, undecided
from force_diffusion.symbolic.variances.variance import ClosedForm, packings, value_at

from .both_sides import ExactSolution
from .draws import Site, SmallPacking

if TYPE_CHECKING:
    from force_diffusion.numeric.mechanics.taylor import TaylorPacking


def compare(
    pairs: Iterable[tuple[str, Fraction, Fraction] | tuple[str, int, int]],
    equal: str = "equal as fractions",
) -> Ruling:
    """Agree when there are pairs of values and all are equal, in words ``equal``."""
    count = 0
    for where, stated, true in pairs:
        if stated != true:
            return Ruling(Verdict.DISAGREES, f"{where}: stated {stated}, exact {true}")
        count += 1
    if not count:
        return undecided("there was nothing to compare")
    return Ruling(Verdict.AGREES, f"{equal}, {count} compared")


def zero_outside(packing: SmallPacking) -> Ruling:
    """No force of first order leaves the cone of a load, nor turns twice inside it."""
    solution = ExactSolution(packing, "single")
    k, l = packing.loaded  # noqa: E741

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for layer in range(l):
            # f⁻ left of the cone, as far as no image of the cone is met; count is Eq. 10's n
            for count in range(l - layer - packing.width + 1, 1):
                force = solution.force(k - (l - layer) + 2 * count, layer, "-")
                yield f"n = {count}, j = {layer}", Fraction(0), abs(force.value) + abs(force.slope)

    return compare(pairs())


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

    def over_ordered(packing: "TaylorPacking", across: int, layer: int) -> Fraction:
        ordered, slope = packing.force(across, layer, branch)
        return slope / ordered

    # each load adds 1 to the ordered f⁺ and t to f⁻ below it
    carried = (ratio - 1) * n[0], -(1 + ratio) * n[1]
    return weights_by_layer(height, n, dict.fromkeys(carrying, carried), over_ordered)


def weights_by_layer(
    height: int,
    n: tuple[Fraction, Fraction],
    loads: Mapping[int, tuple[Fraction, Fraction]],
    slope: Callable[["TaylorPacking", int, int], Fraction],
    layers: Sequence[int] | None = None,
) -> tuple[dict[Site, Fraction], ...]:
    """First-order weights of a quantity in some layers; each bead of a layer has the same load.

    All layers below the surface are asked for if none is named. ``slope`` is its order ε¹ at
    (i, j) in a packing in which one bead has radius r + ε.
    """
    from force_diffusion.numeric.mechanics import taylor

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


def dropped_weights(
    printed: sympy.Expr, variance_dropped: sympy.Expr, packing: SmallPacking
) -> Ruling:
    """Exact weights less those of Eq. 12, squared and summed: the stated polynomial in M and j."""
    geometry = explicit.geometry(*packing.n, Fraction(1))

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        height = 12
        weights = weights_of_forces(height, packing.n, "surface")
        for layer in (6,):
            at = {**geometry, sy.M: height, sy.j: layer, sy.i: layer}
            exact_weights = dict(weights[layer])
            for (family, across, source), weight in explicit.weights(printed, at).items():
                if family:
                    key = (across - layer, source)
                    exact_weights[key] = exact_weights.get(key, Fraction(0)) - weight
            total = sum((w**2 for w in exact_weights.values()), Fraction(0))
            stated = explicit.number(variance_dropped, {**at, sy.sigma: 1})
            yield f"M = {height}, j = {layer}", stated, total

    return compare(pairs())


def variances(
    forms: dict[str, ClosedForm],
    load: str,
    packing: SmallPacking,
    *,
    up_to: int = 4,
    ratio: Fraction = Fraction(1),
    branch: str = "+",
) -> Ruling:
    """Exact closed forms against sums of squared weights of exact packings, all j < M ≤ up_to.

    ``ratio`` is t = L⁻/L⁺; for f⁻ the forms hold with 1/t in its place.
    """
    share = ratio if branch == "+" else 1 / ratio
    values = {**explicit.geometry(*packing.n, Fraction(1)), sy.sigma: 1, sy.t: share}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        weights = {
            height: weights_of_forces(height, packing.n, load, ratio=ratio, branch=branch)
            for height in range(1, up_to + 1)
        }
        for height, layer, case in packings(up_to):
            closed = value_at(forms, height, layer, case)
            total = sum((w**2 for w in weights[height][layer].values()), Fraction(0))
            yield f"M = {height}, j = {layer}", explicit.number(closed, values), total

    return compare(pairs())


def averages(
    stated: Mapping[str, Callable[[int], sympy.Expr]], packing: SmallPacking, *, up_to: int = 4
) -> Ruling:
    """Means over the layers, by load and M, against squared weights of exact packings."""
    values = {**explicit.geometry(*packing.n, Fraction(1)), sy.sigma: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for load, closed in stated.items():
            for height in range(1, up_to + 1):
                layers = weights_of_forces(height, packing.n, load)
                total = sum((w**2 for layer in layers for w in layer.values()), Fraction(0))
                mean = explicit.number(closed(height), values)
                yield f"M = {height}, {load} load", mean, total / height

    return compare(pairs())


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
    from force_diffusion.numeric.mechanics import taylor

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


def responses(packing: SmallPacking, level: int) -> Ruling:
    """Closed forms of the response against squared weights of an exact packing, every contact."""
    from force_diffusion.numeric import closed_forms

    phi, one = packing.n[1] ** 2 - packing.n[0] ** 2, Fraction(1)

    def square(weights: Mapping[Offset, Fraction]) -> Fraction:
        return sum((w**2 for w in weights.values()), Fraction(0))

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        vertical, magnitude = weights_below_a_load(level, packing.n)
        for ((across, layer), branch), weights in vertical.items():
            site = (across + level % 2, layer, level % 2, level)
            where = f"l = {level}, i − k = {across}, j = {layer}"
            stated = closed_forms.contact_response(*site, branch, phi, one, one)
            yield f"{where}, f{branch}", stated, square(weights)
            if branch == "+":
                other = vertical[(across, layer), "-"]
                both = {bead: weight + other[bead] for bead, weight in weights.items()}
                yield where, closed_forms.bead_response(*site, phi, one, one), square(both)
            if across == (layer - level if branch == "+" else level - layer):
                ordered = 1 / (2 * packing.n[1])
                relative = square(magnitude[(across, layer), branch]) / ordered**2
                yield where, closed_forms.leg_variance(layer, level, phi, one, one), relative

    return compare(pairs())
