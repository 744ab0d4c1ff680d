"""What a ``Picture`` says, drawn in the house style. Needs matplotlib (the extra ``plots``)."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Patch
from matplotlib.ticker import LogFormatterSciNotation, LogLocator, NullFormatter

from . import specification as spec
from . import style

PLAIN = 5e-4
"""Numbers from here to its inverse are not written with powers of ten."""
_SCIENTIFIC = LogFormatterSciNotation(minor_thresholds=(np.inf, np.inf))
PRESSING, PULLING = "0.12", style.VERMILLION


def draw(picture: spec.Picture) -> Figure:
    """Draw all panels, with their letters where there are several."""
    figure = style.figure(style.PAGE if picture.page else style.COLUMN, picture.height)
    letters = "abcdef"[: len(picture.panels)]
    found = figure.subplot_mosaic(
        picture.mosaic or letters,
        sharex="x" in picture.share,
        sharey="y" in picture.share,
        height_ratios=picture.rows,
        width_ratios=picture.columns,
    )
    if len(letters) > 1:
        style.letter([found[letter] for letter in letters])
    below: dict[Any, Artist] = {}
    for letter, panel in zip(letters, picture.panels, strict=True):
        axes = found[letter]
        keys = _draw(axes, panel)
        if panel.legend == "below":
            below |= {key.get_label(): key for key in keys}
        elif panel.legend and keys:
            _legend(axes, panel, keys)
    if below:
        columns = max(panel.columns for panel in picture.panels)
        figure.legend(
            handles=list(below.values()), loc="outside lower center", ncols=columns,
            columnspacing=1.2, handletextpad=0.6,
        )  # fmt: skip
    return figure


def _draw(axes: Axes, panel: spec.Panel) -> list[Artist]:
    """Draw a panel; give the keys of its legend."""
    lists = [one if isinstance(one, Sequence) else [one] for one in panel.elements]
    elements = [element for one in lists for element in one]
    keys = [key for element in elements for key in _PUT[type(element)](axes, element)]
    if panel.scaled:
        axes.set_aspect("equal")
    if panel.bare:
        axes.set_anchor("N")
        axes.axis("off")
    for letter, axis in (("x", panel.x), ("y", panel.y)):
        _scale(axes, letter, axis)
    axes.set_title(panel.title, pad=4)
    return keys


def _legend(axes: Axes, panel: spec.Panel, keys: list[Artist]) -> None:
    under = {"loc": "upper center", "bbox_to_anchor": (0.5, 0)}
    place: dict[str, Any] = under if panel.legend == "under" else {"loc": panel.legend}
    axes.legend(
        handles=keys, title=panel.legend_title or None, title_fontsize=7, ncols=panel.columns,
        columnspacing=1.0, **place,
    )  # fmt: skip


def _scale(axes: Axes, letter: str, axis: spec.Axis) -> None:
    """Set the scale, limits, ticks and name of an axis."""
    getattr(axes, f"set_{letter}label")(axis.name)
    if axis.log:
        getattr(axes, f"set_{letter}scale")("log")
    limits = getattr(axes, f"set_{letter}lim")
    if axis.low is not None or axis.high is not None:
        limits(axis.low, axis.high)
    part = getattr(axes, f"{letter}axis")
    low, high = getattr(axes, f"get_{letter}lim")()
    if axis.log and high < 1000 * low:  # so few powers of ten alone say too little
        part.set_major_locator(LogLocator(10, (1, 2, 5) if high > 10 * low else range(1, 10)))
        part.set_major_formatter(_short if low > PLAIN and high < 1 / PLAIN else _SCIENTIFIC)
        part.set_minor_formatter(NullFormatter())
    if axis.ticks is not None:
        words = axis.ticks if isinstance(axis.ticks, Mapping) else {}
        shown = [words.get(tick, f"{tick:g}".replace("-", "−")) for tick in axis.ticks]
        part.set_ticks(list(axis.ticks), shown)
        axes.minorticks_off()


def _short(value: float, _: Any) -> str:
    return f"{value:g}"


def _colour(colour: spec.Colour) -> str:
    return style.series(colour)[0] if isinstance(colour, int) else colour


def _line(axes: Axes, one: spec.Line) -> Iterable[Artist]:
    colour = _colour(one.colour)
    alone: Any = {"marker": "_", "ms": 7, "mew": 0.9, "clip_on": False} if len(one.x) == 1 else {}
    drawn = axes.plot(
        one.x, one.y, color=colour, ls=one.dashes, lw=one.width, label=one.name or None,
        **alone,
    )  # fmt: skip
    return drawn if one.name else ()


def _points(axes: Axes, one: spec.Points) -> Iterable[Any]:
    colour, marker = style.series(one.series)
    drawn = axes.errorbar(
        one.x, one.y, one.error, fmt=marker, color=colour, ms=one.size, mew=0.7,
        mfc=colour if one.filled else "white", elinewidth=0.7, label=one.name or None, zorder=2.5,
    )  # fmt: skip
    if len(one.x):  # markers on an axis are drawn in full, bars end there
        drawn.lines[0].set_clip_on(False)
    return (drawn,) if one.name else ()


def _area(axes: Axes, one: spec.Area) -> Iterable[Artist]:
    colour = _colour(one.colour)
    fill = axes.fill_betweenx if one.sideways else axes.fill_between
    if len(one.x) == 1:  # of a single place nothing would be seen
        axes.vlines(one.x, one.low, one.high, color=colour, alpha=one.alpha, lw=3)
    elif len(one.x):
        fill(one.x, one.low, one.high, color=colour, alpha=one.alpha, lw=0)
        for edge in (one.low, one.high) if one.edges else ():
            axes.plot(one.x, edge, color=colour, lw=one.edges)
    return (Patch(facecolor=colour, alpha=one.alpha, lw=0, label=one.name),) if one.name else ()


def _rule(axes: Axes, one: spec.Rule) -> Iterable[Artist]:
    look: Any = {"color": _colour(one.colour), "ls": one.dashes, "lw": 0.7, "zorder": 0.5}
    drawn = (axes.axvline if one.axis == "x" else axes.axhline)(one.at, **look)
    drawn.set_label(one.name or "_rule")
    return (drawn,) if one.name else ()


def _words(axes: Axes, one: spec.Words) -> Iterable[Artist]:
    axes.annotate(
        one.words, (one.x, one.y), xytext=one.away, textcoords="offset points",
        color=_colour(one.colour), fontsize=one.size, ha=one.align[0], va=one.align[1], zorder=8,
    )  # fmt: skip
    return ()


def _arrow(axes: Axes, one: spec.Arrow) -> Iterable[Artist]:
    look = {
        "arrowstyle": one.style, "color": _colour(one.colour), "lw": one.width,
        "mutation_scale": one.size, "shrinkA": 0, "shrinkB": 0,
    }  # fmt: skip
    axes.annotate(
        one.words, one.tip, one.tail, ha="center", va="bottom", fontsize=7.5, arrowprops=look,
        zorder=7,
    )  # fmt: skip
    return ()


def _beads(axes: Axes, one: spec.Beads) -> Iterable[Artist]:
    radii = np.broadcast_to(one.radii, len(one.centres))
    circles = [
        Circle((x, y), radius) for (x, y), radius in zip(one.centres, radii, strict=True)
    ]  # fmt: skip
    greys = mpl.colormaps["Greys"].with_extremes(under=PULLING)
    beads = PatchCollection(circles, ec=one.edge, lw=one.width, zorder=3 if one.above else 1)
    if one.shades is None:
        beads.set_facecolor(one.face)
    else:
        beads.set_cmap(greys)
        beads.set_array(one.shades)
        beads.set_clim(0, 1.15 * one.most)  # the darkest grey that is used still shows circles
    axes.add_collection(beads)
    axes.autoscale_view()
    if one.bar:
        bar = axes.figure.colorbar(
            beads, ax=axes, location=one.side, shrink=0.8, aspect=18, pad=0.03, label=one.bar
        )
        (bar.ax.set_xlim if one.side == "bottom" else bar.ax.set_ylim)(0, one.most)
    return ()


def _chains(axes: Axes, one: spec.Chains) -> Iterable[Artist]:
    widths = one.thickness(one.forces)
    for pulls, colour, order in ((False, PRESSING, 1), (True, PULLING, 2)):
        own = (one.forces < 0) == pulls
        lines = LineCollection(
            list(one.ends[own]), linewidths=widths[own].tolist(), colors=colour,
            capstyle="round", zorder=order,
        )  # fmt: skip
        axes.add_collection(lines)
    axes.autoscale_view()
    return [
        Line2D(
            [], [], color=PULLING if force < 0 else PRESSING, lw=float(one.thickness(force)),
            label=name,
        )
        for force, name in one.shown
    ]  # fmt: skip


_PUT: dict[type, Callable[[Axes, Any], Iterable[Any]]] = {
    spec.Line: _line,
    spec.Points: _points,
    spec.Area: _area,
    spec.Rule: _rule,
    spec.Words: _words,
    spec.Arrow: _arrow,
    spec.Beads: _beads,
    spec.Chains: _chains,
}
