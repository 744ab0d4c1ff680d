"""Answers about a packing that the memory does not hold: gathered segment by segment."""

import json
import math
from collections.abc import Iterator
from contextlib import nullcontext
from dataclasses import asdict, dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..accuracy.accuracy import Accuracy
from ..accuracy.repeated import repeated
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import Branch, Contact
from ..lattice.layers import full_layer
from ..mechanics.physicality import PHYSICAL, Physicality
from ..mechanics.work import ESTIMATE, Work
from ..planning import planner, segments
from ..planning.plan import Plan
from ..quantities.answer import Answer, at_home, in_units
from ..quantities.base import Block, Listed, Table, contact_changes
from ..quantities.histogram import Histogram
from ..quantities.profile import Profile
from ..quantities.response import Response
from ..scene.source import program_version
from ..statistics.histogram import counted, edges_between
from ..statistics.moments import Moments
from .checkpoint import Checkpoint

if TYPE_CHECKING:
    from ..mechanics.segments import Kept, Segment, Segments


@dataclass
class _Part:
    """What a segment adds to the answer: columns, and whether it is physical."""

    physical: Physicality
    index: dict[str, list[Any]]
    numbers: dict[str, Array]

    def keep(self, kept: "Kept", number: int) -> None:
        """Keep it; what was measured first, so that it is whole once its words are there."""
        columns = [np.asarray(column, dtype=float) for column in self.numbers.values()]
        kept.put(f"numbers{number}", np.stack(columns) if columns else np.empty(0))
        physical = asdict(self.physical)
        del physical["looks_at"]  # the one realisation
        words = [physical, self.index, list(self.numbers)]
        letters = np.frombuffer(json.dumps(words).encode(), np.uint8)
        kept.put(f"words{number}", letters.astype(float))

    @classmethod
    def of(cls, kept: "Kept", number: int) -> "_Part | None":
        """Read what was kept, if it was."""
        words, numbers = kept.get(f"words{number}"), kept.get(f"numbers{number}")
        if words is None or numbers is None:
            return None
        physical, index, names = json.loads(words.astype(np.uint8).tobytes())
        found = Physicality(**physical)
        if found.between is not None:
            lower, upper = found.between
            found.between = (lower[0], lower[1]), (upper[0], upper[1])
        if found.first_tensile is not None:
            i, j, branch = physical["first_tensile"]
            found.first_tensile = Contact(i, j, Branch(branch))
        return cls(found, index, dict(zip(names, numbers, strict=True)))


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
        answer = Answer(table, bins, _physical(plan, parts), None)
        return answer, _accuracy(plan, work)


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
            for row in _changes(plan, way.down(number)):
                own += counted(row, edges)
            way.kept.put(f"counts{number}", own)
        counts += own
    bins = zip(edges[:-1], edges[1:], map(int, counts), strict=True)
    return Table({}, {"change": change}, ("change",)), list(bins)


def _changes(plan: Plan, segment: "Segment") -> Iterator[Array]:
    """Give the changes of a segment's contacts, row by row, in the unit of the answer."""
    forces = segment.solved.forces
    assert forces is not None
    for j in range(max(segment.first, 1), min(segment.last + 1, len(forces.rows))):
        for _, _, g in forces.below(j):
            if g.size:
                row = Table({}, {"change": np.asarray(g)}, ("change",))
                yield in_units(plan.quantity, row, FLOAT64).numbers["change"]


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
        physical.look_at_gaps(packing, range(layers.start - low, layers.stop - low))
        physical.look_at_forces(forces, layers)
    rows = problem.region.rows[layers.start : layers.stop]
    work.did_rows("checked", rows, sum(row.count for row in rows))
    if isinstance(quantity, Profile):
        assert problem.width is not None
        gatherer = quantity.gatherer(problem, FLOAT64)
        stop = layers.stop if segment.number + 1 < segment.of else problem.height + 1
        whole = [full_layer(j, problem.width) for j in range(layers.start, stop) if j]
        blocks = [Block(branch, row) for row in whole for branch in Branch]
        gatherer.take(contact_changes(solved, blocks, 1))
        keys = list(gatherer.found)
        found = [(F, m.unit, m.count, m.mean, m.square) for F, m in gatherer.found.values()]
        columns = np.array(found, dtype=float).reshape(-1, 5).T
        names = ("ordered", "unit", "count", "mean", "square")
        index: dict[str, list[Any]] = {"j": [j for j, _ in keys], "branch": [b for _, b in keys]}
        return _Part(physical, index, dict(zip(names, columns, strict=True)))
    if isinstance(quantity, Histogram):
        extremes = [(row.min(), row.max()) for row in _changes(plan, segment)]
        if not extremes:
            return _Part(physical, {}, {})
        lows, highs = zip(*extremes, strict=True)
        return _Part(physical, {}, {"change": np.array([min(lows), max(highs)])})
    if isinstance(quantity, Response):
        table = quantity.rows_of(problem, solved, layers)
        if not table.rows:
            return _Part(physical, {}, {})
        return _Part(physical, {k: v.tolist() for k, v in table.index.items()}, table.numbers)
    contact = problem.contact
    wanted = 1 if contact is None else contact.j + 1  # the layer whose forces are the answer
    if wanted not in layers:
        return _Part(physical, {}, {})
    assert isinstance(quantity, Listed)
    table = quantity.rows_of(problem, solved)
    return _Part(physical, {k: v.tolist() for k, v in table.index.items()}, table.numbers)


def _table(plan: Plan, parts: list[_Part]) -> Table:
    quantity = plan.quantity
    if not isinstance(quantity, Profile):
        parts = [part for part in parts if part.numbers]
        small = tuple(name for name in parts[0].numbers if "change" in name)
        types = {"branch": "U1"}
        index = {
            name: np.concatenate([np.array(p.index[name], types.get(name, "i8")) for p in parts])
            for name in parts[0].index
        }
        numbers = {n: np.concatenate([p.numbers[n] for p in parts]) for n in parts[0].numbers}
        return Table(index, numbers, small)
    gatherer = quantity.gatherer(plan.problem, FLOAT64)
    for part in parts:
        columns = (part.numbers[name] for name in ("ordered", "unit", "count", "mean", "square"))
        keys = zip(part.index["j"], map(Branch, part.index["branch"]), strict=True)
        for key, (F, unit, count, mean, square) in zip(
            keys, zip(*columns, strict=True), strict=True
        ):
            gatherer.found[key] = F, Moments(float(unit), int(count), mean, square)
    none = np.zeros((1, len(gatherer.found)))
    gatherer.scatter.add(none, none)  # of one packing there is no scatter
    return gatherer.table()


def _physical(plan: Plan, parts: list[_Part]) -> Physicality:
    """Merge what was found, the lowest layers first."""
    found = Physicality(looks_at=range(1))
    for part in parts:
        found.above(part.physical)
    if found.first_tensile is not None:
        found.first_tensile = at_home(plan.quantity, found.first_tensile)
    return found


def _accuracy(plan: Plan, work: Work) -> Accuracy:
    """Estimate the error from a packing as high and narrow: it grows with the height alone."""
    note = f"estimated, not certified, from {segments.COLUMNS} columns of as many layers"
    with work.repeat(ESTIMATE):
        try:
            _, found = repeated(planner.plan(segments.narrow(plan.scene)), work)
        except (ForceDiffusionError, ArithmeticError) as error:
            return Accuracy(math.inf, False, FLOAT64.name, 0.0, f"not known: {error}")
    return Accuracy(found.error_bound, False, FLOAT64.name, found.bits_lost, note)
