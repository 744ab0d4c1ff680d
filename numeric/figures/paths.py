"""Figure B1: a scheme of what the theorems beyond the paper are about.

(a) The radii that a contact force depends on to leading order, by the weights of Eq. 12. (b) The
cone below a point load, and a path that turns once. (c) The same in a packing of spheres.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from . import specification as spec
from .elements import base, base_vectors, point_load, point_load_in_space, surface_load
from .notation import at
from .packings import PHI, Options
from .specification import Line

HEIGHT, COLUMN, LAYER = 8, 0, 3
"""M, and the contact f⁺_ij of (a)."""
APEX, DOWN, ACROSS = 7, 3, 3
"""l of (b) and (c), and steps of a path down a leg and away from it."""
WIDE = 6
DASHES = (0, (4, 1.5))


def weight(i: int, j: int) -> int:
    """Give the weight of δr_ij in the contact's force, but for a factor of all (Eq. 12)."""
    aside = abs(i - j - (COLUMN - LAYER))
    return {0: -2, 2: 1}.get(aside, 0) * (HEIGHT - max(LAYER, j)) if j else 0


def line(
    places: Sequence[Array], colour: spec.Colour, width: float = 1.6, dashes: Any = "-"
) -> Line:
    """Draw a line through places in the plane or in space."""
    x, y, *z = np.array(places).T
    return Line(x, y, colour, dashes, width=width, z=z)


def name(place: Array, words: str, align: tuple[str, str], away: tuple[float, float]) -> spec.Words:
    """Name a place."""
    return spec.Words(float(place[0]), float(place[1]), words, 1, align, away, 9)


def contact() -> spec.Panel:
    """Draw beads as grey as their weights are large, and the contact."""
    sites = [
        (i, j) for j in range(HEIGHT + 1) for i in range(COLUMN - WIDE, COLUMN + WIDE + 1)
        if (i - j - COLUMN + LAYER) % 2 == 0
    ]  # fmt: skip
    weights = np.array([abs(weight(*site)) for site in sites])
    ends = at(COLUMN, LAYER), at(COLUMN + 1, LAYER + 1)
    left, right = at(COLUMN - WIDE - 1, 0)[0], at(COLUMN + WIDE + 1, 0)[0]
    middle = (ends[0] + ends[1]) / 2
    return spec.Panel(
        [
            spec.Beads(np.array([at(*site) for site in sites]), 1.0, weights / weights.max()),
            line(ends, 1, 2.5),
            name(middle, r"$f^+_{ij}$", ("right", "center"), (-16, 12)),
            *surface_load(np.array([at(i, j) for i, j in sites if j == HEIGHT])),
            base(left, right),
        ],
        spec.Axis(low=left, high=right),
        spec.Axis(low=-2, high=at(0, HEIGHT)[1] + 6),
        scaled=True,
        bare=True,
    )


def cone() -> spec.Panel:
    """Draw the legs, the beads inside, and a path that turns from the right leg."""
    sites = [
        (i, j) for j in range(APEX) for i in range(j - APEX, APEX - j + 1, 2)
    ]  # fmt: skip
    apex, corners = at(0, APEX), (at(-APEX, 0), at(APEX, 0))
    turn = at(DOWN, APEX - DOWN)
    end = at(DOWN - ACROSS, APEX - DOWN - ACROSS)
    left, right = corners[0][0] - 2, corners[1][0] + 2
    return spec.Panel(
        [
            spec.Beads(np.array([at(*site) for site in sites])),
            *(line([apex, corner], 0) for corner in corners),
            line([apex, turn, end], 1, dashes=DASHES),
            name((apex + turn) / 2, "$p$", ("left", "bottom"), (3, 1)),
            name((turn + end) / 2, "$q$", ("left", "top"), (2, -2)),
            *point_load(*apex),
            base(left, right),
        ],
        spec.Axis(low=left, high=right),
        spec.Axis(low=-2, high=apex[1] + 8),
        scaled=True,
        bare=True,
    )


def spheres() -> spec.Panel:
    """Draw the three legs, the lines of two faces, and a path that turns into a face."""
    first, second, third = -2 * base_vectors(float(PHI))
    lines = [
        (down * leg, down * leg + (APEX - down) * along)
        for one in (first, third) for leg, along in ((one, second), (second, one))
        for down in range(1, APEX)
    ]  # fmt: skip
    legs = [(0 * leg, APEX * leg) for leg in (first, second, third)]
    path = (0 * first, DOWN * first, DOWN * first + ACROSS * second)

    return spec.Panel(
        [
            *(line(places, "0.8", 0.5) for places in lines),
            *point_load_in_space(float(PHI), APEX),
            *(line(places, 0) for places in legs),
            line(path, 1, dashes=DASHES),
            Line(name="legs", colour=0, width=1.6),
            Line(name="path that turns once", colour=1, dashes=DASHES, width=1.6),
        ],
        legend="below",
        columns=2,
        scaled=True,
        bare=True,
        spatial=True,
    )


def figure(o: Options) -> spec.Figure:
    """Put the three side by side."""
    o.notice("figure B1")
    rows = [
        (i, j, weight(i, j))
        for j in range(HEIGHT + 1) for i in range(COLUMN - WIDE, COLUMN + WIDE + 1)
        if weight(i, j)
    ]  # fmt: skip
    return spec.Figure(
        spec.Picture([contact(), cone(), spheres()], 2.1, page=True, columns=[1, 1, 1.35]),
        tables={"figureB1": spec.table("i j weight", rows)},
        facts={"height": HEIGHT, "layer": LAYER, "apex": APEX, "phi": float(PHI)},
        words=[f"The contact in layer {LAYER} of {HEIGHT} depends on {len(rows)} radii (Eq. 12)"],
    )
