"""Is a solved packing physical? Gaps between beads that should not touch, and signs of forces.

Signs of forces are those of the arithmetic that solved them: with balls they are certified.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cache, reduce

import numpy as np

from ..arithmetic.systems import Array, as_floats
from ..lattice.branch import AxisContact, Contact, Site
from .forces import Forces, pulling
from .gaps import NEIGHBOURS, RESOLUTION, gaps
from .packing import CompiledPacking, SolvedPacking
from .pairs import Extent, Steps, extent, further, may_meet

PHYSICAL = "check that it is physical"
_NEAR = frozenset(((di + dj) // 2, (dj - di) // 2) for di, dj in NEIGHBOURS)


@dataclass
class Physicality:
    """What was found, merged over layers and realisations."""

    smallest_gap: float | None = None
    """Between beads that do not touch, in units of r (in ``data()``: the scene's unit)."""
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
    extent: Extent | None = field(default=None, compare=False)
    """Of the beads of the last packing whose gaps were measured, that of layers above included."""

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
        self,
        packing: SolvedPacking,
        layers: range | None = None,
        above: "Physicality | None" = None,
    ) -> None:
        """Measure the gaps of every pair of near neighbours, and of all others that may overlap.

        Of the lower bead's ``layers`` only, if some are given. ``above``: what was found of layers
        above the packing's, if there are any; pairs with those that may overlap stay undecided.
        """
        top = packing.region.top
        layers = range(top + 1) if layers is None else layers

        @cache
        def rows(j: int) -> tuple[Array, Array, Array]:
            of = packing.c.plus[j], packing.c.minus[j], packing.rho[j]
            return as_floats(of[0]), as_floats(of[1]), as_floats(of[2])

        def bounds(j: int) -> Extent:
            return extent(rows(j)[:2], rows(j)[2])

        if isinstance(packing, CompiledPacking):
            block = packing.block[..., : packing.region.beads]
            here = extent((block[:, 0], block[:, 1]), packing.flat)
        else:
            here = reduce(Extent.joined, map(bounds, range(layers.start, top + 1)))
        self._look(packing, layers, NEIGHBOURS, rows)
        phi = float(1 - 2 * packing.n_x**2)
        others = self.further(phi, _NEAR, here, bounds, layers, top)
        if others:
            self._look(packing, layers, [(p - q, p + q) for p, q in others], rows)
        self.extent = here
        if above is not None and above.extent is not None:
            own = reduce(Extent.joined, map(bounds, layers))
            self.extent = here.joined(above.extent)
            self.undecided_gaps += may_meet(phi, own, above.extent, top + 1 - layers[-1])

    def further(
        self,
        phi: float,
        known: frozenset[Steps],
        all_beads: Extent,
        bounds: Callable[[int], Extent],
        layers: range,
        top: int,
    ) -> list[Steps]:
        """Give what else may overlap, or be nearer than what was found (see ``pairs``)."""
        try:
            return further(phi, known, self.smallest_gap, all_beads, bounds, layers, top)
        except OverflowError:
            self.undecided_gaps += 1
            return []

    def _look(
        self,
        packing: SolvedPacking,
        layers: range,
        offsets: Sequence[tuple[int, int]],
        rows: Callable[[int], tuple[Array, Array, Array]],
    ) -> None:
        """Measure the gaps of pairs at some lattice distances."""
        if isinstance(packing, CompiledPacking):
            from . import compiled_gaps

            region, width = packing.region, packing.region.width
            period = None if width is None else 2 * width

            def named(bead: int) -> Site:
                i, j = region.site(bead)
                return _home(i, period), j

            if self.took(compiled_gaps.gaps(packing, layers, offsets), named):
                return
        for dj in sorted({dj for _, dj in offsets}):
            for j in range(layers.start, min(layers.stop, packing.region.top + 1 - dj)):
                for di, dj_of in offsets:
                    if dj_of == dj:
                        self._pairs(packing, (rows(j), rows(j + dj)), j, (di, dj))

    def took(
        self,
        found: tuple[float, tuple[int, int, int] | None, int, int] | None,
        named: Callable[[int], tuple[int, ...]],
    ) -> bool:
        """Take in what ``compiled_gaps`` found; ``named`` names a bead. Say whether it could."""
        if found is None:
            return False
        smallest, beads, overlaps, undecided = found
        self.overlaps += overlaps
        self.undecided_gaps += undecided
        if beads is not None and (self.smallest_gap is None or not smallest >= self.smallest_gap):
            self.smallest_gap, self.smallest_in = smallest, self.looks_at[beads[2]]
            self.between = named(beads[0]), named(beads[1])
        return True

    def _pairs(
        self,
        packing: SolvedPacking,
        values: tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]],
        j: int,
        offset: tuple[int, int],
    ) -> None:
        di, dj = offset
        width = packing.region.width
        here, there = packing.region.rows[j], packing.region.rows[j + dj]
        index = np.arange(here.count) + (here.first + di - there.first) // 2
        if width is not None:
            index %= width
        inside = (index >= 0) & (index < there.count)
        if not inside.any():
            return
        (c_plus, c_minus, rho), upper = values
        other = index[inside]
        up = upper[0][..., other] - c_plus[..., inside]
        um = upper[1][..., other] - c_minus[..., inside]
        both = rho[..., inside] + upper[2][..., other]
        period = 2 * width if width is not None else None

        def pair(bead: int) -> tuple[Site, Site]:
            i = here.first + 2 * int(np.flatnonzero(inside)[bead])
            return (_home(i, period), here.j), (_home(i + di, period), there.j)

        self.count_gaps(gaps(packing.n_x, offset, up, um, both), pair)

    def count_gaps(
        self, gap: Array, pair: Callable[[int], tuple[tuple[int, ...], tuple[int, ...]]]
    ) -> None:
        """Take in gaps, shape (…, beads); ``pair`` names the two beads of one."""
        self.overlaps += int(np.count_nonzero(gap < -RESOLUTION))
        self.undecided_gaps += int(np.count_nonzero(np.abs(gap) <= RESOLUTION))
        smallest = float(gap.min())
        if self.smallest_gap is None or not smallest >= self.smallest_gap:
            *batch, at = np.argwhere(gap == gap.min())[0]
            self.smallest_in = self.looks_at[int(batch[0]) if batch else 0]
            self.smallest_gap, self.between = smallest, pair(int(at))

    def look_at_forces(self, forces: Forces, layers: range | None = None) -> None:
        """Count the contacts that surely pull and those whose sign stays open.

        Of the upper bead's ``layers`` only, if some are given.
        """
        self.forces_known = True
        top = len(forces.rows) - 1
        layers = range(top + 1) if layers is None else layers
        for j in range(layers.start, min(layers.stop, top + 1)):
            layer = forces.rows[j]
            for branch, F, g in forces.below(j):
                if not len(F):
                    continue
                f = F + g
                pulls, undecided = pulling(f, g, forces.system)
                self.contacts += f.size
                self.tensile += int(np.count_nonzero(pulls))
                self.undecided_signs += int(np.count_nonzero(undecided))
                if pulls.any() and self.first_tensile is None:
                    *batch, q = map(int, np.argwhere(pulls)[0])
                    self.first_tensile_in = self.looks_at[batch[0] if batch else 0]
                    self.first_tensile = forces.contact(layer, branch, q)


def _home(i: int, period: int | None) -> int:
    return i if period is None else i % period
