"""The plot of a study of cost: error against time, both logarithmic, the Pareto front named.

Colour and marker tell ways apart, lines join the digits of one family of arithmetic. Needs
matplotlib (the extra ``plots``).
"""

import math
from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke
from matplotlib.text import Text
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator
from matplotlib.transforms import Bbox

from ...arithmetic.errors import printable
from ...figures import style
from .rows import Reference, Row

WIDE = 60
"""Decades of error beyond which the axis is one of √digits."""

WAYS = {
    "exact, deviation form": (style.BLUE, "o"),
    "exact, plain form": (style.VERMILLION, "s"),
    "first-order line sums": (style.GREEN, "^"),
    "Monte Carlo, exact": (style.BLUE, "o"),
    "Monte Carlo, first-order": (style.GREEN, "^"),
    "exact finite-M formula": (style.PURPLE, "D"),
    "printed asymptotic formula": (style.ORANGE, "v"),
}
DASHES: Mapping[str, tuple[str, Any]] = {
    "hardware": ("float64, long double", "-"),
    "mpmath": ("mpmath", (0, (5, 2))),
    "arb balls": ("arb balls", (0, (1, 1.2))),
}


def draw(
    title: str, ways: Sequence[Row], reference: Reference, sampling_floor: Decimal | None
) -> Figure:
    """Draw log10 of error against log10 of seconds; digits may lie beyond a float's range."""
    figure = style.figure(style.PAGE, 4.6)
    axes = figure.subplots()
    rows = [row for row in ways if row.error and not _in_vain(row, ways)]
    floor = [math.log10(sampling_floor)] if sampling_floor else []
    style.powers_of_ten(axes, "x", [_x(row) for row in rows], 0.06)
    levels = [_y(row) for row in rows] + floor
    style.powers_of_ten(axes, "y", levels, 0.06)
    stretched = max(levels) - min(levels) > WIDE
    if stretched:
        _stretch(axes, min(levels), max(levels))
    lines = _lines(rows)
    for (way, family), line in lines.items():
        colour, marker = WAYS[way]
        x, y = [_x(row) for row in line], [_y(row) for row in line]
        axes.plot(x, y, ls=DASHES[family][1], color=colour, lw=0.9, zorder=2)
        for row in line:
            spread = [math.log10(row.seconds_min), math.log10(row.seconds_max)]
            axes.plot(spread, [_y(row)] * 2, color=colour, lw=0.8, alpha=0.35, zorder=1)
            face = colour if row.pareto else "white"
            axes.plot(_x(row), _y(row), marker, color=colour, mfc=face, ms=4, mew=0.8, zorder=3)
    for level in floor:
        axes.axhline(level, color="0.3", ls=":", lw=0.8, zorder=1)
    axes.set_xlabel("processor time (s): median; pale: from the fastest to the slowest run")
    axes.set_ylabel(
        "measured error / largest |change|" + (", spaced by √digits" if stretched else "")
    )
    name = printable(title).replace("$", r"\$")  # no formula
    axes.set_title(f"{name}; reference {reference.kind}, radius {reference.radius:.1e}", loc="left")
    figure.legend(handles=_keys(lines, bool(floor)), loc="outside lower center", ncols=3)
    figure.draw_without_rendering()  # lays out, so that labels know where points are
    _name(axes, rows)
    return figure


