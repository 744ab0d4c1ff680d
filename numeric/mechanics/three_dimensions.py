"""Problems in three dimensions: solved by ``spheres``, and told in the words of all problems.

Bead (p, q, j) is p e_1 + q e_2 + (j − p − q) e_3, and 0 ≤ p, q < W. Problems count the W² beads of
a layer as one row, column p W + q, so that radii, plans, memory and statistics need no dimension.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import reduce
from math import isqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arithmetic.systems import Array, NumberSystem, as_floats, zeros
from ..disorder.radii import Monodisperse, RadiusError, rows_of
from ..lattice.branch import Axis, AxisContact, Direction, PerAxis
from ..lattice.layers import Bead, Layer, LazyRows, bead_of, bead_of_number
from .forces import Forces
from .loads import LoadSpec
from .pairs import Extent, extent
from .physicality import Physicality
from .problem import Problem, Route, Solved
from .spheres import (
    Borne,
    CompiledPlaced,
    Placed,
    along,
    bear,
    deposit,
    gaps,
    metric,
    near_pairs,
)
from .work import Work

if TYPE_CHECKING:
    from .compiled_spheres import SphereSweeps


def cosine(problem: Problem) -> Fraction:
    """Give φ = n^a·n^b = 1 − s²/8r², as in two dimensions."""
    return 1 - 2 * problem.n_x**2


def side(problem: Problem) -> int:
    """Give W."""
    return isqrt(problem.width or 0)


def lower_bead(upper: Bead, axis: Direction, width: int) -> Bead:
    """Give the bead below a contact."""
    p, q, j = upper
    return (p - (axis == Axis.FIRST)) % width, (q - (axis == Axis.SECOND)) % width, j - 1


def lower_beads(upper: dict[str, Array], axes: Array, width: int) -> dict[str, Array]:
    """Do so for columns p, q and j of beads, and the names of axes."""
    first, second = axes == Axis.FIRST.value, axes == Axis.SECOND.value
    return {
        "p": (upper["p"] - first) % width,
        "q": (upper["q"] - second) % width,
        "j": upper["j"] - 1,
    }


@dataclass(frozen=True)
class AxisForces(Forces):
    """Contact forces along three axes: rows of W² beads, indexed by the upper bead."""

    def contact(self, layer: Layer, branch: Direction, column: int) -> AxisContact:
        """Name the contact below a bead of a row."""
        width = isqrt(layer.count)
        lower = lower_bead((*divmod(column, width), layer.j), branch, width)
        return AxisContact(*lower, Axis(branch))


@dataclass(frozen=True, kw_only=True)
class Spheres(Solved):
    """A solved problem in three dimensions; ``placed`` holds its beads."""

    placed: Placed
    phi: Fraction

    def look_at_gaps(self, physical: Physicality) -> None:
        """Measure the gaps of near pairs, and of all others that may overlap, from the base up."""
        placed, near, top = self.placed, near_pairs(3), len(self.placed.rho) - 1

        def bounds(j: int) -> Extent:
            return extent([as_floats(c) for c in placed.c[j]], as_floats(placed.rho[j]))

        if isinstance(placed, CompiledPlaced):
            block = placed.block[..., : placed.flat.shape[-1]]
            here = extent([block[:, a] for a in range(3)], placed.flat)
        else:
            here = reduce(Extent.joined, map(bounds, range(top + 1)))
        self._look(physical, near)
        phi, layers = float(self.phi), range(top + 1)
        others = physical.further(phi, frozenset(near), here, bounds, layers, top)
        if others:
            self._look(physical, others)

    def _look(self, physical: Physicality, pairs: Sequence[tuple[int, ...]]) -> None:
        """Measure the gaps of pairs so many steps apart."""
        placed = self.placed
        if isinstance(placed, CompiledPlaced):
            from . import compiled_gaps

            W = placed.rho[0].shape[-1]
            all_gaps = compiled_gaps.gaps_of_spheres(placed, self.phi, pairs)
            if physical.took(all_gaps, lambda bead: bead_of_number(bead, W)):
                return
        for j, row in enumerate(self.placed.rho):
            width = row.shape[-1]
            for steps in pairs:
                found = gaps(self.placed, self.phi, j, steps)
                if found is None:
                    continue

                def pair(
                    column: int, steps: tuple[int, ...] = steps, j: int = j, width: int = width
                ) -> tuple[Bead, Bead]:
                    p, q = divmod(column, width)
                    other = (p + steps[0]) % width, (q + steps[1]) % width, j + sum(steps)
                    return (p, q, j), other

                physical.count_gaps(found.reshape(*found.shape[:-2], -1), pair)

    def _at(self, at: int | slice) -> "Spheres":
        def of(rows: Sequence[Array], axes: int) -> LazyRows[Array]:
            where = (slice(None),) * axes + (at,)
            return LazyRows(len(rows), lambda j: rows[j][where] if rows[j].size else rows[j])

        forces, placed = self.forces, self.placed
        if forces is not None:
            change = PerAxis[Sequence[Array]](*(of(rows, 0) for _, rows in forces.change))
            forces = AxisForces(forces.system, forces.rows, forces.ordered, change)
        if isinstance(placed, CompiledPlaced):
            part = at if isinstance(at, slice) else slice(at, at + 1)
            placed = replace(placed, flat=placed.flat[part], block=placed.block[part])
        placed = replace(placed, rho=of(placed.rho, 0), c=of(placed.c, 1), dn=of(placed.dn, 2))
        return replace(self, forces=forces, placed=placed)


def solve(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work,
    sweeps: "SphereSweeps | None" = None,
    on_beads: Sequence[Array | None] | None = None,
) -> Spheres:
    """Solve some realisations together; the caller activates ``system``.

    ``on_beads``: the ``loads`` of the problem, if they are known, the same for the same problem.
    Packings out of the ordinary are left to NumPy's sweeps by the compiled ``sweeps``. Raises
    ``UnbuildableError``, ``NotStandingError`` or ``RadiusError``, naming (p, q, j).
    """
    rows, linear = problem.region.rows, problem.route != Route.EXACT
    beads = problem.region.beads * len(realisations)
    ordered = problem.route == Route.ORDERED
    with work.timed("closed form" if ordered else "radii"):
        rho = _radii(problem, realisations, system, sweeps)
    if not ordered:
        work.did_rows("radii", rows, beads)
    m = metric(3, cosine(problem), system)
    with work.timed("closed form" if ordered else "line sums" if linear else "deposit"):
        quick = None if sweeps is None or linear else sweeps.deposit(rho)
        placed = deposit(rho, m, system, linear=linear) if quick is None else quick
    if not ordered:
        work.did_rows("deposited", rows[:1] if linear else rows, rows[0].count if linear else beads)
        if linear:
            work.did_rows("summed", rows[1:], beads - rows[0].count)
    forces = None
    if problem.needs_forces:
        with work.timed("closed form" if ordered else "balance forces"):
            on_beads = loads(problem, system) if on_beads is None else on_beads
            borne: Borne | None = None
            if sweeps is not None and quick is not None:
                borne = sweeps.bear(quick, on_beads)
            if borne is None:
                borne = bear(placed, on_beads, system, linear=linear)
            forces = _told(problem, borne, system)
        if not ordered:
            work.did_rows("balanced", rows[1:], beads - rows[0].count * len(realisations))
    return Spheres(system, None, forces, None, placed=placed, phi=cosine(problem))


def ordered_forces(problem: Problem, system: NumberSystem) -> Forces:
    """Give the forces of the ordered packing."""
    plain = replace(problem, route=Route.ORDERED, radii=Monodisperse(), needs_forces=True)
    forces = solve(plain, [0], system, Work()).forces
    assert forces is not None
    return forces


def _told(problem: Problem, borne: Borne, system: NumberSystem) -> AxisForces:
    """Give forces along axes, a row a layer."""

    def flat(rows: Sequence[Array], a: int) -> tuple[Array, ...]:
        return tuple(v[a].reshape(*v.shape[1:-2], -1) if v.size else v for v in rows)

    def one(rows: Sequence[Array], a: int) -> tuple[Array, ...]:
        return tuple(v[a].reshape(-1) if v.size else v for v in rows)

    return AxisForces(
        system,
        problem.region.rows,
        PerAxis(*(one(borne.ordered, a) for a in range(3))),
        PerAxis(*(flat(borne.change, a) for a in range(3))),
    )


def _radii(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    sweeps: "SphereSweeps | None",
) -> Sequence[Array]:
    width = side(problem)
    try:
        if sweeps is None:
            rows = rows_of(problem.radii, problem.region.rows, realisations, system)
        else:
            rows = sweeps.radii(realisations)
    except RadiusError as error:
        i, j = error.site
        raise RadiusError(bead_of((i, j), width), error.reason) from None
    return LazyRows(len(rows), lambda j: rows[j].reshape(*rows[j].shape[:-1], width, width))


def loads(problem: Problem, system: NumberSystem) -> list[Array | None]:
    """Give L^a that beads add to F of the contacts below, (3, W, W) a layer, of F = −Σ L^a n^a.

    Of a force straight down they are 1/|Σ n^a| = 1/√(3 + 6φ), with n^1 − n^3 along x.
    """
    load, width, top = problem.load, side(problem), len(problem.region.rows)
    unit = system.root(1 / (3 + 6 * cosine(problem)))
    x, y = system.scalar(1 / (2 * problem.n_x)), system.root(1 / (12 * problem.n_x**2))

    def on_axes(fx: Any, fy: Any, fz: Any) -> Array:
        down = -(fz * unit)
        parts = down + fy * y - fx * x, down - 2 * (fy * y), down + fy * y + fx * x
        found = zeros(system, 3, 1, 1)
        found[:, 0, 0] = parts
        return found

    rows: list[Array | None] = [None] * top
    if load.loaded is None:
        row = zeros(system, 3, width, width) + on_axes(*_unit_force(load, system))
        first = 0 if load.kind == "bulk" else problem.height
        rows[first:] = [row] * (top - first)
    for site in load.loaded or []:
        p, q, j = bead_of(site, width)
        force = _unit_force(load, system)
        if load.single:
            force = tuple(system.scalar(one) for one in load.single[site])
        row_j = rows[j]
        row_j = zeros(system, 3, width, width) if row_j is None else row_j
        row_j[:, p, q] = row_j[:, p, q] + on_axes(*force)[:, 0, 0]
        rows[j] = row_j
    return rows


def _unit_force(load: LoadSpec, system: NumberSystem) -> tuple[Any, ...]:
    """Give the load of a bead, (fx, fy, fz)."""
    zero, one = system.scalar(Fraction(0)), system.scalar(Fraction(1))
    if not load.angle_deg:
        return zero, zero, -one
    sin, cos = load.turn(system)
    return sin, zero, -cos


def sees_images(problem: Problem, lowest_layer: int) -> bool:
    """Say whether any row of the answer differs, with radii in general, from that of W → ∞.

    Above a bead of layer J its loads span M − J columns, and below these there are M more. To first
    order one contact depends on lines down from its own, M − J columns, and beside these.
    """
    width, loaded = side(problem), problem.load.loaded
    height = problem.region.top
    if problem.route == Route.ORDERED:
        return lowest_layer == 0 and any(j and j % width == 0 for _, j in loaded or [])
    if not problem.needs_forces:
        return height >= width
    if loaded is not None and len(loaded) == 1:
        return width <= height
    if problem.route == Route.FIRST_ORDER and lowest_layer == 1:
        return width <= min(height + 1, 2 * height - 1)
    return width <= 2 * height - lowest_layer


def tilt(solved: Spheres, axis: Direction, j: int) -> Array:
    """Give Σ_b of δn's components of the contacts below row j: their rise, over n_z."""
    values = solved.placed.dn[j][int(axis.value) - 1].sum(axis=0)
    return np.asarray(values.reshape(*values.shape[:-2], -1))


def on_base(solved: Spheres, *, exact: bool) -> tuple[Array, Array]:
    """Give what contacts press onto the base, as Σ v^a n^a: ordered and change, (3, W, W) each."""
    forces, dn = solved.forces, solved.placed.dn[1]
    assert forces is not None
    ordered, change = [], zeros(solved.system, *dn.shape[1:])
    for a, (_, *rows) in enumerate(forces.below(1)):
        F, g = (row.reshape(dn.shape[2:]) for row in rows)
        pushed = (F + g if exact else F) * dn[a]
        pushed[a] = pushed[a] + g
        change = change + along(pushed, a, 1, 3)
        ordered.append(along(F, a, 1, 3))
    return np.stack(ordered), change
