"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from ..arithmetic.systems import NumberSystem
from ..lattice.branch import Contact
from ..mechanics.engine import packings
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route
from ..mechanics.work import Work
from .base import Quantity, Table


@dataclass(frozen=True)
class Answer:
    """Rows of numbers; (low, high, count) of a histogram's bins, None for other quantities.

    ``physical``: None where nothing exact was solved, or the same packings a second time.
    ``stopped``: the contact at which a sweep stopped, if it was asked to.
    """

    table: Table
    bins: list[tuple[Fraction, Fraction, int]] | None
    physical: Physicality | None
    stopped: Contact | None


def answer(
    quantity: Quantity,
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work | None = None,
    *,
    plainly: bool = False,
) -> Answer:
    """Answer a question for some realisations; ``plainly`` solves them in the plain form.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    work.uses(system.name)
    exact = problem.route == Route.EXACT
    physical = Physicality() if exact and not work.repeating else None
    stopped = None
    with system.active():
        gatherer = quantity.gatherer(problem, system)
        solved_all = packings(problem, realisations, system, work, physical, plainly=plainly)
        for solved, chunk in solved_all:
            if solved.forces is not None and stopped is None:
                stopped = solved.forces.stopped
            gatherer.add(solved, chunk)
        table = gatherer.table()
        bins = None if work.repeating else quantity.bins_of(table, system)
    return Answer(table, bins, physical, stopped)
