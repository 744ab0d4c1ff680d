"""The figure of cascades."""

from typing import Any

from ...figures import specification as spec

SHARES = {
    "forces_1": "forces changed by more than 1 % of the mean",
    "forces_10": "by more than 10 %",
    "moved": "beads moved by more than 0.001 r",
    "new": "contacts that are new",
}


def picture(summary: list[dict[str, Any]]) -> spec.Picture:
    """Draw one panel a load: shares over M, with bars of two standard errors."""
    panels = []
    for load in dict.fromkeys(row["load"] for row in summary):
        rows = [row for row in summary if row["load"] == load]
        heights = [row["height"] for row in rows]
        elements: list[spec.Element] = []
        for number, (name, words) in enumerate(SHARES.items()):
            shares, bars = ([row[n] for row in rows] for n in (name, f"{name}_error"))
            elements += [
                spec.Line(heights, shares, number, width=0.8),
                spec.Points(heights, shares, number, words, [2 * bar for bar in bars]),
            ]
        x_axis, y_axis = spec.Axis("height $M$", ticks=heights), spec.Axis("share", 0, 1)
        panels.append(spec.Panel(elements, x_axis, y_axis, f"{load} load", "below", columns=2))
    return spec.Picture(panels, 2.9, page=True, share="y")
