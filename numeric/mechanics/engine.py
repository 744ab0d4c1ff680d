"""The engine: the one way in which packings are solved, whatever is asked and of how many."""

import sys
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from importlib import import_module
from typing import TYPE_CHECKING, Any
from weakref import finalize

from ..arithmetic.carried import CARRYING
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.machine import cores
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import rows_of
from ..lattice.branch import Branch
from ..lattice.layers import Layer, Region
from . import first_order
from .physicality import PHYSICAL, Physicality
from .problem import Problem, Route, Solved, rounded
from .sweep import Loads, deposit, radii_named, sweep_down
from .work import Work

if TYPE_CHECKING:
    from .sweeps import Sweeps

# Work from which on the compiled sweeps repay loading the compiler (half a second), counted in
# beads that NumPy sweeps: of this call, and of all before it in this process. A bead, and a row of
# them, which takes calls of its own, count for so many, without errors and with them. Once the
# sweeps are loaded, a small part of that is enough, and anything that carries errors.
COMPILED_FROM, ONCE_LOADED = 2_000_000, 1 / 50
OF_BEAD, OF_ROW = (1, 10), (40, 2000)
# Bytes that stay for the next packings of a thread, whoever asks for them.
STAYS = 64_000_000
# Beads of diagonals that are drawn together.
BLOCK = 10_000
# Beads that are swept together: their arrays still fit into a cache.
TOGETHER = 200_000
# Likewise where compiled loops sum up at once: few, since other programs use the cache, too.
NEAR = 50_000
# Where it does not matter how many are: numbers of a row, for which calls of NumPy cost little, and
# beads at the most.
ROW, MOST = 4096, 1_100_000


class _Kept(threading.local):
    """The sweeps of a thread's last packings, for its next ones, until they take them."""

    def __init__(self) -> None:
        self.last: list[tuple[Any, Any]] = []


_kept = _Kept()


