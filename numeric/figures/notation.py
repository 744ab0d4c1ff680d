"""Figure 1: the notation, on an ordered packing with a disordered one drawn over it.

The disordered packing is solved exactly. Its radii scatter by σ/r = 0.06, far more than in the
other figures, so that it can be seen.
"""

from math import sqrt

import numpy as np

from ..arithmetic.systems import Array
from . import specification as spec
from .packings import N_X, SPACING, Options, centres, planned, solved

HEIGHT, WIDTH, STD = 3, 16, 0.06
SHOWN = range(9)  # columns i of the detail
NX, NY = float(N_X), sqrt(1 - N_X**2)
NAMED = {
    (4, 2): "$(i,j)$", (5, 3): "$(i+1,j+1)$", (3, 3): "$(i-1,j+1)$", (5, 1): "$(i+1,j-1)$",
    (3, 1): "$(i-1,j-1)$",
}  # fmt: skip


def beads(o: Options) -> list[tuple[float, ...]]:
    """Solve a packing and cut the detail out of it: i, j, ordered and displaced centre, radius."""
    o.notice("figure 1")
    one = planned("positions", height=HEIGHT, width=WIDTH, seed=o.seed, std=STD)
    packing = next(solved(one, range(1)))[0].packing
    assert packing is not None
    found = []
    for j, layer in enumerate(packing.region.rows):
        columns = (layer.sites(), *centres(packing, j), 1 + packing.rho[j])
        for i, *numbers in zip(*columns, strict=True):
            if i in SHOWN:
                found.append((i, j, *map(float, numbers)))
    return found


def at(i: float, j: float) -> Array:
    """Give the ordered centre of a bead."""
    return np.array([2 * NX * i, 2 * NY * j])


def beside(place: Array, right: float, up: float) -> tuple[float, float]:
    """Give a place that is so far away from another one."""
    return float(place[0] + right), float(place[1] + up)


def names() -> list[spec.Element]:
    """Name what the text names."""
    found: list[spec.Element] = [
        spec.Words(*beside(at(*site), 0, -0.45 * (site == (4, 2))), words, size=7)
        for site, words in NAMED.items()
    ]
    middle, left, right, edge = at(4, 2), at(2, 0), at(4, 0), at(7, 1)
    for side, name, colour in ((1, "+", 0), (-1, "-", 1)):
        word = rf"$\hat{{\mathbf{{n}}}}^{{{name}}}$"
        tip = beside(middle, side * NX, NY)
        found += [
            spec.Arrow(beside(middle, 0, 0), tip, colour=colour, width=1.3),
            spec.Words(*beside(middle, side * 1.45, -0.12), word, colour),
        ]
    for x, y in (left, right):
        found.append(spec.Line([x, x], [y, y - 1.6], "black", (0, (2, 2)), width=0.5))
    return [
        *found,
        spec.Arrow(beside(left, 0, -1.45), beside(right, 0, -1.45), style="<->"),
        spec.Words(*beside((left + right) / 2, 0, -1.6), "$s$", align=("center", "top")),
        spec.Arrow(beside(edge, 0, 0), beside(edge, 1, 0), style="->"),
        spec.Words(*beside(edge, 0.5, 0.12), "$r$", align=("center", "bottom")),
        spec.Arrow((3.0, 4.85), beside((at(1, 3) + at(2, 2)) / 2, 0, 0), "contact", size=5),
        spec.Words(*beside(at(8, 0), -0.2, -1.6), "base, $j=0$", align=("right", "center")),
    ]


def figure(o: Options) -> spec.Figure:
    """Ordered beads black, the disordered ones grey."""
    found = beads(o)
    _, _, *columns, radii = np.array(found).T
    ordered, displaced = np.stack(columns[:2], axis=1), np.stack(columns[2:], axis=1)
    panel = spec.Panel(
        [
            spec.Line([-2, 14], [0, 0], "black", (0, (1, 1.5)), width=0.6),
            spec.Beads(displaced, radii, face="0.87", edge="0.55", width=0.7),
            spec.Beads(ordered, face="none", edge="black", width=1.1, above=True),
            *names(),
        ],
        spec.Axis(low=0.9, high=11.9),
        spec.Axis(low=-2.45, high=5.15),
        scaled=True,
        bare=True,
    )
    return spec.Figure(
        spec.Picture([panel], 2.4),
        tables={"figure1": spec.table("i j x_ordered y_ordered x y radius", found)},
        facts={"relative_std": STD, "height": HEIGHT, "spacing_over_r": float(SPACING)},
        words=[f"{len(found)} beads of an exact packing at σ/r = {STD}"],
    )
