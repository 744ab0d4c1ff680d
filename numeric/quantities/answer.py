"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ..arithmetic.carried import NONE, Pairs, Sizes
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..disorder.radii import ArrayRadii, RadiusError
from ..lattice.branch import AxisContact, Contact
from ..mechanics.engine import chunk_size, packings
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route, Solved
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import ESTIMATE, Work
from ..unilateral.network import Network, Relaxed
from .base import RATIO, Quantity, Table

# What the sweeps raise for a packing that can't be built.
UNBUILDABLE = (UnbuildableError, NotStandingError, RadiusError)
Bins = list[tuple[Fraction, Fraction, int]]


@dataclass(frozen=True)
class Answer:
    """Rows of numbers; (low, high, count) of a histogram's bins, None for other quantities.

    ``physical``: None where nothing exact was solved, or the same packings a second time.
    ``network``: where beads came to rest under unilateral contacts. Where sweeps carried their
    errors, ``exact`` is the table with them, in a longer arithmetic, and ``sizes`` how large they
    were; or ``left`` says how far changes are from those in it.
    """

    table: Table
    bins: Bins | None
    physical: Physicality | None
    network: Network | None = None
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
    longer: NumberSystem | None = None,
) -> Answer:
    """Answer a question for some realisations.

    With a ``longer`` arithmetic, ``system`` is float64 and numbers carry their errors.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    work.uses(system.name)
    asked = _Asked(quantity, problem, realisations, system, work, longer)
    with system.active(), asked.own.active():
        found = asked.gathered()
        table, physical = found.table, found.physical
        bins = None if work.repeating else quantity.bins_of(table, system)
    if problem.route == Route.ORDERED:
        table, bins = _of_all(quantity.scene.ask.realisations, table, bins)
    if physical is not None and physical.first_tensile is not None:
        physical.first_tensile = at_home(quantity, physical.first_tensile)
    return replace(found, table=table, bins=bins)


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

    def gathered(self) -> Answer:
        """Gather the rows, and look whether packings are physical, if they are exact."""
        quantity, system, longer = self.quantity, self.system, self.longer
        layers, physical = quantity.all_layers, None
        if self.problem.route == Route.EXACT and not self.work.repeating:
            physical = Physicality(looks_at=self.realisations)
        gatherer = quantity.gatherer(self.problem, system)
        beside = None if longer is None else quantity.gatherer(self.problem, longer)
        network: Network | None = None
        sizes = NONE
        for solved, chunk in self.packings(physical):
            pairs = isinstance(system, Pairs)
            gatherer.add(solved.longer(system) if pairs else solved, chunk, layers)
            if beside is not None and longer is not None and gatherer.left() is None:
                with self.work.timed(ESTIMATE):
                    beside.add(solved.longer(longer), chunk, layers)
            sizes |= solved.sizes
            if isinstance(solved, Relaxed):
                network = solved.network
        table, exact = self.finished(gatherer.table(), system), None
        left = gatherer.left() if beside is not None else None
        if beside is not None and longer is not None and left is None:
            with self.work.timed(ESTIMATE):
                exact = self.finished(beside.table(), longer)
        return Answer(table, None, physical, network, exact, sizes, left)

    def finished(self, table: Table, system: NumberSystem) -> Table:
        """Give the rows in order, by name and in units."""
        table = in_units(self.quantity, table.sorted(), system)
        return table if table.index else replace(table, index=self.quantity.names)

    def packings(self, physical: Physicality | None) -> Packings:
        """Solve packings, at which ``physical`` looks; errors say which packing it was."""
        problem, realisations, work, done = self.problem, self.realisations, self.work, 0
        if problem.route == Route.UNILATERAL:
            from ..unilateral.relaxation import relaxed  # SciPy's solvers take 35 MB

            assert isinstance(self.system, Balls)
            (realisation,) = realisations
            yield relaxed(problem, realisation, self.system, work), realisations
            return
        try:
            for solved, chunk in packings(
                problem, realisations, self.own, work, physical,
                carried=self.carried, copied=True,
            ):  # fmt: skip
                yield solved, chunk
                done += len(chunk)
        except UNBUILDABLE as error:
            if len(realisations) > 1:
                error.add_note(_which(problem, realisations[done:], self.own))
            raise


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


def at_home(quantity: Quantity, contact: Contact | AxisContact) -> Contact | AxisContact:
    """Name a contact by the column within the period, as rows do."""
    if isinstance(contact, AxisContact):
        return contact
    return contact._replace(i=quantity.naming.home(contact.i))


def _which(problem: Problem, realisations: Sequence[int], system: NumberSystem) -> str:
    """Name the first packing that can't be built, of those that were solved together."""
    word = "packing" if isinstance(problem.radii, ArrayRadii) else "realisation"
    for k in realisations[: chunk_size(problem, system)]:
        try:
            list(packings(problem, [k], system))
        except UNBUILDABLE:
            return f"{word} {k}"
    return f"of {word}s {realisations[0]} on"
