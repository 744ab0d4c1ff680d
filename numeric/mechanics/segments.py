"""One packing that the memory does not hold: swept segment by segment, the same numbers.

On the way up only the positions of every k-th layer are kept. On the way down the layers between
are drawn and deposited again, so that a segment at a time is there, as if all had been solved
together: no bit differs. With k near the root of the height that takes half as long again. Of a
packing for which that is still too much, the layer below every n-th segment is kept alone: those
between are found once more on the way down, n segments at a time.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, Protocol, TypeVar

import numpy as np

from ..arithmetic.carried import CARRYING, Carried
from ..arithmetic.errors import NotReachedError
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import PerBranch, per_direction
from ..lattice.layers import Layer, LazyRows, Region, Rows
from . import local
from .kernels import Deposition, Descent
from .loads import on_layers, on_rows
from .physicality import PHYSICAL, Physicality
from .problem import Problem, Solved
from .sweep import Forces, Loads, NotStandingError, SolvedPacking, check_standing, deposit
from .sweeps import Drawing, tell
from .work import Work

T = TypeVar("T", Drawing, Deposition)
# Layers above a segment that are deposited, too: beads look for gaps so far up.
OVER = 3


class Kept(Protocol):
    """What is kept on the way, by name; it may have been kept by an earlier run."""

    def get(self, name: str) -> Array | None:
        """Give what was kept, or None."""

    def put(self, name: str, values: Array) -> None:
        """Keep an array."""

    def drop(self, name: str) -> None:
        """Forget it."""

    def save(self, *, now: bool = True) -> None:
        """Make sure of it; if not ``now``, where that takes little of the time."""


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

    def save(self, *, now: bool = True) -> None:
        """There is nowhere else to keep it."""


class Segments:
    """Solves one realisation of a problem, ``segment`` layers at a time (an even number)."""

    def __init__(
        self,
        problem: Problem,
        realisation: int,
        work: Work,
        kept: Kept,
        *,
        again: bool = False,
    ) -> None:
        """``kept`` may hold what an earlier run has kept; ``again``: all will go down once more."""
        self.problem, self.realisation, self.work, self.kept = problem, realisation, work, kept
        self.again = again
        self.layers, self.top, self.every = problem.segment, problem.region.top, problem.every
        self.count = max(1, -(-self.top // self.layers))
        self._parts: dict[type, Any] = {}
        self._strength = problem.load.strength(problem.n_x, CARRYING)

    def up(self, highest: int) -> None:
        """Deposit all segments below the ``highest``; keep the layer below it and every n-th.

        Raises ``RadiusError``, and ``UnbuildableError`` for a bead that can't rest.
        """
        self._climb(highest, self.every)

    def _climb(self, highest: int, every: int) -> None:
        """Deposit what lies between a layer that is kept and the ``highest`` segment."""
        d = self.problem.dimension
        rows = [*range(d), *range(d + d * d, 2 * d + d * d)]
        known = (n for n in range(highest, 0, -1) if self.kept.get(f"c{n}") is not None)
        for number in range(next(known, 0) + 1, highest + 1):
            region, _, block = self._deposited(number - 1)
            of = slice(region.starts[self.layers], region.starts[self.layers + 1])
            self.kept.put(f"c{number}", block[0, rows, of])
            if (number - 1) % every:
                self.kept.drop(f"c{number - 1}")
            self.kept.save(now=False)

    def layers_of(self, number: int) -> range:
        """Give the layers that a segment answers for, with those that bear nothing above the last.

        The highest layer of a segment is the lowest of the next one, whose own it is not.
        """
        last = (number + 1) * self.layers if number + 1 < self.count else self.problem.height
        return range(number * self.layers + bool(number), last + 1)

    def packings(
        self, number: int, physical: Physicality | None
    ) -> Iterator[tuple[Solved, Sequence[int]]]:
        """Solve a segment: the highest first, and then one after the other.

        Only its rows and their neighbours are there, numbered as in the whole. ``physical`` looks
        at it. Raises what ``up`` does, and ``NotStandingError``.
        """
        solved, packing = self._down(number)
        if physical is not None:
            with self.work.timed(PHYSICAL):
                layers, low = self.layers_of(number), packing.region.rows[0].j
                there = range(layers.start - low, min(layers.stop, self.top + 1) - low)
                more = packing.region.rows[-1].j < self.top
                physical.look_at_gaps(packing, there, more=more)
                if solved.forces is not None and self.problem.needs_forces:
                    physical.look_at_forces(solved.forces, layers)
            rows = self.problem.region.rows[layers.start : layers.stop]
            self.work.did_rows("checked", rows, sum(row.count for row in rows))
        yield solved, [self.realisation]

    def _down(self, number: int) -> tuple[Solved, SolvedPacking]:
        """Solve a segment; give also what there is of the packing alone."""
        self._climb(number, 1)
        region, rho, block = self._deposited(number)
        low = number * self.layers
        last = min(low + self.layers, self.top)
        descent, g = None, None
        rows = self.problem.force_rows[low : low + self.layers + 2]
        if self.problem.needs_forces and len(rows) > 1:  # else it lies above all loads
            old = self._parts.get(Descent)
            loads, g = self._loads_on(rows, number), None if old is None else old.g
            descent = Descent(region, rows, loads, carried=True, g=g)
            self._parts[Descent] = descent
            g = self._balanced(number, descent, region, rho, block)
        solved = tell(self.problem.phi, self._parts[Deposition], rho, descent, g)
        assert solved.packing is not None
        return self._whole(solved, low, range(low + 1, last + 1)), solved.packing

    def leave(self, number: int) -> None:
        """Forget what only that segment needed, once it is done."""
        if not self.again or number % self.every:
            self.kept.drop(f"c{number}")
        for name in (f"g{number + 1}", f"F{number + 1}"):
            self.kept.drop(name)
        self.kept.save(now=False)

    def _deposited(self, number: int) -> tuple[Region, Array, Array]:
        problem, work, low = self.problem, self.work, number * self.layers
        rows = problem.region.rows[low : low + self.layers + OVER + 1]
        region = Region(problem.width, rows, problem.dimension)
        with work.timed("radii"):
            draw = self._ready(Drawing(problem.radii, region, carried=True), "rho")
            rho = draw([self.realisation])
        work.did_rows("radii", region.rows, region.beads)
        with work.timed("deposit"):
            rest = self._ready(Deposition(problem.phi, region, carried=True), "block")
            base = self.kept.get(f"c{number}") if number else None
            block = rest(rho, base)
            if block is None:  # then this names the bead
                d = problem.dimension
                on = None if base is None else tuple(map(Carried, base[:d], base[d:]))
                deposit(problem.phi, region, self._rows(region, rho), CARRYING, work, on=on)
                raise NotReachedError("a position is beyond the range of float64")
        work.did_rows("deposited", region.rows, region.beads)
        return region, rho, block

    def _rows(self, region: Region, rho: Array) -> list[Carried]:
        values, errors = (np.split(part, region.starts[1:-1]) for part in rho[0])
        return [Carried(*pair) for pair in zip(values, errors, strict=True)]

    def _balanced(
        self, number: int, descent: Descent, region: Region, rho: Array, block: Array
    ) -> Array:
        rows = descent.rows
        with self.work.timed("balance forces"):
            g = descent(block, self.kept.get(f"g{number + 1}"))
            if g is None:
                packing = tell(self.problem.phi, self._parts[Deposition], rho).packing
                assert packing is not None
                raise _not_balanced(packing, rows)
            if number and rows[1].count:
                self.kept.put(f"g{number}", descent.row(1))
                of = slice(descent.starts[1], descent.starts[2])
                self.kept.put(f"F{number}", descent.F[:, of].copy())
        self.work.did_rows("balanced", rows[1:], descent.beads)
        return g

    def _loads_on(self, rows: Rows, number: int) -> Loads:
        """Give the loads of a segment's rows; the highest bears all that lies above it."""
        load, d = self.problem.load, self.problem.dimension
        if load.kind in {"surface", "bulk"}:
            first = rows[0].j if load.kind == "bulk" else load.height
            on = on_layers(self._strength.unit, rows, range(first - rows[0].j, len(rows)), CARRYING)
        else:
            single = self._strength.single if load.kind == "file" else {}
            low = rows[0].j
            here = {
                (i, j - low): single.get((i, j), self._strength.unit)
                for i, j in load.loaded or []
                if low <= j < low + len(rows)
            }
            on = on_rows(here, rows, load.width, CARRYING, d)
        above = self.kept.get(f"F{number + 1}")
        if above is None:
            return on
        shares: list[tuple[Any, ...]] = [of for _, of in on]
        return per_direction([(*shares[a][:-1], Carried(above[a], above[d + a])) for a in range(d)])

    def _ready(self, part: T, memory: str) -> T:
        """Give a part the memory of the last of its kind, if that fits."""
        old = self._parts.get(type(part))
        if old is not None and getattr(old, memory).shape[1:] == part.shape:
            setattr(part, memory, getattr(old, memory))
        self._parts[type(part)] = part
        return part

    def _whole(self, solved: Solved, low: int, own: range) -> Solved:
        """Number rows as in the whole packing; those that are not there are empty.

        Blocks of forces are those below the layers ``own``.
        """
        nothing: Array = np.empty(0)
        problem = self.problem

        def placed(rows: Sequence[Any], count: int) -> LazyRows[Any]:
            def row(j: int) -> Any:
                return rows[j - low] if low <= j < low + len(rows) else nothing

            return LazyRows(count, row)

        def each(values: PerBranch[Any], count: int) -> PerBranch[Any]:
            return per_direction([placed(rows, count) for _, rows in values])

        layers, rows = self.top + 1, problem.force_rows
        packing, forces = solved.packing, solved.forces
        assert packing is not None
        packing = SolvedPacking(
            problem.phi,
            FLOAT64,
            problem.region,
            placed(packing.rho, layers),
            each(packing.c, layers),
            each(packing.dn, layers),
        )
        none: PerBranch[Sequence[Array]] = per_direction([()] * problem.dimension)
        forces = forces or Forces(FLOAT64, problem.region, Rows(), none, none)
        beads = sum(row.count for row in rows[own.start : own.stop])
        forces = replace(
            forces,
            region=problem.region,
            rows=rows,
            ordered=each(forces.ordered, len(rows)),
            change=each(forces.change, len(rows)),
            F=None if forces.F is None else forces.F[:, :beads],
            g=None if forces.g is None else forces.g[..., :beads],
        )
        rest = None if solved.rest is None else self._whole(solved.rest, low, own)
        return Solved(FLOAT64, packing, forces, None, rest, solved.sizes)


def _not_balanced(packing: SolvedPacking, rows: Sequence[Layer]) -> Exception:
    """Name the bead whose contacts are parallel, if that is why."""
    region = packing.region
    for j in range(len(rows) - 1, 0, -1):
        row, own = rows[j], region.rows[j]
        dn = [[region.here(v, own, row) for v in of[j]] for _, of in packing.dn]
        d = len(dn)
        turned = [[dn[a][b] for a in range(d)] for b in range(d)]
        _, det = local.solved(turned, ([np.zeros(row.count)] * d,))
        try:
            check_standing(det, row, region, FLOAT64)
        except NotStandingError as error:
            return error
    return NotReachedError("a force is beyond the range of float64")
