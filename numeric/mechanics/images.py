"""Does the answer of a periodic packing differ from the infinite slab's?

It does where a bead, or a load, is met twice on the way to one answer: as itself and as its image.
What an answer depends on is unwrapped, as it would lie in the slab, and looked at for two sites of
a layer that are the same modulo 2W. For exact forces it is enough to look at layer 0: two images
stand on images. There the triangle below a loaded bead (k, l) ends at k − l and k + l.
"""

from collections.abc import Iterable
from itertools import combinations, pairwise

from ..lattice.branch import Contact, Site
from ..lattice.layers import full_layer
from . import first_order
from .loads import LoadSpec
from .problem import Problem, Route


def sees_images(problem: Problem) -> bool:
    """Say whether any row of the answer differs, with radii in general, from the slab's."""
    width, load, contact = problem.width, problem.load, problem.contact
    if width is None or problem.route == Route.ORDERED:
        return False
    if problem.dimension > 2:
        return _of_spheres(problem)
    if not problem.needs_forces:
        tip = problem.height if problem.site is None else problem.site[1]
        return tip >= width
    if problem.route == Route.EXACT:
        if contact is not None:
            return _exact([contact.upper], load, width, contact.upper[1])
        sites = full_layer(1, width).sites()  # W of them, more than a memory holds
        return _exact(((i, 1) for i in sites), load, width, 1)
    if contact is not None:
        return _first_order(contact, load, width)
    return width <= _highest(load)  # the contact straight below the highest load is the first


def _of_spheres(problem: Problem) -> bool:
    """Say whether any row of the answer differs, with radii in general, from that of W → ∞.

    Above a bead of layer 1 its loads span M − 1 columns, and below these there are M more. To first
    order one contact depends on lines down from its own, M − 1 columns, and beside these.
    """
    width, loaded = problem.side, problem.load.loaded
    height = problem.region.top
    if not problem.needs_forces:
        return height >= width
    if loaded is not None and len(loaded) == 1:
        return width <= height
    if problem.route == Route.FIRST_ORDER:
        return width <= min(height + 1, 2 * height - 1)
    return width <= 2 * height - 1


def _highest(load: LoadSpec) -> int:
    return load.height if load.loaded is None else max((j for _, j in load.loaded), default=0)


def _above(apex: Site, load: LoadSpec, width: int) -> list[Site] | None:
    """Give the loads in the upward cone of a bead, unwrapped; None if one is there twice."""
    i, j = apex
    found = []
    for k, m in load.loaded or []:
        if m < max(j, 1):
            continue
        first = i - (m - j) + (k - i + m - j) % (2 * width)
        if first + 2 * width <= i + (m - j):
            return None
        if first <= i + (m - j):
            found.append((first, m))
    return found


def _exact(apexes: Iterable[Site], load: LoadSpec, width: int, layer: int) -> bool:
    """Look at the triangles below all loads that stand on one of the ``apexes`` of a ``layer``."""
    widest = 2 * _highest(load) - layer + 1
    if load.loaded is None or widest <= width:
        return widest > width
    for apex in apexes:
        above = _above(apex, load, width)
        if above is None or _overlap(
            _joined([((k - m) // 2, (k + m) // 2) for k, m in above]), width
        ):
            return True
    return False


def _joined(runs: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Join runs of columns that overlap.

    >>> _joined([(4, 6), (0, 2), (2, 3)])
    [(0, 3), (4, 6)]
    """
    joined: list[tuple[int, int]] = []
    for first, last in sorted(runs):
        if joined and first <= joined[-1][1]:
            joined[-1] = (joined[-1][0], max(last, joined[-1][1]))
        else:
            joined.append((first, last))
    return joined


def _overlap(runs: list[tuple[int, int]], width: int) -> bool:
    """Say whether runs of different columns overlap modulo W.

    >>> _overlap([(0, 3), (4, 6)], 7), _overlap([(0, 3), (4, 6)], 6), _overlap([(-1, 1)], 2)
    (False, True, True)
    """
    home = sorted((first % width, first % width + last - first) for first, last in runs)
    if not home:
        return False
    around = (home[0][0] + width, 0)
    return any(left[1] >= right[0] for left, right in pairwise([*home, around]))


def _first_order(contact: Contact, load: LoadSpec, width: int) -> bool:
    """Look at the diagonals that decide a contact, and at the loads above it."""
    if _above(contact.upper, load, width) is None:
        return True
    lines = first_order.lines_read(contact, load).values()
    return any(_coincide(a, b, 2 * width) for a, b in combinations(lines, 2))


def _coincide(a: first_order.Line, b: first_order.Line, period: int) -> bool:
    """Say whether two diagonals hold different sites of a layer that are images of each other."""
    start, end = (a.at(m) - b.at(m) for m in (0, min(a.top, b.top)))
    # The distance changes by 2 from layer to layer, or not at all: no multiple is jumped over.
    least, most = min(start, end), max(start, end)
    return any(
        high >= period and high // period * period >= low
        for low, high in ((least, most), (-most, -least))
    )
