"""The plot of a study of cost: error against time, both logarithmic, the Pareto front named.

Colour and marker tell ways apart, lines join the digits of one family of arithmetic.
"""

import math
from collections.abc import Mapping, Sequence
from decimal import Decimal
from itertools import groupby
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..arithmetic.errors import printable
from ..figures.style import GREY, PAGE, panels, points, powers_of_ten
from .rows import Reference, Way

# Decades of error beyond which the axis is one of √digits.
WIDE = 60
POWERS = (0, -5, -15, -30, -50, -100, -200, -300)
SERIES = {
    "exact": 0,
    "Monte Carlo, exact": 0,
    "first-order line sums": 2,
    "Monte Carlo, first-order": 2,
    "exact finite-M formula": 3,
    "printed asymptotic formula": 4,
}
DASHES = {"float64": "-", "mpmath": (0, (5, 2)), "arb balls": (0, (1, 1.2))}


def figure(
    title: str, ways: Sequence[Way], reference: Reference, sampling_floor: Decimal | None
) -> Figure:
    """Draw log10 of error against log10 of seconds; digits may lie beyond a float's range."""
    rows = [row for row in ways if row.error and not _in_vain(row, ways)]
    places = {row: (math.log10(row.seconds), float(row.error.log10())) for row in rows}
    drawn, (axes,) = panels("a", PAGE, 4.6)
    for line in lines(rows):
        _draw(axes, line, places)
    if sampling_floor:
        level = float(sampling_floor.log10())
        axes.axhline(level, color="0.3", ls=":", lw=0.7, label="standard error of sampling")
    _explain(axes, rows)
    powers_of_ten(axes.xaxis)
    powers_of_ten(axes.yaxis)
    powers = [power for _, power in places.values()]
    if max(powers, default=0) - min(powers, default=0) > WIDE:
        # the few digits of hardware get as much room as the many of big numbers
        axes.set_yscale("function", functions=(_root, lambda y: np.sign(y) * y**2))
        axes.set_yticks([power for power in POWERS if power >= 1.15 * min(powers)])
        axes.yaxis.set_major_formatter(lambda power, _: f"$10^{{{power:g}}}$")
        axes.set_ylim(1.15 * min(powers), max(*powers, 0) + 1)
    else:
        axes.margins(y=0.1)
    _name(axes, places)
    name = printable(title).replace("$", r"\$")  # no formula
    axes.set_title(f"{name}; reference {reference.kind}, radius {reference.radius:.1e}")
    axes.set_xlabel("processor time (s): median; thin: from the fastest to the slowest run")
    axes.set_ylabel("measured error / largest |change|")
    drawn.legend(loc="outside lower center", ncols=3)
    return drawn


def _root(power: Any) -> Any:
    return np.sign(power) * np.sqrt(np.abs(power))


def _in_vain(row: Way, rows: Sequence[Way]) -> bool:
    """Say whether more digits of one way bring nothing but a longer time: the table has them."""
    return any(
        r.way == row.way
        and r.realisations == row.realisations
        and r.seconds < row.seconds
        and r.error <= row.error <= r.error * Decimal("1.01")
        for r in rows
    )


def _family(row: Way) -> str:
    return next(name for name in DASHES if row.arithmetic.startswith(name))


def lines(rows: Sequence[Way]) -> list[list[Way]]:
    """Collect rows that a line joins: a way in one family of arithmetic, by size, or by error."""

    def joined(row: Way) -> tuple[str, str]:
        return row.way, _family(row)

    ordered = sorted(rows, key=lambda row: (joined(row), row.realisations or 0, -row.error))
    return [list(line) for _, line in groupby(ordered, joined)]


def _draw(axes: Axes, line: list[Way], places: Mapping[Way, tuple[float, float]]) -> None:
    """Draw a line, its points, and how their times scatter."""
    series = SERIES[line[0].way]
    if len(line) > 1:
        axes.plot(
            *zip(*(places[row] for row in line), strict=True), color=f"C{series}",
            ls=DASHES[_family(line[0])],
        )  # fmt: skip
    for row in line:
        x, y = places[row]
        spread = math.log10(row.seconds_min), math.log10(row.seconds_max)
        axes.plot(spread, (y, y), color=f"C{series}", lw=0.3)
        points(axes, [x], [y], series, ms=4, mfc=f"C{series}" if row.pareto else "white")


def _name(axes: Axes, places: Mapping[Way, tuple[float, float]]) -> None:
    """Name the points of the front, and the sizes of ensembles, but where names would overlap.

    Names stand to the lower left, where by its definition nothing lies beside the front.
    """
    taken: list[tuple[float, float, int]] = []
    for row, at in places.items():
        side = 1 if row.way == "Monte Carlo, exact" else -1
        x, y = axes.transAxes.inverted().transform(axes.transData.transform(at))
        if (row.pareto or row.realisations) and not any(
            side == other and abs(x - a) < 0.09 and abs(y - b) < 0.04 for a, b, other in taken
        ):
            taken.append((x, y, side))
            axes.annotate(
                _short(row), at, (4 * side, 0), textcoords="offset points", fontsize=7,
                color=f"C{SERIES[row.way]}", ha="left" if side > 0 else "right", va="top",
            )  # fmt: skip


def _explain(axes: Axes, rows: Sequence[Way]) -> None:
    """Explain markers, then lines, then what is filled."""
    for way, series in SERIES.items():
        if any(row.way == way for row in rows):
            points(axes, [], [], series, way, ms=4)
    joined = {_family(line[0]) for line in lines(rows) if len(line) > 1}
    for family, dashes in DASHES.items():
        if family in joined and len(joined) > 1:
            axes.plot([], [], color=GREY, ls=dashes, label=family)
    points(axes, [], [], 0, "filled: Pareto front", ms=4, mfc="C0")


def _short(row: Way) -> str:
    if row.realisations is not None:
        return f"$N={row.realisations}$"
    if row.arithmetic.startswith("arb balls"):
        return f"balls {math.floor(int(row.arithmetic.split()[2]) * math.log10(2))}"
    return row.arithmetic.replace(" digits", "").replace(",", "")
