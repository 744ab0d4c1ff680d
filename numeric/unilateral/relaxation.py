"""Packings without tension: a start, a protocol, and a certificate of where it ends."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from time import process_time
from typing import Literal

import numpy as np
from scipy.optimize import linprog

from ..arithmetic.decimals import short
from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls, NumberSystem
from ..disorder.radii import rows_of
from ..lattice.layers import column, whole
from ..mechanics.engine import solve
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route, Solved, axes
from ..mechanics.work import Work
from . import event_driven, interior_path, linear_programs
from .certificate import Certificate, certify, smallest_gap
from .grains import Grains, Pairs
from .linear_programs import NO_FORCE
from .network import Frame, Network, Relaxed, UnfinishedError
from .starts import dropped, in_pockets, lattice_contacts, loads_of, must_hold, sites, start

# Gaps up to this, in units of r, may be contacts after the linear programs.
NEARLY = 1e-5
# Forces that are this small, as a share of the largest, are never told from zero.
ZERO = 1e-60


@dataclass(frozen=True)
class Rung:
    """One way to where beads rest: a ``start``, and what moves them from there."""

    start: Literal[
        "the deposited packing",
        "a stretched lattice",  # where the deposited packing can't be built, or overlaps
        "the end of an interior path",
        "beads dropped one by one",
        "pockets of the base",
    ]
    by: Literal["linear programs", "events", "nothing"]

    def __str__(self) -> str:
        """Name it."""
        return self.start if self.by == "nothing" else f"{self.by} from {self.start}"


_PROGRAMS = Rung("the deposited packing", "linear programs")
_EVENTS = Rung("the deposited packing", "events")
PROTOCOLS = {
    "linear-programs": (_PROGRAMS,),
    "interior-path": (
        Rung("the end of an interior path", "nothing"),
        Rung("the end of an interior path", "linear programs"),
    ),
    "event-driven": (_EVENTS,),
    "event-ladder": (_EVENTS, Rung("beads dropped one by one", "events")),
    "ladder": (
        _PROGRAMS,
        Rung("beads dropped one by one", "linear programs"),
        Rung("pockets of the base", "nothing"),
    ),
}


@dataclass
class RelaxedPacking:
    """Where beads came to rest, in float64: what a longer arithmetic starts from."""

    grains: Grains
    contacts: Pairs
    backbone: Array
    rattlers: Array
    events: int
    fall: float
    rung: Rung


class GivenUpError(UnfinishedError):
    """What the user allows was not enough: no other rung is tried."""


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
        work.kept[realisation] = Search(problem, realisation, work)
    search: Search = work.kept[realisation]
    while settled := search.settled(work):
        try:
            with work.timed("certify"):
                network = _certified(problem, realisation, settled, system)
        except UnfinishedError as error:
            search.refuse(settled.rung, error)
        else:
            return Relaxed(system, None, None, None, network=network)
    return _as_deposited(problem, realisation, system)


def settle(problem: Problem, realisation: int, work: Work) -> RelaxedPacking | None:
    """Let beads come to rest; None where the deposited packing has neither tension nor overlap."""
    return Search(problem, realisation, work).settled(work)


class Search:
    """The rungs of a protocol for one packing, one after the other, until one answers.

    What a rung found is kept until a proof refuses it. Raises ``UnfinishedError`` where nothing can
    stand, or no rung is left.
    """

    def __init__(self, problem: Problem, realisation: int, work: Work) -> None:
        self.problem = problem
        self.grains, self.supports, self.overlaps = start(problem, realisation)
        for row in problem.region.rows:
            work.did("radii", row)
            work.did("balanced", row)
        self.events, self.seconds = 0, 0.0
        self.refused: list[tuple[Rung, UnfinishedError]] = []
        self.found: RelaxedPacking | None = None
        self.path: tuple[Array, Pairs, Array] | None = None  # centres where it ended, pairs, λ/g
        self.as_deposited = False
        if self.supports is not None and not self.overlaps:
            forces = balanced(self.grains, self.supports)
            self.as_deposited = forces.min() >= -event_driven.SLACK * np.abs(forces).max()
        if not self.as_deposited:
            must_hold(self.grains)

    def settled(self, work: Work) -> RelaxedPacking | None:
        """Give where beads rest by the first rung that answers; None as for ``settle``."""
        rungs = PROTOCOLS[self.problem.protocol]
        while self.found is None and not self.as_deposited:
            if len(self.refused) == len(rungs):
                raise self._nothing_left()
            rung = rungs[len(self.refused)]
            if rung == _PROGRAMS and self.supports is None:
                rung = replace(rung, start="a stretched lattice")
            with work.timed("relax"):
                try:
                    self.found = self._at_rest(rung, work)
                except GivenUpError:
                    raise
                except UnfinishedError as error:
                    self.refuse(rung, error)
        return self.found

    def refuse(self, rung: Rung, error: UnfinishedError) -> None:
        """Note why a rung has no answer; the next one is tried."""
        self.refused.append((rung, error))
        self.found = None

    def _nothing_left(self) -> UnfinishedError:
        more = "none is known, and none is proved to be impossible"
        if len(self.refused) == 1:
            more = 'protocol = "ladder", or "event-ladder", tries more ways'
        tried = "; ".join(f"{rung}: {error}" for rung, error in self.refused)
        return UnfinishedError(f"no packing was found ({more}). {tried}")

    def _at_rest(self, rung: Rung, work: Work) -> RelaxedPacking:
        """Go one way."""
        problem, begin, events = self.problem, process_time() - self.seconds, 0

        def progress(now: int) -> None:
            nonlocal events
            events = now
            if work.progress is not None:
                work.progress(f"{rung}: {events}", 0)
            most, seconds = problem.most_events, problem.most_seconds
            if most is not None and self.events + events > most:
                raise GivenUpError(f"not at rest after effects.most_events = {most}")
            if seconds is not None and process_time() - begin > seconds:
                raise GivenUpError(
                    f"not at rest after effects.most_seconds = {short(seconds)}; "
                    f"events: {self.events + events}"
                )

        grains = replace(self.grains)
        try:
            contacts = self._placed(rung, grains)
            before = grains.energy()
            if rung.start == "the end of an interior path":
                if self.path is None:
                    pairs, firmness = interior_path.follow(grains, progress)
                    self.path = grains.x, pairs, firmness
                grains.x, pairs, firmness = self.path
                if rung.by == "nothing":
                    contacts = _bearing(grains, pairs, firmness)
                    contacts = contacts[np.argsort(grains.named(contacts))]  # not by rounding
            if rung.by == "linear programs":
                steps = events
                near, forces = linear_programs.relax(grains, lambda n: progress(steps + n))
                touching = grains.gaps(near) < NEARLY
                contacts = _bearing(grains, near[touching], forces[touching])
            elif rung.by == "events":
                if contacts is None:
                    wrong = f"has {self.overlaps} overlaps" if self.overlaps else "can't be built"
                    raise UnfinishedError(f"the deposited packing {wrong}, and events start there")
                contacts, forces = event_driven.relax(grains, contacts, progress)
                contacts = contacts[forces > NO_FORCE * forces.max()]
        finally:
            self.events, self.seconds = self.events + events, process_time() - begin
        assert contacts is not None
        free = np.arange(grains.fixed, len(grains.radii))
        touched = np.isin(free, contacts)
        backbone, rattlers = free[touched], free[~touched]
        if len(contacts) != 2 * len(backbone):
            raise UnfinishedError(
                f"degenerate: {len(contacts)} contacts bear force and their beads have "
                f"{2 * len(backbone)} coordinates: a strict minimum needs as many; some force may "
                "be exactly zero"
            )
        _close(grains, contacts, backbone)
        _free(grains, rattlers)
        fall = before - grains.energy()
        return RelaxedPacking(grains, contacts, backbone, rattlers, events, fall, rung)

    def _placed(self, rung: Rung, grains: Grains) -> Pairs | None:
        """Put beads where a rung starts; give contacts that are closed, if all can be."""
        if rung.start == "beads dropped one by one":
            return dropped(grains, sites(self.problem))
        if rung.start == "pockets of the base":
            return in_pockets(grains)
        return None if self.overlaps else self.supports


def balanced(grains: Grains, contacts: Pairs, backbone: Array | None = None) -> Array:
    """Balance the forces of as many contacts as there are coordinates of the beads that bear them.

    ``backbone``: the numbers of those beads, by default all free ones.
    """
    place = slice(None) if backbone is None else grains.coordinates(backbone)
    factors = grains.factors(contacts, place)
    return np.asarray(factors.solve(-grains.weights[place], trans="T"))


def _bearing(grains: Grains, pairs: Pairs, sizes: Array) -> Pairs:
    """Pick the contacts that bear force: as many, the largest first, as make a rigid packing.

    ``sizes``: of their forces, or what else is larger the surer a pair bears one.
    """
    order = np.argsort(-sizes, kind="stable")[: np.count_nonzero(sizes > 0)]
    candidates, sizes = pairs[order], sizes[order]
    beads = np.zeros(len(grains.radii), dtype=bool)
    beads[: grains.fixed] = True
    found, best = None, 0.0
    free = 0
    for k, pair in enumerate(candidates):
        free += int(np.count_nonzero(~beads[pair]))
        beads[pair] = True
        following = sizes[k + 1] if k + 1 < len(sizes) else 1e-250
        if k + 1 == 2 * free and sizes[k] / following > best:
            found, best = k + 1, sizes[k] / following
    if found is None:
        raise UnfinishedError("degenerate: no rigid set of contacts bears force at the end")
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
    raise UnfinishedError("degenerate: the contacts that bear force can't all be closed at once")


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
        loads_of(problem, region, system),
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
        largest = max(float(force.mid()) for force in found.forces)
        if any(abs(force) < ZERO * largest for force in found.forces if not force > 0):
            raise UnfinishedError(
                f"degenerate: a contact bears less than {ZERO:g} of the largest force, if any"
            )
        raise UndecidedError("the enclosures are too wide to tell whether all forces are positive")
    smallest = smallest_gap(found.x, known, contacts)
    assert problem.width is not None
    return Network(
        problem.width, found.x, contacts, found.forces, settled.rattlers, settled.events,
        settled.fall, smallest, known, found.kantorovich, str(settled.rung),
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
    width, nx, ny = problem.width, *axes(problem.n_x, system)
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
    smallest = smallest_gap(x, known, lattice_contacts(width, problem.height))
    network = Network(
        width, x, pairs_array, out[bearing], rattlers, 0, 0.0, smallest, known
    )  # fmt: skip
    return Relaxed(system, packing, forces, None, network=network)
