"""The questions in three dimensions: beads (p, q, j), and contacts along three axes.

Rows of W² beads take the place of layers of W (see ``lattice.layers.Region``).
"""

from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import Array, NumberSystem, from_floats, zeros
from ..lattice.branch import Axis
from ..lattice.layers import Layer, Region, full_layer, lower_beads, whole
from ..lattice.regions import Rows
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved
from ..scene.scene import Scene
from .base import Block, ContactQuantity, Listed, Quantity, Table, contact_changes, slope
from .base_reactions import on_base
from .contact_forces import ContactForces
from .histogram import Histogram
from .profile import Profile
from .response import Response


class SphereQuantity(Quantity):
    """A question about all W² beads of each layer, up to the highest load."""

    branches = tuple(Axis)

    def __init__(self, scene: Scene) -> None:
        """Ask a scene's question."""
        super().__init__(scene)
        assert self.width is not None
        self.side, self.width = self.width, self.width**2
        load = scene.load
        self.top = self.height
        if self.needs_forces and load.at is not None and not load.pressure:
            self.top = int(load.at[2])
        elif self.needs_forces is False and scene.ask.at is not None:
            self.top = int(scene.ask.at[2])

    @property
    def single(self) -> bool:
        """Every bead is needed, whatever is asked."""
        return False

    def beads(self, load: LoadSpec) -> tuple[Rows, Region]:
        """Give all beads that bear load or are asked for, and those below them."""
        assert self.width is not None
        region = whole(self.width, self.top, dimension=3)
        return region.rows, region

    def most_beads(self) -> int:
        """Count them."""
        return (self.top + 1) * (self.width or 0)

    def sites_of(self, rows: Sequence[Layer]) -> dict[str, Array]:
        """Give the columns p, q and j of beads, row by row."""
        j = np.repeat([row.j for row in rows], [row.count for row in rows]).astype(np.int64)
        columns = [np.arange(row.count) + (row.first - row.j % 2) // 2 for row in rows]
        p, q = np.divmod(np.concatenate([np.empty(0, np.int64), *columns]), self.side)
        return {"p": p, "q": q, "j": j}

    def contacts_of(self, blocks: Sequence[Block]) -> dict[str, Array]:
        """Give the columns p, q, j and branch of contacts, by their lower beads."""
        found = self.sites_of([row for _, row in blocks])
        names = np.array([branch.value for branch, _ in blocks], dtype="U1")
        branch = np.repeat(names, [row.count for _, row in blocks])
        below = lower_beads(found, branch, self.side)
        return {**below, "branch": branch}


class SphereContacts(SphereQuantity, ContactQuantity):
    """A question about contact forces."""


class SphereForces(SphereContacts, ContactForces):
    """All contact forces."""


class SphereProfile(SphereContacts, Profile):
    """Mean force, mean and standard deviation of its change, by layer and axis."""


class SphereHistogram(SphereContacts, Histogram):
    """All changes of contact forces, to be counted into bins."""


class SphereResponse(SphereContacts, Response):
    """All contacts below a point load; those that it does not reach bear nothing."""


class SphereContact(SphereContacts, Listed):
    """One contact force and its change."""

    name = "contact"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a realisation."""
        return realisations

    @property
    def place(self) -> tuple[Block, int]:
        """The contact's axis and row of upper beads, and its place in that row."""
        assert self.scene.ask.at is not None
        p, q, j, name = self.scene.ask.at
        axis = Axis(name)
        column = (int(p) + (axis == Axis.FIRST)) % self.side * self.side
        column += (int(q) + (axis == Axis.SECOND)) % self.side
        return Block(axis, full_layer(int(j) + 1, self.width or 0)), column

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the one group."""
        assert self.scene.ask.at is not None
        return {k: [v] for k, v in zip(("p", "q", "j", "branch"), self.scene.ask.at, strict=True)}

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (1, 1), and g, (1, realisations, 1)."""
        block, column = self.place
        ((_, F, g),) = contact_changes(solved, [block], realisations)
        return F[None, column : column + 1], g[None, :, column : column + 1]

    def ordered(self, problem: Problem) -> list[Fraction]:
        """Give the ordered force."""
        block, column = self.place
        (forces,) = self.ordered_of(problem, [block])
        return [forces[column] if forces else Fraction(0)]

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give the one row, with the layer of its upper bead."""
        if self.place[0].row.j not in layers:
            none = zeros(solved.system, 0)
            return Table({}, {"force": none, "change": none}, ("change",))
        F, g = self.changes(problem, solved, 1)
        index = {k: np.array(v) for k, v in self.labels(problem).items()}
        return Table(index, {"force": F[0] + g[0, 0], "change": g[0, 0].copy()}, ("change",))


class SpherePositions(SphereQuantity, Listed):
    """Positions of one bead or of all, in the scene's unit of length.

    x is along n^1 − n^3, z is up, and bead (0, 0, 0) is at the origin.
    """

    name = "positions"
    needs_forces = False

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead."""
        return (1 if self.scene.ask.at is not None else region.beads) * realisations

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give a row a bead of some layers, from the lowest up."""
        system, r = solved.system, solved.system.number(self.scene.packing.radius)
        rows = [row for row in problem.region.rows if row.j in layers]
        at = self.scene.ask.at
        if at is not None:
            rows = [row for row in rows if row.j == int(at[2])]
        c = [zeros(system, 3, row.count) for row in rows]
        if solved.packing is not None:
            of = [values for _, values in solved.packing.c]
            c = [np.stack([values[row.j] for values in of]) for row in rows]
        if at is not None and rows:
            p, q, j = map(int, at)
            column = p * self.side + q
            rows, c = [Layer(j, 2 * column + j % 2, 1)], [c[0][:, column : column + 1]]
        index, all_c = self.sites_of(rows), np.concatenate([zeros(system, 3, 0), *c], axis=1)
        moved = _cartesian(all_c, problem, system, raised=False)
        first, second, layer = index.values()
        home = np.stack([2 * first, 2 * second, 2 * (layer - first - second)])
        numbers = from_floats(system, home.astype(np.float64))
        placed = _cartesian(numbers, problem, system, raised=True)
        names = ("x", "y", "z")
        return Table(
            index,
            {name: (a + b) * r for name, a, b in zip(names, placed, moved, strict=True)}
            | {f"d{name}": a * r for name, a in zip(names, moved, strict=True)},
            tuple(f"d{name}" for name in names),
        )


class SphereBase(SphereQuantity, Listed):
    """The force with which the base holds each of its beads, own load included."""

    name = "base_reactions"
    lowest_layer = 0

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead of the base."""
        return (self.width or 0) * realisations

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give a row a bead of the base, with the layer above it."""
        system, layer = solved.system, full_layer(0, self.width or 0)
        if 1 not in layers:
            layer = Layer(0, 0, 0)
        F, change = map(np.stack, on_base(problem, solved, layer))
        numbers = {}
        for name, value, moved in zip(
            ("x", "y", "z"),
            _cartesian(F, problem, system, raised=True),
            _cartesian(change, problem, system, raised=True),
            strict=True,
        ):
            numbers[f"f{name}"], numbers[f"change_{name}"] = value + moved, moved
        small = ("change_x", "change_y", "change_z")
        ordered = {k: numbers[k] for k in ("fx", "fy", "fz", *small)}
        return Table(self.sites_of([layer]), ordered, small)


def _cartesian(
    components: Array, problem: Problem, system: NumberSystem, *, raised: bool
) -> tuple[Array, Array, Array]:
    """Give (x, y, z) of v = Σ v^a n^a, or of a vector with v_a = n^a·v, along the first axis."""
    a, b, c = components
    nx, nz = system.scalar(problem.n_x), slope(problem, system)
    third = system.root(Fraction(1, 3))
    x, y, z = a - c, (2 * b - a - c) * third, a + b + c
    if raised:
        return x * nx, y * nx, z * nz
    return x / (2 * nx), y / (2 * nx), z / (3 * nz)


SPHERE_QUANTITIES: dict[str, Callable[[Scene], Quantity]] = {
    one.name: one
    for one in (
        SphereContact,
        SphereForces,
        SpherePositions,
        SphereProfile,
        SphereHistogram,
        SphereResponse,
        SphereBase,
    )
}
