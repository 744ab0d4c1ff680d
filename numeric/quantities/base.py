"""The base class of questions: what each needs, its rows, how they are gathered, its limits.

A question is a class of its own in a file of its own; ``quantities.quantities_of`` finds it by
name.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any, ClassVar

import numpy as np

from ..arithmetic.decimals import nearest
from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..disorder.radii import DrawnRadii
from ..lattice import regions
from ..lattice.branch import ORDER, Branch
from ..lattice.layers import Block, Naming, Region, Rows, columns_of, standing_on_base, taken, whole
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Route
from ..mechanics.sweep import Solved
from ..scene.scene import CheckedScene
from ..statistics.bins import Bins
from ..theory.expected import stds_of_contacts

# σ_f/⟨f⟩, and the columns that scatter from sample to sample as others do, whose errors are known.
RATIO = "std_over_mean"
SCATTER_OF = {
    "mean": "mean_change",
    "force_mean": "force_mean_change",
    "vertical_mean": "vertical_mean_change",
    RATIO: "std",
}


Columns = dict[str, Array]


@dataclass(frozen=True)
class Table:
    """Rows of an answer, column by column; all columns have the same length.

    ``index`` names the rows (sites, branches, realisations), and holds what theory says of them, in
    fractions (dtype object). ``numbers`` are in the arithmetic of the run. ``small`` columns are
    the deviations from the ordered packing: accuracy is judged by their error, relative to the
    largest of them. ``errors`` are standard errors of the columns that are statistics over
    packings. ``bins`` are those of a histogram, whose rows are changes.
    """

    index: Columns
    numbers: Columns
    small: tuple[str, ...]
    errors: Columns = field(default_factory=dict)
    bins: Bins | None = None

    @property
    def rows(self) -> int:
        """How many rows there are."""
        return len(next(iter(self.numbers.values()), []))

    @property
    def columns(self) -> Columns:
        """All columns, exact numbers as float64, each standard error beside its number."""
        columns = {
            name: np.array([*map(nearest, values)]) if values.dtype == object else values
            for name, values in self.index.items()
        }
        for name, values in self.numbers.items():
            columns[name] = values
            if name in self.errors:
                columns[f"{name}_error"] = self.errors[name]
        return columns

    @property
    def largest(self) -> float:
        """The largest size of a small number, as a float."""
        sizes = (as_floats(abs(self.numbers[name])).max(initial=0) for name in self.small)
        return float(max(sizes, default=0))

    def sorted(self) -> "Table":
        """Give the rows by realisation, j, i (or p, q) and branch as numbers, "+" before "-"."""
        keys = [self.index[name] for name in (*ORDER, "realisation") if name in self.index]
        if not keys:
            return self
        order = np.lexsort(keys)
        parts = (self.index, self.numbers, self.errors)
        index, numbers, errors = ({k: v[order] for k, v in part.items()} for part in parts)
        return Table(index, numbers, self.small, errors)


class Quantity(ABC):
    """A question about a scene."""

    name: ClassVar[str]
    of_forces: ClassVar[bool] = True
    """Whether its numbers are forces, and not lengths."""
    merged: ClassVar[bool] = False
    """Whether realisations are merged into one set of rows."""
    numbers: ClassVar[int] = 4
    """How many numbers a row has, at the most."""
    roundings: ClassVar[int] = 6
    """Of a number of the answer, sums over many apart, in units 2^-53 of the largest change."""

    def __init__(self, scene: CheckedScene) -> None:
        """Ask a scene's question."""
        self.scene, self.height = scene, scene.packing.height
        self.naming = Naming(scene.packing.dimension, scene.packing.width)
        self.width, self.branches = self.naming.row, self.naming.branches

    # What it needs

    @property
    def needs_forces(self) -> bool:
        """Whether forces are solved for: where contacts open they decide where beads rest."""
        return self.of_forces or self.scene.effects.contacts == "unilateral"

    @property
    def by_layers(self) -> bool:
        """Whether whole layers are solved, whatever is asked."""
        return self.naming.dimension > 2 or self.scene.effects.contacts == "unilateral"

    @property
    def single(self) -> bool:
        """Whether one contact or one bead is solved for, and not the whole packing."""
        return self.scene.ask.at is not None and not self.by_layers

    @property
    def fewest_beads(self) -> int:
        """Bound from below how many beads are solved, before any are listed."""
        layers, load, contact = self.top + 1, self.scene.load, self.scene.contact
        if self.by_layers:
            return layers * (self.width or 0)
        if self.width is not None or load.kind == "file":
            return 0
        if load.at is not None and contact is not None:
            (i, j), (across, top) = contact.upper, load.at
            if abs(across - i) > top - j:  # no load reaches it
                return 0
        return layers * (layers + 1) // 2  # the triangle below a bead of the highest layer

    @property
    def top(self) -> int:
        """The highest layer that is solved: of the load, or as asked."""
        if self.scene.effects.contacts == "unilateral":
            return self.height
        at = self.scene.load.at if self.needs_forces else self.scene.ask.at
        return self.height if at is None else int(at[self.naming.dimension - 1])

    def beads(self, load: LoadSpec) -> tuple[Rows, Region]:
        """Give the beads whose forces are to be balanced, and those that are to be deposited."""
        if self.by_layers:
            region = self.layers_up_to(self.top)
            return region.rows if self.needs_forces else Rows(), region
        rows = self.force_rows(load) if self.needs_forces else Rows()
        return rows, self.region(rows)

    def force_rows(self, load: LoadSpec) -> Rows:
        """Give the beads whose forces are to be balanced."""
        if load.loaded is not None:
            return regions.downward_cone(load.loaded, self.width)
        return self.layers_up_to(self.height).rows

    def layers_up_to(self, top: int) -> Region:
        """Give whole layers of a periodic packing."""
        assert self.width is not None
        return whole(self.width, top, self.naming.dimension)

    def region(self, force_rows: Rows) -> Region:
        """Give the beads that are to be deposited."""
        if not force_rows.beads:
            return Region(self.width, Rows())
        return standing_on_base(force_rows, self.width)

    # What limits it

    @abstractmethod
    def answer_rows(self, region: Region, realisations: int) -> int:
        """Bound the number of rows of the answer."""

    def gathered(self, region: Region, realisations: int) -> int:
        """Bound what gathering so many realisations at once takes beside them, counted in beads."""
        return 0

    def kept(self, region: Region, realisations: int) -> int:
        """Bound the bytes of what is kept of all realisations until the last is gathered."""
        return 0

    # How it is gathered

    def gatherer(self, problem: Problem) -> "Listing":
        """Start to gather the answer: by default a list of one realisation after the other."""
        return Listing(self, problem)

    @abstractmethod
    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give the rows of one realisation."""


class Listing:
    """Gathers solved realisations: lists the rows of one below those of the other."""

    def __init__(self, quantity: Quantity, problem: Problem) -> None:
        """Start empty."""
        self.quantity, self.problem = quantity, problem
        self.parts: list[Table] = []

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Take in solved realisations (in a batch, the first axis of the arrays)."""
        for number, realisation in enumerate(realisations):
            single = solved if len(realisations) == 1 else solved.realisation(number)
            part = self.quantity.rows(self.problem, single)
            if self.problem.realisations > 1:
                number_of = {"realisation": np.full(part.rows, realisation)}
                part = replace(part, index=part.index | number_of)
            self.parts.append(part)

    def table(self) -> Table:
        """Put the realisations below each other."""
        first = self.parts[0]
        return Table(
            {k: np.concatenate([part.index[k] for part in self.parts]) for k in first.index},
            {k: np.concatenate([part.numbers[k] for part in self.parts]) for k in first.numbers},
            first.small,
        )


