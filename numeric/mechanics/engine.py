"""The engine: it solves every packing, whatever the question and the number of packings."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib.util import find_spec
from typing import Any

from ..arithmetic.carried import CARRYING
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..lattice.layers import Rows
from . import first_order
from .physicality import Physicality
from .problem import Problem, Route
from .sweep import Solved, rounded, swept
from .work import Work

# Beads that are swept together: their arrays still fit into a cache.
TOGETHER = 200_000


def compiles(problem: Problem, system: NumberSystem) -> bool:
    """Say whether compiled loops solve: discs, in float64, where numba is installed."""
    discs = problem.route == Route.EXACT and problem.dimension == 2 and system is FLOAT64
    return discs and find_spec("numba") is not None


def chunk_size(problem: Problem, system: NumberSystem) -> int:
    """Say how many realisations are swept together: as many as keep the arrays small."""
    if system.dtype is object or problem.route in {Route.LINE_SUMS, Route.ORDERED}:
        return 1
    return max(1, TOGETHER // max(problem.region.beads, 1))


def packings(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work | None = None,
    physical: Physicality | None = None,
    *,
    carried: bool = False,
) -> Iterator[tuple[Solved, Sequence[int]]]:
    """Solve realisations in their order, ``chunk_size`` at a time.

    Gives what was solved together and its realisations: the first axis of arrays. The caller
    activates ``system``. ``physical`` looks at every packing. With ``carried`` numbers, float64,
    carry their errors on the way, and are rounded once. Raises what the sweeps raise for a packing
    that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    size = chunk_size(problem, system)
    for at in range(0, len(realisations), size):
        chunk = realisations[at : at + size]
        solved = solve(problem, chunk, system, work, carried=carried)
        if physical is not None:
            physical.look_at(solved, chunk)
            work.did("checked", problem.region.beads * len(chunk))
        yield solved, chunk


def solve(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work,
    *,
    carried: bool = False,
) -> Solved:
    """Solve some realisations together; the caller activates ``system``."""
    if problem.route == Route.ORDERED:
        return _ordered(problem, system)
    if problem.route == Route.LINE_SUMS:
        line_sums = _line_sums(problem, realisations[0], CARRYING if carried else system, work)
        return rounded(line_sums) if carried else line_sums
    load = problem.load if problem.needs_forces else None
    linear = problem.route != Route.EXACT
    solved = swept(
        problem.n_x, problem.radii, load, problem.region, problem.force_rows, realisations, system,
        linear=linear, carried=carried,
    )  # fmt: skip
    work.did("summed" if linear else "deposited", problem.region.beads * len(realisations))
    return solved


def _ordered(problem: Problem, system: NumberSystem) -> Solved:
    solved = Solved(problem.phi, system, problem.region)
    load, rows = problem.load, problem.force_rows
    if problem.needs_forces:
        strength = load.strength(problem.n_x, system)
        if problem.contact is not None:
            i, j, branch = problem.contact
            beads = Rows([i, i + branch.side], [1, 1], j)  # the lower and the upper one
            force = load.ordered(beads, strength, system)[branch.number, 0]
            return replace(solved, single=(force, system.number(problem.n_x * 0)))
        F = load.ordered(rows, strength, system)
        return replace(solved, rows=rows, F=F, g=system.zeros(1, *F.shape))
    return solved


def _line_sums(problem: Problem, realisation: int, system: NumberSystem, work: Work) -> Solved:
    """Read the radii of the diagonals that the answer depends on, and sum."""
    contact, load = problem.contact, problem.load

    def rho(line: first_order.Line) -> Any:
        return problem.radii.of(line.rows, [realisation], system)[0]

    if contact is not None:
        single = first_order.contact_change(contact, load, rho, problem.n_x, system)
    else:
        assert problem.site is not None
        i, j = problem.site  # c⁺ and c⁻ are sums along the diagonals up to it (Eq. 3)
        lines = first_order.Line(i - j, 1, j), first_order.Line(i + j, -1, j)
        plus, minus = (first_order.line_sum(rho(line))[-1] for line in lines)
        single = plus, minus
    work.did("summed", problem.line_beads)
    return Solved(problem.phi, system, problem.region, single=single)
