"""An answer: packings solved, looked at, and gathered as a quantity asks."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..arithmetic.carried import NONE, Sizes
from ..arithmetic.systems import Balls, NumberSystem
from ..disorder.radii import ArrayRadii, BeadError
from ..mechanics.engine import packings
from ..mechanics.physicality import Physicality
from ..mechanics.problem import Problem, Route
from ..mechanics.sweep import Solved
from ..mechanics.work import Work
from ..statistics.bins import histogram
from ..unilateral.network import Network, Relaxed
from .base import RATIO, Quantity, Table
from .histogram import Histogram


class Answer(NamedTuple):
    """Tables of numbers, one a question.

    ``physical``: None where nothing exact was solved, or the same packings a second time.
    ``network``: where beads came to rest under unilateral contacts. ``sizes``: those of the errors
    that sweeps carried, if they did.
    """

    tables: tuple[Table, ...]
    physical: Physicality | None
    network: Network | None = None
    sizes: Sizes = NONE


def answer(
    quantities: Sequence[Quantity],
    problem: Problem,
    realisations: Sequence[int],
    system: NumberSystem,
    work: Work | None = None,
    *,
    carried: bool = False,
) -> Answer:
    """Answer questions about some realisations; ``carried``: numbers, float64, carry their errors.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    work = Work() if work is None else work
    network, sizes = None, NONE
    physical = Physicality() if problem.route == Route.EXACT else None
    gatherers = [quantity.gatherer(problem) for quantity in quantities]
    tables = []
    # an ordered packing is solved once, whatever is asked
    alike = quantities[0].scene.ask.realisations // problem.realisations
    with system.active():
        for solved, chunk in _solved(problem, realisations, system, work, physical, carried):
            for gatherer in gatherers:
                gatherer.add(solved, chunk)
            sizes |= solved.sizes
            if isinstance(solved, Relaxed):
                network = solved.network
        for quantity, gatherer in zip(quantities, gatherers, strict=True):
            table = in_units(quantity, gatherer.table().sorted(), system)
            if "samples" in table.index:
                table.index["samples"] *= alike
            if isinstance(quantity, Histogram):
                bins = histogram(table.numbers["change"], quantity.bins, system)
                table = replace(table, bins=bins._replace(counts=bins.counts * alike))
            tables.append(table)
    return Answer(tuple(tables), physical, network, sizes)


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
            problem, realisations, system, work, physical, carried=carried
        ):
            yield solved, chunk
            done += len(chunk)
    except BeadError as error:
        if len(realisations) > 1:
            word = "packing" if isinstance(problem.radii, ArrayRadii) else "realisation"
            error.add_note(f"{word} {realisations[done + error.place]}")
        raise


def in_units(quantity: Quantity, table: Table, system: NumberSystem) -> Table:
    """Give forces in the unit in which the load's magnitude is written."""
    magnitude = quantity.scene.load.magnitude
    if not quantity.of_forces or magnitude == 1:
        return table
    factor = system.number(magnitude)
    unit = float(magnitude) if magnitude < 10**300 else np.inf
    with np.errstate(all="ignore"):  # standard errors beyond floats are not known
        errors = {k: v * unit for k, v in table.errors.items()}
    numbers = {k: v if k == RATIO else v * factor for k, v in table.numbers.items()}
    return Table(table.index, numbers, table.small, errors)