class ContactQuantity(Quantity):
    """A question about contact forces, of which an ensemble has statistics.

    Its groups hold contacts that are alike: a layer and branch of a profile, or one contact.
    """

    roundings = 1

    def force_rows(self, load: LoadSpec) -> Rows:
        """Give the beads whose force balance decides the one contact's force, or all."""
        contact = self.scene.contact
        if contact is None:
            return super().force_rows(load)
        if load.loaded is None and self.width is None:
            # The slab: the contact's own cone is cut out of rows wide enough for it.
            reach = regions.upward_cone(contact.upper, self.height, None)
        else:
            reach = super().force_rows(load)
        return regions.contact_rows(contact, reach, self.width)

    def blocks(self, problem: Problem) -> list[Block]:
        """Give the one contact, or those that are asked for and that loads reach.

        They are in the order of the groups, with the layers of their upper beads.
        """
        if self.scene.ask.at is not None:
            return [self.naming.contact(self.scene.ask.at)]
        layers = self.scene.ask.layers  # of lower beads
        asked = range(self.height) if layers is None else set(layers)
        rows = [row for row in problem.reached if row.count and row.j - 1 in asked]
        return [Block(branch, row) for row in rows for branch in self.branches]

    @property
    def all_contacts(self) -> list[Block]:
        """The contacts of a whole periodic packing."""
        rows = self.layers_up_to(self.height).rows[1:]
        return [Block(branch, row) for row in rows for branch in self.branches]

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Give columns that name the groups, one entry a group."""
        contacts = self.naming.contacts(self.blocks(problem))
        return {name: column.tolist() for name, column in contacts.items()}

    def members(self, problem: Problem) -> int:
        """Count the contacts of a group."""
        return 1

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give ordered and changed forces of the groups.

        Shapes: (groups, 1 or members) and (groups, realisations, members).
        """
        F, g = contact_forces(solved, self.blocks(problem), realisations)
        return F[:, None], g.T[:, :, None]

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give the contacts that loads reach."""
        return self.listed(self.blocks(problem), solved)

    def listed(self, blocks: Sequence[Block], solved: Solved) -> Table:
        """Give a row a contact."""
        F, g = contact_forces(solved, blocks, 1)
        return Table(self.naming.contacts(blocks), {"force": F + g[0], "change": g[0]}, ("change",))


def contact_forces(
    solved: Solved, blocks: Sequence[Block], realisations: int
) -> tuple[Array, Array]:
    """Give F, shape (contacts,), and g, (realisations, contacts), block after block.

    Contacts that no load reaches have zeros.
    """
    system, rows = solved.system, solved.rows
    if solved.single is not None:  # line sums of the one contact
        force, change = (system.filled([number]) for number in solved.single)
        return force, change[None]
    zero = system.zeros(1)[0]
    F, g = [system.zeros(0)], [system.zeros(realisations, 0)]
    for branch, row in blocks:
        j, a = row.j, branch.number
        if j >= len(rows) or not rows[j].count:  # no load reaches this layer
            F.append(system.zeros(row.count))
            g.append(system.zeros(realisations, row.count))
            continue
        columns = columns_of(rows[j], row, solved.region.width)
        F.append(taken(solved.ordered(a, j), columns, zero))
        g.append(taken(solved.change(a, j), columns, zero))
    return np.concatenate(F), np.concatenate(g, axis=1)


def has_theory(problem: Problem) -> bool:
    """Say whether the closed forms of variances hold: Eqs. 13, 14, B2, B3, B13 and B14.

    They are those of drawn radii under loads on whole layers, of spheres straight down, where
    first-order forces see no images.
    """
    load, drawn = problem.load, isinstance(problem.radii, DrawnRadii)
    if not drawn or load.loaded is not None or problem.route == Route.ORDERED:
        return False
    if problem.dimension > 2:
        spheres = problem.dimension == 3 and not load.angle_deg
        return spheres and problem.region.side > problem.height + 1
    return problem.width is None or problem.width > problem.height


def first_order_std(problem: Problem, contacts: Iterable[tuple[int, str]]) -> Array | None:
    """Give σ_f of contacts (j, branch), exact to first order (Eqs. 13, 14, B2, B3 at finite M).

    Shape (contacts,): fractions, a float64 times the exact σ/r, in units of the load. None where
    the equations don't apply.
    """
    load, height = problem.load, problem.height
    if not has_theory(problem):
        return None
    std, phi = problem.radii.relative_std, float(problem.phi)
    unit = tuple(map(float, load.strength(problem.n_x, FLOAT64).unit))
    stds = []
    for j, branch in contacts:
        over = height - j if load.kind == "bulk" else 1
        of = stds_of_contacts(load.kind, height, j, phi, unit)[Branch(branch).number]
        stds.append(Fraction(of * over) * std)
    return np.array(stds, dtype=object)
