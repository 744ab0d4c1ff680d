"""Beads, force chains, loads and the base, drawn to scale. Lengths in units of r."""

from collections.abc import Sequence
from math import ceil
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from ..arithmetic.systems import Array

PRESSING, PULLING = "0.12", "#D55E00"
WIDEST, THINNEST, THINNEST_KEY = 3.0, 0.05, 0.4  # points; the last is seen in a legend
EQUAL = 1e-12
"""Forces that differ by less than this share are equal: their differences are rounding."""
MOST_ARROWS = 40
DOWN = np.array([0.0, -1.0])
NOTHING = 0.01
"""Share of the largest response, up to which a negative one is no tension."""


def bare(axes: Axes, left: float, right: float, low: float, high: float) -> None:
    """Show this part of a packing, to scale and without axes."""
    axes.set(xlim=(left, right), ylim=(low, high), aspect="equal", anchor="N")
    axes.axis("off")


def draw_beads(axes: Axes, centres: Array, radii: Any = 1.0, **look: Any) -> PatchCollection:
    """Draw beads at ``centres``, (beads, 2)."""
    sizes = np.broadcast_to(radii, len(centres))
    circles = [Circle(tuple(at), size) for at, size in zip(centres, sizes, strict=True)]
    beads = PatchCollection(circles, **{"ec": "0.75", "lw": 0.25, **look})
    axes.add_collection(beads)
    axes.autoscale_view()
    return beads


def shade(axes: Axes, beads: PatchCollection, shades: Array, most: float, **bar: Any) -> None:
    """Make beads as grey as ``shades``, (beads,), are large, negative ones vermillion.

    A bar shows the greys up to ``most``; ``location`` is its side, ``label`` its name.
    """
    beads.set_cmap(mpl.colormaps["Greys"].with_extremes(under=PULLING))
    beads.set_array(shades)
    beads.set_clim(0, 1.15 * most)  # the darkest grey that is used still shows circles
    made = axes.figure.colorbar(beads, ax=axes, shrink=0.8, aspect=18, pad=0.03, **bar)
    made.ax.set(**{"xlim" if made.orientation == "horizontal" else "ylim": (0, most)})


def draw_base(axes: Axes, left: float, right: float, height: float = -0.9) -> None:
    """Draw the base."""
    axes.plot([left, right], [height, height], "k", lw=1)


def arrow(axes: Axes, tail: Any, tip: Any, words: str = "", **look: Any) -> None:
    """Draw an arrow, with words at its tail."""
    shape = {"arrowstyle": "-|>", "mutation_scale": 6, "lw": 0.7, "shrinkA": 0, "shrinkB": 0}
    axes.annotate(
        words, tip, tail, ha="center", va="bottom", fontsize=7.5, zorder=7,
        arrowprops={"color": "black", **shape, **look},
    )  # fmt: skip


def draw_surface_load(axes: Axes, beads: Array, along: Array = DOWN) -> None:
    """Draw arrows that end on ``beads``, (beads, 2), or on every other one, …, if they are many.

    ``along``: the direction of the load, (2,), a unit vector.
    """
    for bead in beads[:: ceil(len(beads) / MOST_ARROWS)]:
        arrow(axes, bead - 4.5 * along, bead - 1.1 * along, color="0.3", mutation_scale=5)


def draw_point_load(axes: Axes, bead: Array, along: Array = DOWN) -> None:
    """Draw the loaded bead, (2,), and the arrow of its load."""
    draw_beads(axes, bead[None], fc="none", ec="black", lw=0.6, zorder=3)
    words = r"$\mathbf{F}^{\rm load}$"
    arrow(axes, bead - 6 * along, bead - along, words, lw=1, mutation_scale=7)


def draw_cone(
    axes: Axes, centres: Array, shades: Array, apex: Array, most: float, along: Array = DOWN,
    **bar: Any,
) -> None:  # fmt: skip
    """Draw the beads of a response below its apex, with the load, the base and a bar of greys.

    ``centres``: (beads, 2); ``shades``, (beads,), from 0 to ``most``; ``bar`` as ``shade`` has it.
    """
    shades = np.where(shades > -NOTHING * most, np.maximum(shades, 0), shades)
    reach = max(float(np.abs(centres[:, 0] - apex[0]).max(initial=0)), 0) + 2
    shade(axes, draw_beads(axes, centres), shades, most, **bar)
    draw_point_load(axes, apex, along)
    draw_base(axes, apex[0] - reach, apex[0] + reach, -1.2)
    bare(axes, apex[0] - reach, apex[0] + reach, -2, apex[1] + 10)


def alike(forces: Array) -> bool:
    """Say whether all forces press, the smallest more than a third as much as the largest."""
    return bool(forces.min() > forces.max() / 3)


def extremes(forces: Array, mean: float) -> list[tuple[float, str]]:
    """Give the smallest and the largest force, and how far they are from the mean, in words."""
    ends = ("smallest", float(forces.min())), ("largest", float(forces.max()))
    return [(force, rf"{name}, ${100 * (force / mean - 1):+.2g}\%$") for name, force in ends]


def thickness(some: Any, forces: Array) -> Array:
    """Widths of lines, in points, for some of all ``forces``: in proportion to them.

    Where forces are ``alike``, so would be their lines: these are thin from the smallest force on.
    """
    sizes, largest = np.abs(some), float(np.abs(forces).max()) or 1.0
    if not alike(forces):
        return np.asarray(np.maximum(WIDEST * (sizes / largest), THINNEST))
    least = float(forces.min())
    span = largest - least
    if span < EQUAL * largest:
        return np.full_like(sizes, WIDEST / 2)
    return np.asarray(WIDEST * (0.1 + 0.9 * (sizes - least) / span))


def draw_coloured(axes: Axes, ends: Array, forces: Array, values: Array, label: str) -> None:
    """Draw contacts as ``draw_chains`` does, coloured by ``values``, (contacts,), with a bar."""
    widths = thickness(forces, forces).tolist()
    lines = LineCollection(list(ends), linewidths=widths, array=values, capstyle="round")
    axes.add_collection(lines)
    axes.figure.colorbar(lines, ax=axes, shrink=0.8, aspect=18, pad=0.03, label=label)


def draw_chains(axes: Axes, ends: Array, forces: Array, shown: Sequence[tuple[float, str]]) -> None:
    """Draw contacts as lines between ``ends``, (contacts, 2, 2), as thick as ``forces``.

    Pressing ones are dark, pulling ones vermillion. ``shown``: forces that the legend of the whole
    figure shows, with their names.
    """
    for own, colour in ((forces >= 0, PRESSING), (forces < 0, PULLING)):
        widths = thickness(forces[own], forces).tolist()
        lines = LineCollection(list(ends[own]), linewidths=widths, colors=colour)
        lines.set(capstyle="round", zorder=1 + (colour == PULLING))
        axes.add_collection(lines)
    keys = []
    for f, name in shown:
        width = max(float(thickness(f, forces)), THINNEST_KEY)
        keys.append(Line2D([], [], c=PULLING if f < 0 else PRESSING, lw=width, label=name))
    if keys:
        axes.figure.legend(handles=keys, loc="outside lower center", ncols=3)
