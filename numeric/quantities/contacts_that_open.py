"""The questions under unilateral contacts, whose contacts are pairs of beads and no longer i, j, ±.

Rows name both beads as they were deposited, and the branch where they are neighbours of the
lattice. Only contacts that bear force are listed.
"""

import numpy as np

from ..arithmetic.systems import NumberSystem
from ..lattice.layers import Region, Rows, whole
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved, axes
from ..unilateral.network import Network, Relaxed
from .base import Listed, Table, column


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
        return 2 * region.beads

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give all rows."""
        assert isinstance(solved, Relaxed)
        return self.listed(problem, solved.network, solved.system)

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give the rows of a network."""
        raise NotImplementedError


class NetworkForces(NetworkQuantity):
    """All contacts that bear force."""

    name = "contact_forces"

    def listed(self, problem: Problem, network: Network, system: NumberSystem) -> Table:
        """Give a row a contact, by its lower bead, then its upper one."""
        order = np.lexsort((network.pairs[:, 0], network.pairs[:, 1]))
        pairs = network.pairs[order]
        lower = [network.bead(b) for _, b in pairs]
        upper = [network.bead(a) for a, _ in pairs]
        index = {
            "i": np.array([i for i, _ in lower]),
            "j": np.array([j for _, j in lower]),
            "branch": np.array([network.branch(pair) for pair in pairs]),
            "upper_i": np.array([i for i, _ in upper]),
            "upper_j": np.array([j for _, j in upper]),
        }
        return Table(index, {"force": network.forces[order]}, ("force",))


class NetworkPositions(NetworkQuantity):
    """Where beads rest, in the scene's unit of length; that of a rattler is one of many."""

    name = "positions"

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


NETWORK_QUANTITIES: dict[str, type[NetworkQuantity]] = {
    "contact_forces": NetworkForces,
    "positions": NetworkPositions,
}
