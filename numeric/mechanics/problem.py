"""What is to be solved: beads, radii, loads, and by which theory."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from math import isqrt
from typing import Any

from ..arithmetic.carried import NONE, Sizes
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import Radii
from ..lattice.branch import Contact, Site
from ..lattice.layers import Layer, Region, Rows
from ..lattice.regions import reached
from . import sweep
from .loads import LoadSpec
from .local import cosine
from .sweep import Forces, SolvedPacking


def axes(n_x: Fraction, system: NumberSystem) -> tuple[Any, Any]:
    """Give (n_x, n_y) with n_y = √(1 − n_x²)."""
    return system.number(n_x), system.root(1 - n_x**2)


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
        at = slice(number, number + 1)
        packing, forces = self.packing, self.forces
        if packing is not None:
            packing = replace(packing, rho=packing.rho[at], block=packing.block[at])
        if forces is not None:
            forces = replace(forces, g=forces.g[at])
        return replace(self, packing=packing, forces=forces)


def rounded(solved: Solved) -> Solved:
    """Round numbers that carry their errors once, and say how large errors were."""
    if solved.packing is not None:
        packing, forces, sizes = sweep.rounded(solved.packing, solved.forces)
        return Solved(FLOAT64, packing, forces, None, sizes)
    assert solved.single is not None
    errors = [abs(float(one.error)) for one in solved.single]
    force = max(abs(float(one.value)) for one in solved.single)
    single = solved.single[0].nearest, solved.single[1].nearest
    return Solved(FLOAT64, None, None, single, Sizes(max(errors), 0.0, max(errors), force))
