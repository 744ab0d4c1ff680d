"""Gaps between beads that should not touch, in float64 from the deviations: (|d|² − D²)/(|d| + D).

D is the sum of the radii. The ordered part of the numerator is an exact rational, so that packings
within 1e-12 of touching are told apart.
"""

from fractions import Fraction

import numpy as np

from ..arithmetic.systems import Array

# Neighbours that don't touch in the ordered packing, to the right or above, nearest first.
NEIGHBOURS = ((2, 0), (0, 2), (3, 1), (-3, 1), (1, 3), (-1, 3))
# Beads this many layers above others are among them.
ABOVE = max(dj for _, dj in NEIGHBOURS)
# Gaps smaller than this, in units of r, are below the rounding of float64.
RESOLUTION = 1e-14


def of_lattice(n_x: Fraction, offset: tuple[int, int]) -> tuple[float, ...]:
    """Give what gaps of pairs at lattice distance ``offset`` have in common.

    The shares of the two components in the change of the square of the distance, that square (of
    the ordered packing, exact) as it is and less 4, 2 φ and 1 − φ².
    """
    di, dj = offset
    phi = 1 - 2 * n_x**2
    square = 4 * (di**2 * n_x**2 + dj**2 * (1 - n_x**2))
    return di + dj, dj - di, float(square), float(square - 4), 2 * float(phi), float(1 - phi**2)


def gaps(n_x: Fraction, offset: tuple[int, int], up: Array, um: Array, both: Array) -> Array:
    """Give the gaps of pairs at lattice distance ``offset``, in units of r."""
    along, across, square, least, twice_phi, det = of_lattice(n_x, offset)
    size = (up * up + um * um - twice_phi * up * um) / det
    change = 2 * (along * up + across * um) + size
    distance = np.sqrt(np.maximum(square + change, 0))
    excess = least + (change - 4 * both - both * both)
    return np.asarray(excess / (distance + 2 + both))
