"""Answers about one large packing: gathered segment by segment."""

import json
import math
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import asdict, astuple, dataclass
from fractions import Fraction
from functools import reduce
from operator import or_
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..accuracy.accuracy import Accuracy
from ..accuracy.repeated import stated
from ..arithmetic.carried import NONE, Sizes
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import AxisContact, Contact, direction
from ..mechanics.physicality import PHYSICAL, Physicality
from ..mechanics.problem import Solved
from ..mechanics.work import Work
from ..planning.plan import Plan
from ..quantities.answer import Answer, at_home, in_units, named
from ..quantities.base import Columns, Table
from ..quantities.histogram import Histogram
from ..scene.source import program_version, source_of
from ..statistics.histogram import counted, edges_between
from .checkpoint import Checkpoint

if TYPE_CHECKING:
    from ..mechanics.segments import Kept, Segment, Segments


@dataclass
class _Part:
    """What a segment adds to the answer: a table, and whether it is physical.

    ``apart``: how far numbers are from those of the longer arithmetic; ``sizes`` of the errors that
    the sweep carried.
    """

    physical: Physicality
    table: Table
    apart: float = 0.0
    sizes: Sizes = NONE

    def keep(self, kept: "Kept", number: int) -> None:
        """Keep it; what was measured first, so that it is whole once its words are there."""
        table = self.table
        parts: dict[str, Columns] = {
            "index": table.index,
            "numbers": table.numbers,
            "errors": table.errors,
        }
        for kind, columns in parts.items():
            for name, column in columns.items():
                kept.put(f"{kind}{number} {name}", column)
        physical = asdict(self.physical)
        del physical["looks_at"]  # the one realisation
        errors = [self.apart, *astuple(self.sizes)]
        words = [physical, [list(columns) for columns in parts.values()], table.small, errors]
        kept.put(f"words{number}", np.frombuffer(json.dumps(words).encode(), np.uint8))

    @classmethod
    def of(cls, kept: "Kept", number: int) -> "_Part | None":
        """Read what was kept, if it was."""
        words = kept.get(f"words{number}")
        if words is None:
            return None
        physical, parts, small, errors = json.loads(words.tobytes())
        found = Physicality(**physical)
        if found.between is not None:
            lower, upper = found.between
            found.between = tuple(lower), tuple(upper)
        if found.first_tensile is not None:
            *site, name = physical["first_tensile"]
            make: Any = Contact if len(site) == 2 else AxisContact
            found.first_tensile = make(*site, direction(name))

        def columns(kind: str, of: list[str]) -> dict[str, Array]:
            columns = {name: kept.get(f"{kind}{number} {name}") for name in of}
            return {name: column for name, column in columns.items() if column is not None}

        index, numbers, scatter = map(columns, ("index", "numbers", "errors"), parts)
        table = Table(index, numbers, tuple(small), scatter)
        return cls(found, table, errors[0], Sizes(*errors[1:]))


def by_segments(plan: Plan, work: Work, checkpoint: Path | None = None) -> tuple[Answer, Accuracy]:
    """Answer a plan of segments; with a ``checkpoint`` file, from where the last run ended.

    Raises ``CheckpointError``, and what the sweeps raise for a packing that can't be built.
    """
    from ..mechanics.segments import InMemory, Segments

    problem, quantity = plan.problem, plan.quantity
    work.uses(FLOAT64.name)
    opened = None if checkpoint is None else Checkpoint(checkpoint, _key(plan))
    with FLOAT64.active(), opened or nullcontext():
        kept: Kept = opened or InMemory()
        counts = isinstance(quantity, Histogram) and not quantity.single
        way = Segments(problem, 0, problem.segment, work, kept, again=counts)
        parts: list[_Part] = []
        missing = [n for n in range(way.count) if _Part.of(kept, n) is None]
        if missing:
            way.up(missing[-1])
        for number in reversed(range(way.count)):
            part = _Part.of(kept, number)
            if part is None:
                part = _part(plan, way.down(number), work, counts=counts)
                if opened is not None:
                    part.keep(kept, number)
                way.leave(number)
            parts.insert(0, part)
        bins: list[tuple[Fraction, Fraction, int]] | None
        if counts:
            table, bins = _counted(plan, way, parts)
        else:
            table = _table(plan, parts)
            bins = quantity.bins_of(table, FLOAT64)
        sizes = reduce(or_, [part.sizes for part in parts], NONE)
        answer = Answer(table, bins, _physical(plan, parts), None, sizes=sizes)
        apart = Fraction(max(part.apart for part in parts))
        return answer, stated(answer, apart, plan)


