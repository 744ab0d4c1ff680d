"""Figure 4 drawn: maps of mean and fluctuation, cuts through the cone, the double Y."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from ..arithmetic.systems import Array
from . import parts, style
from .models.double_y import Profile
from .packings import Medium
from .response import CUTS, LEVEL, Response


def draw(data: Response) -> Figure:
    """Draw maps of mean and fluctuation, line cuts, and the double Y where it is asked for."""
    where = "bottom" if data.double_y else "right"
    if data.double_y:
        figure = style.figure(style.PAGE, 4.7)
        panels = figure.subplots(2, 2, height_ratios=(1, 1.05)).ravel().tolist()
        _double_y(panels[3], data.double_y, data.medium)
    else:
        figure = style.figure(style.PAGE, 3.4)
        grid = figure.add_gridspec(2, 2, width_ratios=(0.85, 1.1))
        cells = (grid[0, 0], grid[1, 0], grid[:, 1])
        panels = [figure.add_subplot(cell) for cell in cells]
    _map(panels[0], data, data.mean, r"$\langle p\rangle\,/\,f^{\rm load}$", where, 0.5)
    highest = float(data.variance[data.apex - 2][1])
    _map(panels[1], data, data.variance, VARIANCE, where, highest)
    _cuts(panels[2], data)
    style.letter(panels)
    return figure


VARIANCE = r"$\sigma^2_{\rm ensemble}(p)\,/\,(f^{\rm load}\sigma_{\delta r}/r)^2$"


def _map(
    axes: Axes, data: Response, values: tuple[Array, ...], name: str, where: str, highest: float
) -> None:
    nx, ny = float(data.medium.n_x), data.medium.n_y
    parts.cone(
        axes,
        [(2 * nx * i, 2 * ny * j) for j in range(data.apex) for i in data.sites(j)],
        np.concatenate(values),
        (0, 2 * ny * data.apex),
        name,
        where,
        highest,
    )


def _cuts(axes: Axes, data: Response) -> None:
    limits = data.limits()
    for number, j in enumerate(CUTS):
        colour, marker = style.series(number)
        x = data.sites(j) / data.apex
        low, high = limits[j]
        axes.fill_between(x[1:-1], low[1:-1], high[1:-1], color=colour, alpha=0.2, lw=0)
        axes.plot(x[1:-1], data.variance[j][1:-1], color=colour, lw=0.9)
        for leg in (0, -1):
            axes.vlines(x[leg], low[leg], high[leg], color=colour, alpha=0.2, lw=3)
            axes.plot(x[leg], data.variance[j][leg], "_", color=colour, ms=6, mew=0.9)
        axes.plot(
            x, data.simulated_variance[j], marker, color=colour, ms=2.6, mew=0.6,
            markerfacecolor="white",
        )  # fmt: skip
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
    axes.text(0, 5, "legs of the cone", ha="center", va="center", color="0.3", fontsize=7.5)
    axes.set_xlim(-1.08, 1.4)
    axes.set_ylim(0, None)
    axes.set_xlabel("horizontal position $i/l$")
    axes.set_ylabel(VARIANCE)
    axes.figure.legend(
        handles=[
            style.line("0.3", "-", "exact first order"),
            style.line("black", "--", "Eq. (16), printed"),
            Line2D([], [], color="0.3", marker="o", ls="", ms=2.6, mew=0.6, mfc="white",
                   label="simulated"),
            style.shade("0.3", f"{LEVEL:.0%} band of all"),
            style.line(style.series(2)[0], ":", f"one contact, $j={lower}$"),
        ],
        loc="outside lower center", ncols=5, columnspacing=1.2,
    )  # fmt: skip


def _double_y(axes: Axes, found: tuple[Profile, ...], medium: Medium) -> None:
    for number, one in enumerate(found):
        colour, _ = style.series(number)
        dashes = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (4, 1.5, 1, 1.5)))[number % 4]
        axes.stairs(one.density, one.edges, color=colour, ls=dashes, lw=1.0, label=one.name)
    cone = float(medium.n_x) / medium.n_y
    for x in (-cone, cone):
        axes.axvline(x, color="0.6", lw=0.6, ls=(0, (1, 1.5)), zorder=0,
                     label="the packing's cone" if x > 0 else None)  # fmt: skip
    axes.set_xlim(-3, 3)
    axes.set_ylim(0, None)
    axes.set_xlabel("horizontal position $x/H$")
    axes.set_ylabel(r"mean response $H\,p(x)\,/\,f^{\rm load}$")
    axes.legend(loc="upper center", title="double Y", title_fontsize=7.5)
