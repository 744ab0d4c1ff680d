"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from ..arithmetic.carried import NONE, Sizes
from ..arithmetic.systems import Balls, NumberSystem
from ..disorder.radii import ArrayRadii, RadiusError
from ..lattice.branch import AxisContact, Contact
from ..mechanics.engine import chunk_size, packings
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route, Solved
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import Work
from ..unilateral.network import Network, Relaxed
from .base import RATIO, Quantity, Table

# What the sweeps raise for a packing that can't be built.
UNBUILDABLE = (UnbuildableError, NotStandingError, RadiusError)
Bins = list[tuple[Fraction, Fraction, int]]


@dataclass(frozen=True)
class Answer:
    """Rows of numbers; (low, high, count) of a histogram's bins, None for other quantities.

    ``physical``: None where nothing exact was solved, or the same packings a second time.
    ``network``: where beads came to rest under unilateral contacts. ``sizes``: those of the errors
    that sweeps carried, if they did.
    """

    table: Table
    bins: Bins | None
    physical: Physicality | None
    network: Network | None = None
    sizes: Sizes = NONE


def answer(
    quantity: Quantity,
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work | None = None,
    *,
    carried: bool = False,
) -> Answer:
    """Answer a question for some realisations; ``carried``: numbers, float64, carry their errors.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    work.uses(system.name)
    physical, network, sizes, bins = None, None, NONE, None
    if problem.route == Route.EXACT and not work.repeating:
        physical = Physicality(looks_at=realisations)
    gatherer = quantity.gatherer(problem, system)
    with system.active():
        for solved, chunk in _solved(problem, realisations, system, work, physical, carried):
            gatherer.add(solved, chunk)
            sizes |= solved.sizes
            if isinstance(solved, Relaxed):
                network = solved.network
        table = in_units(quantity, gatherer.table().sorted(), system)
        if not table.index:
            table = replace(table, index=quantity.names)
        if not work.repeating:
            bins = quantity.bins_of(table, system)
    if problem.route == Route.ORDERED:
        table, bins = _of_all(quantity.scene.ask.realisations, table, bins)
    if physical is not None and physical.first_tensile is not None:
        physical.first_tensile = at_home(quantity, physical.first_tensile)
    return Answer(table, bins, physical, network, sizes)


def _solved(
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work,
    physical: Physicality | None,
    carried: bool,
) -> Iterator[tuple[Solved, Sequence[int]]]:
    """Solve packings, at which ``physical`` looks; errors say which packing it was."""
    if problem.route == Route.UNILATERAL:
        from ..unilateral.relaxation import relaxed  # SciPy's solvers take 35 MB

        assert isinstance(system, Balls)
        (realisation,) = realisations
        yield relaxed(problem, realisation, system, work), realisations
        return
    done = 0
    try:
        for solved, chunk in packings(
            problem, realisations, system, work, physical, carried=carried, copied=True
        ):
            yield solved, chunk
            done += len(chunk)
    except UNBUILDABLE as error:
        if len(realisations) > 1:
            error.add_note(_which(problem, realisations[done:], system))
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
