"""Packings without tension: a start, a protocol, and a certificate of where it ends."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np
from scipy.optimize import linprog

from ..arithmetic.decimals import short
from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import FLOAT64, Array, Balls, NumberSystem, as_floats
from ..disorder.radii import rows_of
from ..lattice.branch import Branch
from ..lattice.layers import Region, column, whole
from ..mechanics import plain
from ..mechanics.engine import solve
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route, Solved
from ..mechanics.sweep import UnbuildableError
from ..mechanics.work import Work
from . import event_driven, linear_programs
from .certificate import Certificate, certify, smallest_gap
from .grains import Grains, Pairs
from .linear_programs import NO_FORCE
from .network import Frame, Network, Relaxed, UnfinishedError

# Gaps up to this, in units of r, may be contacts after the linear programs.
NEARLY = 1e-5


@dataclass
class RelaxedPacking:
    """Where beads came to rest, in float64: what a longer arithmetic starts from."""

    grains: Grains
    contacts: Pairs
    backbone: Array
    rattlers: Array
    events: int
    fall: float


def packings(
    problem: Problem, realisations: Sequence[int], system: NumberSystem, work: Work
) -> Iterator[tuple[Solved, Sequence[int]]]:
    """Solve realisations one after the other; the caller activates ``system``, which is balls.

    Raises ``UnbuildableError``, ``UnfinishedError`` where beads do not come to rest, and
    ``UndecidedError`` where more bits may tell.
    """
    assert isinstance(system, Balls)
    for realisation in realisations:
        yield _one(problem, realisation, system, work), [realisation]


def _one(problem: Problem, realisation: int, system: Balls, work: Work) -> Relaxed:
    if realisation not in work.kept:
        work.kept[realisation] = settle(problem, realisation, work)
    settled = work.kept[realisation]
    if settled is None:
        return _as_deposited(problem, realisation, system)
    with work.timed("certify"):
        return Relaxed(
            system, None, None, None, network=_certified(problem, realisation, settled, system)
        )


def settle(problem: Problem, realisation: int, work: Work) -> RelaxedPacking | None:
    """Let beads come to rest; None where the deposited packing has neither tension nor overlap."""
    grains, supports, overlaps = start(problem, realisation)
    for row in problem.region.rows:
        work.did("radii", row)
        work.did("balanced", row)
    shown, begin = work.progress, process_time()

    def progress(events: int) -> None:
        if shown is not None:
            shown(f"{problem.protocol}: {events}", 0)
        most, seconds = problem.most_events, problem.most_seconds
        if most is not None and events > most:
            raise UnfinishedError(f"not at rest after effects.most_events = {most}")
        if seconds is not None and process_time() - begin > seconds:
            raise UnfinishedError(
                f"not at rest after effects.most_seconds = {short(seconds)}; events: {events}"
            )

    if supports is not None and not overlaps:
        forces = balanced(grains, supports)
        if forces.min() >= -event_driven.SLACK * np.abs(forces).max():
            return None
    _must_hold(grains)
    before = grains.energy()
    with work.timed("relax"):
        if problem.protocol == "event-driven":
            if supports is None or overlaps:
                raise UnfinishedError(
                    "the deposited packing "
                    + ("can't be built" if supports is None else f"has {overlaps} overlaps")
                    + ', and protocol = "event-driven" starts from it: choose "linear-programs"'
                )
            contacts, events = event_driven.relax(grains, supports, progress)
            forces = balanced(grains, contacts)
            bearing = forces > NO_FORCE * forces.max()
            contacts = contacts[bearing]
        else:
            near, forces, events = linear_programs.relax(grains, progress)
            contacts = _bearing(grains, near, forces)
    free = np.arange(grains.fixed, len(grains.radii))
    touched = np.isin(free, contacts)
    backbone, rattlers = free[touched], free[~touched]
    if len(contacts) != 2 * len(backbone):
        raise UnfinishedError(
            f"{len(contacts)} contacts bear force and their beads have {2 * len(backbone)} "
            "coordinates: a strict minimum needs as many; some force may be exactly zero"
        )
    _close(grains, contacts, backbone)
    _free(grains, rattlers)
    return RelaxedPacking(grains, contacts, backbone, rattlers, events, before - grains.energy())


def start(problem: Problem, realisation: int) -> tuple[Grains, Pairs | None, int]:
    """Deposit the beads; a stretched lattice, and no supports, where some can't be deposited."""
    width, height = problem.width, problem.height
    assert width is not None
    region = whole(width, height)
    rho = rows_of(problem.radii, region.rows, [realisation], FLOAT64)
    radii = np.concatenate([1 + row for row in rho])
    nx, ny = (float(n) for n in plain.axes(problem.n_x, FLOAT64))
    load = as_floats(_load(problem, region, FLOAT64))
    i = np.concatenate([row.first + 2 * np.arange(row.count) for row in region.rows])
    j = np.repeat(np.arange(height + 1), width)
    grains = Grains(np.zeros((len(radii), 2)), radii, 4 * nx * width, load, width)
    supports = _supports(width, height)
    try:
        deposited = replace(problem, route=Route.EXACT, needs_forces=False, region=region)
        with np.errstate(all="ignore"):
            packing = solve(deposited, [realisation], FLOAT64, Work()).packing
        assert packing is not None
        plus, minus = (np.concatenate(list(c)) for c in (packing.c.plus, packing.c.minus))
        grains.x = np.stack(
            [2 * nx * i + (plus - minus) / (2 * nx), 2 * ny * j + (plus + minus) / (2 * ny)], axis=1
        )
        near = grains.near(0.1)
        others = near[~np.isin(grains.named(near), grains.named(supports))]
        overlaps = int(np.count_nonzero(grains.gaps(others) < 1e-9))
        if not overlaps or problem.protocol == "event-driven":
            return grains, supports, overlaps
    except UnbuildableError:
        pass
    if radii.min() <= 0:
        raise UnbuildableError((0, 0), "a radius is not positive")
    apart = 2 * float(radii.max()) * (1 + 1e-9)
    if apart >= 8 * nx:
        raise UnfinishedError(
            "no start without overlaps is known: some radius is the spacing or more"
        )
    rise, turn = np.sqrt(max(apart**2 - (2 * nx) ** 2, (2 * ny) ** 2)), np.zeros(width)
    if apart >= 4 * nx:  # neighbours in a layer would overlap: every second one is a step higher
        turn[1::2] = 1
        turn[-1] += width % 2 * 2  # the first follows the last
        rise = apart * (1 + turn.max())
    lift = np.where(j > 0, apart * np.tile(turn, height + 1), 0)
    grains.x = np.stack([2 * nx * i, rise * j + lift], axis=1)
    return grains, None, 0