def _counted(
    plan: Plan, way: "Segments", parts: list[_Part]
) -> tuple[Table, list[tuple[Fraction, Fraction, int]]]:
    """Count all changes into bins, on a second way down; the table has their extremes alone."""
    quantity = plan.quantity
    assert isinstance(quantity, Histogram)
    found = [part.table.numbers["change"] for part in parts if part.table.rows]
    if not found:
        return Table({}, {"change": np.empty(0)}, ("change",)), []
    change = np.array([min(low for low, _ in found), max(high for _, high in found)])
    edges = edges_between(float(change[0]), float(change[1]), quantity.bins)
    counts = np.zeros(len(edges) - 1)
    for number in reversed(range(way.count)):
        own = way.kept.get(f"counts{number}")
        if own is None:
            segment = way.down(number)
            table, _ = _rows(plan, segment, segment.solved)
            own = counted(table.numbers["change"], edges)
            way.kept.put(f"counts{number}", own)
            way.leave(number)
        counts += own
    bins = zip(edges[:-1], edges[1:], map(int, counts), strict=True)
    return Table({}, {"change": change}, ("change",)), list(bins)


def _key(plan: Plan) -> dict[str, Any]:
    """Describe what decides the numbers that are kept."""
    return {
        "scene": source_of(plan.scene),
        "layers": [plan.problem.segment, plan.problem.every],
        "version": program_version(),
    }


def _part(plan: Plan, segment: "Segment", work: Work, *, counts: bool) -> _Part:
    problem, solved = plan.problem, segment.solved
    forces, packing = solved.forces, segment.packing
    assert forces is not None
    layers = range(segment.first, segment.last + 1)
    physical = Physicality()
    with work.timed(PHYSICAL):
        low = packing.region.rows[0].j
        more = packing.region.rows[-1].j < problem.region.top
        there = range(layers.start - low, layers.stop - low)
        physical.look_at_gaps(packing, there, more=more)
        if problem.needs_forces:
            physical.look_at_forces(forces, layers)
    rows = problem.region.rows[layers.start : layers.stop]
    work.did_rows("checked", rows, sum(row.count for row in rows))
    (table, apart), longer = _rows(plan, segment, solved), plan.method.longer
    if apart is None:
        assert longer is not None
        exact, _ = _rows(plan, segment, solved.longer(longer))
        apart = max(
            _above(np.abs(exact.numbers[name] - table.numbers[name]).max(initial=0))
            for name in table.small
        )
    if counts and table.rows:
        change = table.numbers["change"]
        table = Table({}, {"change": np.array([change.min(), change.max()])}, ("change",))
    return _Part(physical, table, apart, solved.sizes)


def _above(value: Any) -> float:
    """Round a number up that may be longer."""
    return math.nextafter(float(value), math.inf) if value else 0.0


def _rows(plan: Plan, segment: "Segment", solved: Solved) -> tuple[Table, float | None]:
    """Give the rows of the answer that a segment has, in its unit, and ``Gatherer.left``."""
    problem, quantity = plan.problem, plan.quantity
    highest = segment.last if segment.number + 1 < segment.of else problem.height
    gatherer = quantity.gatherer(problem, solved.system)
    gatherer.add(solved, [0], range(segment.first, highest + 1))
    return in_units(quantity, gatherer.table().sorted(), solved.system), gatherer.left()


def _table(plan: Plan, parts: list[_Part]) -> Table:
    """Put the rows of all segments below each other; the parts are used up, column by column."""
    tables = [part.table for part in parts if part.table.rows] or [parts[0].table]

    def joined(columns: Sequence[Columns]) -> dict[str, Array]:
        return {n: np.concatenate([one.pop(n) for one in columns]) for n in list(columns[0])}

    index: Columns = joined([table.index for table in tables])
    numbers, small = joined([table.numbers for table in tables]), tables[0].small
    errors = joined([table.errors for table in tables])
    return named(plan.quantity, Table(index, numbers, small, errors, in_order=True))


def _physical(plan: Plan, parts: list[_Part]) -> Physicality:
    """Merge what was found, the lowest layers first."""
    found = Physicality(looks_at=range(1))
    for part in parts:
        found.above(part.physical)
    if found.first_tensile is not None:
        found.first_tensile = at_home(plan.quantity, found.first_tensile)
    return found