def _stretch(axes: Axes, low: float, high: float) -> None:
    """Give the few digits of hardware as much room as the many of big numbers."""
    axes.set_yscale(
        "function",
        functions=(
            lambda y: np.sign(y) * np.sqrt(np.abs(y)),
            lambda root: np.sign(root) * root**2,
        ),
    )
    axes.set_ylim(low * 1.15, max(high, 0) + 1)
    axes.yaxis.set_major_locator(FixedLocator([0, -5, -15, -30, -50, -100, -200, -300]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.yaxis.set_major_formatter(FuncFormatter(lambda power, _: f"$10^{{{power:.0f}}}$"))


def _in_vain(row: Row, rows: Sequence[Row]) -> bool:
    """Say whether more digits of one way bring nothing but a longer time: the table has them."""
    return any(
        r.way == row.way
        and r.realisations == row.realisations
        and r.seconds < row.seconds
        and r.error <= row.error <= r.error * Decimal("1.01")
        for r in rows
    )


def _x(row: Row) -> float:
    return math.log10(row.seconds)


def _y(row: Row) -> float:
    return float(row.error.log10())


def _family(row: Row) -> str:
    return next((name for name in DASHES if row.arithmetic.startswith(name)), "hardware")


def _lines(rows: list[Row]) -> dict[tuple[str, str], list[Row]]:
    """Collect the rows that a line joins: one way in one family of arithmetic, by size or error."""
    found: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        found.setdefault((row.way, _family(row)), []).append(row)
    for line in found.values():
        line.sort(key=lambda row: row.realisations or 0)  # ensembles by their size
    return found


def _keys(lines: Mapping[tuple[str, str], list[Row]], floor: bool) -> list[Line2D]:
    """Explain markers, then lines, then what is filled."""
    ways = [way for way in WAYS if any(way == drawn for drawn, _ in lines)]
    keys = [
        Line2D([], [], color=WAYS[way][0], marker=WAYS[way][1], mfc="white", ls="", ms=4, label=way)
        for way in ways
    ]
    joined = {family for (_, family), line in lines.items() if len(line) > 1}
    for family, (name, dashes) in DASHES.items():
        if family in joined and len(joined) > 1:
            keys.append(Line2D([], [], color="0.3", ls=dashes, lw=0.9, label=name))
    keys.append(Line2D([], [], color="0.3", marker="o", ls="", ms=4, label="filled: Pareto front"))
    if floor:
        keys.append(Line2D([], [], color="0.3", ls=":", lw=0.8, label="standard error of sampling"))
    return keys


def _name(axes: Axes, rows: list[Row]) -> None:
    """Name the points of the front, and the sizes of ensembles, beside or below them."""
    taken = [box for row in rows for box in _around(axes, row)]
    canvas: Any = axes.figure.canvas
    for row in sorted((row for row in rows if row.pareto or row.realisations), key=_x):
        note = axes.annotate(
            _short(row), (_x(row), _y(row)), xytext=(-6, 0), textcoords="offset points",
            fontsize=7, color=WAYS[row.way][0], va="center", zorder=4,
            path_effects=[withStroke(linewidth=1.5, foreground="white")],
            arrowprops={"arrowstyle": "-", "color": "0.5", "lw": 0.4, "shrinkA": 0, "shrinkB": 2},
        )  # fmt: skip
        note.set_in_layout(False)
        spots = [
            (side * reach, up, "right" if side < 0 else "left")
            for reach in (6, 12, 20, 30, 45)
            for up in (0, -6, 6, -12, -18, -26, 12, -36)
            for side in (-1, 1)
        ]
        if any(_fits(note, spot, canvas, axes.bbox, taken) for spot in spots):
            taken.append(Text.get_window_extent(note, canvas.get_renderer()))
        else:
            note.remove()  # the table has it


def _around(axes: Axes, row: Row) -> tuple[Bbox, Bbox]:
    """Give what the marker takes, and the line of its times."""
    x, y = axes.transData.transform((_x(row), _y(row)))
    left, right = (
        axes.transData.transform((math.log10(seconds), _y(row)))[0]
        for seconds in (row.seconds_min, row.seconds_max)
    )
    return (
        Bbox.from_extents(x - 4, y - 4, x + 4, y + 4),
        Bbox.from_extents(left, y - 1, right, y + 1),
    )


def _fits(
    note: Any, spot: tuple[int, int, str], canvas: Any, inside: Bbox, taken: list[Bbox]
) -> bool:
    """Put a label at a spot and say whether it hides nothing there."""
    note.set_position(spot[:2])
    note.set_horizontalalignment(spot[2])
    note.update_positions(canvas.get_renderer())  # of the arrow it has, and of the text
    box = Text.get_window_extent(note, canvas.get_renderer())
    return bool(
        inside.x0 <= box.x0 and box.x1 <= inside.x1 and inside.y0 <= box.y0 and box.y1 <= inside.y1
        and not any(box.overlaps(other) for other in taken)
    )  # fmt: skip


def _short(row: Row) -> str:
    if row.realisations is not None:
        return f"$N={row.realisations}$"
    if row.arithmetic.startswith("arb balls"):
        return f"balls {math.floor(int(row.arithmetic.split()[2]) * math.log10(2))}"
    return row.arithmetic.replace(" digits", "").replace(",", "")
