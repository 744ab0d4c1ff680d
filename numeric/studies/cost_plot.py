"""The plot of a study of cost: error against time, both logarithmic, the Pareto front named.

Colour and marker tell ways apart, lines join the digits of one family of arithmetic.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from itertools import groupby
from typing import Any

from ..arithmetic.errors import printable
from ..figures import specification as spec
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
DASHES: Mapping[str, tuple[str, Any]] = {
    "float64": ("float64", "-"),
    "mpmath": ("mpmath", (0, (5, 2))),
    "arb balls": ("arb balls", (0, (1, 1.2))),
}


def picture(
    title: str, ways: Sequence[Way], reference: Reference, sampling_floor: Decimal | None
) -> spec.Picture:
    """Draw log10 of error against log10 of seconds; digits may lie beyond a float's range."""
    rows = [row for row in ways if row.error and not _in_vain(row, ways)]
    floor = [float(sampling_floor.log10())] if sampling_floor else []
    powers = [float(row.error.log10()) for row in rows]
    y_name = "measured error / largest |change|"
    stretched = max(powers, default=0) - min(powers, default=0) > WIDE
    y_axis = spec.powers_of_ten(y_name, powers + floor)
    if stretched:  # the few digits of hardware get as much room as the many of big numbers
        low, high = _root(1.15 * min(powers)), _root(max(*powers, 0) + 1)
        ticks = {_root(power): f"$10^{{{power}}}$" for power in POWERS if _root(power) >= low}
        y_axis = spec.Axis(f"{y_name}, spaced by √digits", low, high, ticks=ticks)
    places = {
        row: (math.log10(row.seconds), _root(power) if stretched else power)
        for row, power in zip(rows, powers, strict=True)
    }
    x_axis = spec.powers_of_ten(
        "processor time (s): median; thin: from the fastest to the slowest run",
        [x for x, _ in places.values()],
    )
    name = printable(title).replace("$", r"\$")  # no formula
    panel = spec.Panel(
        [
            *(list(_drawn(line, places)) for line in lines(rows)),
            list(_names(places, x_axis, y_axis)),
            list(_keys(rows)),
            [spec.Rule("y", level, ":", "0.3", "standard error of sampling") for level in floor],
        ],
        x_axis, y_axis, title=f"{name}; reference {reference.kind}, radius {reference.radius:.1e}",
        legend="below", columns=3,
    )  # fmt: skip
    return spec.Picture([panel], 4.6, page=True)


def _root(power: float) -> float:
    return math.copysign(math.sqrt(abs(power)), power)


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


def _drawn(line: list[Way], places: Mapping[Way, tuple[float, float]]) -> Iterator[spec.Element]:
    """Draw a line, its points, and how their times scatter."""
    series, dashes = SERIES[line[0].way], DASHES[_family(line[0])][1]
    xs, ys = zip(*(places[row] for row in line), strict=True)
    if len(line) > 1:
        yield spec.Line(xs, ys, series, dashes)
    for row in line:
        x, y = places[row]
        spread = math.log10(row.seconds_min), math.log10(row.seconds_max)
        yield spec.Line(spread, (y, y), series, width=0.3)
        yield spec.Points([x], [y], series, size=4, filled=row.pareto)


def _names(
    places: Mapping[Way, tuple[float, float]], x_axis: spec.Axis, y_axis: spec.Axis
) -> Iterator[spec.Words]:
    """Name the points of the front, and the sizes of ensembles, but where names would overlap.

    Names stand to the lower left, where by its definition nothing lies beside the front.
    """
    (left, right), (low, high) = ((axis.low or 0, axis.high or 0) for axis in (x_axis, y_axis))
    taken: list[tuple[float, float, int]] = []
    for row, (x, y) in places.items():
        side = 1 if row.way == "Monte Carlo, exact" else -1
        if (row.pareto or row.realisations) and not any(
            side == other
            and abs(x - a) < 0.09 * (right - left)
            and abs(y - b) < 0.04 * (high - low)
            for a, b, other in taken
        ):
            taken.append((x, y, side))
            align = "left" if side > 0 else "right", "top"
            yield spec.Words(x, y, _short(row), SERIES[row.way], align, (4 * side, 0), 7)


def _keys(rows: Sequence[Way]) -> Iterator[spec.Element]:
    """Explain markers, then lines, then what is filled."""
    for way, series in SERIES.items():
        if any(row.way == way for row in rows):
            yield spec.Points(series=series, name=way, size=4)
    joined = {_family(line[0]) for line in lines(rows) if len(line) > 1}
    for family, (name, dashes) in DASHES.items():
        if family in joined and len(joined) > 1:
            yield spec.Line(dashes=dashes, name=name)
    yield spec.Points(name="filled: Pareto front", size=4, filled=True)


def _short(row: Way) -> str:
    if row.realisations is not None:
        return f"$N={row.realisations}$"
    if row.arithmetic.startswith("arb balls"):
        return f"balls {math.floor(int(row.arithmetic.split()[2]) * math.log10(2))}"
    return row.arithmetic.replace(" digits", "").replace(",", "")
