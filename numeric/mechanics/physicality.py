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
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product

import numpy as np

from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import AxisContact, Contact
from ..lattice.layers import Layer, Region, Rows
from . import local
from .local import RESOLUTION
from .sweep import SIGNS, Forces, SolvedPacking, pulling

PHYSICAL = "check that it is physical"
Steps = tuple[int, ...]
# A number that bounds, and was rounded a few times.
ROOM = 1 + 1e-9


@dataclass
class Physicality:
    """What was found, merged over realisations.

    ``smallest_gap`` is that of two beads that do not touch, or of a bead and its own image. In an
    answer's ``physical`` it is in the unit that radii are given in, here in units of r.
    """

    smallest_gap: float | None = None
    between: tuple[tuple[int, ...], tuple[int, ...]] | None = None
    overlaps: int = 0
    undecided_gaps: int = 0
    tensile: int = 0
    undecided_signs: int = 0
    contacts: int = 0
    forces_known: bool = False
    first_tensile: Contact | AxisContact | None = None
    smallest_in: int = 0
    first_tensile_in: int = 0
    """Realisations, or packings of a batch, that the two were found in."""
    looks_at: Sequence[int] = (0,)

    @property
    def sound(self) -> bool:
        """Whether no two beads overlap and no contact pulls, as far as was looked, and surely."""
        pulls = self.tensile or self.undecided_signs
        return not (self.overlaps or self.undecided_gaps or pulls)

    def look_at_gaps(self, packing: SolvedPacking) -> None:
        """Measure the gaps of all pairs of beads that could meet."""
        found = gaps(packing)
        self.overlaps += found.overlaps
        self.undecided_gaps += found.undecided
        if found.between is not None and not found.smallest >= self._smallest:
            lower, upper = found.between
            self.smallest_gap, self.smallest_in = found.smallest, self.looks_at[found.packing]
            self.between = named(packing, lower), named(packing, upper)

    @property
    def _smallest(self) -> float:
        return math.inf if self.smallest_gap is None else self.smallest_gap

    def look_at_forces(self, forces: Forces) -> None:
        """Count the contacts that surely pull and those whose sign stays open."""
        self.forces_known = True
        if forces.F is not None and forces.g is not None:
            self.contacts += forces.g.size
            pulling_rows = [] if forces.hold else self._count(forces.rows, forces.F, forces.g)
        else:
            pulling_rows = []
            for j in range(len(forces.rows)):
                for _, F, g in forces.below(j):
                    pulls, undecided = pulling(F + g, g, forces.system)
                    self.contacts += g.size
                    self.tensile += int(np.count_nonzero(pulls))
                    self.undecided_signs += int(np.count_nonzero(undecided))
                    if pulls.any():
                        pulling_rows.append(j)
        if pulling_rows and self.first_tensile is None:
            self._name(forces, pulling_rows[0])

    def _count(self, rows: Rows, F: Array, g: Array) -> Sequence[int]:
        """Count all contacts of compiled loops together; give the first row of which one pulls."""
        f, room = F + g, SIGNS * max(g.max(initial=0), -g.min(initial=0))
        ends = np.cumsum(rows.counts[::-1])
        ends = ends[: int(np.searchsorted(ends, F.shape[1])) + 1]
        cuts = F.shape[1] - ends[::-1]
        if np.count_nonzero(f <= room) > np.count_nonzero(f < -room):
            # some are so small that their layer decides
            counts, changes = np.diff(np.append(cuts, F.shape[1])), np.abs(g).max(axis=0, initial=0)
            room = SIGNS * np.maximum.reduceat(changes, cuts, axis=1).repeat(counts, axis=1)
            self.undecided_signs += int(np.count_nonzero((np.abs(f) <= room) & (f != 0)))
        pulls = f < -room
        self.tensile += int(np.count_nonzero(pulls))
        if not pulls.any():
            return []
        first = int(np.argmax(pulls.any(axis=(0, 1))))
        return [len(rows) - len(cuts) + int(np.searchsorted(cuts, first, "right")) - 1]

    def _name(self, forces: Forces, j: int) -> None:
        """Name the first contact below a row that pulls."""
        for branch, F, g in forces.below(j):
            pulls, _ = pulling(F + g, g, forces.system)
            if pulls.any():
                *batch, q = map(int, np.argwhere(pulls)[0])
                self.first_tensile_in = self.looks_at[batch[0] if batch else 0]
                self.first_tensile = forces.contact(forces.rows[j], branch, q)
                return


