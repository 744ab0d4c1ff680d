"""The figure of the cost of stability: errors and lost bits above, the times they cost below.

Markers and lines say the same as colours.
"""

from collections.abc import Iterator
from math import log10
from typing import Any

import numpy as np

from ...figures import specification as spec
from .enclosures import DIGITS, LINE_SUMS, POSITIONS

DEVIATION, PLAIN = 0, 1  # series
LEAST = 1e-30  # of σ/r: below it nothing changes any more
FORMS = ((POSITIONS, PLAIN, "--"), (LINE_SUMS, DEVIATION, "-"))
Rows = list[dict[str, Any]]


def picture(floats: Rows, enclosures: Rows) -> spec.Picture:
    """Draw four panels: float64 on the left, balls on the right; times below."""
    rows = [r for r in floats if r["group"] == "disorder" and r["relative_std"] >= LEAST]
    balls = [row for row in enclosures if row["bits_lost"] is not None]
    panels = [_errors(rows), _lost(balls), _ratios(rows), _seconds(balls)]
    return spec.Picture(panels, 5.2, page=True, mosaic="ab;cd", rows=(5, 3))


def _by_height(rows: Rows) -> Iterator[tuple[int, bool, Rows]]:
    """Give the rows of each height, and whether it is the larger one."""
    heights = sorted({row["height"] for row in rows})
    for height in heights:
        yield height, height > heights[0], [row for row in rows if row["height"] == height]


def _std_axis(rows: Rows) -> spec.Axis:
    return spec.powers_of_ten("σ/r", [log10(row["relative_std"]) for row in rows])


def _errors(rows: Rows) -> spec.Panel:
    elements: list[spec.Element] = [
        spec.Rule("y", 0, ":", name="no digit is left above"),
    ]
    for key, words, series, dashes in (
        ("plain_error", "plain form", PLAIN, "--"),
        ("error", "deviation form", DEVIATION, "-"),
    ):
        for height, larger, own in _by_height(rows):
            here = [row for row in own if row[key]]
            x, y = ([log10(row[name]) for row in here] for name in ("relative_std", key))
            elements += [
                spec.Line(x, y, series, dashes),
                spec.Points(x, y, series, f"{words}, $M={height}$", filled=larger),
            ]
    y_axis = spec.powers_of_ten(
        "error / largest |change|", [-17.0, *(log10(row["plain_error"]) for row in rows)]
    )
    title = "float64: largest error of the contact forces"
    return spec.Panel(elements, _std_axis(rows), y_axis, title)


def _ratios(rows: Rows) -> spec.Panel:
    elements: list[spec.Element] = [spec.Rule("y", 1, ":", name="as long as the plain form")]
    for height, larger, own in _by_height(rows):
        here = [row for row in own if row["plain_seconds"] and row["seconds"]]
        x = [log10(row["relative_std"]) for row in here]
        y = [row["seconds"] / row["plain_seconds"] for row in here]
        elements.append(spec.Points(x, y, DEVIATION, f"$M={height}$", filled=larger))
    # the ratio is one number; what scatters is the machine
    y_axis = spec.Axis("ratio of seconds", 0, 4)
    title = "their time: deviation form / plain form"
    return spec.Panel(elements, _std_axis(rows), y_axis, title, columns=3)


def _curves(rows: Rows, key: str) -> Iterator[tuple[int, Rows, list[spec.Element]]]:
    """Draw a column over the height, a curve for each form and σ/r; give series and rows, too."""
    for form, series, dashes in FORMS:
        own = sorted((row for row in rows if row["form"] == form), key=lambda row: row["height"])
        for number, std in enumerate(sorted({row["relative_std"] for row in own})):
            here = [row for row in own if row["relative_std"] == std]
            x, y = ([row[name] for row in here] for name in ("height", key))
            points = spec.Points(x, y, series, "" if number else form)
            yield series, here, [spec.Line(x, y, series, dashes), points]


def _lost(rows: Rows) -> spec.Panel:
    elements: list[spec.Element] = []
    for series, here, drawn in _curves(rows, "bits_lost"):
        elements += drawn
        if series == PLAIN:
            continue
        bits, highest, last = [r["bits_lost"] for r in here], here[0]["critical_height"], here[-1]
        words = f"σ/r = {last['relative_std']:.0e}".replace("e-0", "e-")
        place = last["height"], last["bits_lost"]
        elements.append(spec.Words(*place, words, series, ("left", "center"), (6, 0)))
        heights = [row["height"] for row in here]
        if heights[0] <= highest <= heights[-1]:  # M*, on the curve
            lies = np.exp(np.interp(np.log(highest), np.log(heights), np.log(bits)))
            elements.append(spec.Points([highest], [lies], 3, size=4.5, filled=True))
    elements.append(spec.Points(series=3, name="$M^*=(σ/r)^{-2/3}$", size=4.5, filled=True))
    y_axis = spec.Axis("bits", 4, 5000, log=True)
    return spec.Panel(elements, _height_axis(rows), y_axis, "balls: bits lost in all")


def _height_axis(rows: Rows) -> spec.Axis:
    name = f"layers $M$ (strips of {rows[0]['width']} beads a layer)"
    return spec.Axis(name, 3.4, 4100, log=True, ticks=(4, 16, 64, 256, 1024))


def _seconds(rows: Rows) -> spec.Panel:
    elements = [drawn for *_, drawn in _curves(rows, "seconds")]
    y_axis = spec.Axis("seconds", log=True)
    title = f"the time of {DIGITS} certified digits"
    return spec.Panel(elements, _height_axis(rows), y_axis, title)
