"""What several scale drawings have: loads, the base, the cone of a response. In units of r."""

from math import ceil, sqrt

import numpy as np

from ..arithmetic.systems import Array
from .specification import Arrow, Axis, Beads, Colour, Element, Line, Panel

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


def base_vectors(phi: float) -> Array:
    """Give n¹, n² and n³ of a packing of spheres, (vector, xyz); n¹ − n³ is along x."""
    up, out = sqrt((1 + 2 * phi) / 3), sqrt(2 * (1 - phi) / 3)
    turns = np.radians([-30, 90, 210])
    return np.stack([out * np.cos(turns), out * np.sin(turns), np.full(3, up)], axis=1)


def across_cone(phi: float, layers: int, colour: Colour, name: str = "") -> Line:
    """Draw the edge of the cone of a bead at the origin, so many layers below it."""
    corners = -2 * layers * base_vectors(phi)
    x, y, z = np.concatenate([corners, corners[:1]]).T
    return Line(x, y, colour, name=name, z=[z])


def point_load_in_space(phi: float, layers: int) -> list[Element]:
    """Draw the load of the bead at the origin, and the edge of its cone on the base."""
    arrow = Arrow((0, 0, 6), (0, 0, 1.5), r"$\mathbf{F}^{\rm load}$", width=1.0)
    loaded = Beads(np.zeros((1, 3)), edge="black", width=0.6)
    return [across_cone(phi, layers, "black"), loaded, arrow]


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
