"""Positions of beads."""

from collections.abc import Sequence

import numpy as np

from ..arithmetic.systems import Array
from ..lattice import regions
from ..lattice.branch import axis_names
from ..lattice.layers import Layer, Region, Rows, columns_of, taken
from ..mechanics.problem import Problem, cartesian, ordered_places
from ..mechanics.sweep import Solved
from ..unilateral.network import Relaxed
from .base import Quantity, Table


class Positions(Quantity):
    """Positions of one bead or of all, in the scene's unit of length.

    The first bead of the ordered base is at the origin, x is along the base, and the last axis up.
    Where contacts open, that of a bead which bears no force is one of many.
    """

    name = "positions"
    of_forces = False

    def region(self, force_rows: Rows) -> Region:
        """Give the triangle below the bead, or the whole packing."""
        if self.scene.site is not None:
            return Region(self.width, regions.downward_cone([self.scene.site], self.width))
        return self.layers_up_to(self.height)

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
        home = [of * r for of in ordered_places(index.values(), problem, system)]
        if isinstance(solved, Relaxed):
            beads = index["j"] * solved.network.width + index["i"] // 2
            index["contacts"] = solved.network.bearing[beads]
            change = [x * r - at for x, at in zip(solved.network.x[beads].T, home, strict=True)]
        else:
            moved = self._moved(solved, rows)
            change = [of * r for of in cartesian(moved, problem, system, raised=False)]
        axes = axis_names(len(home))
        place = zip(axes, home, change, strict=True)
        moves = {f"d{axis}": of for axis, of in zip(axes, change, strict=True)}
        return Table(index, {axis: a + b for axis, a, b in place} | moves, tuple(moves))

    def _moved(self, solved: Solved, rows: Sequence[Layer]) -> list[Array]:
        """Give c of each direction, row by row."""
        system, region = solved.system, solved.region
        if solved.single is not None:  # line sums of the one bead
            return [system.filled([number]) for number in solved.single]
        if solved.block is None:
            return [system.zeros(sum(row.count for row in rows))] * len(self.branches)
        columns = [columns_of(region.rows[row.j], row, self.width) for row in rows]
        parts = (
            [taken(solved.c(a, row.j)[0], at) for row, at in zip(rows, columns, strict=True)]
            for a in range(region.dimension)
        )
        return [np.concatenate([system.array([]), *each]) for each in parts]
