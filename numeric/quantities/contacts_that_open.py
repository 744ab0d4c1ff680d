"""The questions under unilateral contacts, whose contacts are pairs of beads and no longer i, j, ±.

Rows name both beads as they were deposited, and the branch where they are neighbours of the
lattice. Only contacts that bear force are listed.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import FLOAT64, Array, NumberSystem, as_floats
from ..lattice.branch import Branch
from ..lattice.layers import Region, Rows, whole
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved, axes
from ..statistics.bins import histogram
from ..statistics.moments import root
from ..statistics.ratios import moments
from ..unilateral import Network, Relaxed
from .base import RATIO, Gatherer, Listed, Table, column
from .histogram import DEFAULT_BINS


class NetworkQuantity(Listed):
    """A question about a whole strip, all of whose beads may move."""

    @property
    def single(self) -> bool:
        """Every bead is needed, whatever is asked."""
        return False

    def beads(self, load: LoadSpec) -> tuple[Rows, Region]:
        """Give all beads."""
        assert self.width is not None
        region = whole(self.width, self.height)
        return region.rows, region

    def most_beads(self) -> int:
        """Count all beads."""
        return (self.height + 1) * (self.width or 0)

    def answer_rows(self, region: Region, realisations: int) -> int:
        """Two contacts a bead, at most."""
        return 2 * region.beads * realisations

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give the rows of one realisation; it is never cut into layers."""
        assert isinstance(solved, Relaxed)
        return self.listed(problem, solved.network, solved.system)

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give the rows of one network."""
        raise NotImplementedError

    squares = False  # covariances are known on the lattice only

    def members(self, problem: Problem) -> int:
        """Give 0: how many contacts a group has differs from packing to packing."""
        return 0

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Give columns that name the groups of samples of which an ensemble has statistics."""
        raise NotImplementedError

    def samples(self, problem: Problem, network: Network) -> tuple[Array, Array]:
        """Give the group of each sample, and its value less that of ``ordered``, in float64."""
        raise NotImplementedError

    def ordered(self, problem: Problem) -> Array:
        """Give the ordered force of each group, exact floats; 0 where forces differ anyway."""
        return np.zeros(len(next(iter(self.labels(problem).values()), [None])))

    def mean_force(self, problem: Problem) -> float:
        """Give the mean force of the ordered packing, as in ``NetworkProfile``; 0 if unknown."""
        return float(NetworkProfile(self.scene).ordered(problem)[:-1].mean())

    def sums(self, problem: Problem, network: Network) -> Array:
        """Give how many samples each group has, their sums and those of squares, (3, groups)."""
        group, value = self.samples(problem, network)
        count = len(self.ordered(problem))
        return np.stack([np.bincount(group, value**k, minlength=count) for k in range(3)])


class NetworkForces(NetworkQuantity):
    """All contacts that bear force."""

    name = "contact_forces"

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give a row a contact, by its lower bead, then its upper one."""
        order = np.lexsort((network.pairs[:, 0], network.pairs[:, 1]))
        return _contacts(network, order, {"force": network.forces[order]})


class NetworkContact(NetworkQuantity):
    """The force of one contact of the lattice: zero where it opened."""

    name = "contact"
    statistics = True

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """There is one group."""
        assert self.scene.contact is not None
        i, j, branch = self.scene.contact
        return {"i": [self.naming.home(i)], "j": [j], "branch": [branch.value]}

    def samples(self, problem: Problem, network: Network) -> tuple[Array, Array]:
        """Give the one force."""
        change = self._force(network, FLOAT64) - self.ordered(problem)
        return np.zeros(1, dtype=int), as_floats(change)

    def ordered(self, problem: Problem) -> Array:
        """Give its force in the ordered packing."""
        assert self.scene.contact is not None
        strength = problem.load.strength(problem.n_x, FLOAT64)
        found = problem.load.ordered_force(self.scene.contact, strength, FLOAT64)
        return np.array([float(found)])

    def _force(self, network: Network, system: NumberSystem) -> Any:
        assert self.scene.contact is not None
        i, j, branch = self.scene.contact
        for pair, value in zip(network.pairs, network.forces, strict=True):
            here = network.bead(pair[1]) == (self.naming.home(i), j)
            if here and network.branch(pair) == branch.value:
                return value
        return system.number(Fraction(0))

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give its row."""
        return Table(
            {name: np.array(values) for name, values in self.labels(problem).items()},
            {"force": column([self._force(network, system)], system)},
            ("force",),
        )


class NetworkResponse(NetworkQuantity):
    """The contacts that bear an isolated load, with the vertical components of their forces."""

    name = "response"
    statistics = True

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the beads but those of the surface, which bear nothing."""
        assert self.width is not None
        sites = [(2 * q + j % 2, j) for j in range(self.height) for q in range(self.width)]
        return {"i": [i for i, _ in sites], "j": [j for _, j in sites]}

    def samples(self, problem: Problem, network: Network) -> tuple[Array, Array]:
        """Give the vertical force that each bead bears from those above it."""
        beads = self.height * network.width
        borne = as_floats(network.pushes()[:, 1])
        lower = network.pairs[:, 1]
        found = np.bincount(lower, borne, minlength=beads)[:beads]
        return np.arange(beads), found

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give a row a contact."""
        order = np.lexsort((network.pairs[:, 0], network.pairs[:, 1]))
        pushes = network.pushes()[order]
        return _contacts(network, order, {"force": network.forces[order], "vertical": pushes[:, 1]})


