"""What is to be solved: beads, radii, loads, and by which theory."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum
from fractions import Fraction
from functools import cached_property
from typing import Any

from ..arithmetic.systems import Array, NumberSystem
from ..disorder.radii import Radii
from ..lattice.branch import Contact, Site
from ..lattice.layers import Layer, Region, Rows
from ..lattice.regions import reached
from .first_order import beads_read
from .loads import LoadSpec
from .local import cosine, level, total, vertical_square


def axes(n_x: Fraction, system: NumberSystem, dimension: int = 2) -> tuple[Any, Any]:
    """Give n_x, and the vertical component of the base vectors: n_y, or n_z of three."""
    return system.number(n_x), system.root(vertical_square(dimension, n_x))


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
    def line_beads(self) -> int:
        """How many beads lie on the diagonals that decide a single answer to first order."""
        if self.contact is not None:
            return beads_read(self.contact, self.load)
        assert self.site is not None
        return 2 * self.site[1] + 1

    @cached_property
    def reached(self) -> Sequence[Layer]:
        """The beads that loads reach: of each layer, runs of neighbours."""
        if self.load.loaded is None:
            return self.force_rows
        return reached(self.load.loaded, self.force_rows, self.region)


def cartesian(
    components: Sequence[Array], problem: Problem, system: NumberSystem, *, raised: bool
) -> tuple[Array, ...]:
    """Give (x, y), or (x, y, z), of v = Σ v^a n^a; or of a vector with v_a = n^a·v.

    The last is up; x is along n^1 − n^d, the y of three dimensions along 2 n^2 − n^1 − n^3.
    """
    nx, up = axes(problem.n_x, system, problem.dimension)
    results = []
    for k, row in enumerate(level(len(components)), 1):
        parts = [v if h == 1 else h * v for h, v in zip(row, components, strict=True) if h]
        along = total(parts)
        across = along if k == 1 else along * system.root(Fraction(1, 3))
        results.append(across * nx if raised else across / (2 * nx))
    rise = total(components)
    return (*results, rise * up if raised else rise / (len(components) * up))


def ordered_places(
    beads: Iterable[Array], problem: Problem, system: NumberSystem
) -> tuple[Array, ...]:
    """Give the positions of beads, columns of names, in the ordered packing, in units of r."""
    *columns, j = beads
    steps = [2 * across for across in (*columns, j - sum(columns))]
    if len(columns) == 1:
        steps = [j + columns[0], j - columns[0]]
    return cartesian([_whole(step, system) for step in steps], problem, system, raised=True)


def _whole(numbers: Array, system: NumberSystem) -> Any:
    """Turn whole numbers into the number system: float64 holds none above 2^53."""
    if abs(numbers).max(initial=0) < 2**53:
        return system.from_floats(numbers.astype(float))
    return system.array(numbers.tolist())
