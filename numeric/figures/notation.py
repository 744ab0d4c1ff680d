"""Figure 1: the notation, on an ordered packing with a disordered one drawn over it.

The disordered packing is solved exactly. Its radii scatter by σ/r = 0.06, far more than in the
other figures, so that it can be seen.
"""

from math import sqrt

import numpy as np

from ..arithmetic.systems import FLOAT64, Array
from .beads import arrow, bare, draw_beads
from .packings import N_X, SPACING, Made, Medium, Options, Table, planned, solve_first
from .style import COLUMN, panels

HEIGHT, WIDTH, STD = 3, 16, 0.06
SHOWN = 9  # columns i of the detail
NX, NY = float(N_X), sqrt(1 - N_X**2)
NAMED = {
    (4, 2): "$(i,j)$", (5, 3): "$(i+1,j+1)$", (3, 3): "$(i-1,j+1)$", (5, 1): "$(i+1,j-1)$",
    (3, 1): "$(i-1,j-1)$",
}  # fmt: skip


def beads(o: Options) -> Table:
    """Solve a packing and cut the detail out of it: i, j, ordered and displaced centre, radius."""
    o.notice("figure 1")
    plan = planned("positions", o, Medium(std=STD), height=HEIGHT, width=WIDTH)
    found = solve_first(plan)
    radii = 1 + plan.problem.radii.of(plan.problem.region.rows, [0], FLOAT64)[0]
    shown = found["i"] < SHOWN
    found = {name: column[shown] for name, column in found.items()}
    return {
        "i": found["i"],
        "j": found["j"],
        "x_ordered": found["x"] - found["dx"],
        "y_ordered": found["y"] - found["dy"],
        "x": found["x"],
        "y": found["y"],
        "radius": radii[shown],
    }


def at(i: float, j: float) -> Array:
    """Give the ordered centre of a bead."""
    return np.array([2 * NX * i, 2 * NY * j])


def beside(place: Array, right: float, up: float) -> tuple[float, float]:
    """Give a place that is so far away from another one."""
    return float(place[0] + right), float(place[1] + up)


def figure(o: Options) -> Made:
    """Ordered beads black, the disordered ones grey; what the text names has its name."""
    columns = beads(o)
    ordered, displaced = (
        np.stack([columns[f"x{which}"], columns[f"y{which}"]], axis=1) for which in ("_ordered", "")
    )
    drawn, (axes,) = panels("a", COLUMN, 2.3)
    draw_beads(axes, displaced, columns["radius"], fc="0.87", ec="0.55", lw=0.7)
    draw_beads(axes, ordered, fc="none", ec="black", lw=1.1, zorder=3)
    for site, words in NAMED.items():
        x, y = at(*site)
        axes.text(x, y - 0.45 * (site == (4, 2)), words, size=7, ha="center", va="center", zorder=8)
    middle, left, right, edge = at(4, 2), at(2, 0), at(4, 0), at(7, 1)
    for side, name, colour in ((1, "+", "C0"), (-1, "-", "C1")):
        arrow(axes, middle, beside(middle, side * NX, NY), color=colour, lw=1.3)
        words, place = rf"$\hat{{\mathbf{{n}}}}^{{{name}}}$", beside(middle, side * 1.45, -0.12)
        axes.annotate(words, place, size=7.5, color=colour, ha="center", va="center", zorder=8)
    axes.plot([-2, 14], [0, 0], "k", ls=(0, (1, 1.5)), lw=0.6)
    axes.annotate("base, $j=0$", beside(at(8, 0), -0.2, -1.6), size=7.5, ha="right", va="center")
    for x, y in (left, right):
        axes.plot([x, x], [y, y - 1.6], "k", ls=(0, (2, 2)), lw=0.5)
    arrow(axes, beside(left, 0, -1.45), beside(right, 0, -1.45), arrowstyle="<->")
    axes.annotate("$s$", beside((left + right) / 2, 0, -1.6), size=7.5, ha="center", va="top")
    arrow(axes, edge, beside(edge, 1, 0), arrowstyle="->")
    axes.annotate("$r$", beside(edge, 0.5, 0.12), size=7.5, ha="center", va="bottom", zorder=8)
    arrow(axes, (3.0, 4.85), (at(1, 3) + at(2, 2)) / 2, "contact", mutation_scale=5)
    bare(axes, 0.9, 11.9, -2.45, 5.15)
    facts = {"relative_std": STD, "height": HEIGHT, "spacing_over_r": float(SPACING)}
    says = f"{len(ordered)} beads of an exact packing at σ/r = {STD}"
    return Made(drawn, {"figure1": columns}, facts, [says])