@dataclass
class Gaps:
    """The smallest gap, the number of its packing and its two beads; overlaps; what is too close.

    Beads are named as (row, column).
    """

    smallest: float = math.inf
    packing: int = 0
    between: tuple[tuple[int, int], tuple[int, int]] | None = None
    overlaps: int = 0
    undecided: int = 0

    @property
    def matters(self) -> float:
        """The size from which on gaps change nothing."""
        return max(self.smallest, RESOLUTION)


@lru_cache(maxsize=64)
def _least(dimension: int, phi: Fraction) -> Fraction:
    """Give the least eigenvalue of the Gram matrix."""
    return min(1 - phi, 1 + (dimension - 1) * phi)


@lru_cache(maxsize=64)
def square_of(phi: Fraction, steps: Steps) -> Fraction:
    """Give the square of a distance in the ordered packing, exactly."""
    return 4 * (sum(s * s for s in steps) * (1 - phi) + sum(steps) ** 2 * phi)


@lru_cache(maxsize=64)
def _shell(dimension: int, phi: Fraction, reach: int) -> tuple[tuple[float, Steps], ...]:
    """Give all lattice distances with steps up to ``reach`` that none beyond falls below."""
    found = []
    for steps in product(range(-reach, reach + 1), repeat=dimension):
        first = next((s for s in (sum(steps), *steps) if s), 0)
        contact = sum(steps) == 1 and sum(map(abs, steps)) == 1
        square = square_of(phi, steps)
        if first > 0 and not contact and square < 4 * _least(dimension, phi) * (reach + 1) ** 2:
            found.append((math.sqrt(square), steps))
    return tuple(sorted(found))


def by_distance(dimension: int, phi: Fraction) -> Iterator[tuple[float, Steps]]:
    """Give lattice distances of beads that are in no contact, each pair once, nearest first.

    >>> [steps for _, steps in zip(range(2), by_distance(2, Fraction(-1, 8)))]
    [(2.6457513110645907, (1, 1)), (3.0, (1, -1))]
    """
    reach, given = 3, 0
    while True:
        shell = _shell(dimension, phi, reach)
        yield from shell[given:]
        reach, given = 2 * reach, len(shell)


def gaps(packing: SolvedPacking) -> Gaps:
    """Measure gaps of packings of any arithmetic, in float64 from the deviations."""
    region, found = packing.region, Gaps()
    d, phi = region.dimension, packing.phi
    turn, moved, widest = _bounds(packing, phi)
    thick = 2 + 2 * widest
    # √d/(2√λ) steps are the most of a distance of 1, λ the least eigenvalue of the Gram matrix
    slack = 1 - turn * math.sqrt(d / float(_least(d, phi))) / 2
    compiled = None if packing.memory is None else _Compiled(packing)
    # no two beads of a part of the slab are farther apart; elsewhere each has images
    farthest = math.inf if region.width is not None else 4 * region.widest + 8 * region.top + 8
    for distance, steps in by_distance(d, phi):
        if distance > farthest:
            return found
        nearest = max(distance * slack, distance - moved) - thick
        if nearest > found.matters:
            return found
        if distance - min(sum(map(abs, steps)) * turn, moved) - thick > found.matters:
            continue
        if compiled is not None:
            compiled.measure(found, steps, phi)
            continue
        for j in range(region.top + 1 - sum(steps)):
            _measure(found, packing, steps, phi, j)
    return found


def _bounds(packing: SolvedPacking, phi: Fraction) -> tuple[float, float, float]:
    """Bound the change of a contact's vector, twice the displacement of a bead, and δr/r."""
    d = packing.region.dimension
    dn, c = [0.0] * d, [0.0] * d
    if packing.memory is not None:
        widest = float(np.maximum(packing.memory.rho.max(), 0))
        deepest = float(-np.minimum(packing.memory.rho.min(), 0))
        most = packing.memory.most.max(axis=0).tolist()
        c, dn = most[:d], [sum(most[a : a + d]) for a in range(d, d + d * d, d)]
    else:
        rho = [as_floats(row) for row in packing.rho]
        widest = max(float(row.max(initial=0)) for row in rho)
        deepest = max(float(-row.min(initial=0)) for row in rho)
        for a, ((_, rows), (_, turns)) in enumerate(zip(packing.c, packing.dn, strict=True)):
            c[a] = max(float(np.abs(as_floats(row)).max(initial=0)) for row in rows)
            sizes = [
                sum(float(np.abs(as_floats(x)).max(initial=0)) for x in turns[j])
                for j in range(1, len(turns))
            ]
            dn[a] = max(sizes, default=0.0)
    turn = 2 * max(widest, deepest) + (2 + 2 * widest) * max(dn)
    moved = 2 * math.sqrt(sum(x * x for x in c) / float(_least(d, phi)))
    return turn * ROOM, moved * ROOM, widest


