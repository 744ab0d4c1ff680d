"""What several scale drawings have: loads, the base, the cone of a response. In units of r."""

from math import ceil

import numpy as np

from ..arithmetic.systems import Array
from .specification import Arrow, Axis, Beads, Element, Line, Panel

MOST_ARROWS = 40
NOTHING = 0.01
"""Share of the largest response, up to which a negative one is no tension."""


def surface_load(beads: Array, across: float = 0.0) -> list[Element]:
    """Draw arrows that end on ``beads``, (beads, 2), or on every other one, …, if they are many.

    ``across``: how far to the side they go on one unit downwards.
    """
    some = beads[:: ceil(len(beads) / MOST_ARROWS)]
    down = np.array([across, -1.0]) / np.hypot(across, 1)
    return [
        Arrow(tuple(bead - 4.5 * down), tuple(bead - 1.1 * down), colour="0.3", size=5)
        for bead in some.tolist()
    ]


def base(left: float, right: float, height: float = -0.9) -> Line:
    """Draw the base."""
    return Line([left, right], [height, height], "black", width=1.0)


def point_load(x: float, y: float) -> list[Element]:
    """Draw the loaded bead and the arrow of its load."""
    arrow = Arrow((x, y + 6), (x, y + 1), r"$\mathbf{F}^{\rm load}$", width=1.0, size=7)
    return [Beads(np.array([[x, y]]), edge="black", width=0.6, above=True), arrow]


def cone(
    centres: Array, shades: Array, apex: tuple[float, float], name: str, side: str, most: float
) -> Panel:
    """Draw the beads of a response below its apex, with the load, the base and a bar of greys.

    ``centres``: (beads, 2); ``shades``, (beads,), from 0 to ``most``; ``name`` is theirs.
    """
    shades = np.where(shades > -NOTHING * most, np.maximum(shades, 0), shades)
    reach = max(float(np.abs(centres[:, 0] - apex[0]).max(initial=0)), 0) + 2
    left, right = apex[0] - reach, apex[0] + reach
    return Panel(
        [
            Beads(centres, 1.0, shades, name, side, most),
            *point_load(*apex),
            base(left, right, -1.2),
        ],
        Axis(low=left, high=right),
        Axis(low=-2, high=apex[1] + 10),
        scaled=True,
        bare=True,
    )
