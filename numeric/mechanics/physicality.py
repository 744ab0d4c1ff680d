"""Is a solved packing physical? Gaps between beads that should not touch, and signs of forces.

Signs of forces are those of the arithmetic that solved them: with balls they are certified.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..arithmetic.systems import Array
from ..lattice.branch import AxisContact, Contact
from ..lattice.layers import Rows
from .gaps import gaps, named
from .sweep import SIGNS, Forces, SolvedPacking, pulling

PHYSICAL = "check that it is physical"


@dataclass
class Physicality:
    """What was found, merged over layers and realisations.

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

    def above(self, other: "Physicality") -> None:
        """Merge with what was found in layers further up."""
        if other.between is not None and (self.between is None or other._rank() < self._rank()):
            self.smallest_gap, self.between = other.smallest_gap, other.between
        self.overlaps += other.overlaps
        self.undecided_gaps += other.undecided_gaps
        self.tensile += other.tensile
        self.undecided_signs += other.undecided_signs
        self.contacts += other.contacts
        self.forces_known |= other.forces_known
        self.first_tensile = self.first_tensile or other.first_tensile

    def _rank(self) -> tuple[float, int, int]:
        """Give what decides which gap is named: of equal ones that of the nearest layers."""
        assert self.smallest_gap is not None
        assert self.between is not None
        lower, upper = self.between
        return self.smallest_gap, upper[-1] - lower[-1], lower[-1]

    def look_at_gaps(
        self, packing: SolvedPacking, layers: range | None = None, *, more: bool = False
    ) -> None:
        """Measure the gaps of all pairs of beads that could meet within the region.

        Of the lower bead's ``layers`` only, if some are given; ``more``: rows above are not there.
        """
        layers = range(packing.region.top + 1) if layers is None else layers
        found = gaps(packing, layers, more=more)
        self.overlaps += found.overlaps
        self.undecided_gaps += found.undecided + found.unseen
        if found.between is not None and not found.smallest >= self._smallest:
            lower, upper = found.between
            self.smallest_gap, self.smallest_in = found.smallest, self.looks_at[found.packing]
            self.between = named(packing, lower), named(packing, upper)

    @property
    def _smallest(self) -> float:
        return math.inf if self.smallest_gap is None else self.smallest_gap

    def look_at_forces(self, forces: Forces, layers: range | None = None) -> None:
        """Count the contacts that surely pull and those whose sign stays open.

        Of the upper bead's ``layers`` only, if some are given.
        """
        self.forces_known = True
        if layers is not None and forces.hold:
            rows = forces.rows[max(layers.start, 1) : layers.stop]
            self.contacts += forces.region.dimension * rows.beads
            return
        if layers is None and forces.F is not None and forces.g is not None:
            self.contacts += forces.g.size
            pulling_rows = [] if forces.hold else self._count(forces.rows, forces.F, forces.g)
        else:
            every = range(len(forces.rows))
            pulling_rows = []
            for j in every if layers is None else every[layers.start : layers.stop]:
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
