"""Is a solved packing physical? Gaps between beads that should not touch, and signs of forces.

Signs of forces are those of the arithmetic that solved them: with balls they are certified.

Gaps are those between all beads that could meet and are in no contact, images of a bead itself
included. Pairs are looked at by their distance on the lattice, nearest first. Along a chain of
Σ|s_a| contacts two beads move apart by Σ|s_a| P at most, P the largest change of a contact's
vector, and by twice the largest displacement: pairs that are too far apart to be the closest, or
to overlap, are left out, and no others.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import Any

import numpy as np

from ..arithmetic.carried import CARRYING
from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import directions
from ..lattice.layers import Block, Layer, Region
from . import local
from .local import RESOLUTION
from .loops import loops
from .sweep import Solved, metric_array, shift_of

Steps = tuple[int, ...]
# A number that bounds, and was rounded a few times.
ROOM = 1 + 1e-9


@dataclass
class Physicality:
    """What was found, merged over realisations.

    ``smallest_gap`` is that of two beads that do not touch, or of a bead and its own image. In an
    answer's ``physical`` it is in the unit that radii are given in, here in units of r.
    ``first_tensile`` has the numbers of a contact's lower bead and the branch, as rows name them.
    """

    smallest_gap: float | None = None
    between: tuple[tuple[int, ...], tuple[int, ...]] | None = None
    overlaps: int = 0
    undecided_gaps: int = 0
    tensile: int = 0
    undecided_signs: int = 0
    contacts: int = 0
    forces_known: bool = False
    first_tensile: dict[str, int | str] | None = None
    smallest_in: int = 0
    first_tensile_in: int = 0
    """Realisations, or packings of a batch, that the two were found in."""
    looks_at: Sequence[int] = (0,)

    @property
    def sound(self) -> bool:
        """Whether no two beads overlap and no contact pulls, as far as was looked, and surely."""
        pulls = self.tensile or self.undecided_signs
        return not (self.overlaps or self.undecided_gaps or pulls)

    def look_at(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Look at packings, which are these realisations."""
        self.looks_at = realisations
        if solved.block is not None:
            self.look_at_gaps(solved)
        if solved.g is not None:
            self.look_at_forces(solved)

    @property
    def _least_gap(self) -> float:
        return math.inf if self.smallest_gap is None else self.smallest_gap

    def look_at_gaps(self, packing: Solved) -> None:
        """Measure the gaps of all pairs of beads that could meet, in float64 from the deviations.

        Those of pairs that are too far apart to be the closest of all packings are left out.
        """
        region = packing.region
        d, phi = region.dimension, float(packing.phi)
        if packing.system.dtype is object:
            rho, block = as_floats(packing.rho), as_floats(packing.block)
            packing = replace(packing, system=FLOAT64, rho=rho, block=block)
        turn, moved, widest = _bounds(packing, phi)
        thick = 2 + 2 * widest
        # √d/(2√λ) steps are the most of a distance of 1, λ the least eigenvalue of the Gram matrix
        slack = 1 - turn * math.sqrt(d / _least(d, phi)) / 2
        # no two beads of a part of the slab are farther apart; elsewhere each has images
        farthest = math.inf if region.width is not None else 4 * region.widest + 8 * region.top + 8
        for distance, steps in by_distance(d, phi):
            matters = max(self._least_gap, RESOLUTION)
            nearest = max(distance * slack, distance - moved) - thick
            if distance > farthest or nearest > matters:
                return
            if distance - min(sum(map(abs, steps)) * turn, moved) - thick <= matters:
                self._look_at_pairs(packing, steps)

    def _look_at_pairs(self, packing: Solved, steps: Steps) -> None:
        """Measure the gaps of one kind of pairs."""
        gap = gaps_of(packing, steps)
        if not gap.min(initial=math.inf) > RESOLUTION:  # or it is NaN
            self.overlaps += int(np.count_nonzero(gap < -RESOLUTION))
            close = np.abs(gap) <= RESOLUTION
            self.undecided_gaps += int(np.count_nonzero(close | np.isnan(gap)))
        least = float(np.fmin.reduce(gap, axis=None, initial=math.inf))
        if least < self._least_gap:
            number, bead = divmod(int(np.argmax(gap == least)), gap.shape[1])
            region = packing.region
            j = int(np.searchsorted(region.starts, bead, "right")) - 1
            own = region.bead(region.rows[j], bead - int(region.starts[j]))
            self.smallest_gap, self.smallest_in = least, self.looks_at[number]
            naming, here = region.naming, (0,) * len(steps)
            self.between = naming.beyond(own, here), naming.beyond(own, steps)

    def look_at_forces(self, forces: Solved) -> None:
        """Count the contacts that surely pull and those whose sign stays open."""
        self.forces_known = True
        self.contacts += int(np.prod(forces.g.shape))
        pulls, undecided = pulling(forces)
        self.tensile += int(np.count_nonzero(pulls))
        self.undecided_signs += int(np.count_nonzero(undecided))
        if self.first_tensile is None and np.any(pulls):
            starts = forces.rows.starts_above
            first = int(np.argmax(pulls.any(axis=(0, 1))))
            j = int(np.searchsorted(starts, first, "right")) - 1
            row = pulls[:, :, starts[j] : starts[j + 1]]
            a = int(np.argmax(row.any(axis=(0, 2))))
            packing, q = map(int, np.argwhere(row[:, a])[0])
            upper = Layer(j, forces.rows[j].first + 2 * q, 1)
            contact = Block(directions(forces.region.dimension)[a], upper)
            names = forces.region.naming.contacts([contact])
            self.first_tensile_in = self.looks_at[packing]
            self.first_tensile = {name: column.tolist()[0] for name, column in names.items()}


