"""Second-order means of exact packings, as fractions.

The coefficient of ε² is a quadratic form in the radii. In the mean over independent radii of mean 0
only its diagonal is left: one bead at a time is enlarged, and the changes of all contacts of a
layer are added up, which by translation is the sum over all beads for one contact.
"""

from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import cache

import sympy
from force_diffusion.derivations.witnesses.draws import SmallPacking
from force_diffusion.derivations.witnesses.squared_weights import compare
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel.decisions import Ruling
from force_diffusion.symbolic.variances.variance import ClosedForm, packings, value_at

HIGHEST = 5


@cache
def means(
    height: int,
    n: tuple[Fraction, Fraction],
    load: str,
    ratio: Fraction = Fraction(1),
    branch: str = "+",
) -> tuple[tuple[Fraction, ...], tuple[tuple[Fraction, Fraction], ...]]:
    """Means at order σ², for r = σ = 1: of a branch's f/⟨f⟩ of layers j < M, and of (δx, δy).

    ``ratio`` is t = L⁻/L⁺ of the loads. The packing is so wide that no exact force or position sees
    an image of itself.
    """
    from force_diffusion.numeric.mechanics import taylor

    width = 2 * height + 3
    carrying = range(1, height + 1) if load == "bulk" else (height,)
    loads = {
        (across, layer): ((ratio - 1) * n[0], -(1 + ratio) * n[1])
        for layer in carrying
        for across in range(layer % 2, 2 * width, 2)
    }
    forces = [Fraction(0)] * height
    places = [(Fraction(0), Fraction(0))] * (height + 1)
    for source in range(height + 1):
        rho = {(source % 2, source): Fraction(1)}
        solved = taylor.solve(width, height, n=n, rho=rho, loads=loads, order=2)
        for layer in range(height + 1):
            for across in range(layer % 2, 2 * width, 2):
                x, y = solved.displacement(across, layer)
                places[layer] = places[layer][0] + x[2], places[layer][1] + y[2]
                if layer < height:
                    force = solved.force(across, layer, branch)
                    forces[layer] += force[2] / force[0]
    return tuple(forces), tuple(places)


def forces(
    forms: dict[str, ClosedForm],
    load: str,
    packing: SmallPacking,
    ratio: Fraction = Fraction(1),
    branch: str = "+",
) -> Ruling:
    """Closed forms of ⟨f⟩ over its ordered value, less 1, against exact packings, all j < M ≤ 5.

    ``ratio`` is t = L⁻/L⁺ of the loads; for f⁻ the forms hold with 1/t in its place.
    """
    share = ratio if branch == "+" else 1 / ratio
    values = {**explicit.geometry(*packing.n, Fraction(1)), sy.sigma: 1, sy.t: share}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for height, layer, case in packings(HIGHEST):
            stated = explicit.number(value_at(forms, height, layer, case), values)
            true = means(height, packing.n, load, ratio, branch)[0][layer]
            yield f"M = {height}, j = {layer}", stated, true

    return compare(pairs())


def positions(stated: sympy.Expr, packing: SmallPacking) -> Ruling:
    """A closed form of ⟨δy⟩ for j ≥ 1, and ⟨δx⟩ = 0, against exact packings of M ≤ 5."""
    values = {**explicit.geometry(*packing.n, Fraction(1)), sy.sigma: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for layer, (x, y) in enumerate(means(HIGHEST, packing.n, "surface")[1]):
            found = explicit.number(stated, {**values, sy.j: layer}) if layer else Fraction(0)
            yield f"j = {layer}", found, y
            yield f"j = {layer}, horizontally", Fraction(0), x

    return compare(pairs())


N = (Fraction(21, 29), Fraction(20, 29))


def fails(
    candidate: sympy.Eq,
    subject: sympy.Symbol,
    exact: Callable[[int, int], Fraction],
    layers: Iterator[tuple[int, int]],
) -> str | None:
    """Where an equation of a mean, M and j fails on exact packings, r = σ = 1; None if nowhere."""
    values = {**explicit.geometry(*N, Fraction(1)), sy.sigma: 1}
    for height, layer in layers:
        try:
            at = {**values, sy.M: height, sy.j: layer, subject: exact(height, layer)}
            left, right = (explicit.number(side, at) for side in candidate.args)
        except explicit.AmbiguousError:
            return None
        if left != right:
            return f"for M = {height}, j = {layer}, n_x = {N[0]}: {left} on the left, {right}"
    return None


@cache
def response(
    level: int, n: tuple[Fraction, Fraction]
) -> dict[tuple[tuple[int, int], str], Fraction]:
    """Means at order σ² below a load on one bead of layer ``level``, r = σ = 1.

    In units of f_load/2n_y, by ((i − k, j), branch). Many equal loads share one packing, so far
    apart that none feels the bead that is enlarged below another; below each, it is another bead.
    """
    from force_diffusion.numeric.mechanics import taylor

    reach = 2 * level + 2
    apart = 2 * reach + 2
    found: dict[tuple[tuple[int, int], str], Fraction] = {}
    for source in range(level + 1):
        offsets = [o for o in range(-reach, reach + 1) if (o + level - source) % 2 == 0]
        tops = [level % 2 + apart * place for place in range(len(offsets))]
        width = apart * len(offsets) // 2
        pairs = zip(tops, offsets, strict=True)
        solved = taylor.solve(
            width,
            level,
            n=n,
            rho={((top + o) % (2 * width), source): Fraction(1) for top, o in pairs},
            loads={(top, level): (Fraction(0), -2 * n[1]) for top in tops},
            order=2,
        )
        for top in tops:
            for layer in range(level):
                for across in range(-(level - layer) - 2, level - layer + 3, 2):
                    for branch in "+-":
                        contact = (across, layer), branch
                        change = solved.force((top + across) % (2 * width), layer, branch)[2]
                        found[contact] = found.get(contact, Fraction(0)) + change
    return found


@cache
def moments(height: int, n: tuple[Fraction, Fraction]) -> tuple[tuple[Fraction, Fraction], ...]:
    """Means at order σ² of f ℓ N_x² and f ℓ N_y² over their ordered values, by layer, r = σ = 1.

    ℓ is the distance of the two centres, N the direction of a contact; a surface load.
    """
    from force_diffusion.numeric.mechanics import taylor

    width = 2 * height + 3
    loads = {
        (across, height): (Fraction(0), -2 * n[1]) for across in range(height % 2, 2 * width, 2)
    }
    found = [[Fraction(0), Fraction(0)] for _ in range(height)]
    for source in range(height + 1):
        one = {(source % 2, source): Fraction(1)}
        solved = taylor.solve(width, height, n=n, rho=one, loads=loads, order=2)
        for layer in range(height):
            for across in range(layer % 2, 2 * width, 2):
                ends = ((across, layer), ((across + 1) % (2 * width), layer + 1))
                length = [
                    Fraction(2),
                    sum((one.get(end, Fraction(0)) for end in ends), Fraction(0)),
                ]
                force = solved.force(across, layer, "+")
                for axis, change in enumerate(solved.direction(across, layer, "+")):
                    unit = [n[axis] + change[0], *change[1:]]
                    product = _times(_times(force, [*length, Fraction(0)]), _times(unit, unit))
                    found[layer][axis] += product[2] / product[0]
    return tuple((x, y) for x, y in found)


def _times(one: list[Fraction], other: list[Fraction]) -> list[Fraction]:
    """The product of two series, to order ε²."""
    return [
        sum((one[k] * other[order - k] for k in range(order + 1)), Fraction(0))
        for order in range(3)
    ]
