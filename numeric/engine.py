"""The engine: solves a plan for some realisations in one number system, counting its work."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import Any

from numeric import first_order, packing
from numeric.forces import Forces, sweep_down
from numeric.lattice import Layer
from numeric.packing import Packing
from numeric.planner import Plan
from numeric.radii import rows_of
from numeric.systems import FLOAT64, NumberSystem
from numeric.work import Work

# Beads from which on the compiled sweeps repay loading the compiler (half a second).
COMPILED_FROM = 2_000_000


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
    seconds: dict[str, float]


def solve(plan: Plan, realisations: Sequence[int], system: NumberSystem, work: Work) -> Solved:
    """Solve what the plan asks; the caller activates ``system``."""
    if plan.route == "ordered":
        return _ordered(plan, system)
    if plan.route == "line sums":
        return _line_sums(plan, realisations[0], system, work)
    seconds: dict[str, float] = {}
    clock = _Clock(seconds)
    rho = rows_of(plan.radii, plan.region.rows, realisations, system, work)
    clock.stop("read radii", "draw radii")
    n_x = plan.scene.n_x
    deposit, sweep = _sweeps(plan, system)
    if plan.route == "exact":
        solved = deposit(n_x, plan.region, rho, system, work)
        clock.stop("deposit")
    else:
        solved = first_order.displace(n_x, plan.region, rho, system, work)
        clock.stop("line sums")
    if not plan.needs_forces:
        return Solved(system, solved, None, None, seconds)
    strength = plan.load.strength(n_x, system)
    loads = plan.load.on(plan.force_rows, strength, system)
    forces = sweep(
        solved,
        plan.force_rows,
        loads,
        linear=plan.route == "first-order",
        stop_at_tension=plan.scene.effects.stop_at_tension,
        work=work,
    )
    clock.stop("balance forces")
    return Solved(system, solved, forces, None, seconds)


def _sweeps(
    plan: Plan, system: NumberSystem
) -> tuple[Callable[..., Packing], Callable[..., Forces]]:
    """Give the sweeps: for much exact work the compiled ones, same numbers, where numba is."""
    much = plan.region.beads * plan.realisations >= COMPILED_FROM
    if much and system is FLOAT64 and plan.route == "exact":
        try:
            from numeric import fast
        except ImportError:
            pass
        else:
            return fast.deposit, fast.sweep_down
    return packing.deposit, sweep_down


class _Clock:
    def __init__(self, seconds: dict[str, float]) -> None:
        self.seconds = seconds
        self.start = perf_counter()

    def stop(self, *steps: str) -> None:
        now = perf_counter()
        for step in steps:
            self.seconds[step] = now - self.start
        self.start = now


def _ordered(plan: Plan, system: NumberSystem) -> Solved:
    start = perf_counter()
    forces, single = None, None
    n_x = plan.scene.n_x
    if plan.needs_forces:
        strength = plan.load.strength(n_x, system)
        if plan.single_contact:
            zero = system.number(plan.scene.n_x * 0)
            single = (plan.load.ordered_force(plan.scene.contact, strength, system), zero)
        else:
            forces = plan.load.ordered_forces(plan.force_rows, strength, system)
    return Solved(system, None, forces, single, {"closed form": perf_counter() - start})


def _line_sums(plan: Plan, realisation: int, system: NumberSystem, work: Work) -> Solved:
    start = perf_counter()
    seconds = {"read radii": 0.0, "draw radii": 0.0, "line sums": 0.0}

    def radius_at(i: int, j: int) -> Any:
        begun = perf_counter()
        layer = Layer(j, i, 1)
        work.did("radii", layer)
        work.did("summed", layer)
        radius = plan.radii.row(layer, [realisation], system)[0]
        seconds["draw radii"] += perf_counter() - begun
        seconds["read radii"] = seconds["draw radii"]
        return radius

    def finished(single: tuple[Any, Any]) -> Solved:
        seconds["line sums"] = perf_counter() - start - seconds["draw radii"]
        return Solved(system, None, None, single, seconds)

    n_x = plan.scene.n_x
    if not plan.needs_forces:
        i, j = plan.scene.site
        lines = first_order.Diagonals(i, j, 1, radius_at, {})
        single = (
            first_order.line_sum(lines.along(0, j))[-1],
            first_order.line_sum(lines.across(i, j))[-1],
        )
        return finished(single)
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
    return finished((own, change))
