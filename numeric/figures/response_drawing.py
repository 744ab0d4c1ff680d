"""Figure 4 drawn: maps of mean and fluctuation, cuts through the cone, the double Y."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PatchCollection
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from numeric.figures import style
from numeric.figures.packings import N_X
from numeric.figures.response import CUTS, Response
from numeric.lattice import Array
from numeric.models.double_y import Profile


def draw(data: Response) -> Figure:
    """Draw maps of mean and fluctuation, line cuts, and the double Y where it is asked for."""
    where = "bottom" if data.double_y else "right"
    if data.double_y:
        figure = style.figure(style.PAGE, 4.7)
        panels = figure.subplots(2, 2, height_ratios=(1, 1.05)).ravel().tolist()
        _double_y(panels[3], data.double_y)
    else:
        figure = style.figure(style.PAGE, 3.3)
        grid = figure.add_gridspec(2, 2, width_ratios=(1, 1.1))
        cells = (grid[0, 0], grid[1, 0], grid[:, 1])
        panels = [figure.add_subplot(cell) for cell in cells]
    _map(panels[0], data, data.mean, r"$\langle p\rangle\,/\,f^{\rm load}$", where, edges=True)
    _map(panels[1], data, data.variance, VARIANCE, where, edges=False)
    _cuts(panels[2], data)
    style.letter(panels)
    return figure


VARIANCE = r"$\sigma^2_{\rm ensemble}(p)\,/\,(f^{\rm load}\sigma_{\delta r}/r)^2$"


def _map(
    axes: Axes, data: Response, values: tuple[Array, ...], name: str, where: str, *, edges: bool
) -> None:
    nx, ny = float(N_X), np.sqrt(1 - float(N_X) ** 2)
    discs, shades = [], []
    for j in range(data.apex):
        for q, i in enumerate(data.sites(j)):
            edge = q in {0, data.apex - j}
            if edge and not edges:
                axes.add_patch(Circle((2 * nx * i, 2 * ny * j), 1, fc="none", ec="0.6", lw=0.35))
                continue
            discs.append(Circle((2 * nx * i, 2 * ny * j), 1))
            shades.append(values[j][q])
    beads = PatchCollection(discs, cmap="Greys", ec="0.75", lw=0.25)
    beads.set_array(np.array(shades))
    highest = 0.5 if edges else float(values[data.apex - 2][1])
    beads.set_clim(0, 1.15 * highest)  # the darkest grey still lets circles be seen
    axes.add_collection(beads)
    top = (0, 2 * ny * data.apex)
    axes.add_patch(Circle(top, 1, fc="none", ec="black", lw=0.6))
    axes.annotate(
        r"$\mathbf{F}^{\rm load}$", (0, top[1] + 1), (0, top[1] + 6), ha="center", va="bottom",
        arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1, "shrinkA": 0, "shrinkB": 0,
                    "mutation_scale": 7},
    )  # fmt: skip
    reach = 2 * nx * data.apex + 2
    axes.plot([-reach, reach], [-1.2, -1.2], color="black", lw=0.8)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-2, top[1] + 10)
    axes.set_aspect("equal", anchor="N")
    axes.axis("off")
    bar = axes.figure.colorbar(
        beads, ax=axes, location=where, shrink=0.8, aspect=18, pad=0.03, label=name
    )
    (bar.ax.set_xlim if where == "bottom" else bar.ax.set_ylim)(0, highest)


def _cuts(axes: Axes, data: Response) -> None:
    limits = data.limits()
    for number, j in enumerate(CUTS):
        colour, marker = style.series(number)
        x = data.sites(j)[1:-1] / data.apex
        low, high = limits[j]
        middle = data.simulated_variance[j][1:-1]
        axes.fill_between(x, low, high, color=colour, alpha=0.2, lw=0)
        axes.plot(x, middle, marker, color=colour, ms=2.6, mew=0.6, markerfacecolor="white")
        axes.plot(x, data.variance[j][1:-1], color=colour, lw=0.9)
        reach = 1 - j / data.apex
        axes.hlines(data.printed(j), -reach, reach, color="black", lw=0.8, ls="--")
        axes.annotate(
            f"$j={j}$", (reach, data.printed(j)), xytext=(3, -1), textcoords="offset points",
            va="center", color=colour, fontsize=7.5,
        )  # fmt: skip
    lower = CUTS[2]
    axes.plot(
        data.sites(lower)[1:-1] / data.apex, data.one_contact[lower][1:-1],
        color=style.series(2)[0], lw=0.9, ls=":",
    )  # fmt: skip
    axes.text(
        0.7, 13, f"one contact,\n$j={lower}$", color=style.series(2)[0], fontsize=7.5, va="center"
    )
    axes.set_xlim(-1.05, 1.4)
    axes.set_ylim(0, None)
    axes.set_xlabel("horizontal position $i/l$")
    axes.set_ylabel(VARIANCE)
    axes.legend(
        handles=[
            style.line("0.3", "-", "exact first order"),
            style.line("black", "--", "Eq. (16), printed"),
        ],
        loc="lower left",
    )  # fmt: skip


def _double_y(axes: Axes, found: tuple[Profile, ...]) -> None:
    for number, one in enumerate(found):
        colour, _ = style.series(number)
        dashes = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (4, 1.5, 1, 1.5)))[number % 4]
        axes.stairs(one.density, one.edges, color=colour, ls=dashes, lw=1.0, label=one.name)
    cone = float(N_X / (1 - N_X**2) ** 0.5)
    for x in (-cone, cone):
        axes.axvline(x, color="0.6", lw=0.6, ls=(0, (1, 1.5)), zorder=0)
    axes.annotate("the packing's cone", (cone, 2.2), (1.35, 2.2), va="center", fontsize=7)
    axes.set_xlim(-3, 3)
    axes.set_ylim(0, None)
    axes.set_xlabel("horizontal position $x/H$")
    axes.set_ylabel(r"mean response $H\,p(x)\,/\,f^{\rm load}$")
    axes.legend(loc="upper center", title="double Y", title_fontsize=7.5)
