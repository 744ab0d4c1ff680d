"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ..arithmetic.carried import NONE, Pairs, Sizes
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..disorder.radii import ArrayRadii, RadiusError
from ..lattice.branch import AxisContact, Contact
from ..mechanics.engine import chunk_size, packings
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import ESTIMATE, Work
from ..unilateral.network import Network, Relaxed, UnfinishedError
from .base import RATIO, Quantity, Table

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
) -> Answer:
    """Answer a question for some realisations; ``plainly`` solves them in the plain form.

    With a ``longer`` arithmetic, ``system`` is float64 and numbers carry their errors.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    work.uses(system.name)
    exact = problem.route == Route.EXACT
    physical = Physicality() if exact and not work.repeating else None
    stopped: Contact | AxisContact | None = None
    networks: list[Network] = []
    pairs, carried = isinstance(system, Pairs), longer is not None or isinstance(system, Pairs)
    own = FLOAT64 if carried else system
    sizes = NONE
    with system.active(), own.active():
        gatherer = quantity.gatherer(problem, system)
        beside = None if longer is None else quantity.gatherer(problem, longer)
        if problem.route == Route.UNILATERAL:
            from ..unilateral.relaxation import packings as relaxed  # SciPy's solvers take 35 MB

            solved_all = relaxed(problem, realisations, system, work)
        else:
            solved_all = packings(
                problem, realisations, own, work, physical, plainly=plainly, carried=carried,
                copied=True,
            )  # fmt: skip
        done, layers = 0, quantity.all_layers
        try:
            for solved, chunk in solved_all:
                if solved.forces is not None and stopped is None:
                    stopped = solved.forces.stopped
                if isinstance(solved, Relaxed):
                    networks.append(solved.network)
                gatherer.add(solved.longer(system) if pairs else solved, chunk, layers)
                if beside is not None and longer is not None and gatherer.left() is None:
                    with work.timed(ESTIMATE):
                        beside.add(solved.longer(longer), chunk, layers)
                sizes |= solved.sizes
                done += len(chunk)
        except (*UNBUILDABLE, UnfinishedError) as error:
            if problem.route == Route.UNILATERAL and len(realisations) > 1:
                error.add_note(f"realisation {realisations[done]}; an ensemble leaves such out")
            elif len(realisations) > 1:
                error.add_note(_which(problem, realisations[done:], system, plainly))
            raise
        table = in_units(quantity, named(quantity, gatherer.table()).sorted(), system)
        again = None
        left = gatherer.left() if beside is not None else None
        if beside is not None and longer is not None and left is None:
            with work.timed(ESTIMATE):
                again = in_units(quantity, named(quantity, beside.table()).sorted(), longer)
        bins = None if work.repeating else quantity.bins_of(table, system)
    if problem.route == Route.ORDERED:
        table, bins = _of_all(quantity.scene.ask.realisations, table, bins)
    if physical is not None and physical.first_tensile is not None:
        physical.first_tensile = at_home(quantity, physical.first_tensile)
    stopped = None if stopped is None else at_home(quantity, stopped)
    return Answer(table, bins, physical, stopped, tuple(networks), again, sizes, left)


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
