"""All contact forces."""

import numpy as np

from ..lattice.layers import Block, Region, full_layer
from ..mechanics.problem import Problem, Solved
from ..unilateral.network import Network, Relaxed
from .base import ContactQuantity, Table


class ContactForces(ContactQuantity):
    """All contact forces; of a periodic packing also those that no load reaches, exactly zero.

    Contacts that open are pairs of beads, named as they were deposited; only those that bear force
    are listed, with a branch where the two are neighbours of the lattice.
    """

    name = "contact_forces"
    numbers = 2

    def answer_rows(self, region: Region, realisations: int) -> int:
        """The contacts below each bead above the base."""
        beads = region.beads if self.width is None else self.width * self.height
        return len(self.branches) * beads * realisations

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a contact."""
        if isinstance(solved, Relaxed):
            return of_network(solved.network)
        blocks = self.blocks(problem)
        if self.width is not None:
            rows = [full_layer(j, self.width) for j in range(1, self.height + 1)]
            blocks = [Block(b, row) for row in rows for b in self.branches]
        return self.listed(blocks, solved)


def of_network(network: Network) -> Table:
    """Give a row a contact, by its lower bead, then its upper one."""
    order = np.lexsort((network.pairs[:, 0], network.pairs[:, 1]))
    pairs = network.pairs[order]
    (upper_i, upper_j), (i, j) = (network.names(pairs[:, end]) for end in (0, 1))
    branch = np.array([network.branch(pair) for pair in pairs])
    index = {"i": i, "j": j, "branch": branch, "upper_i": upper_i, "upper_j": upper_j}
    return Table(index, {"force": network.forces[order]}, ("force",))
