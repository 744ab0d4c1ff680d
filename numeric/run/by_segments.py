"""Answers about a packing that the memory does not hold: gathered segment by segment."""

import json
import math
from collections.abc import Iterator
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
from ..lattice.branch import Branch, Contact
from ..lattice.layers import full_layer
from ..mechanics.physicality import PHYSICAL, Physicality
from ..mechanics.problem import Solved
from ..mechanics.work import Work
from ..planning.plan import Plan
from ..quantities.answer import Answer, at_home, in_units
from ..quantities.base import Block, Listed, Table, contact_changes
from ..quantities.histogram import Histogram
from ..quantities.profile import Profile
from ..quantities.response import Response
from ..scene.source import program_version
from ..statistics.histogram import counted, edges_between
from .checkpoint import Checkpoint

if TYPE_CHECKING:
    from ..mechanics.segments import Kept, Segment, Segments


@dataclass
class _Part:
    """What a segment adds to the answer: columns, and whether it is physical.

    ``apart``: how far numbers are from those of the longer arithmetic; ``sizes`` of the errors that
    the sweep carried.
    """

    physical: Physicality
    index: dict[str, list[Any]]
    numbers: dict[str, Array]
    apart: float = 0.0
    sizes: Sizes = NONE

    def keep(self, kept: "Kept", number: int) -> None:
        """Keep it; what was measured first, so that it is whole once its words are there."""
        columns = [np.asarray(column, dtype=float) for column in self.numbers.values()]
        kept.put(f"numbers{number}", np.stack(columns) if columns else np.empty(0))
        physical = asdict(self.physical)
        del physical["looks_at"]  # the one realisation
        errors = [self.apart, *astuple(self.sizes)]
        words = [physical, self.index, list(self.numbers), errors]
        letters = np.frombuffer(json.dumps(words).encode(), np.uint8)
        kept.put(f"words{number}", letters.astype(float))

    @classmethod
    def of(cls, kept: "Kept", number: int) -> "_Part | None":
        """Read what was kept, if it was."""
        words, numbers = kept.get(f"words{number}"), kept.get(f"numbers{number}")
        if words is None or numbers is None:
            return None
        physical, index, names, errors = json.loads(words.astype(np.uint8).tobytes())
        found = Physicality(**physical)
        if found.between is not None:
            lower, upper = found.between
            found.between = (lower[0], lower[1]), (upper[0], upper[1])
        if found.first_tensile is not None:
            i, j, branch = physical["first_tensile"]
            found.first_tensile = Contact(i, j, Branch(branch))
        columns = dict(zip(names, numbers, strict=True))
        return cls(found, index, columns, errors[0], Sizes(*errors[1:]))


def by_segments(plan: Plan, work: Work, checkpoint: Path | None = None) -> tuple[Answer, Accuracy]:
    """Answer a plan of segments; with a ``checkpoint`` file, from where the last run ended.

    Raises ``CheckpointError``, and what the sweeps raise for a packing that can't be built.
    """
    from ..mechanics.segments import KEPT, InMemory, Segments, count

    problem = plan.problem
    work.uses(FLOAT64.name)
    numbers = range(count(problem, problem.segment))
    names = {f"{kind}{n}" for kind in (*KEPT, "numbers", "words", "counts") for n in numbers}
    opened = None if checkpoint is None else Checkpoint(checkpoint, _key(plan), names)
    with FLOAT64.active(), opened or nullcontext():
        kept: Kept = opened or InMemory()
        counts = isinstance(plan.quantity, Histogram)
        way = Segments(problem, 0, problem.segment, work, kept, again=counts)
        parts: list[_Part] = []
        missing = [n for n in range(way.count) if _Part.of(kept, n) is None]
        if missing:
            way.up(missing[-1])
        for number in reversed(range(way.count)):
            part = _Part.of(kept, number)
            if part is None:
                part = _part(plan, way.down(number), work)
                part.keep(kept, number)
            parts.insert(0, part)
        bins = None
        if counts:
            table, bins = _counted(plan, way, parts)
        else:
            table = in_units(plan.quantity, _table(plan, parts).sorted(), FLOAT64)
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
    found = [part.numbers["change"] for part in parts if part.numbers]
    if not found:
        return Table({}, {"change": np.empty(0)}, ("change",)), []
    change = np.array([min(low for low, _ in found), max(high for _, high in found)])
    edges = edges_between(float(change[0]), float(change[1]), quantity.bins)
    counts = np.zeros(len(edges) - 1)
    for number in reversed(range(way.count)):
        own = way.kept.get(f"counts{number}")
        if own is None:
            own = np.zeros(len(counts))
            segment = way.down(number)
            for row in _changes(plan, segment, segment.solved):
                own += counted(row, edges)
            way.kept.put(f"counts{number}", own)
        counts += own
    bins = zip(edges[:-1], edges[1:], map(int, counts), strict=True)
    return Table({}, {"change": change}, ("change",)), list(bins)