def _must_hold(grains: Grains) -> None:
    """Raise where beads of the base overlap, or can't push sideways as much as the load does.

    A bead that touches a bead of the base is at its side the further the smaller it is, until it
    touches the next one too; between those two none can fall through.
    """
    base, s = grains.radii[: grains.fixed], grains.period / grains.fixed
    wide = base + np.roll(base, -1) >= s
    if wide.any():
        q = int(np.argmax(wide))
        raise UnfinishedError(
            f"no packing can stand: beads {q} and {(q + 1) % grains.fixed} of the base overlap"
        )
    smallest = grains.radii[grains.fixed :].min()
    one = base + smallest
    sines = []
    for other in (np.roll(one, 1), np.roll(one, -1)):
        if (one + other <= s).any():
            return
        sines.append((s**2 + one**2 - other**2) / (2 * s * one))
    side, up = grains.load[grains.fixed :].sum(axis=0)
    lean, most = np.arctan2(abs(side), -up), np.arcsin(np.max(sines))
    if lean > most + 1e-9:
        raise UnfinishedError(
            f"no packing can stand: the load leans by {np.degrees(lean):.4g}° to the vertical, and "
            f"beads of the base hold others against {np.degrees(most):.4g}° at most"
        )


def _supports(width: int, height: int) -> Pairs:
    """List the contacts of the lattice: each bead above the base with its two supports."""
    pairs = [
        (j * width + q, (j - 1) * width + column(2 * q + j % 2 - branch.side, j - 1, width))
        for j in range(1, height + 1)
        for q in range(width)
        for branch in Branch
    ]
    return np.array(pairs)


