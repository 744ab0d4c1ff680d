"""Ways to answer a scene: any plan in any number system, also in the plain form, as one table."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    LONGDOUBLE,
    Balls,
    BigFloat,
    NumberSystem,
    zeros,
)
from force_diffusion.numeric.disorder.radii import rows_of
from force_diffusion.numeric.lattice.layers import Array, Layer, Region, full_layer, pick, whole
from force_diffusion.numeric.mechanics import plain
from force_diffusion.numeric.mechanics.engine import Solved, batches, solve
from force_diffusion.numeric.mechanics.forces import Forces
from force_diffusion.numeric.mechanics.packing import Packing
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.plan import Plan
from force_diffusion.numeric.quantities.answers import GATHERERS, Table
from force_diffusion.numeric.scene.sections import Scene

DIGITS = (20, 30, 50, 100, 300)

Solver = Callable[[Plan, Sequence[int], NumberSystem, Work], Solved]

# What needs the turned directions of contacts, and not only their forces.
TURNED = {"base_reactions", "response"}
PLAIN_QUANTITIES = {"contact", "contact_forces", "positions", *TURNED}


def systems() -> Iterator[NumberSystem]:
    """All arithmetics: float64, long double where it is longer, mpmath and balls by digits."""
    yield FLOAT64
    if LONGDOUBLE.bits > FLOAT64.bits:
        yield LONGDOUBLE
    yield from (BigFloat(digits) for digits in DIGITS)
    yield from (Balls(math.ceil(digits * math.log2(10))) for digits in DIGITS)


def with_geometry(scene: Scene, geometry: str) -> Scene:
    """Give the scene with another ``effects.geometry``."""
    effects = scene.effects.model_copy(update={"geometry": geometry})
    return scene.model_copy(update={"effects": effects})


def answer(
    plan: Plan, system: NumberSystem, realisations: Sequence[int], solver: Solver = solve
) -> Table:
    """Answer a plan's question for some realisations; units as in the scene's own answer.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    with system.active():
        gatherer = GATHERERS[plan.scene.ask.quantity](plan, system)
        for chunk in batches(plan, realisations, system):
            gatherer.add(solver(plan, chunk, system, Work()), chunk)
        return gatherer.table()


def why_not_plain(plan: Plan) -> str | None:
    """Say why the plain form can't answer a plan; None where it can."""
    if plan.route != "exact":
        return "it solves the exact packing, and the scene asks for less"
    if plan.scene.packing.width is None:
        return "it is written for periodic packings; the scene's is an infinite slab"
    if plan.scene.effects.stop_at_tension:
        return "it does not stop at tension"
    quantity = plan.scene.ask.quantity
    if quantity not in PLAIN_QUANTITIES:
        return f"it gives forces and positions, from which '{quantity}' is not gathered"
    return None


def solve_plainly(
    plan: Plan, realisations: Sequence[int], system: NumberSystem, work: Work
) -> Solved:
    """Solve one realisation of a periodic packing in the plain form, like ``engine.solve``.

    The ordered values are subtracted from solved positions and forces, which is where the plain
    form loses its digits. Only what the gatherers of ``PLAIN_QUANTITIES`` and the check that it is
    physical read is filled in.
    """
    scene = plan.scene
    width = scene.packing.width
    assert width is not None
    region = whole(width, scene.packing.height)
    with work.timed("radii"):
        rho = rows_of(plan.radii, region.rows, realisations, system, work)
    with work.timed("deposit"):
        packing = plain.deposit(scene.n_x, rho, system)
        placed = _placed(plan, packing, rho)
    for layer in region.rows:
        work.did("deposited", layer)
    if not plan.needs_forces:
        return Solved(system, placed, None, None)
    with work.timed("balance forces"):
        forces = _balanced(plan, packing, region, system)
    for layer in plan.force_rows[1:]:
        work.did("balanced", layer)
    return Solved(system, placed, forces, None)


def _balanced(
    plan: Plan, packing: plain.PlainPacking, region: Region, system: NumberSystem
) -> Forces:
    """Balance forces and subtract the ordered ones."""
    scene = plan.scene
    width = scene.packing.width
    assert width is not None
    nx, ny = packing.n
    strength = plan.load.strength(scene.n_x, system)
    on = plan.load.on(region.rows, strength, system)

    def cartesian(row: Layer) -> plain.Vector | None:
        plus, minus = on.plus[row.j], on.minus[row.j]
        if plus is None or minus is None:
            return None
        return plain.Vector((minus - plus) * nx, -(plus + minus) * ny)

    found = plain.forces(packing, tuple(cartesian(row) for row in region.rows))
    # The ordered forces on all beads: rows above the highest load, if there are any, have none.
    ordered = plan.load.ordered_forces(region.rows, strength, system)
    zero = zeros(system, 1)[0]

    def wanted(values: Sequence[Array]) -> tuple[Array, ...]:
        return tuple(
            pick(values[row.j], full_layer(row.j, width), row, width, zero) if row.j else values[0]
            for row in plan.force_rows
        )

    changes = [
        [f - F for f, F in zip(found.plus, ordered.ordered_plus, strict=True)],
        [f - F for f, F in zip(found.minus, ordered.ordered_minus, strict=True)],
    ]
    return Forces(
        system, plan.force_rows, wanted(ordered.ordered_plus), wanted(ordered.ordered_minus),
        wanted(changes[0]), wanted(changes[1]),
    )  # fmt: skip


def _placed(plan: Plan, packing: plain.PlainPacking, rho: Sequence[Array]) -> Packing:
    """Put displacements into the coordinates c^± = n^±·δx that answers are gathered from."""
    nx, ny = packing.n
    moved = plain.displacements(packing)
    turned = plan.scene.ask.quantity in TURNED
    return Packing(
        plan.scene.n_x, packing.system, packing.region, rho,
        tuple(d.x * nx + d.y * ny for d in moved), tuple(d.y * ny - d.x * nx for d in moved),
        tuple(_turned(N, nx, ny) for N in packing.plus) if turned else (),
        tuple(_turned(N, -nx, ny) for N in packing.minus) if turned else (),
    )  # fmt: skip


def _turned(N: plain.Vector, nx: Any, ny: Any) -> tuple[Array, Array]:
    """Give (a, b) of N − n = a n⁺ + b n⁻, for the contacts of ordered direction n = (nx, ny)."""
    x, y = (N.x - nx) / (2 * abs(nx)), (N.y - ny) / (2 * ny)
    return y + x, y - x
