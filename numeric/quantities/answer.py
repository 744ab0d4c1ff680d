"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from ..arithmetic.carried import NONE, Pairs, Sizes
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import ArrayRadii, RadiusError
from ..lattice.branch import AxisContact, Contact
from ..mechanics.engine import chunk_size, packings
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route, Solved
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import ESTIMATE, Work
from ..statistics.histogram import counted, edges_between
from ..unilateral.network import Network, Relaxed, UnfinishedError
from .base import RATIO, Quantity, Table
from .histogram import Histogram
from .parts import Part, joined

if TYPE_CHECKING:
    from ..mechanics.segments import Kept

# What the sweeps raise for a packing that can't be built.
UNBUILDABLE = (UnbuildableError, NotStandingError, RadiusError)
Bins = list[tuple[Fraction, Fraction, int]]


@dataclass(frozen=True)
class Answer:
    """Rows of numbers; (low, high, count) of a histogram's bins, None for other quantities.

    ``physical``: None where nothing exact was solved, or the same packings a second time.
    ``stopped``: the contact at which a sweep stopped, if it was asked to. ``networks``: where beads
    came to rest, one a realisation, under unilateral contacts. Where sweeps carried their errors,
    ``exact`` is the table with them, in a longer arithmetic, and ``sizes`` how large they were;
    or ``left`` says how far changes are from those in it.
    """

    table: Table
    bins: Bins | None
    physical: Physicality | None
    stopped: Contact | AxisContact | None
    networks: tuple[Network, ...] = ()
    exact: Table | None = None
    sizes: Sizes = NONE
    left: float | None = None