def _changes(plan: Plan, segment: "Segment", solved: Solved) -> Iterator[Array]:
    """Give the changes of a segment's contacts, row by row, in the unit of the answer."""
    forces = solved.forces
    assert forces is not None
    assert isinstance(plan.quantity, Histogram)
    rows = range(max(segment.first, 1), min(segment.last + 1, len(forces.rows)))
    for j in filter(plan.quantity.is_asked, rows):
        for _, _, g in forces.below(j):
            if g.size:
                row = Table({}, {"change": np.asarray(g)}, ("change",))
                yield in_units(plan.quantity, row, solved.system).numbers["change"]


def _key(plan: Plan) -> dict[str, Any]:
    """Describe what decides the numbers that are kept."""
    scene = plan.scene.model_dump(mode="json", exclude={"folder": True})
    return {"scene": scene, "layers": plan.problem.segment, "version": program_version()}


def _part(plan: Plan, segment: "Segment", work: Work) -> _Part:
    problem, quantity, solved = plan.problem, plan.quantity, segment.solved
    forces, packing = solved.forces, segment.packing
    assert forces is not None
    layers = range(segment.first, segment.last + 1)
    physical = Physicality()
    with work.timed(PHYSICAL):
        low = packing.region.rows[0].j
        more = packing.region.rows[-1].j < problem.region.top
        there = range(layers.start - low, layers.stop - low)
        physical.look_at_gaps(packing, there, more=more)
        physical.look_at_forces(forces, layers)
    rows = problem.region.rows[layers.start : layers.stop]
    work.did_rows("checked", rows, sum(row.count for row in rows))
    assert plan.method.longer is not None
    longer = solved.longer(plan.method.longer)
    if isinstance(quantity, Histogram):
        apart, extremes = 0.0, []
        both = zip(*(_changes(plan, segment, one) for one in (solved, longer)), strict=True)
        for row, exact in both:
            extremes.append((row.min(), row.max()))
            apart = max(apart, _above(np.abs(exact - row).max()))
        if not extremes:
            return _Part(physical, {}, {}, sizes=solved.sizes)
        lows, highs = zip(*extremes, strict=True)
        numbers = {"change": np.array([min(lows), max(highs)])}
        return _Part(physical, {}, numbers, apart, solved.sizes)
    table, exact_table = (_rows(plan, segment, one) for one in (solved, longer))
    if table is None or exact_table is None:
        return _Part(physical, {}, {}, sizes=solved.sizes)
    near = in_units(quantity, table, FLOAT64).numbers
    exact_numbers = in_units(quantity, exact_table, longer.system).numbers
    apart = max(
        _above(np.abs(exact_numbers[name] - near[name]).max(initial=0)) for name in table.small
    )
    index = {name: column.tolist() for name, column in table.index.items()}
    return _Part(physical, index, table.numbers, apart, solved.sizes)


def _above(value: Any) -> float:
    """Round a number up that may be longer."""
    return math.nextafter(float(value), math.inf) if value else 0.0


def _rows(plan: Plan, segment: "Segment", solved: Solved) -> Table | None:
    """Give the rows of the answer that a segment has; None where it has none."""
    problem, quantity = plan.problem, plan.quantity
    layers = range(segment.first, segment.last + 1)
    if isinstance(quantity, Profile):
        assert problem.width is not None
        gatherer = quantity.gatherer(problem, solved.system)
        stop = layers.stop if segment.number + 1 < segment.of else problem.height + 1
        whole = [full_layer(j, problem.width) for j in range(layers.start, stop) if j]
        blocks = [Block(branch, row) for row in whole for branch in Branch]
        gatherer.take(contact_changes(solved, blocks, 1))
        none = np.zeros((1, len(gatherer.found)))
        gatherer.scatter.add(none, none)  # of one packing there is no scatter
        return gatherer.table()
    if isinstance(quantity, Response):
        table = quantity.rows_of(problem, solved, layers)
        return table if table.rows else None
    contact = problem.contact
    wanted = 1 if contact is None else contact.j + 1  # the layer whose forces are the answer
    if wanted not in layers:
        return None
    assert isinstance(quantity, Listed)
    return quantity.rows_of(problem, solved)


def _table(plan: Plan, parts: list[_Part]) -> Table:
    """Put the rows of all segments below each other."""
    parts = [part for part in parts if part.numbers]
    first = parts[0]
    types = {"branch": "U1", "first_order_std": "U"}
    index = {
        name: np.concatenate([np.array(p.index[name], types.get(name, "i8")) for p in parts])
        for name in first.index
    }
    numbers = {n: np.concatenate([p.numbers[n] for p in parts]) for n in first.numbers}
    small = tuple(name for name in numbers if "change" in name or name == "std")
    errors = {}
    if isinstance(plan.quantity, Profile):
        errors = {name: np.full(len(index["j"]), np.nan) for name in small}
    return Table(index, numbers, small, errors)


def _physical(plan: Plan, parts: list[_Part]) -> Physicality:
    """Merge what was found, the lowest layers first."""
    found = Physicality(looks_at=range(1))
    for part in parts:
        found.above(part.physical)
    if found.first_tensile is not None:
        found.first_tensile = at_home(plan.quantity, found.first_tensile)
    return found
