"""One packing that the memory does not hold: swept segment by segment, the same numbers.

On the way up only the positions of every k-th layer are kept. On the way down the layers between
are drawn and deposited again, so that a segment at a time is there, as if all had been solved
together: no bit differs. With k near the root of the height that takes half as long again. float64
is compiled; other arithmetics, which repeat a packing to estimate its error, are swept by NumPy.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

from ..arithmetic.errors import NotReachedError
from ..arithmetic.systems import FLOAT64, Array, NumberSystem, zeros
from ..disorder.radii import rows_of
from ..lattice.branch import PerBranch
from ..lattice.layers import Layer, LazyRows, Region, pick
from ..lattice.regions import Rows
from . import forces, packing
from .compiled import Drawing
from .compiled_forces import Descent
from .compiled_packing import Deposition
from .forces import Forces, Loads
from .gaps import ABOVE
from .loads import on_rows
from .packing import CompiledPacking, SolvedPacking
from .problem import Problem, Solved
from .work import Work

T = TypeVar("T", Drawing, Deposition, Descent)
# Layers above a segment that are deposited, too: beads look for gaps so far up.
OVER = ABOVE
# Names under which a segment's number follows: positions below it, and forces on its lowest layer.
KEPT = ("c", "g", "F")


def count(problem: Problem, layers: int) -> int:
    """Give how many segments of so many layers a problem has."""
    return max(1, -(-problem.region.top // layers))


class Kept(Protocol):
    """What is kept on the way, by name; it may have been kept by an earlier run."""

    def get(self, name: str) -> Array | None:
        """Give what was kept, or None."""

    def put(self, name: str, values: Array) -> None:
        """Keep an array."""

    def drop(self, name: str) -> None:
        """Forget what this run needs no more, if it takes memory."""


class InMemory:
    """Keeps in memory."""

    def __init__(self) -> None:
        """Nothing is kept."""
        self._kept: dict[str, Array] = {}

    def get(self, name: str) -> Array | None:
        """Give what was kept, or None."""
        return self._kept.get(name)

    def put(self, name: str, values: Array) -> None:
        """Keep an array."""
        self._kept[name] = values

    def drop(self, name: str) -> None:
        """Forget it."""
        self._kept.pop(name, None)


@dataclass(frozen=True)
class Segment:
    """One ``of`` several parts: layers ``first`` … ``last``, whose contacts below are balanced.

    Of ``solved`` only these rows and their neighbours are there; rows are numbered as in the whole.
    ``packing`` has what there is alone, from layer ``first`` or the one below it on.
    """

    number: int
    of: int
    first: int
    last: int
    solved: Solved
    packing: SolvedPacking

    @property
    def layers(self) -> range:
        """Its layers, ``first`` … ``last``."""
        return range(self.first, self.last + 1)


class Segments:
    """Solves one realisation of a problem, ``layers`` at a time (an even number)."""

    def __init__(
        self,
        problem: Problem,
        realisation: int,
        layers: int,
        work: Work,
        kept: Kept,
        *,
        again: bool = False,
        system: NumberSystem = FLOAT64,
    ) -> None:
        """``kept`` may hold what an earlier run has kept; ``again``: all will go down once more.

        The caller activates ``system``; files keep float64 alone.
        """
        self.problem, self.realisation, self.work, self.kept = problem, realisation, work, kept
        self.again, self.system = again, system
        self.layers, self.top = layers, problem.region.top
        self.count = count(problem, layers)
        self._parts: dict[type, Any] = {}
        self._strength = problem.load.strength(problem.n_x, system)

    def up(self, highest: int) -> None:
        """Deposit all segments below the ``highest``; keep the layer below each.

        Raises ``RadiusError``, and ``UnbuildableError`` for a bead that can't rest.
        """
        for number in range(1, highest + 1):
            if self.kept.get(f"c{number}") is None:
                solved = self._deposited(number - 1)
                c = solved.c
                place = self.layers
                self.kept.put(f"c{number}", np.stack([c.plus[place], c.minus[place]]))

    def down(self, number: int) -> Segment:
        """Solve a segment: the highest first, and then one after the other.

        Raises what ``up`` does, and ``NotStandingError``.
        """
        solved = self._deposited(number)
        low = number * self.layers
        last = min(low + self.layers, self.top)
        found = None
        if self.problem.needs_forces:
            found = self._balanced(number, solved)
        for name in (f"c{number}", f"g{number + 1}", f"F{number + 1}")[self.again :]:
            self.kept.drop(name)
        whole, first = self._whole(solved, found, low), low + 1 if number else 0
        return Segment(number, self.count, first, last, whole, solved)

    def _deposited(self, number: int) -> SolvedPacking:
        problem, work, low = self.problem, self.work, number * self.layers
        region = Region(problem.width, problem.region.rows[low : low + self.layers + OVER + 1])
        base = self.kept.get(f"c{number}") if number else None
        on = None if base is None else (base[0], base[1])
        if self.system is not FLOAT64:
            with work.timed("radii"):
                drawn = rows_of(problem.radii, region.rows, [self.realisation], self.system)
            work.did_rows("radii", region.rows, region.beads)
            with work.timed("deposit"):
                return packing.deposit(problem.n_x, region, drawn, self.system, work, on=on)
        with work.timed("radii"):
            draw = self._ready(Drawing(problem.radii, region), "rho")
            rho, rows = draw([self.realisation])
        work.did_rows("radii", region.rows, region.beads)
        with work.timed("deposit"):
            deposit = self._ready(Deposition(problem.n_x, region), "block")
            solved = deposit(rho, rows, base)
            if solved is None:  # then this names the bead
                return packing.deposit(problem.n_x, region, rows, FLOAT64, work, on=on)
        work.did_rows("deposited", region.rows, region.beads)
        return solved

    def _balanced(self, number: int, solved: SolvedPacking) -> Forces | None:
        low = number * self.layers
        rows = self.problem.force_rows[low : low + self.layers + 2]
        if len(rows) < 2:
            return None  # above all loads
        above = self.kept.get(f"g{number + 1}")
        ordered = self.kept.get(f"F{number + 1}")
        with self.work.timed("balance forces"):
            loads = [self._loads(row) for row in rows]
            if ordered is not None:
                loads[-1] = (ordered[0], ordered[1])
            plus, minus = zip(*loads, strict=True)
            sweep = self._compiled if self.system is FLOAT64 else self._swept
            found, lowest = sweep(solved, rows, Loads(plus, minus), above)
            if number and rows[1].count:
                self.kept.put(f"g{number}", lowest)
                self.kept.put(
                    f"F{number}", np.stack([found.ordered.plus[1], found.ordered.minus[1]])
                )
        return found

    def _compiled(
        self, solved: SolvedPacking, rows: Rows, loads: Loads, above: Array | None
    ) -> tuple[Forces, Array]:
        """Balance the forces by compiled sweeps; give also what the segment below takes along.

        That, as ``above`` of this one: g^± and what their sums have lost, (2, 2, beads).
        """
        descent = self._ready(Descent(solved.region, rows, loads), "g", "lost")
        found = descent(solved, above) if isinstance(solved, CompiledPacking) else None
        if found is None:
            raise _not_balanced(solved, rows)
        self.work.did_rows("balanced", rows[:0:-1], descent.beads)
        return found, descent.row(1)

    def _swept(
        self, solved: SolvedPacking, rows: Rows, loads: Loads, above: Array | None
    ) -> tuple[Forces, Array]:
        """Do the same in any arithmetic."""
        known = None
        if above is not None:
            plus, minus = loads.plus[-1], loads.minus[-1]
            assert plus is not None
            assert minus is not None
            known = (plus, minus), (above[0, 0], above[0, 1]), (above[1, 0], above[1, 1])
        found = forces.sweep_down(solved, rows, loads, work=self.work, above=known)
        if not rows[1].count:
            return found, zeros(self.system, 2, 2, 0)
        g = found.change.plus[1], found.change.minus[1]
        lost = g if self.system.dtype is object else found.lost  # not looked at there
        return found, np.array([g, lost])

    def _loads(self, row: Layer) -> tuple[Array | None, Array | None]:
        load = self.problem.load
        if load.kind in {"surface", "bulk"}:
            if load.kind == "surface" and row.j < load.height:
                return None, None
            plus, minus = self._strength.unit
            nothing = zeros(self.system, row.count)
            return nothing + plus, nothing + minus
        loaded = load.loaded or []
        single = self._strength.single if load.kind == "file" else {}
        here = {(i, 0): single.get((i, j), self._strength.unit) for i, j in loaded if j == row.j}
        loads = on_rows(here, (row,), load.width, self.system)
        return loads.plus[0], loads.minus[0]

    def _ready(self, part: T, *memory: str) -> T:
        """Give a part the memory of the last of its kind, if that fits."""
        old = self._parts.get(type(part))
        if old is not None and old.size == part.size:
            for name in memory:
                setattr(part, name, getattr(old, name))
        self._parts[type(part)] = part
        return part

    def _whole(self, solved: SolvedPacking, found: Forces | None, low: int) -> Solved:
        """Number rows as in the whole packing; those that are not there are empty."""
        nothing = zeros(self.system, 0)

        def placed(rows: Sequence[Any], count: int, empty: Any = nothing) -> LazyRows[Any]:
            def row(j: int) -> Any:
                return rows[j - low] if low <= j < low + len(rows) else empty

            return LazyRows(count, row)

        layers, pair = self.top + 1, (nothing, nothing)
        whole = SolvedPacking(
            solved.n_x,
            self.system,
            self.problem.region,
            placed(solved.rho, layers),
            PerBranch(placed(solved.c.plus, layers), placed(solved.c.minus, layers)),
            PerBranch(placed(solved.dn.plus, layers, pair), placed(solved.dn.minus, layers, pair)),
        )
        rows = self.problem.force_rows
        there: Sequence[tuple[Sequence[Array], Sequence[Array]]] = (((), ()), ((), ()))
        if found is not None:
            F, g = found.ordered, found.change
            there = (F.plus, F.minus), (g.plus, g.minus)
        ordered, change = (
            PerBranch[Sequence[Array]](placed(plus, len(rows)), placed(minus, len(rows)))
            for plus, minus in there
        )
        return Solved(self.system, whole, Forces(self.system, rows, ordered, change), None)


def _not_balanced(solved: SolvedPacking, rows: Sequence[Layer]) -> Exception:
    """Name the bead whose contacts are parallel, if that is why."""
    for j in range(len(rows) - 1, 0, -1):
        row, own = rows[j], solved.region.rows[j]
        plus, minus = (
            [pick(v, own, row, solved.region.width) for v in dn[j]] for _, dn in solved.dn
        )
        minor = plus[0] * minus[1] - minus[0] * plus[1]
        try:
            forces.check_standing(1 + (plus[0] + minus[1] + minor), row, FLOAT64)
        except forces.NotStandingError as error:
            return error
    return NotReachedError("a force is beyond the range of float64")