# A float64 force has no sign within so much of its layer's largest change.
SIGNS = 2.0**-40


def pulling(forces: Solved) -> tuple[Any, Any]:
    """Tell contacts that surely pull and those whose sign is open, as ``Solved.g`` has them.

    Balls decide by their own radius. Hardware floats have none: there a force is taken as open
    within 2^-40 of the largest change of its layer and branch in all packings, far above their
    measured error below M*. Nothing is told of them, False, where plainly none pulls.
    """
    F, g, starts = forces.F, forces.g, forces.rows.starts_above
    if forces.system.dtype is object:
        pulls, holds = forces.system.signs(-(F + g))
        return pulls, ~(pulls | holds)
    most = max(g.max(initial=0), -g.min(initial=0))
    if F.min(initial=np.inf) - most > 2 * SIGNS * most:
        return False, False
    counts = np.diff(starts)
    changes = np.maximum.reduceat(np.abs(g).max(axis=0), starts[:-1][counts > 0], axis=1)
    f, room = F + g, SIGNS * changes.repeat(counts[counts > 0], axis=1)
    return f < -room, (np.abs(f) <= room) & (f != 0)


def _least(dimension: int, phi: float) -> float:
    """Give the least eigenvalue of the Gram matrix."""
    return min(1 - phi, 1 + (dimension - 1) * phi)


def square_of(phi: Fraction, steps: Steps) -> tuple[float, float]:
    """Give the square of a distance in the ordered packing, and that less 4, each rounded once."""
    top, bottom = phi.as_integer_ratio()
    own, both = sum(s * s for s in steps), sum(steps) ** 2
    square = 4 * (own * (bottom - top) + both * top)
    return square / bottom, (square - 4 * bottom) / bottom


@lru_cache(maxsize=8)
def _steps(dimension: int, reach: int) -> tuple[list[Steps], Array, Array]:
    """Give all steps up to ``reach`` to no contact, one of each two; Σ s² and (Σ s)² of them."""
    listed = []
    for steps in product(range(-reach, reach + 1), repeat=dimension):
        first = next((s for s in (sum(steps), *steps) if s), 0)
        if first > 0 and not (sum(steps) == 1 and sum(map(abs, steps)) == 1):
            listed.append(steps)
    table = np.array(listed, float)
    return listed, (table**2).sum(axis=1), table.sum(axis=1) ** 2


