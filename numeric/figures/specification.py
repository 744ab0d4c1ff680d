"""What a figure is: panels of lines, points and beads, its data files, and what it says.

Nothing here draws: ``drawing`` does, in the house style. A colour is the number of a series, which
has a marker of its own, too, or one that matplotlib knows by name. Lines, areas and points without
a place are keys of the legend alone.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import ceil, floor
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..statistics.bands import Band

Colour = int | str
Table = dict[str, Any]
"""Columns of a CSV file by name, (rows,) each; what is one number is the same in all rows."""
GREY = "0.35"
WIDEST, THINNEST = 3.0, 0.05  # points
EQUAL = 1e-12
"""Forces that differ by less than this share are equal: their differences are rounding."""


@dataclass(frozen=True)
class Axis:
    """An axis; limits that are None are found from what is drawn; ``ticks`` may have words."""

    name: str = ""
    low: float | None = None
    high: float | None = None
    log: bool = False
    ticks: Sequence[float] | Mapping[float, str] | None = None


def powers_of_ten(name: str, logs: Iterable[float]) -> Axis:
    """Give an axis of log10 of what is drawn, which may lie beyond a float's range, as powers.

    >>> list(powers_of_ten("error", [-337, -15.5]).ticks)
    [-350, -300, -250, -200, -150, -100, -50, 0]
    """
    found = list(logs)
    low, high = min(found, default=0.0), max(found, default=0.0)
    room = max(0.06 * (high - low), 0.3)
    low, high = low - room, high + room
    step = next(s for s in (1, 2, 5, 10, 20, 50, 100) if s >= min((high - low) / 8, 100))
    powers = range(ceil(low / step) * step, floor(high) + 1, step)
    return Axis(name, low, high, ticks={power: f"$10^{{{power}}}$" for power in powers})


RELATIVE_HEIGHT = Axis("relative height $z=j/M$", 0, 1)


@dataclass(frozen=True)
class Line:
    """A curve through (x, y); of a single point, a dash."""

    x: Any = ()
    y: Any = ()
    colour: Colour = GREY
    dashes: Any = "-"
    name: str = ""
    width: float = 0.9


def in_parts(x: Any, y: Any, bulk: slice, colour: Colour, dashes: Any = "-") -> list[Line]:
    """Draw a curve through the bulk, and a dash wherever beside it a place has a value of its own.

    >>> [len(one.x) for one in in_parts([0, 1, 2, 3], [5, 1, 2, 3], slice(1, None), 0)]
    [3, 1]
    """
    inside, beside = range(len(x))[bulk], set(range(len(x))).difference(range(len(x))[bulk])
    return [
        Line(np.take(x, some), np.take(y, some), colour, dashes)
        for some in (inside, *([at] for at in sorted(beside)))
    ]


@dataclass(frozen=True)
class Points:
    """What was found at (x, y), with error bars: half-widths, or those below and above."""

    x: Any = ()
    y: Any = ()
    series: int = 0
    name: str = ""
    error: Any = None
    size: float = 3.2
    filled: bool = False


@dataclass(frozen=True)
class Area:
    """What lies between two curves over x; ``edges`` are as strong as lines, if drawn."""

    x: Any = ()
    low: Any = ()
    high: Any = ()
    colour: Colour = GREY
    alpha: float = 0.25
    name: str = ""
    edges: float = 0.0
    sideways: bool = False


@dataclass(frozen=True)
class Rule:
    """A straight line across the panel, ``at`` a value of the axis "x" or "y"."""

    axis: str
    at: float
    dashes: Any = "-"
    colour: Colour = "0.6"
    name: str = ""


@dataclass(frozen=True)
class Words:
    """Words at (x, y), moved by ``away`` points; ``align``: horizontally and vertically."""

    x: float
    y: float
    words: str
    colour: Colour = "black"
    align: tuple[str, str] = ("center", "center")
    away: tuple[float, float] = (0, 0)
    size: float = 7.5


@dataclass(frozen=True)
class Arrow:
    """An arrow from ``tail`` to ``tip``, with words at its tail."""

    tail: Any
    tip: Any
    words: str = ""
    colour: Colour = "black"
    style: str = "-|>"
    width: float = 0.7
    size: float = 6


@dataclass(frozen=True)
class Beads:
    """Beads at ``centres``, (beads, 2), as grey as ``shades``, (beads,), are large.

    Negative shades are vermillion. With ``bar``, the name of the shades, there is a bar of greys
    up to ``most``, on a side of the panel. Without shades ``face`` fills them.
    """

    centres: Array
    radii: Any = 1.0
    shades: Array | None = None
    bar: str = ""
    side: str = "bottom"
    most: float = 1.0
    face: str = "none"
    edge: str = "0.75"
    width: float = 0.25
    above: bool = False


@dataclass(frozen=True)
class Chains:
    """Contacts as lines between ``ends``, (contacts, 2, 2), as thick as ``forces``, (contacts,).

    Pressing ones are dark, pulling ones vermillion. ``shown``: forces that the legend shows, with
    their names.
    """

    ends: Array
    forces: Array
    shown: Sequence[tuple[float, str]] = ()

    @property
    def alike(self) -> bool:
        """Whether thickness is from the smallest force on: in proportion all would look alike."""
        return alike(self.forces)

    def thickness(self, forces: Any) -> Array:
        """Widths of lines in points for forces of any shape."""
        sizes, largest = np.abs(forces), float(np.abs(self.forces).max()) or 1.0
        if not self.alike:
            return np.asarray(np.maximum(WIDEST * (sizes / largest), THINNEST))
        least = float(self.forces.min())
        span = largest - least
        if span < EQUAL * largest:
            return np.asarray(np.full_like(sizes, WIDEST / 2))
        return np.asarray(WIDEST * (0.1 + 0.9 * (sizes - least) / span))


def alike(forces: Array) -> bool:
    """Say whether all forces press, the smallest more than a third as much as the largest."""
    return bool(forces.min() > forces.max() / 3)


Element = Line | Points | Area | Rule | Words | Arrow | Beads | Chains


@dataclass(frozen=True)
class Panel:
    """One panel, of elements or lists of them.

    ``legend`` is its place, "below" under the whole figure, "" nowhere.

    ``scaled``: both axes alike; ``bare``: no axes.
    """

    elements: Sequence[Element | Sequence[Element]]
    x: Axis = Axis()
    y: Axis = Axis()
    title: str = ""
    legend: str = "best"
    legend_title: str = ""
    columns: int = 1
    scaled: bool = False
    bare: bool = False


@dataclass(frozen=True)
class Picture:
    """Panels (a), (b), … placed as ``mosaic`` says: "ab" side by side, "a;b" one above the other.

    A page or a column wide, and so many inches high. ``share``: "x" or "y", of all panels.
    """

    panels: Sequence[Panel]
    height: float
    page: bool = False
    mosaic: str = ""
    share: str = ""
    rows: Sequence[float] | None = None
    columns: Sequence[float] | None = None


def table(names: str, rows: Iterable[Iterable[Any]]) -> Table:
    """Give the columns of rows, by names with spaces between them."""
    return dict(zip(names.split(), zip(*rows, strict=True), strict=True))


def stacked(parts: Sequence[Table]) -> Table:
    """Put tables of the same columns below each other."""
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


@dataclass(frozen=True)
class Comparison:
    """What was simulated, with its band, and what ``theory`` says, (L,); ``of``: in words."""

    of: str
    band: Band
    theory: Array

    def deviation(self, theory: Array | None = None) -> float:
        """Largest deviation of this theory or another one, in half-widths: inside is ≤ 1."""
        return self.band.deviation(self.theory if theory is None else theory)

    def verdict(self) -> str:
        """Say whether theory lies inside of the band."""
        return f"{self.of} {self.band.verdict(self.deviation())}"

    def fact(self) -> dict[str, float]:
        """Say it in numbers."""
        return {"largest_deviation_in_half_widths": self.deviation()}

    def points(
        self, x: Any, series: int, name: str = "", *, unit: float = 1.0, rows: Any = ...
    ) -> Points:
        """Give what was simulated, over ``unit``, with its band as error bars."""
        found, (low, high) = self.band.value[rows], (edge[rows] for edge in self.band.limits)
        return Points(x, found / unit, series, name, np.array([found - low, high - found]) / unit)

    def drawn(
        self,
        x: Any,
        series: int,
        name: str = "",
        *,
        unit: float = 1.0,
        bulk: slice = slice(None),
    ) -> list[Element]:
        """Give theory as a line, ``in_parts``, and what was simulated."""
        lines = in_parts(x, self.theory / unit, bulk, series)
        return [*lines, self.points(x, series, name, unit=unit)]

    def columns(self, name: str = "") -> Table:
        """Give columns of a CSV file: what was simulated, its band, theory."""
        low, high = self.band.limits
        return {
            f"{name}simulated": self.band.value,
            "band_low": low,
            "band_high": high,
            f"{name}exact_first_order": self.theory,
        }


@dataclass(frozen=True)
class Figure:
    """A figure: its picture, its CSV files by name, verdicts and parameters, verdicts in words.

    Words that are not given are those of the comparisons.
    """

    picture: Picture
    tables: Mapping[str, Table]
    facts: Mapping[str, Any]
    comparisons: Sequence[Comparison] = ()
    words: Sequence[str] = ()

    @property
    def says(self) -> list[str]:
        """What was found, in words."""
        return list(self.words) or [one.verdict() for one in self.comparisons]