def _load(problem: Problem, region: Region, system: NumberSystem) -> Array:
    """Give the Cartesian loads of all beads, (N, 2)."""
    nx, ny = plain.axes(problem.n_x, system)
    rows = region.rows
    loads = problem.load.on(rows, problem.load.strength(problem.n_x, system), system)
    zero = system.number(problem.n_x * 0)
    out = np.full((len(rows) * rows[0].count, 2), zero, dtype=system.dtype)
    for j, (plus, minus) in enumerate(zip(loads.plus, loads.minus, strict=True)):
        if plus is not None:
            own = slice(j * rows[0].count, (j + 1) * rows[0].count)
            out[own, 0], out[own, 1] = (minus - plus) * nx, -(plus + minus) * ny
    return out


def balanced(grains: Grains, contacts: Pairs, backbone: Array | None = None) -> Array:
    """Balance the forces of as many contacts as there are coordinates of the beads that bear them.

    ``backbone``: the numbers of those beads, by default all free ones.
    """
    place = slice(None) if backbone is None else grains.coordinates(backbone)
    factors = grains.factors(contacts, place)
    return np.asarray(factors.solve(-grains.weights[place], trans="T"))


def _bearing(grains: Grains, pairs: Pairs, forces: Array) -> Pairs:
    """Pick the contacts that bear force: as many, the largest first, as make a rigid packing."""
    touching = (grains.gaps(pairs) < NEARLY) & (forces > 0)
    order = np.argsort(-forces[touching], kind="stable")
    candidates, sizes = pairs[touching][order], forces[touching][order]
    beads = np.zeros(len(grains.radii), dtype=bool)
    beads[: grains.fixed] = True
    found, best = None, 0.0
    free = 0
    for k, pair in enumerate(candidates):
        free += int(np.count_nonzero(~beads[pair]))
        beads[pair] = True
        following = sizes[k + 1] if k + 1 < len(sizes) else 1e-300
        if k + 1 == 2 * free and sizes[k] / following > best:
            found, best = k + 1, sizes[k] / following
    if found is None:
        raise UnfinishedError(
            "the linear programs ended where no rigid set of contacts bears force"
        )
    return np.asarray(candidates[:found])


def _close(grains: Grains, contacts: Pairs, backbone: Array) -> None:
    """Close the gaps of the contacts by Newton's method."""
    place = grains.coordinates(backbone)
    for _ in range(event_driven.ITERATIONS):
        gaps = grains.gaps(contacts)
        if np.abs(gaps).max() < event_driven.CLOSED / 5:
            return
        move = np.zeros(grains.unknowns)
        move[place] = grains.factors(contacts, place).solve(gaps)
        grains.x = grains.x.copy()
        grains.x[grains.fixed :] -= move.reshape(-1, 2)
        if not np.abs(move).max() < 1:
            break
    raise UnfinishedError("the contacts that bear force can't all be closed at once")


def _free(grains: Grains, rattlers: Array) -> None:
    """Move rattlers away from what they touch: no load presses them anywhere."""
    if not len(rattlers):
        return
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
        found = linprog(cost, A_ub=widened, b_ub=grains.gaps(pairs), bounds=bounds, method="highs")
        if found.status:
            return
        move = np.zeros(grains.unknowns)
        move[place] = found.x[:-1]
        grains.x = grains.x.copy()
        grains.x[grains.fixed :] += move.reshape(-1, 2)


