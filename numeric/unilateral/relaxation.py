"""Packings without tension: beads come to rest in float64, and balls prove that they do."""

from collections.abc import Callable
from time import process_time
from typing import NamedTuple

import numpy as np
from scipy.optimize import linprog

from ..arithmetic.decimals import short
from ..arithmetic.systems import Array, Balls
from ..mechanics.problem import Problem
from ..mechanics.work import Work
from .certificate import certify
from .deposited import as_deposited, frame, must_hold, start
from .grains import Grains, Pairs
from .linear_programs import relax
from .network import ImpossibleError, Relaxed, UnfinishedError

# Linear programs after which a packing is given up, unless the scene says otherwise.
MOST_PROGRAMS = 400
# Tensions below this share of the largest force are roundings.
SLACK = 1e-11
# Gaps up to this, in units of r, may be contacts after the linear programs.
NEARLY = 1e-5
# Gaps as small as this are those of contacts: float64 leaves about 1e-14.
CLOSED = 4e-13
# Newton's iterations that close them.
ITERATIONS = 12


class Settled(NamedTuple):
    """Where beads came to rest, in float64; ``contacts`` bear force, or are those of the lattice.

    ``programs``: how many it took, 0 where the deposited packing has no tension; ``fall``: of the
    load's energy.
    """

    grains: Grains
    contacts: Pairs
    programs: int = 0
    fall: float = 0.0


def relaxed(problem: Problem, realisation: int, system: Balls, work: Work) -> Relaxed:
    """Solve a packing whose contacts are unilateral; the caller activates ``system``.

    Raises ``UnbuildableError``, ``UnfinishedError`` where beads do not come to rest, or are not
    proved to, and ``UndecidedError`` where more bits may tell.
    """
    try:
        if work.settled is None:
            work.settled = settle(problem, realisation, work)
        settled, known = work.settled, frame(problem, realisation, system)
        if not settled.programs:
            network = as_deposited(problem, realisation, known, system)
        else:
            network = certify(settled.grains, settled.contacts, known, system)
            network = network._replace(programs=settled.programs, fall=settled.fall)
    except ImpossibleError:
        raise
    except UnfinishedError as error:
        raise UnfinishedError(f"no packing was found, though one may exist: {error}") from error
    return Relaxed(problem.phi, system, problem.region, network=network)


def settle(problem: Problem, realisation: int, work: Work) -> Settled:
    """Let beads come to rest. Raises ``UnfinishedError`` where they don't."""
    grains, supports = start(problem, realisation)
    work.did("balanced", problem.region.beads)
    if supports is not None:
        forces = balanced(grains, supports)
        if forces.min() >= -SLACK * np.abs(forces).max():
            return Settled(grains, supports)
    must_hold(grains)
    before, most = grains.energy(), problem.most_programs or MOST_PROGRAMS
    near, forces, programs = relax(grains, most, _limited(problem, work))
    touching = grains.gaps(near) < NEARLY
    contacts = _bearing(grains, near[touching], forces[touching])
    _close(grains, contacts)
    _free(grains, grains.rattlers(contacts))
    return Settled(grains, contacts, programs, before - grains.energy())


def _limited(problem: Problem, work: Work) -> Callable[[int], None]:
    """Tell progress, and give up after the seconds that the scene allows."""
    begin, seconds = process_time(), problem.most_seconds

    def progress(programs: int) -> None:
        work.did(f"linear programs: {programs}", 0)
        if seconds is not None and process_time() - begin > seconds:
            raise UnfinishedError(
                f"not at rest after effects.most_seconds = {short(seconds)} and {programs} "
                "linear programs"
            )

    return progress


def balanced(grains: Grains, contacts: Pairs) -> Array:
    """Balance the forces of as many contacts as there are coordinates of the beads they hold."""
    place = grains.coordinates(grains.backbone(contacts))
    factors = grains.factors(contacts, place)
    return np.asarray(factors.solve(-grains.weights[place], trans="T"))


def _bearing(grains: Grains, pairs: Pairs, forces: Array) -> Pairs:
    """Pick the contacts that bear force: as many, the largest first, as make a rigid packing."""
    order = np.argsort(-forces, kind="stable")[: np.count_nonzero(forces > 0)]
    candidates, sizes = pairs[order], forces[order]
    beads = np.zeros(len(grains.radii), dtype=bool)
    beads[: grains.fixed] = True
    count, best = None, 0.0
    free = 0
    for k, pair in enumerate(candidates):
        free += int(np.count_nonzero(~beads[pair]))
        beads[pair] = True
        following = sizes[k + 1] if k + 1 < len(sizes) else 1e-250
        if k + 1 == 2 * free and sizes[k] / following > best:
            count, best = k + 1, sizes[k] / following
    if count is None:
        raise UnfinishedError(
            "degenerate: a strict minimum needs as many contacts with force as their beads have "
            "coordinates, and there is no such set; some force may be exactly zero"
        )
    return np.asarray(candidates[:count])


def _close(grains: Grains, contacts: Pairs) -> None:
    """Close the gaps of the contacts by Newton's method."""
    place = grains.coordinates(grains.backbone(contacts))
    for _ in range(ITERATIONS):
        gaps = grains.gaps(contacts)
        if np.abs(gaps).max() < CLOSED:
            return
        move = np.zeros(grains.unknowns)
        move[place] = -grains.factors(contacts, place).solve(gaps)
        grains.move(move)
        if not np.abs(move).max() < 1:
            break
    raise UnfinishedError("degenerate: the contacts that bear force can't all be closed at once")


def _free(grains: Grains, rattlers: Array) -> None:
    """Move rattlers away from what they touch: no load presses them anywhere."""
    for _ in range(5):
        pairs = grains.near(0.5)
        pairs = pairs[np.isin(pairs, rattlers).any(axis=1)]
        if not len(pairs):
            return
        place = grains.coordinates(rattlers)
        A = grains.jacobian(pairs)[:, place]
        widened = np.concatenate([-A.toarray(), np.ones((len(pairs), 1))], axis=1)
        cost = np.zeros(widened.shape[1])
        cost[-1] = -1
        bounds = [(-0.1, 0.1)] * (widened.shape[1] - 1) + [(None, 0.1)]
        result = linprog(cost, A_ub=widened, b_ub=grains.gaps(pairs), bounds=bounds, method="highs")
        if result.status:
            return
        move = np.zeros(grains.unknowns)
        move[place] = result.x[:-1]
        grains.move(move)
