"""All gaps of packings that were deposited compiled, bit for bit.

Those of ``gaps``, or of ``spheres.gaps``.
"""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from ..arithmetic.compiling import borrowed, compiled
from ..arithmetic.systems import FLOAT64, Array
from ..lattice import runs as tables
from .gaps import RESOLUTION, of_lattice
from .packing import CompiledPacking
from .spheres import CompiledPlaced, metric
from .spheres import of_lattice as of_axes

_ALL = 0x7FFF_FFFF_FFFF_FFFF  # all bits of a double but its sign


@compiled
def _gap(
    own: Array, c: tuple[Array, Array], run: Array, kind: Array, phi: tuple[float, float],
    found: Array,
) -> None:  # fmt: skip
    """Measure the gaps of a run of pairs."""
    a, b, n = run[0], run[1], run[2]
    c_plus, c_minus = c
    p_a, p_b, m_a, m_b = (
        c_plus[a : a + n],
        c_plus[b : b + n],
        c_minus[a : a + n],
        c_minus[b : b + n],
    )
    r_a, r_b, gaps = own[a : a + n], own[b : b + n], found[:n]
    along, across, square, excess = kind[0], kind[1], kind[2], kind[3]
    for q in range(n):
        up, um = p_b[q] - p_a[q], m_b[q] - m_a[q]
        both = r_a[q] + r_b[q]
        size = (up * up + um * um - phi[0] * up * um) / phi[1]
        change = 2 * (along * up + across * um) + size
        distance = np.sqrt(max(square + change, 0.0))
        gaps[q] = (excess + (change - 4 * both - both * both)) / (distance + 2 + both)


@compiled
def _gap_of_spheres(
    own: Array, block: Array, run: Array, kind: Array, phi: tuple[float, float], found: Array
) -> None:
    """Measure those of spheres, whose c are the first rows of ``block``."""
    a, b, n = run[0], run[1], run[2]
    c_x, c_y, c_z = block[0, a : a + n], block[1, a : a + n], block[2, a : a + n]
    to_x, to_y, to_z = block[0, b : b + n], block[1, b : b + n], block[2, b : b + n]
    r_a, r_b, gaps = own[a : a + n], own[b : b + n], found[:n]
    x, y, z, square, excess = kind[0], kind[1], kind[2], kind[3], kind[4]
    for q in range(n):
        ux, uy, uz = to_x[q] - c_x[q], to_y[q] - c_y[q], to_z[q] - c_z[q]
        both = r_b[q] + r_a[q]
        common = (ux + uy + uz) * phi[1]
        vx, vy, vz = ux * phi[0] + common, uy * phi[0] + common, uz * phi[0] + common
        change = 4 * (x * ux + y * uy + z * uz) + (vx * ux + vy * uy + vz * uz)
        distance = np.sqrt(max(square + change, 0.0))
        gaps[q] = (excess + (change - 4 * both - both * both)) / (distance + 2 + both)


@compiled
def _counted(found: Array, n: int) -> tuple[float, int, int]:
    """Give the smallest of ``n`` gaps, overlaps, and what is too close."""
    gaps, words = found[:n], found.view(np.int64)
    overlaps = undecided = no_number = 0
    for q in range(n):
        gap = gaps[q]
        overlaps += gap < -RESOLUTION
        undecided += abs(gap) <= RESOLUTION
        no_number += not gap <= np.inf
    least = np.int64(_ALL)
    for q in range(n):  # as whole numbers, which are compared together, doubles have their order
        least = min(least, words[q] ^ ((words[q] >> 63) & _ALL))
    words[n] = least ^ ((least >> 63) & _ALL)
    return found[n], overlaps, -1 if no_number else undecided


@compiled
def _gaps(
    rho: Array, block: Array, runs: Array, lattice: Array, phi: tuple[float, float], found: Array
) -> tuple[float, tuple[int, int, int], int, int]:
    """Measure all gaps: the smallest, its (run, place in it, packing), overlaps, what is too close.

    The last is −1 where a gap is no number. ``runs`` is the table ``runs.of_pairs``, ``lattice``
    has what kinds of pairs have in common (``gaps.of_lattice``), ``phi`` what all have;
    ``found`` is as long as the longest run and one more. Kinds of discs have four numbers, those of
    spheres five. Of equal gaps the first is named: layer
    and kind after layer and kind, in each packing after packing.
    """
    smallest, run, place, packing_of = np.inf, -1, 0, 0
    overlaps = undecided = first = 0
    rho, block, found = borrowed(rho), borrowed(block), borrowed(found)
    runs, lattice = borrowed(runs), borrowed(lattice)
    while first < len(runs):
        last = first
        while (
            last < len(runs) and runs[last, 3] == runs[first, 3] and runs[last, 4] == runs[first, 4]
        ):
            last += 1
        for k in range(len(rho)):
            for r in range(first, last):
                kind = lattice[runs[r, 3]]
                if kind.size == 4:
                    _gap(rho[k], (block[k, 0], block[k, 1]), runs[r], kind, phi, found)
                else:
                    _gap_of_spheres(rho[k], block[k], runs[r], kind, phi, found)
                least, over, close = _counted(found, runs[r, 2])
                if close < 0:
                    return smallest, (run, place, packing_of), overlaps, close
                overlaps += over
                undecided += close
                if least < smallest:
                    smallest, run, packing_of = least, r, k
                    place = 0
                    while found[place] != smallest:
                        place += 1
        first = last
    return smallest, (run, place, packing_of), overlaps, undecided


Found = tuple[float, tuple[int, int, int] | None, int, int]
"""The smallest gap, between which beads, overlaps, and gaps too close to tell.

Two beads by their number in the region, and the packing.
"""


def gaps(
    solved: CompiledPacking, layers: range, offsets: Sequence[tuple[int, int]]
) -> Found | None:
    """Give what there is of a packing of discs; None where a gap is no number."""
    runs = tables.of_pairs(solved.region, layers, offsets)
    kinds = [of_lattice(solved.n_x, offset) for offset in offsets]
    lattice = np.array([kind[:4] for kind in kinds])
    phi = kinds[0][4], kinds[0][5]
    return _found(solved.flat, solved.block, runs, lattice, phi)


def gaps_of_spheres(
    placed: CompiledPlaced, phi: Fraction, pairs: Sequence[tuple[int, ...]]
) -> Found | None:
    """Give what there is of a packing of spheres; None where a gap is no number."""
    runs = tables.of_steps(placed.rho[0].shape[-1], len(placed.rho), pairs)
    m = metric(3, phi, FLOAT64)
    lattice = np.array([of_axes(phi, steps) for steps in pairs])
    return _found(placed.flat, placed.block, runs, lattice, (float(m.own), float(m.cross)))


def _found(
    rho: Array, block: Array, runs: Array, lattice: Array, phi: tuple[float, float]
) -> Found | None:
    found = np.empty(int(runs[:, 2].max(initial=0)) + 1)
    smallest, (run, q, which), overlaps, undecided = _gaps(rho, block, runs, lattice, phi, found)
    if undecided < 0:
        return None
    beads = None if run < 0 else (int(runs[run, 0] + q), int(runs[run, 1] + q), which)
    return smallest, beads, overlaps, undecided
