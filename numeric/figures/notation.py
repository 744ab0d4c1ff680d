"""Figure 1: the notation, on an ordered packing with a disordered one drawn over it.

The disordered packing is solved exactly. Its radii scatter by σ/r = 0.06, far more than in the
other figures, so that it can be seen.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .packings import (
    N_X,
    SPACING,
    Notice,
    Row,
    centres,
    planned,
    solved,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT, WIDTH, STD = 3, 16, 0.06
SHOWN = range(9)  # columns i of the detail that is drawn


@dataclass(frozen=True)
class Notation:
    """The beads of the detail, one row each: lattice indices, ordered and disordered centres."""

    beads: tuple[Row, ...]

    def tables(self) -> dict[str, list[Row]]:
        """CSV files; lengths in units of r."""
        return {"figure1": list(self.beads)}

    def facts(self) -> dict[str, Any]:
        """What the packing is."""
        return {"relative_std": STD, "height": HEIGHT, "spacing_over_r": float(SPACING)}

    def lines(self) -> list[str]:
        """Nothing is decided here."""
        return [f"{len(self.beads)} beads of an exact packing at σ/r = {STD}"]


def beads(seed: int, notice: Notice) -> Notation:
    """Solve a packing and cut the detail out of it."""
    notice("figure 1")
    one = planned("positions", height=HEIGHT, width=WIDTH, seed=seed, std=STD)
    packing = next(solved(one, range(1)))[0].packing
    assert packing is not None
    found = []
    for j, layer in enumerate(packing.region.rows):
        columns = (layer.sites(), *centres(packing, j), 1 + packing.rho[j])
        for i, x0, y0, x, y, radius in zip(*columns, strict=True):
            if i in SHOWN:
                row: Row = {"i": i, "j": j, "x_ordered": float(x0), "y_ordered": float(y0)}
                found.append(row | {"x": float(x), "y": float(y), "radius": float(radius)})
    return Notation(tuple(found))


def draw(data: Notation) -> "Figure":
    """Draw ordered beads black, the disordered ones grey, and name what the text names."""
    from matplotlib.patches import Circle

    from . import style

    figure = style.figure(style.COLUMN, 1.85)
    axes = figure.subplots()
    for bead in data.beads:
        centre = (bead["x"], bead["y"])
        axes.add_patch(Circle(centre, bead["radius"], fc="0.87", ec="0.55", lw=0.7, zorder=1))
    for bead in data.beads:
        centre = (bead["x_ordered"], bead["y_ordered"])
        axes.add_patch(Circle(centre, 1, fc="none", ec="black", lw=1.1, zorder=3))
    _names(axes)
    axes.set_aspect("equal")
    axes.set_xlim(-1.2, 13.2)
    axes.set_ylim(-2.45, 5.15)
    axes.axis("off")
    return figure


def _names(axes: "Axes") -> None:
    from . import style

    nx = float(N_X)
    ny = np.sqrt(1 - nx**2)

    def at(i: float, j: float) -> tuple[float, float]:
        return 2 * nx * i, 2 * ny * j

    for words, site in (
        ("$(i,j)$", (4, 2)),
        ("$(i+1,j+1)$", (5, 3)),
        ("$(i-1,j+1)$", (3, 3)),
        ("$(i+1,j-1)$", (5, 1)),
        ("$(i-1,j-1)$", (3, 1)),
    ):
        x, y = at(*site)
        low = 0.45 if site == (4, 2) else 0.0
        axes.text(x, y - low, words, ha="center", va="center", fontsize=6.2, zorder=6)
    x, y = at(4, 2)
    for side, name, colour in ((1, "+", style.BLUE), (-1, "-", style.VERMILLION)):
        axes.annotate(
            "", (x + side * nx, y + ny), (x, y), zorder=7,
            arrowprops={
                "arrowstyle": "-|>", "color": colour, "lw": 1.3, "shrinkA": 0, "shrinkB": 0,
                "mutation_scale": 7,
            },
        )  # fmt: skip
        axes.text(
            x + side * 1.45, y - 0.12, rf"$\hat{{\mathbf{{n}}}}^{{{name}}}$", color=colour,
            ha="center", va="center", fontsize=7.5, zorder=8,
        )  # fmt: skip
    both = {"arrowstyle": "<->", "lw": 0.7, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 6}
    (left, base), (right, _) = at(2, 0), at(4, 0)
    axes.annotate("", (left, base - 1.45), (right, base - 1.45), arrowprops=both)
    for x in (left, right):
        axes.plot([x, x], [base, base - 1.6], color="black", lw=0.5, ls=(0, (2, 2)), zorder=5)
    axes.text((left + right) / 2, base - 1.6, "$s$", ha="center", va="top")
    x, y = at(7, 1)
    axes.annotate("", (x + 1, y), (x, y), arrowprops={**both, "arrowstyle": "->"}, zorder=6)
    axes.text(x + 0.5, y + 0.12, "$r$", ha="center", va="bottom", zorder=6)
    upper, lower = at(1, 3), at(0, 2)
    touch = ((upper[0] + lower[0]) / 2, (upper[1] + lower[1]) / 2)
    axes.annotate(
        "contact", touch, (-1.1, 4.75), ha="left", va="center", fontsize=7.5, zorder=9,
        arrowprops={"arrowstyle": "-|>", "lw": 0.7, "color": "black", "mutation_scale": 5,
                    "shrinkA": 1, "shrinkB": 0},
    )  # fmt: skip
    axes.axhline(0, color="black", lw=0.6, ls=(0, (1, 1.5)), zorder=0)
    axes.text(at(8, 0)[0] + 1.2, -1.45, "base, $j=0$", ha="right", va="center", fontsize=7.5)
