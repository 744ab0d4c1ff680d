"""Second-order means of exact packings, as fractions.

The coefficient of ε² is a quadratic form in the radii. In the mean over independent radii of mean 0
only its diagonal is left: one bead at a time is enlarged, and the changes of all contacts of a
layer are added up, which by translation is the sum over all beads for one contact.
"""

from fractions import Fraction
from functools import cache
from itertools import product

import numpy as np

from tests.numeric.mechanics import taylor
from tests.numeric.mechanics.taylor import Series


@cache
def _solved(
    height: int, n: tuple[Fraction, Fraction], load: str, ratio: Fraction, source: int
) -> taylor.TaylorPacking:
    """The packing with one bead of layer ``source`` enlarged, to order ε².

    Loads are −(n⁺ + ratio n⁻) on the beads of the surface, or on all above the base. It is so wide
    that no exact force or position sees an image of itself.
    """
    width = 2 * height + 3
    loads = {
        (across, layer): ((ratio - 1) * n[0], -(1 + ratio) * n[1])
        for layer in (range(1, height + 1) if load == "bulk" else (height,))
        for across in range(layer % 2, 2 * width, 2)
    }
    rho = {(source % 2, source): Fraction(1)}
    return taylor.solve(width, height, n=n, rho=rho, loads=loads, order=2)


@cache
def means(
    height: int,
    n: tuple[Fraction, Fraction],
    load: str,
    ratio: Fraction = Fraction(1),
    branch: str = "+",
) -> tuple[tuple[Fraction, ...], tuple[tuple[Fraction, Fraction], ...]]:
    """Means at order σ², for r = σ = 1: of a branch's f/⟨f⟩ of layers j < M, and of (δx, δy).

    ``ratio`` is t = L⁻/L⁺ of the loads.
    """
    forces = [Fraction(0)] * height
    places = [(Fraction(0), Fraction(0))] * (height + 1)
    for source in range(height + 1):
        solved = _solved(height, n, load, ratio, source)
        for layer in range(height + 1):
            for across in range(layer % 2, 2 * solved.width, 2):
                x, y = solved.displacement(across, layer)
                places[layer] = places[layer][0] + x[2], places[layer][1] + y[2]
                if layer < height:
                    force = solved.force(across, layer, branch)
                    forces[layer] += force[2] / force[0]
    return tuple(forces), tuple(places)


def response(
    level: int, n: tuple[Fraction, Fraction]
) -> dict[tuple[tuple[int, int], str], Fraction]:
    """Means at order σ² below a load on one bead of layer ``level``, r = σ = 1.

    In units of f_load/2n_y, by ((i − k, j), branch).
    """
    return {contact: force for contact, (force, _) in _below_one(level, n).items()}


def pushes(level: int, n: tuple[Fraction, Fraction]) -> dict[tuple[int, int], Fraction]:
    """The same of the vertical force of both upper contacts of a bead, over f_load."""
    found: dict[tuple[int, int], Fraction] = {}
    for (bead, _), (_, push) in _below_one(level, n).items():
        found[bead] = found.get(bead, Fraction(0)) + push / (2 * n[1])
    return found


@cache
def _below_one(
    level: int, n: tuple[Fraction, Fraction]
) -> dict[tuple[tuple[int, int], str], tuple[Fraction, Fraction]]:
    """The mean force of each contact at order σ², and its vertical component, f_load being 2n_y.

    Many equal loads share one packing, so far apart that none feels the bead that is enlarged below
    another; below each, it is another bead.
    """
    reach = 2 * level + 2
    apart = 2 * reach + 2
    found: dict[tuple[tuple[int, int], str], tuple[Fraction, Fraction]] = {}
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
        for top, layer in product(tops, range(level)):
            for across in range(-(level - layer) - 2, level - layer + 3, 2):
                for branch in "+-":
                    at = (top + across) % (2 * width), layer, branch
                    force, up = solved.force(*at), solved.direction(*at)[1]
                    push = force[2] * n[1] + force[1] * up[1] + force[0] * up[2]
                    contact = (across, layer), branch
                    before = found.get(contact, (Fraction(0), Fraction(0)))
                    found[contact] = before[0] + force[2], before[1] + push
    return found


@cache
def moments(
    height: int,
    n: tuple[Fraction, Fraction],
    load: str = "surface",
    ratio: Fraction = Fraction(1),
) -> tuple[tuple[Fraction, Fraction, Fraction], ...]:
    """Means at order σ² of S_xx, S_yy and S_xy over their ordered values, by layer, r = σ = 1.

    S = Σ f ℓ N⊗N over the contacts of a layer, ℓ being the distance of the two centres and N the
    direction. ``ratio`` is t = L⁻/L⁺ of the loads; for 1, where the ordered S_xy is 0, S_xy itself.
    """
    system = Series(2)
    found = np.zeros((height, 3), dtype=object)
    with system.active():
        for source in range(height + 1):
            solved = _solved(height, n, load, ratio, source)
            around = 2 * solved.width
            for layer, (branch, side) in product(range(height), (("+", 1), ("-", -1))):
                for i in range(layer % 2, around, 2):
                    ends = ((i, layer), ((i + side) % around, layer + 1))
                    length = system.series([Fraction(2), Fraction((source % 2, source) in ends)])
                    push = system.series(solved.force(i, layer, branch)) * length
                    turned = zip(
                        (side * n[0], n[1]), solved.direction(i, layer, branch), strict=True
                    )
                    x, y = (
                        system.number(ordered) + system.series(change) for ordered, change in turned
                    )
                    found[layer] += [(push * both)[2] for both in (x * x, y * y, x * y)]
    tilted = (1 - ratio) * n[0] * n[1] or Fraction(1)
    units = [(1 + ratio) * n[0] ** 2, (1 + ratio) * n[1] ** 2, tilted]
    shares = []
    for layer, moment in enumerate(found):
        carried = 2 * (height - layer if load == "bulk" else 1)
        changes = (Fraction(int(change.p), int(change.q)) for change in moment)
        xx, yy, xy = (one / (carried * unit) for one, unit in zip(changes, units, strict=True))
        shares.append((xx, yy, xy))
    return tuple(shares)
