"""Positions of beads."""

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache

from ..arithmetic.systems import Array, NumberSystem, array, from_floats, zeros
from ..lattice import regions
from ..lattice.branch import axis_names
from ..lattice.layers import Layer, Region, Rows, pick, whole
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved
from .base import Columns, Listed, Table, cartesian, column, joined, slope


class Positions(Listed):
    """Positions of one bead or of all, in the scene's unit of length.

    The first bead of the ordered base is at the origin, x is along the base, and the last axis up.
    """

    name = "positions"
    needs_forces = False

    def force_rows(self, load: LoadSpec) -> Rows:
        """No forces are needed."""
        return Rows()

    def region(self, force_rows: Rows) -> Region:
        """Give the triangle below the bead, or the whole packing."""
        if self.scene.site is not None:
            return regions.triangle(*self.scene.site, self.width)
        assert self.width is not None
        return whole(self.width, self.height)

    def line_beads(self, load: LoadSpec) -> int:
        """Count the beads of the two diagonals below the bead."""
        assert self.scene.site is not None
        return 2 * self.scene.site[1] + 1

    def most_beads(self) -> int:
        """Bound the beads to be solved."""
        if self.scene.site is None:
            return (self.top + 1) * (self.width or 0)
        j = self.scene.site[1]
        beads = regions.triangle_beads(j)
        return beads if self.width is None else min(beads, self.width * (j + 1))

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead."""
        return (1 if self.scene.ask.at is not None else region.beads) * realisations

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a bead, from the base up."""
        system, at = solved.system, self.scene.ask.at
        rows: Sequence[Layer] = problem.region.rows
        if at is not None:
            i, j = self.naming.site(at)
            rows = [Layer(j, i, 1)]
        r, index = system.number(self.scene.packing.radius), self.naming.beads(rows)
        moved = cartesian(self._line_sums(solved, rows), problem, system, raised=False)
        axes = axis_names(len(moved))
        change = {f"d{axis}": of * r for axis, of in zip(axes, moved, strict=True)}
        home = self._ordered(problem, rows, index, system)
        place = zip(axes, home, change.values(), strict=True)
        return Table(index, {axis: a + b for axis, a, b in place} | change, tuple(change))

    def _line_sums(self, solved: Solved, rows: Sequence[Layer]) -> list[Array]:
        """Give c of each direction, row by row."""
        system, packing = solved.system, solved.packing
        if solved.single is not None:
            return [column([one], system) for one in solved.single]
        if packing is None:
            return [zeros(system, sum(row.count for row in rows))] * len(self.branches)
        region = packing.region
        return [
            joined(system, [pick(c[row.j], region.rows[row.j], row, self.width) for row in rows])
            for _, c in packing.c
        ]

    def _ordered(
        self, problem: Problem, rows: Sequence[Layer], index: Columns, system: NumberSystem
    ) -> Sequence[Array]:
        """Give the positions of beads in the ordered packing."""
        r = system.number(self.scene.packing.radius)
        if self.by_layers:
            *columns, j = index.values()
            home = [from_floats(system, 2.0 * one) for one in (*columns, j - sum(columns))]
            return [one * r for one in cartesian(home, problem, system, raised=True)]
        x = [_ordered(row.sites(), self.scene.spacing, system) for row in rows]
        step = slope(problem, system) * r
        y = [zeros(system, row.count) + 2 * row.j * step for row in rows]
        return joined(system, x), joined(system, y)


@lru_cache(maxsize=4)
def _ordered(sites: range, spacing: Fraction, system: NumberSystem) -> Array:
    """Give the x of beads of the ordered packing; whole layers take turns."""
    return array(system, [i * spacing / 2 for i in sites])
