"""Does the answer of a periodic packing differ from the infinite slab's?

It does where a bead, or a load, is met twice on the way to one answer: as itself and as its image.
What an answer depends on is unwrapped, as it would lie in the slab, and looked at for two sites of
a layer that are the same modulo 2W. For exact forces it is enough to look at layer 0: two images
stand on images. There the triangle below a loaded bead (k, l) ends at k − l and k + l.
"""

import numpy as np

from ..lattice.branch import Contact
from . import first_order
from .loads import LoadSpec
from .problem import Problem, Route


def sees_images(problem: Problem) -> bool:
    """Say whether any row of the answer differs, with radii in general, from the slab's.

    Several loaded beads count as a whole layer as high as the highest: of these it is said, too,
    where their triangles are too far apart to meet.
    """
    width, load, contact = problem.width, problem.load, problem.contact
    if width is None or problem.route == Route.ORDERED:
        return False
    if problem.dimension > 2:
        return _of_spheres(problem)
    if not problem.needs_forces:
        tip = problem.height if problem.site is None else problem.site[1]
        return tip >= width
    highest = load.top
    if problem.route == Route.EXACT:
        if load.loaded is not None and len(load.loaded) == 1:
            return highest >= width
        layer = 1 if contact is None else contact.upper[1]
        return 2 * highest - layer + 1 > width
    if contact is not None:
        return _first_order(contact, load, width)
    return width <= highest  # the contact straight below the highest load is the first


def _of_spheres(problem: Problem) -> bool:
    """Say whether any row of the answer differs, with radii in general, from that of W → ∞.

    Above a bead of layer 1 its loads span M − 1 columns, and below these there are M more. To first
    order one contact depends on lines down from its own, M − 1 columns, and beside these.
    """
    width, loaded = problem.region.side, problem.load.loaded
    height = problem.region.top
    if not problem.needs_forces:
        return height >= width
    if loaded is not None and len(loaded) == 1:
        return width <= height
    if problem.route == Route.FIRST_ORDER:
        return width <= min(height + 1, 2 * height - 1)
    return width <= 2 * height - 1


def _first_order(contact: Contact, load: LoadSpec, width: int) -> bool:
    """Say whether loads stand on a contact twice, or its diagonals hold a bead and its image."""
    i, j = contact.upper
    for k, m in load.loaded or []:
        rise = m - j
        if rise >= 0 and (k - i + rise) % (2 * width) + 2 * width <= 2 * rise:
            return True  # the load stands on the contact twice
    sites = np.zeros(0, complex)  # i + √−1 j
    for line in first_order.lines_read(contact, load).values():
        i_of, j_of = line.rows.sites
        sites = np.union1d(sites, i_of + 1j * j_of)
    return len(np.unique(sites.real % (2 * width) + 1j * sites.imag)) < len(sites)
