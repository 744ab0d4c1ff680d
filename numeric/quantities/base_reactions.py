"""What the base bears."""

from ..arithmetic.systems import Array, zeros
from ..lattice.branch import axis_names
from ..lattice.layers import Layer, Region, Rows, full_layer
from ..mechanics.problem import Problem, Route, Solved
from .base import Listed, Table, cartesian


class BaseReactions(Listed):
    """The force with which the base holds each of its beads, own load included."""

    name = "base_reactions"
    plain = True
    lowest_layer = 0

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead of the base."""
        on_base = self.width or (region.rows[0].count if region.rows else 1)
        return on_base * realisations

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give a row a bead of the base, from left to right, with the layer above it."""
        forces = solved.forces
        rows = problem.force_rows
        layer = rows[0] if self.width is None else full_layer(0, self.width)
        stopped = forces is not None and forces.stopped is not None and forces.stopped.j
        if stopped or 1 not in layers:
            layer = Layer(0, 0, 0)  # the sweep did not come down to the base
        F, change = (
            cartesian(of, problem, solved.system, raised=True)
            for of in on_base(problem, solved, layer)
        )
        axes = axis_names(len(F))
        changes = {f"change_{axis}": of for axis, of in zip(axes, change, strict=True)}
        total = {f"f{axis}": a + b for axis, a, b in zip(axes, F, change, strict=True)}
        return Table(self.naming.beads([layer]), total | changes, tuple(changes))


def on_base(
    problem: Problem, solved: Solved, layer: Layer
) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
    """Give what contacts and loads press onto the base, as Σ v^a n^a: ordered, and change."""
    system, forces, region = solved.system, solved.forces, problem.region
    base, strength = Rows([layer.first], [layer.count]), problem.load.strength(problem.n_x, system)
    own = problem.load.on(base, strength, system)
    nothing = zeros(system, layer.count)
    ordered = [nothing if load[0] is None else nothing + load[0] for _, load in own]
    change = [nothing] * len(ordered)
    if forces is None or len(forces.rows) < 2 or not layer.count:
        return tuple(ordered), tuple(change)
    zero = zeros(system, 1)[0]
    for a, (branch, *values) in enumerate(forces.below(1)):
        F, g = (region.above(v, forces.rows[1], layer, a, zero) for v in values)
        ordered[a] = ordered[a] + F
        change[a] = change[a] + g
        if solved.packing is None:
            continue
        # to first order, a change of the force times one of its direction is left out
        f = F if problem.route == Route.FIRST_ORDER else F + g
        source = solved.packing.region.rows[1]
        for b, of in enumerate(solved.packing.dn[branch][1]):
            change[b] = change[b] + f * region.above(of, source, layer, a, zero)
    return tuple(ordered), tuple(change)
