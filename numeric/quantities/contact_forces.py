"""All contact forces."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np

from ..arithmetic.systems import FLOAT64, Array, as_floats
from ..lattice.branch import axis_names, bead_names
from ..lattice.layers import Block, Naming, Region, full_layer
from ..mechanics.problem import Problem
from ..mechanics.sweep import Solved
from ..scene.sections import LARGEST
from ..unilateral.network import Network, Relaxed
from .base import Columns, ContactQuantity, Table, cartesian
from .positions import Positions


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
        """Give a row a contact."""
        if isinstance(solved, Relaxed):
            table = of_network(solved.network)
        else:
            blocks = self.blocks(problem)
            if self.width is not None:
                rows = [full_layer(j, self.width) for j in range(1, self.height + 1)]
                blocks = [Block(b, row) for row in rows for b in self.branches]
            table = self.listed(blocks, solved)
        return replace(table, index=table.index | self._ends(problem, solved, table.index))

    def _ends(self, problem: Problem, solved: Solved, contacts: Columns) -> Columns:
        """Say where both beads of contacts are, to be drawn; and which contacts cross the seam.

        The upper bead is the image next to the lower one. Centres are rounded to 1e-12 r. NaN: the
        answer doesn't depend on the bead.
        """
        d, packing = problem.dimension, self.scene.packing
        names, axes = bead_names(d), axis_names(d)
        spacing = packing.s / packing.radius
        usual = packing.model_copy(update={"radius": Fraction(1), "spacing": spacing})
        beads = Positions(self.scene.model_copy(update={"packing": usual})).rows(problem, solved)
        there = np.stack([beads.index[name] for name in names])
        columns = [*axes, *(f"d{axis}" for axis in axes)]
        numbers = np.stack([as_floats(beads.numbers[name]) for name in columns])
        lower = np.stack([contacts[name] for name in names])
        low, moved = np.split(numbers_of(lower, there, numbers), 2)
        if isinstance(solved, Relaxed):
            upper = np.stack([contacts["upper_i"], contacts["upper_j"]])
            high, period = numbers_of(upper, there, numbers)[:d], float(solved.network.frame.period)
            turns = np.round((low[0] - high[0]) / period)
            high[0] += turns * period
            wraps = turns != 0
        else:
            number = np.argmax([contacts["branch"] == part.value for part in self.branches], axis=0)
            upper, wraps = upper_beads(lower, number, self.naming)
            apart = numbers_of(upper, there, numbers)[d:] - moved
            high = low + steps_up(problem)[number].T + apart
        r = float(packing.radius) if packing.radius < LARGEST else math.inf
        with np.errstate(all="ignore"):
            low, high = (np.round(places, 12) * r for places in (low, high))
        ends = zip([*axes, *(f"upper_{axis}" for axis in axes)], [*low, *high], strict=True)
        return {**dict(ends), "wraps": wraps.astype(np.int64)}


def upper_beads(lower: Array, number: Array, naming: Naming) -> tuple[Array, Array]:
    """Give the upper beads of contacts, and which of them are images beside the lower ones.

    Beads are columns of their numbers, (2, contacts) or (3, contacts); ``number`` is that of the
    direction.
    """
    steps = [[1, 1], [-1, 1]] if naming.dimension == 2 else [[1, 0, 1], [0, 1, 1], [0, 0, 1]]
    beside = lower + np.array(steps)[number].T
    upper = beside.copy()
    if naming.side is not None:
        upper[:-1] %= naming.side * (2 if naming.dimension == 2 else 1)
    return upper, (upper != beside).any(axis=0)


def steps_up(problem: Problem) -> Array:
    """Give the ways from lower to upper beads of the ordered packing, (directions, axes), in r."""
    steps = list(2 * np.eye(problem.dimension))
    with FLOAT64.active():
        return np.stack(cartesian(steps, problem, FLOAT64, raised=True), axis=-1)


def numbers_of(wanted: Array, there: Array, numbers: Array) -> Array:
    """Give the ``numbers``, (…, beads), of ``wanted`` beads, NaN where they are not ``there``.

    Beads are columns of their numbers.
    """
    both = np.concatenate([there, wanted], axis=1)
    low = both.min(axis=1, initial=0)[:, None]
    keys = np.ravel_multi_index(both - low, tuple(both.max(axis=1, initial=0) - low[:, 0] + 1))
    given, asked = keys[: there.shape[1]], keys[there.shape[1] :]
    order = np.argsort(given)
    place = np.searchsorted(given, asked, sorter=order)
    padded = np.append(numbers, np.full((len(numbers), 1), np.nan), axis=1)
    at = np.append(order, -1)[place]
    return np.where(np.append(given, -1)[at] == asked, padded[:, at], np.nan)


def of_network(network: Network) -> Table:
    """Give a row a contact, by its lower bead, then its upper one."""
    order = np.lexsort((network.pairs[:, 0], network.pairs[:, 1]))
    pairs = network.pairs[order]
    (upper_i, upper_j), (i, j) = (network.names(pairs[:, end]) for end in (0, 1))
    branch = np.array([network.branch(pair) for pair in pairs])
    index = {"i": i, "j": j, "branch": branch, "upper_i": upper_i, "upper_j": upper_j}
    return Table(index, {"force": network.forces[order]}, ("force",))
