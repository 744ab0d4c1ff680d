"""What the base bears."""

from ..arithmetic.systems import Array, zeros
from ..lattice.branch import Branch, Direction
from ..lattice.layers import Layer, Region, full_layer, pick
from ..mechanics import plain
from ..mechanics.problem import Problem, Route, Solved
from .base import Listed, Table


class BaseReactions(Listed):
    """The force with which the base holds each of its beads, own load included."""

    name = "base_reactions"
    plain = True
    lowest_layer = 0

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead of the base."""
        on_base = self.width or (region.rows[0].count if region.rows else 1)
        return on_base * realisations

    def rows_of(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a bead of the base, from left to right."""
        system, forces = solved.system, solved.forces
        nx, ny = plain.axes(problem.n_x, system)
        rows = problem.force_rows
        layer = rows[0] if self.width is None else full_layer(0, self.width)
        if forces is not None and forces.stopped is not None and forces.stopped.j:
            layer = Layer(0, 0, 0)  # the sweep did not come down to the base
        own = problem.load.on((layer,), problem.load.strength(problem.n_x, system), system)
        zero = zeros(system, layer.count)
        plus = zero if own.plus[0] is None else own.plus[0]
        minus = zero if own.minus[0] is None else own.minus[0]
        change_plus, change_minus = zero, zero
        if forces is not None and len(rows) > 1 and layer.count:
            F, g, a, b = self._above(solved, layer)
            p, m = Branch.PLUS, Branch.MINUS
            plus, minus = plus + F[p], minus + F[m]
            # to first order, a change of the force times one of its direction is left out
            f = F if problem.route == Route.FIRST_ORDER else {s: F[s] + g[s] for s in Branch}
            change_plus = g[p] + (f[p] * a[p] + f[m] * a[m])
            change_minus = g[m] + (f[p] * b[p] + f[m] * b[m])
        cx, cy = (change_plus - change_minus) * nx, (change_plus + change_minus) * ny
        return Table(
            self.sites_of([layer]),
            {
                "fx": (plus - minus) * nx + cx,
                "fy": (plus + minus) * ny + cy,
                "change_x": cx,
                "change_y": cy,
            },
            ("change_x", "change_y"),
        )

    def _above(self, solved: Solved, layer: Layer) -> tuple[dict[Direction, Array], ...]:
        """F, g and the components of δn of the two contacts above each base bead."""
        assert solved.forces is not None
        zero = zeros(solved.system, 1)[0]
        found: tuple[dict[Direction, Array], ...] = {}, {}, {}, {}
        F, g, a, b = found
        for branch, ordered, change in solved.forces.below(1):
            at = Layer(1, layer.first + branch.side, layer.count)
            F[branch] = pick(ordered, solved.forces.rows[1], at, self.width, zero)
            g[branch] = pick(change, solved.forces.rows[1], at, self.width, zero)
            a[branch] = b[branch] = zeros(solved.system, layer.count)
            if solved.packing is not None:
                source = solved.packing.region.rows[1]
                a[branch], b[branch] = (
                    pick(v, source, at, self.width, zero) for v in solved.packing.dn[branch][1]
                )
        return found
