"""Positions of beads."""

from fractions import Fraction
from functools import lru_cache

from ..arithmetic.systems import Array, NumberSystem, array, zeros
from ..lattice import regions
from ..lattice.layers import Layer, Region, pick, whole
from ..lattice.regions import Rows
from ..mechanics import plain
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved
from .base import Listed, Table, column, joined


class Positions(Listed):
    """Positions of one bead or of all, in the scene's unit of length."""

    name = "positions"
    needs_forces = False
    plain = True

    def force_rows(self, load: LoadSpec) -> Rows:
        """No forces are needed."""
        return ()

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
            assert self.width is not None
            return self.width * (self.height + 1)
        j = self.scene.site[1]
        beads = regions.triangle_beads(j)
        return beads if self.width is None else min(beads, self.width * (j + 1))

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead."""
        return (1 if self.single else region.beads) * realisations

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give a row a bead of some layers, from the lowest up."""
        scene, system = self.scene, solved.system
        nx, ny = plain.axes(scene.n_x, system)
        r = system.number(scene.packing.radius)
        rows = [row for row in problem.region.rows if row.j in layers]
        if scene.site is not None:
            i, j = scene.site
            rows = [Layer(j, i, 1)] if j in layers else []
        columns: dict[str, list[Array]] = {"x": [], "y": [], "dx": [], "dy": []}
        for layer in rows:
            cp, cm = self._line_sums(solved, layer)
            dx, dy = (cp - cm) / (2 * nx) * r, (cp + cm) / (2 * ny) * r
            columns["x"].append(_ordered(layer.sites(), scene.spacing, system) + dx)
            columns["y"].append(dy + 2 * layer.j * (ny * r))
            columns["dx"].append(dx)
            columns["dy"].append(dy)
        return Table(
            self.sites_of(rows),
            {name: joined(system, parts) for name, parts in columns.items()},
            ("dx", "dy"),
        )

    def _line_sums(self, solved: Solved, layer: Layer) -> tuple[Array, Array]:
        if solved.single is not None:
            return column([solved.single[0]], solved.system), column(
                [solved.single[1]], solved.system
            )
        if solved.packing is None:
            nothing = zeros(solved.system, layer.count)
            return nothing, nothing
        source, c = solved.packing.region.rows[layer.j], solved.packing.c
        return (
            pick(c.plus[layer.j], source, layer, self.width),
            pick(c.minus[layer.j], source, layer, self.width),
        )


@lru_cache(maxsize=4)
def _ordered(sites: range, spacing: Fraction, system: NumberSystem) -> Array:
    """Give the x of beads of the ordered packing; whole layers take turns."""
    return array(system, [i * spacing / 2 for i in sites])