def _frame(problem: Problem, realisation: int, system: Balls) -> Frame:
    assert problem.width is not None
    region = whole(problem.width, problem.height)
    rho = rows_of(problem.radii, region.rows, [realisation], system)
    return Frame(
        np.concatenate([1 + row for row in rho]),
        _base(problem, system),
        system.number(4 * problem.n_x * problem.width),
        _load(problem, region, system),
    )


def _certified(
    problem: Problem, realisation: int, settled: RelaxedPacking, system: Balls
) -> Network:
    grains, contacts = settled.grains, settled.contacts
    known = _frame(problem, realisation, system)
    found: Certificate = certify(grains, contacts, settled.backbone, known, system)
    if not all(force > 0 for force in found.forces):
        if any(force < 0 for force in found.forces):
            raise UnfinishedError("a contact of the settled packing pulls")
        raise UndecidedError("the enclosures are too wide to tell whether all forces are positive")
    smallest = smallest_gap(found.x, known, contacts)
    assert problem.width is not None
    return Network(
        problem.width, found.x, contacts, found.forces, settled.rattlers, settled.events,
        settled.fall, smallest, known, found.kantorovich,
    )  # fmt: skip


def _base(problem: Problem, system: Balls) -> Array:
    """Give the centres of the base, (W, 2)."""
    assert problem.width is not None
    x = np.empty((problem.width, 2), dtype=object)
    for q in range(problem.width):
        x[q, 0] = system.number(4 * problem.n_x * q)
        x[q, 1] = system.number(problem.n_x * 0)
    return x


def _as_deposited(problem: Problem, realisation: int, system: Balls) -> Relaxed:
    """Solve the packing as without the effect: no contact pulls, and nothing moves."""
    deposited = replace(problem, route=Route.EXACT, needs_forces=True)
    solved = solve(deposited, [realisation], system, Work())
    packing, forces = solved.packing, solved.forces
    assert packing is not None
    assert forces is not None
    assert problem.width is not None
    seen = Physicality()
    seen.look_at_forces(forces)
    if seen.tensile:
        raise UnfinishedError("a contact pulls by less than float64 tells")
    if seen.undecided_signs:
        raise UndecidedError("the enclosures are too wide to tell whether a contact pulls")
    width, nx, ny = problem.width, *plain.axes(problem.n_x, system)
    x = np.empty(((problem.height + 1) * width, 2), dtype=object)
    for j, row in enumerate(packing.region.rows):
        plus, minus = packing.c.plus[j], packing.c.minus[j]
        for q, i in enumerate(row.sites()):
            x[j * width + q, 0] = 2 * nx * i + (plus[q] - minus[q]) / (2 * nx)
            x[j * width + q, 1] = 2 * ny * j + (plus[q] + minus[q]) / (2 * ny)
    pairs, values = [], []
    for j, row in enumerate(forces.rows):
        for branch, F, g in forces.below(j):
            for q, i in enumerate(row.sites() if len(F) else ()):
                pairs.append(
                    (j * width + q, (j - 1) * width + column(i - branch.side, j - 1, width))
                )
                values.append(F[q] + g[q])
    bearing = np.array([not (f.rad() == 0 and f == 0) for f in values], dtype=bool)
    pairs_array = np.array(pairs).reshape(-1, 2)[bearing]
    out = np.empty(len(values), dtype=object)
    out[:] = values
    free = np.arange(width, (problem.height + 1) * width)
    rattlers = free[~np.isin(free, pairs_array)]
    known = _frame(problem, realisation, system)
    smallest = smallest_gap(x, known, _supports(width, problem.height))
    network = Network(
        width, x, pairs_array, out[bearing], rattlers, 0, 0.0, smallest, known
    )  # fmt: skip
    return Relaxed(system, packing, forces, None, network=network)