def _measure(found: Gaps, packing: SolvedPacking, steps: Steps, phi: Fraction, j: int) -> None:
    """Take in the gaps of one row and one kind of pairs."""
    region, other = packing.region, j + sum(steps)
    own, over = region.rows[j], region.rows[other]

    def there(values: Array) -> Array:
        return region.moved(values, over, own, steps, np.float64(0))

    known = there(np.ones(over.count)) > 0
    if not own.count or not known.any():
        return
    u = tuple(there(as_floats(rows[other])) - as_floats(rows[j]) for _, rows in packing.c)
    both = there(as_floats(packing.rho[other])) + as_floats(packing.rho[j])
    square = square_of(phi, steps)
    m = local.metric(region.dimension, packing.phi, FLOAT64.scalar)
    with FLOAT64.active():
        gap = local.gap(steps, float(square), float(square - 4), u, both, m,
                        lambda v: np.sqrt(np.maximum(v, 0)))  # fmt: skip
    gap = gap[..., known]
    found.overlaps += int(np.count_nonzero(gap < -RESOLUTION))
    found.undecided += int(np.count_nonzero(~(np.abs(gap) > RESOLUTION)))
    least = np.nanmin(gap, initial=math.inf)
    if least < found.smallest:
        *batch, at = map(int, np.argwhere(gap == least)[0])
        column = int(np.flatnonzero(known)[at])
        columns = there(np.arange(over.count, dtype=np.float64))
        found.smallest, found.packing = float(least), batch[0] if batch else 0
        found.between = (j, column), (other, int(columns[column]))


@lru_cache(maxsize=64)
def _pairs(region: Region, steps: Steps) -> tuple[Array, Array]:
    """Give the runs of ``loops.gaps`` of one kind of pairs, and each layer's first one."""
    from .kernels import MOST
    from .runs import pairs_of

    runs = pairs_of(region, [steps], MOST)
    return runs, np.searchsorted(runs[:, 0], region.starts)


class _Compiled:
    """Measures the gaps of packings of compiled loops, the same numbers."""

    def __init__(self, packing: SolvedPacking) -> None:
        from . import kernels

        assert packing.memory is not None
        self.kernels, self.packing, region = kernels, packing, packing.region
        self.m = kernels.constants(region.dimension, packing.phi, carried=False)
        self.gaps = np.empty((1, kernels.MOST + 1))
        self.loop = kernels.kernels(region.dimension).gaps

    def measure(self, found: Gaps, steps: Steps, phi: Fraction) -> None:
        """Take in the gaps of one kind of pairs."""
        packing, region = self.packing, self.packing.region
        assert packing.memory is not None
        runs, first = _pairs(region, steps)
        of_layer = first[: max(region.top + 1 - sum(steps), 0) + 1]
        square = square_of(phi, steps)
        m = np.array([*self.m, *steps, float(square), float(square - 4)])
        counted = np.zeros(6, np.int64)
        smallest = self.loop(
            packing.memory.rho[:, None], packing.memory.block, runs, of_layer, m, found.smallest,
            counted, self.gaps, self.gaps.view(np.int64)[0],
        )  # fmt: skip
        found.overlaps += int(counted[3])
        found.undecided += int(counted[4] + counted[5])
        if smallest < found.smallest:
            found.smallest, found.packing = smallest, int(counted[0])
            lower, upper = (self._named(int(bead)) for bead in counted[1:3])
            found.between = lower, upper

    def _named(self, bead: int) -> tuple[int, int]:
        starts = self.packing.region.starts
        row = int(np.searchsorted(starts, bead, "right")) - 1
        return row, bead - int(starts[row])


def named(packing: SolvedPacking, bead: tuple[int, int]) -> tuple[int, ...]:
    """Name a bead of a row as users know it, within the period."""
    row, column = bead
    region = packing.region
    layer: Layer = region.rows[row]
    site = region.bead(layer, column)
    if region.dimension == 2 and region.width is not None:
        return site[0] % (2 * region.width), site[1]
    return site