def chunk_size(problem: Problem, system: NumberSystem) -> int:
    """Say how many realisations are swept together: as many as keep the arrays small."""
    if not _in_batches(problem, system):
        return 1
    return max(1, TOGETHER // max(problem.region.beads, 1))


def at_once(problem: Problem) -> int:
    """Say how many realisations compiled sweeps take together where nothing else needs them."""
    return max(cores(), NEAR // max(problem.region.beads, 1))


def _in_batches(problem: Problem, system: NumberSystem) -> bool:
    """Say whether several realisations may be swept together."""
    return not (system.dtype is object or problem.route == Route.LINE_SUMS)


def packings(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work | None = None,
    physical: Physicality | None = None,
    *,
    any_number: bool = False,
    carried: bool = False,
    copied: bool = False,
) -> Iterator[tuple[Solved, Sequence[int]]]:
    """Solve realisations in their order, ``chunk_size`` at a time.

    Gives what was solved together and its realisations: the first axis of arrays, which a single
    one lacks. The next ones take the memory of the last: what is to stay has to be copied. So do
    those of the next call, if of the last ones all is ``copied``. The caller activates ``system``.
    ``physical`` looks at every packing. With ``carried`` numbers, float64, carry their errors on
    the way, and are rounded once. With ``any_number`` more may come together, so that all cores
    have some. Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    size = chunk_size(problem, system)
    sweeps, loads = ready(problem, system, carried=carried)
    together = size
    if sweeps is not None and _in_batches(problem, system):
        together = size * -(-cores() // size)
    elif any_number and _in_batches(problem, system):
        region = problem.region
        together = max(size, min(ROW // max(region.widest, 1), MOST // max(region.beads, 1)))
    try:
        for at in range(0, len(realisations), together):
            batch = realisations[at : at + together]
            parts = [slice(k, min(k + size, len(batch))) for k in range(0, len(batch), size)]
            all_solved = None
            if len(parts) > 1:
                # If one can't be built, they are solved part by part, so that the first is named.
                with suppress(ForceDiffusionError):
                    all_solved = _solved(
                        problem, batch, system, work, sweeps, loads, carried=carried
                    )
            if any_number and all_solved is not None:
                parts = [slice(0, len(batch))]
            for part in parts:
                chunk = batch[part]
                if all_solved is None:
                    solved = _solved(problem, chunk, system, work, sweeps, loads, carried=carried)
                else:
                    solved = all_solved if len(parts) == 1 else all_solved.some(part)
                if physical is not None:
                    with work.timed(PHYSICAL):
                        physical.looks_at = chunk
                        _look(physical, solved)
                    region = problem.region
                    work.did_rows("checked", region.rows, region.beads * len(chunk))
                yield solved, chunk
    finally:
        if copied:
            keep(problem, sweeps, loads)


def _look(physical: Physicality, solved: Solved) -> None:
    if solved.packing is not None:
        physical.look_at_gaps(solved.packing)
    if solved.forces is not None:
        physical.look_at_forces(solved.forces)


def solve(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work,
    *,
    carried: bool = False,
) -> Solved:
    """Solve some realisations together; the caller activates ``system``."""
    sweeps, loads = ready(problem, system, carried=carried)
    return _solved(problem, realisations, system, work, sweeps, loads, carried=carried)


def _solved(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work,
    sweeps: "Sweeps | None",
    loads: Loads | None,
    *,
    carried: bool,
) -> Solved:
    if problem.route == Route.ORDERED:
        with work.timed("closed form"):
            return _ordered(problem, system)
    own: NumberSystem = CARRYING if carried else system
    if problem.route == Route.LINE_SUMS:
        found = _line_sums(problem, realisations[0], own, work)
        return rounded(found) if carried else found
    region, rows, n = problem.region, problem.force_rows, len(realisations)
    linear = problem.route != Route.EXACT
    with work.timed("radii"), radii_named(region):
        rho: Any = (
            rows_of(problem.radii, region.rows, realisations, own)
            if sweeps is None
            else sweeps.radii(realisations)
        )
    work.did_rows("radii", region.rows, region.beads * n)
    block = None
    with work.timed("line sums" if linear else "deposit"):
        if sweeps is not None:
            block = sweeps.deposit(rho)
        if block is None:
            beads = rho if sweeps is None else sweeps.rows(rho)
            packing = deposit(problem.phi, region, beads, own, work, linear=linear)
            if system is FLOAT64 and not linear:
                _by_numpy[problem.dimension] += _work(region, n, 1, carried=carried)
        else:
            work.did_rows("deposited", region.rows, region.beads * n)
    if sweeps is not None and block is not None:
        if loads is None:
            return sweeps.told(rho, block, None, None)
        with work.timed("balance forces"):
            descent = sweeps.descent(rows, loads)
            g = descent(block)
        if g is not None:
            work.did_rows("balanced", rows[1:], descent.beads * n)
            return sweeps.told(rho, block, descent, g)
        packing = sweeps.swept(rho, block)
    forces = None
    if loads is not None:
        with work.timed("balance forces"):
            forces = sweep_down(packing, rows, loads, linear=linear, work=work)
    found = Solved(own, packing, forces, None)
    return rounded(found) if carried else found


def keep(problem: Problem, sweeps: Any, loads: Any) -> None:
    """Keep what ``ready`` gave for this thread's next packings of the same shape and load.

    What takes much memory goes with the problem.
    """
    if sweeps is not None:
        last = _kept.last
        last[:] = [(sweeps, loads)]
        if sweeps.bytes > STAYS:
            finalize(problem, last.clear)


def ready(
    problem: Problem, system: NumberSystem, *, carried: bool = False
) -> tuple["Sweeps | None", Loads | None]:
    """Give what all realisations have alike: the compiled sweeps, if they are taken, and loads."""
    with suppress(IndexError):
        sweeps, loads = _kept.last.pop()
        if system is FLOAT64 and sweeps.serves(problem, carried=carried):
            return sweeps, loads
    return _compiled(problem, system, carried=carried), _loads(
        problem, CARRYING if carried else system
    )


def _loads(problem: Problem, system: NumberSystem) -> Loads | None:
    """Give the loads, the same for all realisations; None where no sweep needs them."""
    if not problem.needs_forces or problem.route not in {Route.EXACT, Route.FIRST_ORDER}:
        return None
    strength = problem.load.strength(problem.n_x, system)
    return problem.load.on(problem.force_rows, strength, system)


_by_numpy: Counter[int] = Counter()
"""Work that NumPy did so far in each dimension."""


def _work(region: Region, packings: int, calls: int, *, carried: bool) -> int:
    rows = OF_ROW[carried] * len(region.rows) * calls
    return OF_BEAD[carried] * region.beads * packings + rows


def worth_compiling(
    problem: Problem, system: NumberSystem, *, carried: bool = False, before: int = 0
) -> bool:
    """Say whether there is so much to do that compiled sweeps are taken, where numba is.

    ``before``: work that NumPy has done.
    """
    if problem.route != Route.EXACT or system is not FLOAT64:
        return False
    n = problem.realisations
    return before + _work(problem.region, n, n, carried=carried) >= COMPILED_FROM


def compiles(problem: Problem, system: NumberSystem, *, carried: bool = False) -> bool:
    """Say whether compiled sweeps are taken: for much work in float64, where numba is."""
    kernels, d = sys.modules.get(f"{__package__}.kernels"), problem.dimension
    before = _by_numpy[d]
    if kernels is not None and d in kernels.LOADED:
        before = COMPILED_FROM if carried else int(COMPILED_FROM * (1 - ONCE_LOADED))
    if not worth_compiling(problem, system, carried=carried, before=before):
        return False
    try:
        import_module(".sweeps", __package__)
    except ImportError:
        return False
    return True


def _compiled(problem: Problem, system: NumberSystem, *, carried: bool) -> "Sweeps | None":
    """Give the compiled sweeps, same numbers, if they are taken."""
    if not compiles(problem, system, carried=carried):
        return None
    from .sweeps import Sweeps

    return Sweeps(problem, carried=carried)


def _ordered(problem: Problem, system: NumberSystem) -> Solved:
    forces, single = None, None
    n_x = problem.n_x
    if problem.needs_forces:
        strength = problem.load.strength(n_x, system)
        if problem.contact is not None:
            zero = system.number(problem.n_x * 0)
            single = (problem.load.ordered_force(problem.contact, strength, system), zero)
        else:
            forces = problem.load.ordered_forces(
                problem.region, problem.force_rows, strength, system
            )
    return Solved(system, None, forces, single)


def _line_sums(problem: Problem, realisation: int, system: NumberSystem, work: Work) -> Solved:
    with work.timed("radii"):
        known = _along(problem, realisation, system, work)
    with work.timed("line sums"):
        return Solved(system, None, None, _summed(problem, known, system, work))


def _along(
    problem: Problem, realisation: int, system: NumberSystem, work: Work
) -> dict[tuple[int, int], Any]:
    """Read the radii of the diagonals that the answer depends on, each bead once."""
    if problem.contact is not None:
        lines = first_order.lines_read(problem.contact, problem.load)
    else:
        assert problem.site is not None
        i, j = problem.site
        lines = [first_order.Line(i - j, 1, j), first_order.Line(i + j, -1, j)]
    sites = list(dict.fromkeys((line.at(m), m) for line in lines for m in range(line.top + 1)))
    known: dict[tuple[int, int], Any] = {}
    for at in range(0, len(sites), BLOCK):
        block = sites[at : at + BLOCK]
        known.update(zip(block, problem.radii.at(block, realisation, system), strict=True))
        for i, m in block:
            work.did("radii", Layer(m, i, 1))
    return known


def _summed(
    problem: Problem, known: dict[tuple[int, int], Any], system: NumberSystem, work: Work
) -> tuple[Any, Any]:
    """Give (c⁺, c⁻) of the one bead, or (force, change) of the one contact."""

    def radius_at(i: int, j: int) -> Any:
        work.did("summed", Layer(j, i, 1))
        return known[i, j]

    n_x = problem.n_x
    if problem.contact is None:
        assert problem.site is not None
        i, j = problem.site
        lines = first_order.Diagonals(i, j, 1, radius_at, {})
        return (
            first_order.line_sum(lines.along(0, j))[-1],
            first_order.line_sum(lines.across(i, j))[-1],
        )
    contact = problem.contact
    i, j, branch = contact
    side, other = branch.side, branch.other
    strength = problem.load.strength(n_x, system)

    def ordered(a: int, b: int, orientation: Branch) -> Any:
        return problem.load.ordered_force((a, b, orientation), strength, system)

    above, below = first_order.crossing_layers(contact, problem.load)
    own = ordered(*contact)
    change, _ = first_order.contact_change(
        contact,
        own=own if problem.load.carries(*contact) else None,
        above={m: ordered(i + side * (m - j), m, other) for m in above},
        below={m: ordered(i + side * (m - j + 1), m - 1, other) for m in below},
        radius_at=radius_at,
        n_x=n_x,
        system=system,
    )
    return own, change
