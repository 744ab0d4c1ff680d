"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Protocol

import numpy as np

from ..arithmetic.carried import NONE, Pairs, Sizes
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import ArrayRadii, RadiusError
from ..lattice.branch import AxisContact, Contact
from ..mechanics.engine import chunk_size, packings
from ..mechanics.kept import Kept
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route, Solved
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import ESTIMATE, Work
from ..statistics.bins import counted, edges_between
from ..unilateral import Network, Relaxed, UnfinishedError
from .base import RATIO, Quantity, Table
from .histogram import Histogram
from .parts import Part, joined

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
    kept: Kept | None = None,
) -> Answer:
    """Answer a question for some realisations; ``plainly`` solves them in the plain form.

    With a ``longer`` arithmetic, ``system`` is float64 and numbers carry their errors. What is
    ``kept`` of a sweep by segments may be that of an earlier run.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    work.uses(system.name)
    asked = _Asked(quantity, problem, realisations, system, work, longer)
    counts = problem.segments > 1 and isinstance(quantity, Histogram) and not quantity.single
    networks: list[Network] = []
    with system.active(), asked.own.active():
        sweep: Sweep = _Whole(asked, plainly, networks)
        if problem.segment:
            from ..mechanics.segments import Segments

            (realisation,) = realisations
            store = Kept() if kept is None else kept
            sweep = Segments(problem, realisation, work, store, again=counts)
        part = _swept(asked, sweep, kept, counts=counts)
        table = named(quantity, part.table)
        again = None if part.exact is None else named(quantity, part.exact)
        bins: Bins | None = None
        if counts:
            bins = _counted(asked, sweep, store, table)
        elif not work.repeating:
            bins = quantity.bins_of(table, system)
    if problem.route == Route.ORDERED:
        table, bins = _of_all(quantity.scene.ask.realisations, table, bins)
    physical, stopped = part.physical, part.stopped
    if physical is not None and physical.first_tensile is not None:
        physical.first_tensile = at_home(quantity, physical.first_tensile)
    stopped = None if stopped is None else at_home(quantity, stopped)
    return Answer(table, bins, physical, stopped, tuple(networks), again, part.sizes, part.left)


Packings = Iterator[tuple[Solved, Sequence[int]]]


class Sweep(Protocol):
    """Solves packings part by part, the highest first; a small one is a single part."""

    def up(self, highest: int) -> None:
        """Make ready for the parts up to the ``highest`` that is needed."""

    def layers_of(self, number: int) -> range:
        """Give the layers that a part answers for."""

    def packings(self, number: int, physical: Physicality | None) -> Packings:
        """Solve a part of each packing; ``physical`` looks at it."""

    def leave(self, number: int) -> None:
        """Forget what only that part needed."""


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

    def gathered(self, sweep: Sweep, number: int, *, look: bool) -> Part:
        """Gather the rows of a part, and ``look`` whether it is physical, if it is exact."""
        quantity, system, longer = self.quantity, self.system, self.longer
        layers, physical = sweep.layers_of(number), None
        if look and self.problem.route == Route.EXACT and not self.work.repeating:
            physical = Physicality(looks_at=self.realisations)
        gatherer = quantity.gatherer(self.problem, system)
        beside = None if longer is None else quantity.gatherer(self.problem, longer)
        stopped: Contact | AxisContact | None = None
        sizes = NONE
        for solved, chunk in sweep.packings(number, physical):
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


class _Whole:
    """Whole packings, in one part; ``networks`` are collected, errors say which packing it was."""

    def __init__(self, asked: _Asked, plainly: bool, networks: list[Network]) -> None:
        self.asked, self.plainly, self.networks = asked, plainly, networks

    def up(self, highest: int) -> None:
        """There is nothing below the one part."""

    def leave(self, number: int) -> None:
        """Nothing is kept."""

    def layers_of(self, number: int) -> range:
        """All layers."""
        return self.asked.quantity.all_layers

    def packings(self, number: int, physical: Physicality | None) -> Packings:
        """Solve them."""
        asked, done = self.asked, 0
        problem, realisations, work = asked.problem, asked.realisations, asked.work
        if problem.route == Route.UNILATERAL:
            from ..unilateral import packings as relaxed  # SciPy's solvers take 35 MB

            solved_all = relaxed(problem, realisations, asked.system, work)
        else:
            solved_all = packings(
                problem, realisations, asked.own, work, physical, plainly=self.plainly,
                carried=asked.carried, copied=True,
            )  # fmt: skip
        try:
            for solved, chunk in solved_all:
                if isinstance(solved, Relaxed):
                    self.networks.append(solved.network)
                yield solved, chunk
                done += len(chunk)
        except (*UNBUILDABLE, UnfinishedError) as error:
            if problem.route == Route.UNILATERAL and len(realisations) > 1:
                error.add_note(f"realisation {realisations[done]}; an ensemble leaves such out")
            elif len(realisations) > 1:
                error.add_note(_which(problem, realisations[done:], asked.own, self.plainly))
            raise


def _swept(asked: _Asked, sweep: Sweep, kept: Kept | None, *, counts: bool) -> Part:
    """Gather all parts, from the top; what ``counts`` changes has the extremes alone."""
    parts: list[Part] = []
    numbers = range(asked.problem.segments - 1, -1, -1)
    known = {} if kept is None else {n: Part.of(kept, n) for n in numbers}
    missing = [n for n in numbers if known.get(n) is None]
    if missing:
        sweep.up(missing[0])
    for number in numbers:
        part = known.pop(number, None)
        if part is None:
            part = asked.gathered(sweep, number, look=True)
            if kept is not None or len(numbers) > 1:
                part = part.measured()
            part = part.extremes() if counts else part
            if kept is not None:
                part.keep(kept, number)
            sweep.leave(number)
        parts.insert(0, part)
    found = parts[0] if len(parts) == 1 else joined(parts)
    return found.extremes() if counts else found


def _counted(asked: _Asked, sweep: Sweep, kept: Kept, table: Table) -> Bins:
    """Count all changes, of which the ``table`` has the extremes, on a second way down."""
    assert isinstance(asked.quantity, Histogram)
    if not table.rows:
        return []
    low, high = table.numbers["change"].tolist()
    edges = edges_between(low, high, asked.quantity.bins)
    count = np.zeros(len(edges) - 1)
    for number in reversed(range(asked.problem.segments)):
        own = kept.get(f"counts{number}")
        if own is None:
            part = asked.gathered(sweep, number, look=False)
            own = counted(part.table.numbers["change"], edges)
            kept.put(f"counts{number}", own)
            sweep.leave(number)
        count += own
    return list(zip(edges[:-1], edges[1:], map(int, count), strict=True))


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
    unit = float(magnitude) if magnitude < 10**300 else np.inf
    with np.errstate(all="ignore"):  # standard errors beyond floats are not known
        errors = {k: v * unit for k, v in table.errors.items()}
    numbers = {k: v if k == RATIO else v * factor for k, v in table.numbers.items()}
    return Table(table.index, numbers, table.small, errors)


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
