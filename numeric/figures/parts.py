"""What several figures draw: force chains, responses on beads, distributions of changes.

Lengths are in units of r. Needs matplotlib (the extra ``plots``).
"""

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from ..arithmetic.systems import Array
from . import style

PRESSING, PULLING = "0.12", style.VERMILLION
WIDEST = 3.0  # points
NOTHING = 0.01  # share of the largest response, up to which a negative one is no tension


def force_chains(axes: Axes, ends: Array, forces: Array) -> None:
    """Draw contacts as lines, pressing ones dark, pulling ones vermillion; widths in proportion.

    ``ends``: (contacts, 2, 2), both ends as (x, y); ``forces``: (contacts,).
    """
    widths = WIDEST * (np.abs(forces) / (np.abs(forces).max() or 1))
    for pulls, colour, order in ((False, PRESSING, 1), (True, PULLING, 2)):
        own = (forces < 0) == pulls
        lines = LineCollection(
            list(ends[own]), linewidths=np.maximum(widths[own], 0.05).tolist(), colors=colour,
            capstyle="round", zorder=order,
        )  # fmt: skip
        axes.add_collection(lines)


def chain_keys(forces: Array, shown: Sequence[tuple[float, str]]) -> list[Line2D]:
    """Give keys of a legend, each as wide as a force and with its name."""
    handles = []
    for force, name in shown:
        handles.append(style.line(PULLING if force < 0 else PRESSING, "-", name))
        handles[-1].set_linewidth(WIDEST * (abs(force) / (np.abs(forces).max() or 1)))
    return handles


def surface_load(axes: Axes, left: float, right: float, top: float) -> None:
    """Draw the base below and arrows above a packing."""
    axes.plot([left, right], [-0.9, -0.9], color="black", lw=1)
    for x in left + np.linspace(0.03, 0.97, 16) * (right - left):
        axes.annotate(
            "", (x, top + 0.9), (x, top + 5),
            arrowprops={"arrowstyle": "-|>", "color": "0.3", "lw": 0.7, "mutation_scale": 5},
        )  # fmt: skip


def point_load(axes: Axes, x: float, y: float) -> None:
    """Draw the loaded bead and the arrow of its load."""
    axes.add_patch(Circle((x, y), 1, fc="none", ec="black", lw=0.6))
    axes.annotate(
        r"$\mathbf{F}^{\rm load}$", (x, y + 1), (x, y + 6), ha="center", va="bottom",
        arrowprops={"arrowstyle": "-|>", "color": "black", "lw": 1, "shrinkA": 0, "shrinkB": 0,
                    "mutation_scale": 7},
    )  # fmt: skip


def discs(
    axes: Axes, circles: Sequence[tuple[float, float, float]], shades: Array
) -> PatchCollection:
    """Draw beads (x, y, radius) as grey as ``shades`` say, (beads,); negative ones vermillion."""
    patches = [Circle((x, y), radius) for x, y, radius in circles]
    greys = mpl.colormaps["Greys"].with_extremes(under=PULLING)
    beads = PatchCollection(patches, cmap=greys, ec="0.75", lw=0.25)
    beads.set_array(shades)
    axes.add_collection(beads)
    return beads


def cone(
    axes: Axes,
    centres: Sequence[tuple[float, float]],
    shades: Array,
    apex: tuple[float, float],
    name: str,
    where: str,
    highest: float,
) -> None:
    """Draw the beads of a response below its apex, with the load, the base and a colour bar."""
    shades = np.where(shades > -NOTHING * highest, np.maximum(shades, 0), shades)
    beads = discs(axes, [(x, y, 1) for x, y in centres], shades)
    beads.set_clim(0, 1.15 * highest)  # the darkest grey still lets circles be seen
    point_load(axes, *apex)
    reach = max(abs(x - apex[0]) for x, _ in [*centres, apex]) + 2
    axes.plot([apex[0] - reach, apex[0] + reach], [-1.2, -1.2], color="black", lw=0.8)
    axes.set_xlim(apex[0] - reach, apex[0] + reach)
    axes.set_ylim(-2, apex[1] + 10)
    axes.set_aspect("equal", anchor="N")
    axes.axis("off")
    bar = axes.figure.colorbar(
        beads, ax=axes, location=where, shrink=0.8, aspect=18, pad=0.03, label=name
    )
    (bar.ax.set_xlim if where == "bottom" else bar.ax.set_ylim)(0, highest)


def densities(
    axes: Axes, v: Array, density: Array, error: Array | None, look: tuple[str, str], name: str
) -> None:
    """Draw densities at v on a logarithmic axis, with their errors if these are known."""
    style.points(axes, v, density, error, look, name)
    axes.set_yscale("log")
