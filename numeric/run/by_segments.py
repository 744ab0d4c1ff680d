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
from ..accuracy.repeated import ESTIMATED, distances, of_distances, repeated
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import Branch, Contact
from ..lattice.layers import full_layer
from ..mechanics.pairs import Extent
from ..mechanics.physicality import PHYSICAL, Physicality
from ..mechanics.work import Work
from ..planning import planner, segments
from ..planning.plan import ESTIMATE, Plan
from ..quantities.answer import Answer, at_home, in_units
from ..quantities.base import Block, Listed, Table, contact_changes, joined
from ..quantities.histogram import Histogram
from ..quantities.profile import Profile, ProfileMoments
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
        if found.extent is not None:
            found.extent = Extent(**physical["extent"])
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
    from ..mechanics.segments import KEPT, count

    work.uses(FLOAT64.name)
    numbers = range(count(plan.problem, plan.problem.segment))
    names = {f"{kind}{n}" for kind in (*KEPT, "numbers", "words", "counts") for n in numbers}
    opened = None if checkpoint is None else Checkpoint(checkpoint, _key(plan), names)
    with FLOAT64.active(), opened or nullcontext():
        return _answer(plan, work, opened), _accuracy(plan, work)


def _answer(plan: Plan, work: Work, opened: Checkpoint | None) -> Answer:
    """Sweep the packing; what that takes of the memory is free afterwards."""
    from ..mechanics.segments import InMemory, Segments

    kept: Kept = opened or InMemory()
    counts = isinstance(plan.quantity, Histogram)
    way = Segments(plan.problem, 0, plan.problem.segment, work, kept, again=counts)
    parts: list[_Part] = []
    missing = [n for n in range(way.count) if _Part.of(kept, n) is None]
    if missing:
        way.up(missing[-1])
    for number in reversed(range(way.count)):
        part = _Part.of(kept, number)
        if part is None:
            part = _part(plan, way.down(number), work, parts[0].physical if parts else None)
            part.keep(kept, number)
        parts.insert(0, part)
    bins = None
    if counts:
        table, bins = _counted(plan, way, parts)
    else:
        table = in_units(plan.quantity, _table(plan, parts).sorted(), FLOAT64)
    return Answer(table, bins, _physical(plan, parts), None)


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
    forces, system = segment.solved.forces, segment.solved.system
    assert forces is not None
    for j in range(max(segment.first, 1), min(segment.last + 1, len(forces.rows))):
        for _, _, g in forces.below(j):
            if g.size:
                row = Table({}, {"change": np.asarray(g)}, ("change",))
                yield in_units(plan.quantity, row, system).numbers["change"]


def _key(plan: Plan) -> dict[str, Any]:
    """Describe what decides the numbers that are kept."""
    scene = plan.scene.model_dump(mode="json", exclude={"folder": True})
    return {"scene": scene, "layers": plan.problem.segment, "version": program_version()}


def _part(plan: Plan, segment: "Segment", work: Work, above: Physicality | None) -> _Part:
    """Give what a segment adds; ``above``: what was found in the segment above it."""
    problem, quantity, layers = plan.problem, plan.quantity, segment.layers
    forces, packing = segment.solved.forces, segment.packing
    assert forces is not None
    physical = Physicality()
    with work.timed(PHYSICAL):
        low = packing.region.rows[0].j
        missing = packing.region.rows[-1].j < problem.region.top
        own = range(layers.start - low, layers.stop - low)
        physical.look_at_gaps(packing, own, above if missing else None)
        physical.look_at_forces(forces, layers)
    rows = problem.region.rows[layers.start : layers.stop]
    work.did_rows("checked", rows, sum(row.count for row in rows))
    if isinstance(quantity, Profile):
        gatherer = _moments(plan, segment)
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
    table = _rows(plan, segment)
    if table is None:
        return _Part(physical, {}, {})
    return _Part(physical, {k: v.tolist() for k, v in table.index.items()}, table.numbers)


def _moments(plan: Plan, segment: "Segment") -> ProfileMoments:
    """Gather a segment's layers of a profile, each of which is whole there."""
    problem, quantity, layers = plan.problem, plan.quantity, segment.layers
    assert isinstance(quantity, Profile)
    assert problem.width is not None
    gatherer = quantity.gatherer(problem, segment.solved.system)
    stop = layers.stop if segment.number + 1 < segment.of else problem.height + 1
    whole = [full_layer(j, problem.width) for j in range(layers.start, stop) if j]
    blocks = [Block(branch, row) for row in whole for branch in Branch]
    gatherer.take(contact_changes(segment.solved, blocks, 1))
    return gatherer


def _rows(plan: Plan, segment: "Segment") -> Table | None:
    """Give a segment's rows of an answer that lists contacts or beads; None: it has none."""
    problem, quantity, solved = plan.problem, plan.quantity, segment.solved
    if isinstance(quantity, Response):
        table = quantity.rows_of(problem, solved, segment.layers)
        return table if table.rows else None
    contact = problem.contact
    wanted = 1 if contact is None else contact.j + 1  # the layer whose forces are the answer
    if wanted not in segment.layers:
        return None
    assert isinstance(quantity, Listed)
    return quantity.rows_of(problem, solved)


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
    return _of_one_packing(gatherer)


def _of_one_packing(gatherer: ProfileMoments) -> Table:
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
    """Estimate the error by a repeat of the packing, or of another that stands for it."""
    with work.repeat(ESTIMATE):
        try:
            if not segments.stands_in(plan.scene):
                return _repeated(plan, work)
            _, found = repeated(planner.plan(segments.narrow(plan.scene)), work)
        except (ForceDiffusionError, ArithmeticError) as error:
            return Accuracy(math.inf, False, FLOAT64.name, 0.0, f"not known: {error}")
    note = f"{ESTIMATED}, from another packing: {segments.COLUMNS} columns of as many layers"
    times = segments.STAND_IN
    lost = found.bits_lost + math.log2(times) if found.bits_lost else 0.0
    return Accuracy(times * found.error_bound, False, FLOAT64.name, lost, note)


def _repeated(plan: Plan, work: Work) -> Accuracy:
    """Solve the same packing once more, segment by segment beside one with more digits."""
    from ..mechanics.segments import InMemory, Segments

    problem, longer = plan.problem, plan.method.longer
    assert longer is not None
    work.uses(longer.name)
    with longer.active():
        ways = [
            Segments(problem, 0, problem.segment, work, InMemory(), system=system)
            for system in (FLOAT64, longer)
        ]
        for way in ways:
            way.up(way.count - 1)
        found = [(0.0, 0.0)]
        for number in reversed(range(ways[0].count)):
            small, again = (_compared(plan, way.down(number)) for way in ways)
            if small is not None and again is not None:
                found.append(distances(small, again))
    return of_distances(found, FLOAT64)


def _compared(plan: Plan, segment: "Segment") -> Table | None:
    """Give what a segment adds to the answer, before it is merged; None: nothing."""
    quantity, system = plan.quantity, segment.solved.system
    if isinstance(quantity, Histogram):
        changes = joined(system, list(_changes(plan, segment)))
        return Table({}, {"change": changes}, ("change",))
    if isinstance(quantity, Profile):
        table: Table | None = _of_one_packing(_moments(plan, segment))
    else:
        table = _rows(plan, segment)
    return None if table is None else in_units(quantity, table, system)
