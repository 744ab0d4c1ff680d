"""What is to be solved: beads, radii, loads, and by which theory."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from math import isqrt
from typing import Any

import numpy as np

from ..arithmetic.carried import NONE, Sizes
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import Radii
from ..lattice.branch import Contact, PerBranch, Site, per_direction
from ..lattice.layers import Layer, LazyRows, Region, Rows
from ..lattice.regions import reached
from .loads import LoadSpec
from .local import cosine
from .sweep import Forces, Memory, SolvedPacking


def axes(n_x: Fraction, system: NumberSystem) -> tuple[Any, Any]:
    """Give (n_x, n_y) with n_y = √(1 − n_x²)."""
    return system.scalar(n_x), system.root(1 - n_x**2)


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
    ``most_programs``, ``most_seconds`` of the processor: after which a packing is given up where
    contacts are unilateral. In three dimensions layers of W² beads count as one row.
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
    realisations: int = 1
    most_programs: int | None = None
    most_seconds: Fraction | None = None

    @property
    def dimension(self) -> int:
        """2 for discs, 3 for spheres."""
        return self.region.dimension

    @property
    def side(self) -> int:
        """W, in three dimensions."""
        return isqrt(self.width or 0)

    @property
    def phi(self) -> Fraction:
        """φ = n^a·n^b = 1 − s²/8r²."""
        return cosine(self.n_x)

    @property
    def width(self) -> int | None:
        """W beads a layer, or None for the infinite slab."""
        return self.load.width

    @property
    def height(self) -> int:
        """M."""
        return self.load.height

    @cached_property
    def reached(self) -> Sequence[Layer]:
        """The beads that loads reach: of each layer, runs of neighbours."""
        if self.load.loaded is None:
            return self.force_rows
        return reached(self.load.loaded, self.force_rows, self.region)


@dataclass(frozen=True)
class Solved:
    """Some realisations, solved; what the question does not need is None.

    ``single`` is the (force, change) of the one contact, or the (c⁺, c⁻) of the one bead, that
    line sums give alone. Where the sweep carried errors, all numbers are rounded only once, and
    ``sizes`` says how large errors were.
    """

    system: NumberSystem
    packing: SolvedPacking | None
    forces: Forces | None
    single: tuple[Any, Any] | None
    sizes: Sizes = NONE

    def one(self, number: int) -> "Solved":
        """Give the ``number``-th realisation of those that were solved together."""
        return self._at(number)

    def some(self, of: slice) -> "Solved":
        """Give some of those that were solved together; one alone has no axis of realisations."""
        return self.one(of.start) if of.stop == of.start + 1 else self._at(of)

    def _at(self, at: int | slice) -> "Solved":
        def of(rows: Sequence[Any]) -> LazyRows[Any]:
            def row(j: int) -> Any:
                if isinstance(rows[j], tuple):
                    return tuple(x[at] if x.size else x for x in rows[j])
                return rows[j][at] if rows[j].size else rows[j]

            return LazyRows(len(rows), row)

        def each(values: PerBranch[Any]) -> PerBranch[Any]:
            return per_direction([of(rows) for _, rows in values])

        part = at if isinstance(at, slice) else slice(at, at + 1)
        packing, forces = self.packing, self.forces
        if packing is not None:
            memory = packing.memory
            if memory is not None:
                rho, block, most = memory.rho[part], memory.block[part], memory.most[part]
                memory = Memory(rho, block, most)
            packing = replace(
                packing,
                rho=of(packing.rho),
                c=each(packing.c),
                dn=each(packing.dn),
                memory=memory,
            )
        if forces is not None:
            g = None if forces.g is None else forces.g[part]
            forces = replace(forces, change=each(forces.change), g=g)
        return Solved(self.system, packing, forces, self.single, self.sizes)


def rounded(solved: Solved) -> Solved:
    """Round numbers that carry their errors once."""

    def near(values: Any) -> Any:
        return tuple(map(near, values)) if isinstance(values, tuple) else values.nearest

    def rows(values: Sequence[Any]) -> LazyRows[Any]:
        return LazyRows(len(values), lambda j: near(values[j]))

    def each(values: PerBranch[Any]) -> PerBranch[Any]:
        return per_direction([rows(one) for _, one in values])

    packing, forces, single = solved.packing, solved.forces, solved.single
    if packing is not None:
        packing = replace(
            packing,
            system=FLOAT64,
            rho=rows(packing.rho),
            c=each(packing.c),
            dn=each(packing.dn),
        )
    if forces is not None:
        ordered, change = each(forces.ordered), each(forces.change)
        forces = replace(forces, system=FLOAT64, ordered=ordered, change=change)
    if single is not None:
        single = near(tuple(single))
    return Solved(FLOAT64, packing, forces, single, _sizes(solved))


def _sizes(solved: Any) -> Sizes:
    """Give the largest errors, of rows of numbers that carry theirs."""

    def most(rows: Iterable[Any]) -> float:
        return max((float(np.abs(row).max(initial=0)) for row in rows), default=0.0)

    packing, forces, single = solved.packing, solved.forces, solved.single
    found = Sizes()
    if packing is not None and packing.memory is None:
        moved, turned = ([row for _, rows in v for row in rows] for v in (packing.c, packing.dn))
        found |= Sizes(most(c.error for c in moved), most(x.error for dn in turned for x in dn))
    if forces is not None:
        below = [pair for j in range(len(forces.rows)) for pair in forces.below(j)]
        # as compiled sweeps give it
        force = most(F.value for _, F, _ in below) + most(g.nearest for _, _, g in below)
        found |= Sizes(changed=most(g.error for _, _, g in below), force=force)
    if single is not None:
        errors = [abs(float(one.error or 0)) for one in single]
        found |= Sizes(max(errors), 0.0, max(errors), max(abs(float(s.value)) for s in single))
    return found
