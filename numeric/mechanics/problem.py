"""What is to be solved: beads, radii, loads, and by which theory."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from typing import Any

from ..arithmetic.systems import Array, NumberSystem
from ..disorder.radii import Radii
from ..lattice.branch import Contact, PerBranch, Site
from ..lattice.layers import LazyRows, Region
from ..lattice.regions import Rows
from .forces import Forces
from .loads import LoadSpec
from .packing import CompiledPacking, SolvedPacking


class Route(StrEnum):
    """Which theory, and how it is evaluated."""

    ORDERED = "ordered"  # closed forms of the ordered packing
    LINE_SUMS = "line sums"  # first order, one contact or bead, along a few diagonals
    FIRST_ORDER = "first-order"  # first order, layer by layer
    EXACT = "exact"  # nonlinear, layer by layer
    UNILATERAL = "unilateral"  # nonlinear, contacts may open and close


@dataclass(frozen=True)
class Problem:
    """Packings to be solved, all alike but for their radii.

    ``region``: the beads that are deposited. ``force_rows``: those whose forces are balanced, empty
    where only positions are asked for. ``contact`` or ``site``: the one that is asked for, if it is
    one. ``realisations``: how many there are in all; it decides who sweeps, never a number.
    ``protocol``: how beads come to rest where contacts are unilateral, and when that is given up:
    after ``most_events``, or ``most_seconds`` of the processor. ``segment``: how many layers are in
    memory at a time, 0 for all of them. ``dimension``: 3 for ``three_dimensions``, whose layers of
    W² beads count as one row.
    """

    n_x: Fraction
    radii: Radii
    load: LoadSpec
    route: Route
    region: Region
    force_rows: Rows
    needs_forces: bool
    contact: Contact | None = None
    site: Site | None = None
    stop_at_tension: bool = False
    realisations: int = 1
    protocol: str = ""
    most_events: int | None = None
    most_seconds: Fraction | None = None
    segment: int = 0
    dimension: int = 2

    @property
    def width(self) -> int | None:
        """W beads a layer, or None for the infinite slab."""
        return self.load.width

    @property
    def height(self) -> int:
        """M."""
        return self.load.height


@dataclass(frozen=True)
class Solved:
    """Some realisations, solved; what the question does not need is None.

    ``single`` is the (force, change) of the one contact, or the (c⁺, c⁻) of the one bead, that
    line sums give alone.
    """

    system: NumberSystem
    packing: SolvedPacking | None
    forces: Forces | None
    single: tuple[Any, Any] | None

    def one(self, number: int) -> "Solved":
        """Give the ``number``-th realisation of those that were solved together."""
        return self._at(number)

    def some(self, of: slice) -> "Solved":
        """Give some of those that were solved together; one alone has no axis of realisations."""
        return self.one(of.start) if of.stop == of.start + 1 else self._at(of)

    def _at(self, at: int | slice) -> "Solved":
        def of(rows: Sequence[Array]) -> LazyRows[Array]:
            return LazyRows(len(rows), lambda j: rows[j][at] if rows[j].size else rows[j])

        def turns(rows: Sequence[tuple[Array, Array]]) -> LazyRows[tuple[Array, Array]]:
            def row(j: int) -> tuple[Array, Array]:
                a, b = rows[j]
                return (a[at], b[at]) if a.size else (a, b)

            return LazyRows(len(rows), row)

        packing, forces = self.packing, self.forces
        if packing is not None:
            c, dn = packing.c, packing.dn
            packing = replace(
                packing,
                rho=of(packing.rho),
                c=PerBranch(of(c.plus), of(c.minus)),
                dn=PerBranch(turns(dn.plus), turns(dn.minus)),
            )
        if isinstance(packing, CompiledPacking):
            part = at if isinstance(at, slice) else slice(at, at + 1)
            packing = replace(packing, flat=packing.flat[part], block=packing.block[part])
        if forces is not None:
            change = forces.change
            forces = Forces(
                forces.system,
                forces.rows,
                forces.ordered,
                PerBranch(of(change.plus), of(change.minus)),
                forces.stopped,
            )
        return Solved(self.system, packing, forces, self.single)