def by_distance(dimension: int, phi: float) -> Iterator[tuple[float, Steps]]:
    """Give lattice distances of beads that are in no contact, each pair once, nearest first.

    >>> [steps for _, steps in zip(range(2), by_distance(2, -1 / 8))]
    [(2.6457513110645907, (1, 1)), (3.0, (1, -1))]
    """
    reach, given = 3, 0
    while True:
        steps, squares, sums = _steps(dimension, reach)
        distances = 2 * np.sqrt(squares * (1 - phi) + sums * phi)
        # none beyond falls below
        near = distances < 2 * math.sqrt(_least(dimension, phi)) * (reach + 1) * (1 - 1e-9)
        order = np.lexsort((np.arange(len(steps)), distances))
        shell = [k for k in order.tolist() if near[k]]
        for k in shell[given:]:
            yield float(distances[k]), steps[k]
        reach, given = 2 * reach, len(shell)


def _bounds(packing: Solved, phi: float) -> tuple[float, float, float]:
    """Bound the change of a contact's vector, twice the displacement of a bead, and δr/r."""
    d, rho, block = packing.region.dimension, packing.rho, packing.block
    widest, deepest = max(float(rho.max()), 0.0), max(float(-rho.min()), 0.0)
    most = np.maximum(block.max(axis=(0, 2)), -block.min(axis=(0, 2))).tolist()
    dn = max(sum(most[a : a + d]) for a in range(d, d + d * d, d))
    turn = 2 * max(widest, deepest) + (2 + 2 * widest) * dn
    moved = 2 * math.sqrt(sum(x * x for x in most[:d]) / _least(d, phi))
    return turn * ROOM, moved * ROOM, widest


@lru_cache(maxsize=2)
def _pairs(region: Region, steps: Steps) -> Array:
    """Give the rows of ``loops.gaps``."""
    rows = region.rows
    return np.stack([region.starts[:-1], rows.counts, shift_of(rows, rows, steps)], axis=1)


def gaps_of(packing: Solved, steps: Steps) -> Array:
    """Give the gaps of beads and those so many steps on, (packings, beads); inf where none is."""
    region, rho, block, rise = packing.region, packing.rho, packing.block, sum(steps)
    d, (square, excess) = region.dimension, square_of(packing.phi, steps)
    gaps = np.full(rho.shape, math.inf)
    rows, starts = region.rows, region.starts
    if d == 2 and (made := loops()) is not None:
        table = _pairs(region, steps)
        m = metric_array(packing.phi, CARRYING)[:3]  # its numbers without their errors
        constants = np.array([*m, *steps, square, excess])
        sizes = len(rho), len(rows), rise, region.width or 0, region.beads, block.strides[1] // 8
        arrays = (array.ctypes.data for array in (rho, block, gaps, table, constants))
        made.gaps(*arrays, *sizes)
        return gaps
    layers, metric = tuple(rows), local.metric(d, packing.phi, FLOAT64.number)
    for j in range(max(region.top + 1 - rise, 0)):
        own = slice(starts[j], starts[j + 1])
        over = slice(starts[j + rise], starts[j + rise + 1])
        columns = region.columns(layers[j + rise], layers[j], steps)
        if columns.lacking is not None and columns.lacking.all():
            continue
        u = tuple(block[:, a, over][:, columns.at] - block[:, a, own] for a in range(d))
        both = rho[:, over][:, columns.at] + rho[:, own]
        with FLOAT64.active():
            gap = local.gap(steps, square, excess, u, both, metric)
        gaps[:, own] = gap if columns.lacking is None else np.where(columns.lacking, math.inf, gap)
    return gaps