def answer(
    quantity: Quantity,
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work | None = None,
    *,
    plainly: bool = False,
    longer: NumberSystem | None = None,
    kept: "Kept | None" = None,
) -> Answer:
    """Answer a question for some realisations; ``plainly`` solves them in the plain form.

    With a ``longer`` arithmetic, ``system`` is float64 and numbers carry their errors. What is
    ``kept`` of a sweep by segments may be that of an earlier run.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    work.uses(system.name)
    asked = _Asked(quantity, problem, realisations, system, work, longer)
    networks: list[Network] = []
    bins: Bins | None = None
    with system.active(), asked.own.active():
        if problem.segment:
            part, bins = _by_segments(asked, kept)
        else:
            physical = asked.physical
            solved_all = _whole(asked, plainly, physical, networks)
            part = asked.gathered(solved_all, quantity.all_layers, physical)
        table = named(quantity, part.table)
        again = None if part.exact is None else named(quantity, part.exact)
        if bins is None and not work.repeating:
            bins = quantity.bins_of(table, system)
    if problem.route == Route.ORDERED:
        table, bins = _of_all(quantity.scene.ask.realisations, table, bins)
    physical, stopped = part.physical, part.stopped
    if physical is not None and physical.first_tensile is not None:
        physical.first_tensile = at_home(quantity, physical.first_tensile)
    stopped = None if stopped is None else at_home(quantity, stopped)
    return Answer(table, bins, physical, stopped, tuple(networks), again, part.sizes, part.left)


Packings = Iterator[tuple[Solved, Sequence[int]]]


@dataclass(frozen=True)
class _Asked:
    """What is asked of a sweep, in which arithmetic its numbers are gathered."""

    quantity: Quantity
    problem: Problem
    realisations: Sequence[int]
    system: NumberSystem
    work: Work
    longer: NumberSystem | None

    @property
    def carried(self) -> bool:
        """Whether sweeps carry their errors."""
        return self.longer is not None or isinstance(self.system, Pairs)

    @property
    def own(self) -> NumberSystem:
        """The arithmetic of the sweep."""
        return FLOAT64 if self.carried else self.system

    @property
    def physical(self) -> Physicality | None:
        """Where it is looked whether packings are physical, if it is."""
        exact = self.problem.route == Route.EXACT
        return Physicality() if exact and not self.work.repeating else None

    def gathered(self, packings: Packings, layers: range, physical: Physicality | None) -> Part:
        """Gather the rows that follow from some layers; ``physical`` looks at each packing."""
        quantity, system, longer = self.quantity, self.system, self.longer
        gatherer = quantity.gatherer(self.problem, system)
        beside = None if longer is None else quantity.gatherer(self.problem, longer)
        stopped: Contact | AxisContact | None = None
        sizes = NONE
        for solved, chunk in packings:
            if solved.forces is not None and stopped is None:
                stopped = solved.forces.stopped
            pairs = isinstance(system, Pairs)
            gatherer.add(solved.longer(system) if pairs else solved, chunk, layers)
            if beside is not None and longer is not None and gatherer.left() is None:
                with self.work.timed(ESTIMATE):
                    beside.add(solved.longer(longer), chunk, layers)
            sizes |= solved.sizes
        table, exact = in_units(quantity, gatherer.table().sorted(), system), None
        left = gatherer.left() if beside is not None else None
        if beside is not None and longer is not None and left is None:
            with self.work.timed(ESTIMATE):
                exact = in_units(quantity, beside.table().sorted(), longer)
        return Part(table, physical, exact, left, sizes, stopped)


def _whole(
    asked: _Asked, plainly: bool, physical: Physicality | None, networks: list[Network]
) -> Packings:
    """Solve whole packings, and collect their ``networks``; errors say which packing it was."""
    problem, realisations, work, own = asked.problem, asked.realisations, asked.work, asked.own
    if problem.route == Route.UNILATERAL:
        from ..unilateral.relaxation import packings as relaxed  # SciPy's solvers take 35 MB

        solved_all = relaxed(problem, realisations, asked.system, work)
    else:
        solved_all = packings(
            problem, realisations, own, work, physical, plainly=plainly, carried=asked.carried,
            copied=True,
        )  # fmt: skip
    done = 0
    try:
        for solved, chunk in solved_all:
            if isinstance(solved, Relaxed):
                networks.append(solved.network)
            yield solved, chunk
            done += len(chunk)
    except (*UNBUILDABLE, UnfinishedError) as error:
        if problem.route == Route.UNILATERAL and len(realisations) > 1:
            error.add_note(f"realisation {realisations[done]}; an ensemble leaves such out")
        elif len(realisations) > 1:
            error.add_note(_which(problem, realisations[done:], own, plainly))
        raise


def _by_segments(asked: _Asked, kept: "Kept | None") -> tuple[Part, Bins | None]:
    """Solve one packing segment by segment, from the top; all changes are counted on a second way.

    Gives the answer, of which a histogram has the extremes alone, and its bins.
    """
    from ..mechanics.segments import InMemory, Segments

    quantity, work = asked.quantity, asked.work
    counts = isinstance(quantity, Histogram) and not quantity.single
    store: Kept = InMemory() if kept is None else kept
    (realisation,) = asked.realisations
    way = Segments(asked.problem, realisation, work, store, again=counts)
    numbers = range(way.count - 1, -1, -1)
    missing = next((n for n in numbers if Part.of(store, n) is None), None)
    if missing is not None:
        way.up(missing)
    parts: list[Part] = []
    for number in numbers:
        part = Part.of(store, number)
        if part is None:
            physical = Physicality(looks_at=asked.realisations)
            solved = way.packings(number, physical)
            part = asked.gathered(solved, way.layers_of(number), physical).measured()
            part = part.extremes() if counts else part
            if kept is not None:
                part.keep(kept, number)
            way.leave(number)
        parts.insert(0, part)
    found = joined(parts)
    if not counts or not found.table.rows:
        return found, [] if counts else None
    assert isinstance(quantity, Histogram)
    found = found.extremes()
    low, high = found.table.numbers["change"].tolist()
    edges = edges_between(low, high, quantity.bins)
    count = np.zeros(len(edges) - 1)
    for number in numbers:
        own = store.get(f"counts{number}")
        if own is None:
            part = asked.gathered(way.packings(number, None), way.layers_of(number), None)
            own = counted(part.table.numbers["change"], edges)
            store.put(f"counts{number}", own)
            way.leave(number)
        count += own
    return found, list(zip(edges[:-1], edges[1:], map(int, count), strict=True))


def _of_all(alike: int, table: Table, bins: Bins | None) -> tuple[Table, Bins | None]:
    """Count all realisations where they are alike, and one was solved."""
    index = {k: v * alike if k == "samples" else v for k, v in table.index.items()}
    counted = None if bins is None else [(low, high, count * alike) for low, high, count in bins]
    return replace(table, index=index), counted


def in_units(quantity: Quantity, table: Table, system: NumberSystem) -> Table:
    """Give forces in the unit in which the load's magnitude is written."""
    magnitude = quantity.scene.load.magnitude
    if not quantity.needs_forces or magnitude == 1:
        return table
    factor = system.scalar(magnitude)
    errors = float(magnitude) if magnitude < 10**300 else np.inf
    return Table(
        table.index,
        {k: v if k == RATIO else v * factor for k, v in table.numbers.items()},
        table.small,
        {k: v * errors for k, v in table.errors.items()},
    )


def named(quantity: Quantity, table: Table) -> Table:
    """Give the rows of a whole packing with the columns that name them."""
    return table if table.index else replace(table, index=quantity.names)


def at_home(quantity: Quantity, contact: Contact | AxisContact) -> Contact | AxisContact:
    """Name a contact by the column within the period, as rows do."""
    if isinstance(contact, AxisContact):
        return contact
    return contact._replace(i=quantity.naming.home(contact.i))


def _which(
    problem: Problem, realisations: Sequence[int], system: NumberSystem, plainly: bool
) -> str:
    """Name the first packing that can't be built, of those that were solved together."""
    word = "packing" if isinstance(problem.radii, ArrayRadii) else "realisation"
    for k in realisations[: chunk_size(problem, system)]:
        try:
            list(packings(problem, [k], system, plainly=plainly))
        except UNBUILDABLE:
            return f"{word} {k}"
    return f"of {word}s {realisations[0]} on"
