"""The figure of the cost of stability: errors and lost bits above, the times they cost below.

Needs matplotlib (the extra ``plots``). Markers and lines say the same as colours.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import log10
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from ...figures import style
from .enclosures import DIGITS, LINE_SUMS, POSITIONS

PLAIN, DEVIATION = style.VERMILLION, style.BLUE
LEAST = 1e-30  # of σ/r: below it nothing changes any more
FORMS = ((POSITIONS, PLAIN, "s", "--"), (LINE_SUMS, DEVIATION, "o", "-"))
Rows = list[dict[str, Any]]


def draw(floats: Rows, enclosures: Rows) -> Figure:
    """Draw four panels: float64 on the left, balls on the right; times below."""
    figure = style.figure(style.PAGE, 5.2)
    (errors, lost), (ratios, seconds) = figure.subplots(
        2, 2, sharex="col", gridspec_kw={"height_ratios": (5, 3)}
    )
    rows = [r for r in floats if r["group"] == "disorder" and r["relative_std"] >= LEAST]
    _errors(errors, rows)
    _ratios(ratios, rows)
    balls = [row for row in enclosures if row["bits_lost"] is not None]
    _lost(lost, balls)
    _seconds(seconds, balls)
    for words in [one for axes in figure.axes for one in axes.texts]:
        words.set_in_layout(False)  # they stand at data, which may lie outside of an axis
    return figure


def _heights(rows: Rows) -> list[int]:
    return sorted({row["height"] for row in rows})


def _errors(axes: Axes, rows: Rows) -> None:
    axes.set_title("float64: largest error of the contact forces", loc="left")
    marks = dict(zip(_heights(rows), ("white", None), strict=False))
    for key, colour, marker, dashes in (
        ("plain_error", PLAIN, "s", "--"),
        ("error", DEVIATION, "o", "-"),
    ):
        for height, fill in marks.items():
            here = [row for row in rows if row["height"] == height and row[key]]
            x = [log10(row["relative_std"]) for row in here]
            y = [log10(row[key]) for row in here]
            face = colour if fill is None else fill
            axes.plot(x, y, dashes, marker=marker, color=colour, markerfacecolor=face, ms=3.5)
    style.powers_of_ten(axes, "x", [log10(row["relative_std"]) for row in rows], 0.03)
    style.powers_of_ten(axes, "y", [-17.0, *(log10(row["plain_error"]) for row in rows)], 0.06)
    axes.axhline(0, color="0.5", linewidth=0.8, linestyle=":")
    axes.text(-2, 0.2, "no digit left above", fontsize=7.5, color="0.35", ha="right")
    axes.text(-20.5, 5.2, "plain form", fontsize=7.5, color=PLAIN)
    axes.text(-20.5, -14.3, "deviation form", fontsize=7.5, color=DEVIATION)
    few, many = min(marks), max(marks)
    axes.text(
        0.02, 0.35, f"open: M = {few}\nfilled: M = {many}", fontsize=7.5, color="0.25",
        transform=axes.transAxes,
    )  # fmt: skip
    axes.set_ylabel("error / largest |change|")


def _ratios(axes: Axes, rows: Rows) -> None:
    axes.set_title("their time: deviation form / plain form", loc="left")
    for height, face in zip(_heights(rows), ("white", "0.2"), strict=False):
        here = [r for r in rows if r["height"] == height and r["plain_seconds"] and r["seconds"]]
        x = [log10(row["relative_std"]) for row in here]
        y = [row["seconds"] / row["plain_seconds"] for row in here]
        axes.plot(x, y, "D", color="0.2", markerfacecolor=face, markersize=3.2)
    axes.set_ylim(0, 4)  # the ratio is one number; what scatters is the machine
    axes.axhline(1, color="0.5", linewidth=0.8, linestyle=":")
    axes.text(-2, 1.08, "as long as the plain form", fontsize=7.5, color="0.35", ha="right")
    axes.set_ylabel("ratio of seconds")
    axes.set_xlabel("σ/r")


def _curves(axes: Axes, rows: Rows, key: str) -> Iterator[tuple[str, str, Rows]]:
    """Draw a column over the height, a curve for each form and σ/r; give form, colour and rows."""
    for form, colour, marker, dashes in FORMS:
        own = sorted((row for row in rows if row["form"] == form), key=lambda row: row["height"])
        for std in {row["relative_std"] for row in own}:
            here = [row for row in own if row["relative_std"] == std]
            x, y = [row["height"] for row in here], [row[key] for row in here]
            axes.plot(x, y, dashes, marker=marker, color=colour, ms=3.2, mfc="white")
            yield form, colour, here


def _lost(axes: Axes, rows: Rows) -> None:
    axes.set_title("balls: bits lost in all", loc="left")
    for form, colour, here in _curves(axes, rows, "bits_lost"):
        if form == LINE_SUMS:
            last = here[-1]
            axes.annotate(
                f"σ/r = {last['relative_std']:.0e}".replace("e-0", "e-"),
                (last["height"], last["bits_lost"]), xytext=(6, 0),
                textcoords="offset points", fontsize=7.5, color=colour, va="center",
            )  # fmt: skip
            _mark_critical(axes, here)
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    axes.set_xlim(3.4, 4100)
    axes.set_ylim(4, 5000)
    axes.text(7, 400, "positions:\nabout 3 bits a layer", fontsize=7.5, color=PLAIN)
    axes.text(3.9, 11, "line sums", fontsize=7.5, color=DEVIATION)
    axes.text(
        0.99, 0.02, "filled diamond: M* = (σ/r)$^{-2/3}$", fontsize=7.5, color="0.25", ha="right",
        transform=axes.transAxes,
    )  # fmt: skip
    axes.set_ylabel("bits")


def _mark_critical(axes: Axes, rows: Rows) -> None:
    """Put M* on the curve, if it lies on it."""
    highest = rows[0]["critical_height"]
    for a, b in pairwise(rows):
        if a["height"] <= highest <= b["height"]:
            share = log10(highest / a["height"]) / log10(b["height"] / a["height"])
            bits = a["bits_lost"] ** (1 - share) * b["bits_lost"] ** share
            axes.plot(highest, bits, "D", color="black", markersize=4.5, zorder=5)
            return


def _seconds(axes: Axes, rows: Rows) -> None:
    axes.set_title(f"the time of {DIGITS} certified digits", loc="left")
    list(_curves(axes, rows, "seconds"))
    axes.set_yscale("log")
    axes.set_ylabel("seconds")
    axes.set_xlabel(f"layers M (strips of {rows[0]['width']} beads a layer)")
    axes.xaxis.set_major_locator(FixedLocator([4, 16, 64, 256, 1024]))
    axes.xaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:.0f}")
    axes.text(0.03, 0.86, "positions", fontsize=7.5, color=PLAIN, transform=axes.transAxes)
    axes.text(0.03, 0.74, "line sums", fontsize=7.5, color=DEVIATION, transform=axes.transAxes)