class NetworkPositions(NetworkQuantity):
    """Where beads rest, in the scene's unit of length; that of a rattler is one of many."""

    name = "positions"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a bead."""
        return region.beads * realisations

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give a row a bead, from the base up."""
        r = system.number(self.scene.packing.radius)
        beads = range(len(network.x))
        if self.scene.site is not None:
            i, j = self.scene.site
            bead = j * network.width + self.naming.home(i) // 2
            beads = range(bead, bead + 1)
        names = [network.bead(number) for number in beads]
        bearing = np.bincount(network.pairs.ravel(), minlength=len(network.x))
        nx, ny = axes(problem.n_x, system)
        x = column([network.x[b, 0] * r for b in beads], system)
        y = column([network.x[b, 1] * r for b in beads], system)
        home_x = column([2 * nx * i * r for i, _ in names], system)
        home_y = column([2 * ny * j * r for _, j in names], system)
        return Table(
            {
                "i": np.array([i for i, _ in names]),
                "j": np.array([j for _, j in names]),
                "contacts": np.array([int(bearing[b]) for b in beads]),
            },
            {"x": x, "y": y, "dx": x - home_x, "dy": y - home_y},
            ("dx", "dy"),
        )


class NetworkHistogram(NetworkQuantity):
    """All contact forces, counted into bins: P(f)."""

    name = "histogram"
    statistics = True

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """There is one group, which needs no name."""
        return {}

    def samples(self, problem: Problem, network: Network) -> tuple[Array, Array]:
        """Give all forces."""
        return np.zeros(len(network.forces), dtype=int), as_floats(network.forces)

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give all forces of one realisation."""
        return Table({}, {"force": network.forces}, ("force",))

    def bins_of(self, table: Table, system: NumberSystem) -> list[tuple[Fraction, Fraction, int]]:
        """Count the forces into equal bins."""
        return histogram(table.numbers["force"], self.scene.ask.bins or DEFAULT_BINS, system)


class NetworkProfile(NetworkQuantity):
    """Mean and standard deviation of contact forces, by the layer of the lower bead."""

    name = "profile"
    merged = True
    statistics = True

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the layers; two beads of the surface may touch."""
        return {"j": list(range(self.height + 1))}

    def samples(self, problem: Problem, network: Network) -> tuple[Array, Array]:
        """Give all forces, by layer."""
        layer = network.pairs[:, 1] // network.width
        return layer, as_floats(network.forces - self.ordered(problem)[layer])

    def ordered(self, problem: Problem) -> Array:
        """Give the force of each layer under a load straight down on all beads."""
        found = np.zeros(self.height + 1)
        load = problem.load
        if load.loaded is None and not load.angle_deg:
            strength = load.strength(problem.n_x, FLOAT64)
            for j in range(self.height):
                found[j] = load.ordered_force((j % 2, j, Branch.PLUS), strength, FLOAT64)
        return found

    def gatherer(self, problem: Problem, system: NumberSystem) -> Gatherer:
        """Start to merge."""
        return _Layers(self, problem, system)


class _Layers(Gatherer):
    def __init__(self, quantity: NetworkProfile, problem: Problem, system: NumberSystem) -> None:
        self.quantity, self.problem, self.system = quantity, problem, system
        self.forces: list[list[Any]] = [[] for _ in range(quantity.height + 1)]
        self.sums: list[Array] = []  # of each packing: counts, sums and squares of every layer

    def add(self, solved: Solved, realisations: Sequence[int], layers: range) -> None:
        """Sort forces by the layer of the lower bead."""
        assert isinstance(solved, Relaxed)
        for pair, force in zip(solved.network.pairs, solved.network.forces, strict=True):
            self.forces[solved.network.bead(pair[1])[1]].append(force)
        self.sums.append(self.quantity.sums(self.problem, solved.network))

    def table(self) -> Table:
        """One row a layer that bears force, base first."""
        rows = [(j, forces) for j, forces in enumerate(self.forces) if forces]
        means = [sum(forces[1:], forces[0]) / len(forces) for _, forces in rows]
        spread = [
            sum(((f - mean) * (f - mean) for f in forces), self.system.number(Fraction(0)))
            / len(forces)
            for (_, forces), mean in zip(rows, means, strict=True)
        ]
        std = root(column(spread, self.system), self.system)
        *_, of_mean, of_std = moments(*np.stack(self.sums, axis=1)[:, :, [j for j, _ in rows]])
        return Table(
            {
                "j": np.array([j for j, _ in rows]),
                "samples": np.array([len(forces) for _, forces in rows]),
            },
            {"mean": (mean := column(means, self.system)), "std": std, RATIO: std / mean},
            ("mean", "std"),
            {"mean": of_mean, "std": of_std},
        )


def _contacts(network: Network, order: Array, numbers: dict[str, Array]) -> Table:
    pairs = network.pairs[order]
    lower = [network.bead(b) for _, b in pairs]
    upper = [network.bead(a) for a, _ in pairs]
    return Table(
        {
            "i": np.array([i for i, _ in lower]),
            "j": np.array([j for _, j in lower]),
            "branch": np.array([network.branch(pair) for pair in pairs]),
            "upper_i": np.array([i for i, _ in upper]),
            "upper_j": np.array([j for _, j in upper]),
        },
        numbers,
        ("force",),
    )


NETWORK_QUANTITIES: dict[str, type[NetworkQuantity]] = {
    one.name: one
    for one in (
        NetworkContact,
        NetworkForces,
        NetworkPositions,
        NetworkProfile,
        NetworkHistogram,
        NetworkResponse,
    )
}
