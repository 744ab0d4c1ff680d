"""All contact forces."""

import math
from dataclasses import replace

import numpy as np

from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import axis_names, bead_names
from ..lattice.layers import Region
from ..mechanics.problem import Problem, cartesian, ordered_places
from ..mechanics.sweep import Solved
from ..scene.sections import LARGEST
from ..unilateral.network import Network, Relaxed
from .base import Columns, ContactQuantity, Table


class ContactForces(ContactQuantity):
    """All contact forces; of a periodic packing also those that no load reaches, exactly zero.

    Contacts that open are pairs of beads, named as they were deposited; only those that bear force
    are listed, with a branch where the two are neighbours of the lattice.
    """

    name = "contact_forces"
    numbers = 7

    def answer_rows(self, region: Region, realisations: int) -> int:
        """The contacts below each bead above the base."""
        beads = region.beads if self.width is None else self.width * self.height
        return len(self.branches) * beads * realisations

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a contact, with the places of both its beads, to be drawn.

        The upper bead is the image next to the lower one; ``wraps`` says which contacts cross the
        seam. Centres are rounded to 1e-12 r. NaN: the answer doesn't depend on the bead.
        """
        if isinstance(solved, Relaxed):
            table, low, high, wraps = of_network(solved.network)
        else:
            blocks = self.blocks(problem) if self.width is None else self.all_contacts
            table = self.listed(blocks, solved)
            low, high, wraps = self._ends(problem, solved, table.index)
        axes, radius = axis_names(problem.dimension), self.scene.packing.radius
        r = float(radius) if radius < LARGEST else math.inf
        with np.errstate(all="ignore"):
            low, high = (np.round(places, 12) * r for places in (low, high))
        ends = zip([*axes, *(f"upper_{axis}" for axis in axes)], [*low, *high], strict=True)
        return replace(table, index=table.index | dict(ends) | {"wraps": wraps.astype(np.int64)})

    def _ends(self, problem: Problem, solved: Solved, contacts: Columns) -> tuple[Array, ...]:
        """Give lower and upper centres in units of r, (axes, contacts), and what crosses the seam.

        They are float64: balls would take long.
        """
        lower = np.stack([contacts[name] for name in bead_names(problem.dimension)])
        number = np.argmax([contacts["branch"] == part.value for part in self.branches], axis=0)
        upper, wraps = self.naming.above(lower, number)
        with FLOAT64.active():
            low = np.stack(ordered_places(lower, problem, FLOAT64))
            if solved.block is None:
                return low, low + steps_up(problem)[number].T, wraps
            region, d = solved.region, problem.dimension
            moves = np.pad(as_floats(solved.block[0, :d]), ((0, 0), (0, 1)))
            moves[:, -1] = np.nan
            moved, upper_moved = (
                np.stack(cartesian([*moves[:, region.numbers(b)]], problem, FLOAT64, raised=False))
                for b in (lower, upper)
            )
        low += moved
        return low, low + steps_up(problem)[number].T + (upper_moved - moved), wraps


def steps_up(problem: Problem) -> Array:
    """Give the ways from lower to upper beads of the ordered packing, (directions, axes), in r."""
    steps = list(2 * np.eye(problem.dimension))
    with FLOAT64.active():
        return np.stack(cartesian(steps, problem, FLOAT64, raised=True), axis=-1)


def of_network(network: Network) -> tuple[Table, Array, Array, Array]:
    """Give a row a contact, by its lower bead, then its upper one.

    Gives both centres, too, (2, contacts), and which contacts cross the seam.
    """
    order = np.lexsort((network.pairs[:, 0], network.pairs[:, 1]))
    pairs = network.pairs[order]
    (upper_i, upper_j), (i, j) = (network.names(pairs[:, end]) for end in (0, 1))
    names = {"i": i, "j": j, "branch": network.branches(pairs)}
    index = names | {"upper_i": upper_i, "upper_j": upper_j}
    high, low = as_floats(network.x)[pairs].transpose(1, 2, 0)
    turns = np.round((low[0] - high[0]) / float(network.frame.period))
    high[0] += turns * float(network.frame.period)
    return Table(index, {"force": network.forces[order]}, ("force",)), low, high, turns != 0
