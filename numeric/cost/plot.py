"""The plot of a study of cost: error against time, both logarithmic, every line named beside it.

Needs matplotlib (the extra ``plots``), which nothing else of this package imports.
"""

import math
from collections.abc import Sequence
from decimal import Decimal
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from numeric.cost.study import Row, Study
from numeric.plotting import new_figure, powers_of_ten, saved

STYLES = {
    "exact, deviation form": ("o", "0.0"),
    "exact, plain form": ("s", "0.45"),
    "first-order line sums": ("^", "0.25"),
    "Monte Carlo, exact": ("o", "0.0"),
    "Monte Carlo, first-order": ("^", "0.45"),
}


def plots(study: Study, command: str, title: str) -> dict[str, str | bytes]:
    """Draw a study; ``cost.png`` and ``cost.svg`` both hold the command that reproduces them."""
    return saved(draw(study, title), "cost", f"Cost of accuracy: {title}", command)


def draw(study: Study, title: str) -> Figure:
    """Draw log10 of error against log10 of seconds; digits may lie beyond a float's range."""
    figure = new_figure(9, 7.5)
    figure.subplots_adjust(0.09, 0.08, 0.98, 0.91)
    axes = figure.subplots()
    rows = [row for row in study.rows if row.error and not _in_vain(row, study.rows)]
    floor = [math.log10(study.sampling_floor)] if study.sampling_floor else []
    powers_of_ten(axes, "x", [_x(row) for row in rows], 0.35)  # room for labels
    powers_of_ten(axes, "y", [_y(row) for row in rows] + floor, 0.08)
    for line in _lines(rows):
        marker, grey = STYLES.get(line[0].way, ("D", "0.1"))
        dashes = "--" if line[0].arithmetic.startswith("mpmath") else "-"
        x, y = [_x(row) for row in line], [_y(row) for row in line]
        axes.plot(x, y, dashes, color=grey, linewidth=0.8, zorder=2)
        for row in line:
            spread = [math.log10(row.seconds_min), math.log10(row.seconds_max)]
            axes.plot(spread, [_y(row)] * 2, color=grey, linewidth=0.6, zorder=1)
            face = grey if row.pareto else "white"
            axes.plot(_x(row), _y(row), marker, color=grey, markerfacecolor=face, zorder=3)
    for level in floor:
        n = max((row.realisations or 0 for row in rows), default=0)
        axes.axhline(level, color="0.3", linestyle=":", linewidth=1)
        axes.annotate(
            f"sampling floor: standard error of {n} realisations",
            (0.01, level), xycoords=("axes fraction", "data"), xytext=(0, 3),
            textcoords="offset points", fontsize=8, color="0.3",
        )  # fmt: skip
    taken = [_around(axes, row) for row in rows]
    for line in _lines(rows):
        _name(axes, line, STYLES.get(line[0].way, ("D", "0.1"))[1], taken)
    axes.set_xlabel("seconds, median (thin: fastest to slowest run)")
    axes.set_ylabel("measured error / largest |change|")
    reference = study.reference
    axes.set_title(
        f"{title}: {study.quantity}\n"
        "filled: on the Pareto front of measured error and time; "
        f"reference {reference.kind}, radius {reference.radius:.1e}",
        fontsize=10,
        loc="left",
    )
    axes.spines[["top", "right"]].set_visible(False)
    return figure


def _in_vain(row: Row, rows: Sequence[Row]) -> bool:
    """Say whether more digits of one way bring nothing but a longer time: the table has them."""
    return any(
        r.way == row.way
        and r.realisations == row.realisations
        and r.seconds < row.seconds
        and r.error <= row.error <= r.error * Decimal("1.01")
        for r in rows
    )


def _around(axes: Axes, row: Row) -> Bbox:
    x, y = axes.transData.transform((_x(row), _y(row)))
    return Bbox.from_extents(x - 6, y - 6, x + 6, y + 6)


def _x(row: Row) -> float:
    return math.log10(row.seconds)


def _y(row: Row) -> float:
    return float(row.error.log10())


def _lines(rows: list[Row]) -> list[list[Row]]:
    """Collect the rows that a line joins: one way in one family of arithmetic, by error."""
    found: dict[tuple[str, str], list[Row]] = {}
    for row in rows:
        family = row.arithmetic.split(",", maxsplit=1)[0]
        family = "hardware" if family in {"float64", "longdouble"} else family
        found.setdefault((row.way, family), []).append(row)
    return list(found.values())


def _name(axes: Axes, line: list[Row], grey: str, taken: list[Bbox]) -> None:
    """Name each point beside it, the last of a line in full, away from all that is there."""
    canvas: Any = axes.figure.canvas
    for row in line:
        text = _short(row)
        if row is line[-1]:
            text = f"{row.way}: {text}" if text else row.way
        note = axes.annotate(
            text, (_x(row), _y(row)), xytext=(8, 0), textcoords="offset points", fontsize=7.5,
            color=grey, va="center",
            bbox={"boxstyle": "square,pad=0.05", "fc": "white", "ec": "none"},
            arrowprops={"arrowstyle": "-", "color": grey, "linewidth": 0.4, "shrinkB": 3},
        )  # fmt: skip
        for reach in range(8, 120, 8):
            spots = [(reach, 0, "left"), (-reach, 0, "right")]
            for up in range(10, min(reach, 60) + 1, 10):
                spots += [(s * reach, v * up, a) for v in (1, -1) for s, a in _SIDES]
            if any(_fits(note, spot, canvas, axes.bbox, taken) for spot in spots):
                break
        taken.append(Text.get_window_extent(note, canvas.get_renderer()))


_SIDES = ((1, "left"), (-1, "right"))


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
        return f"N = {row.realisations}"
    if row.arithmetic.startswith("arb balls"):
        return f"balls {math.floor(int(row.arithmetic.split()[2]) * math.log10(2))}"
    return row.arithmetic.replace(" digits", "").replace(",", "")
