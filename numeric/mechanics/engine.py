"""The engine: solves a plan for some realisations in one number system, counting its work."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from force_diffusion.numeric.arithmetic.systems import FLOAT64, NumberSystem
from force_diffusion.numeric.disorder.radii import rows_of
from force_diffusion.numeric.lattice.layers import Layer
from force_diffusion.numeric.mechanics import first_order, packing
from force_diffusion.numeric.mechanics.forces import Forces, sweep_down
from force_diffusion.numeric.mechanics.packing import Packing
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.budget import chunk_size
from force_diffusion.numeric.planning.plan import Plan

# Beads from which on the compiled sweeps repay loading the compiler (half a second).
COMPILED_FROM = 2_000_000
# Beads of diagonals that are drawn together.
BLOCK = 10_000


@dataclass(frozen=True)
class Solved:
    """Some realisations, solved; what the question does not need is None.

    ``single`` is the (force, change) of the one contact, or the (c⁺, c⁻) of the one bead, that
    line sums give alone.
    """

    system: NumberSystem
    packing: Packing | None
    forces: Forces | None
    single: tuple[Any, Any] | None


def batches(
    plan: Plan, realisations: Sequence[int], system: NumberSystem
) -> Iterator[Sequence[int]]:
    """Give the realisations that ``solve`` takes together, in their order."""
    size = 1 if plan.route == "line sums" else chunk_size(plan.region, system, plan.scene)
    for at in range(0, len(realisations), size):
        yield realisations[at : at + size]


def solve(plan: Plan, realisations: Sequence[int], system: NumberSystem, work: Work) -> Solved:
    """Solve what the plan asks; the caller activates ``system``."""
    if plan.route == "ordered":
        with work.timed("closed form"):
            return _ordered(plan, system)
    if plan.route == "line sums":
        return _line_sums(plan, realisations[0], system, work)
    n_x = plan.scene.n_x
    with work.timed("radii"):
        rho = rows_of(plan.radii, plan.region.rows, realisations, system, work)
    deposit, sweep = _sweeps(plan, system)
    if plan.route == "exact":
        with work.timed("deposit"):
            solved = deposit(n_x, plan.region, rho, system, work)
    else:
        with work.timed("line sums"):
            solved = first_order.displace(n_x, plan.region, rho, system, work)
    if not plan.needs_forces:
        return Solved(system, solved, None, None)
    with work.timed("balance forces"):
        strength = plan.load.strength(n_x, system)
        forces = sweep(
            solved,
            plan.force_rows,
            plan.load.on(plan.force_rows, strength, system),
            linear=plan.route == "first-order",
            stop_at_tension=plan.scene.effects.stop_at_tension,
            work=work,
        )
    return Solved(system, solved, forces, None)


def _sweeps(
    plan: Plan, system: NumberSystem
) -> tuple[Callable[..., Packing], Callable[..., Forces]]:
    """Give the sweeps: for much exact work the compiled ones, same numbers, where numba is."""
    much = plan.region.beads * plan.realisations >= COMPILED_FROM
    if much and system is FLOAT64 and plan.route == "exact":
        try:
            from force_diffusion.numeric.mechanics import compiled as fast
        except ImportError:
            pass
        else:
            return fast.deposit, fast.sweep_down
    return packing.deposit, sweep_down


def _ordered(plan: Plan, system: NumberSystem) -> Solved:
    forces, single = None, None
    n_x = plan.scene.n_x
    if plan.needs_forces:
        strength = plan.load.strength(n_x, system)
        if plan.single_contact:
            zero = system.number(plan.scene.n_x * 0)
            single = (plan.load.ordered_force(plan.scene.contact, strength, system), zero)
        else:
            forces = plan.load.ordered_forces(plan.force_rows, strength, system)
    return Solved(system, None, forces, single)


def _line_sums(plan: Plan, realisation: int, system: NumberSystem, work: Work) -> Solved:
    with work.timed("radii"):
        known = _along(plan, realisation, system, work)
    with work.timed("line sums"):
        return Solved(system, None, None, _summed(plan, known, system, work))


def _along(
    plan: Plan, realisation: int, system: NumberSystem, work: Work
) -> dict[tuple[int, int], Any]:
    """Read the radii of the diagonals that the answer depends on, each bead once."""
    if plan.needs_forces:
        lines = first_order.lines_read(plan.scene.contact, plan.load)
    else:
        i, j = plan.scene.site
        lines = [first_order.Line(i - j, 1, j), first_order.Line(i + j, -1, j)]
    sites = list(dict.fromkeys((line.at(m), m) for line in lines for m in range(line.top + 1)))
    known: dict[tuple[int, int], Any] = {}
    for at in range(0, len(sites), BLOCK):
        block = sites[at : at + BLOCK]
        known.update(zip(block, plan.radii.at(block, realisation, system), strict=True))
        for i, m in block:
            work.did("radii", Layer(m, i, 1))
    return known


def _summed(
    plan: Plan, known: dict[tuple[int, int], Any], system: NumberSystem, work: Work
) -> tuple[Any, Any]:
    """Give (c⁺, c⁻) of the one bead, or (force, change) of the one contact."""

    def radius_at(i: int, j: int) -> Any:
        work.did("summed", Layer(j, i, 1))
        return known[i, j]

    n_x = plan.scene.n_x
    if not plan.needs_forces:
        i, j = plan.scene.site
        lines = first_order.Diagonals(i, j, 1, radius_at, {})
        return (
            first_order.line_sum(lines.along(0, j))[-1],
            first_order.line_sum(lines.across(i, j))[-1],
        )
    contact = plan.scene.contact
    i, j, branch = contact
    side, other = (1, "-") if branch == "+" else (-1, "+")
    strength = plan.load.strength(n_x, system)

    def ordered(a: int, b: int, orientation: str) -> Any:
        return plan.load.ordered_force((a, b, orientation), strength, system)

    above, below = first_order.crossing_layers(contact, plan.load)
    own = ordered(*contact)
    change, _ = first_order.contact_change(
        contact,
        own=own if plan.load.carries(*contact) else None,
        above={m: ordered(i + side * (m - j), m, other) for m in above},
        below={m: ordered(i + side * (m - j + 1), m - 1, other) for m in below},
        radius_at=radius_at,
        n_x=n_x,
        system=system,
    )
    return own, change
