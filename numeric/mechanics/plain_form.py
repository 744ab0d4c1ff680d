"""Packings solved in the plain form, and put into the terms of the deviation form.

The ordered values are subtracted from solved positions and forces, which is where the plain form
loses its digits.
"""

from collections.abc import Sequence
from typing import Any

from ..arithmetic.systems import Array, NumberSystem, zeros
from ..disorder.radii import rows_of
from ..lattice.branch import PerBranch
from ..lattice.layers import Layer, LazyRows, Region, full_layer, pick, whole
from . import plain
from .problem import Problem, Solved
from .sweep import Forces, SolvedPacking
from .work import Work


def solve_plainly(
    problem: Problem, realisations: Sequence[int], system: NumberSystem, work: Work
) -> Solved:
    """Solve one realisation of a periodic packing in the plain form, like ``engine.solve``."""
    assert problem.width is not None
    region = whole(problem.width, problem.height)
    with work.timed("radii"):
        rho = rows_of(problem.radii, region.rows, realisations, system)
    for layer in region.rows:
        work.did("radii", layer, len(realisations))
    with work.timed("deposit"):
        packing = plain.deposit(problem.n_x, rho, system)
        placed = _placed(problem, packing, rho)
    for layer in region.rows:
        work.did("deposited", layer)
    if not problem.needs_forces:
        return Solved(system, placed, None, None)
    with work.timed("balance forces"):
        forces = _balanced(problem, packing, region, system)
    for layer in problem.force_rows[1:]:
        work.did("balanced", layer)
    return Solved(system, placed, forces, None)


def _balanced(
    problem: Problem, packing: plain.PlainPacking, region: Region, system: NumberSystem
) -> Forces:
    """Balance forces and subtract the ordered ones."""
    width = problem.width
    assert width is not None
    nx, ny = packing.n
    strength = problem.load.strength(problem.n_x, system)
    on = problem.load.on(region.rows, strength, system)

    def cartesian(row: Layer) -> plain.Vector | None:
        plus, minus = on.plus[row.j], on.minus[row.j]
        if plus is None or minus is None:
            return None
        return plain.Vector((minus - plus) * nx, -(plus + minus) * ny)

    found = plain.forces(packing, tuple(cartesian(row) for row in region.rows))
    # The ordered forces on all beads: rows above the highest load, if there are any, have none.
    ordered = problem.load.ordered_forces(region, region.rows, strength, system)
    zero = zeros(system, 1)[0]

    def wanted(values: Sequence[Array]) -> tuple[Array, ...]:
        return tuple(
            pick(values[row.j], full_layer(row.j, width), row, width, zero) if row.j else values[0]
            for row in problem.force_rows
        )

    changes = [
        [f - F for f, F in zip(found.plus, ordered.ordered.plus, strict=True)],
        [f - F for f, F in zip(found.minus, ordered.ordered.minus, strict=True)],
    ]
    return Forces(
        system,
        region,
        problem.force_rows,
        PerBranch(wanted(ordered.ordered.plus), wanted(ordered.ordered.minus)),
        PerBranch(wanted(changes[0]), wanted(changes[1])),
    )


def _placed(problem: Problem, packing: plain.PlainPacking, rho: Sequence[Array]) -> SolvedPacking:
    """Put displacements into the coordinates c^± = n^±·δx that answers are gathered from."""
    nx, ny = packing.n
    moved = plain.displacements(packing)
    layers = len(packing.plus)
    return SolvedPacking(
        problem.phi,
        packing.system,
        packing.region,
        rho,
        PerBranch(
            tuple(d.x * nx + d.y * ny for d in moved), tuple(d.y * ny - d.x * nx for d in moved)
        ),
        PerBranch(  # only looked up by what asks for directions
            LazyRows(layers, lambda j: _turned(packing.plus[j], nx, ny)),
            LazyRows(layers, lambda j: _turned(packing.minus[j], -nx, ny)),
        ),
    )


def _turned(N: plain.Vector, nx: Any, ny: Any) -> tuple[Array, Array]:
    """Give (a, b) of N − n = a n⁺ + b n⁻, for the contacts of ordered direction n = (nx, ny)."""
    x, y = (N.x - nx) / (2 * abs(nx)), (N.y - ny) / (2 * ny)
    return y + x, y - x
