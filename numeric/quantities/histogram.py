"""How changes of contact forces are distributed."""

from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..lattice.layers import Region
from ..mechanics.problem import Problem, Solved
from ..scene.scene import Scene
from .base import (
    ContactQuantity,
    Listed,
    Quantity,
    Table,
    contact_changes,
    joined,
)
from .contact import SingleContact

DEFAULT_BINS = 20


class Histogram(ContactQuantity, Listed):
    """Changes of the contact forces that loads reach, or those of some layers, in bins."""

    name = "histogram"
    numbers = 2
    roundings = 1

    @property
    def bins(self) -> int:
        """How many bins there are."""
        return self.scene.ask.bins or DEFAULT_BINS

    def answer_rows(self, region: Region, realisations: int) -> int:
        """Two a bin, for its edges as decimals; a change counts for a little."""
        return 2 * (self.scene.ask.bins or 1) + realisations * (1 + region.beads // 50)

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give the changes of contacts."""
        parts = [g[0] for _, _, g in contact_changes(solved, self.blocks(problem), 1)]
        return Table({}, {"change": joined(solved.system, parts)}, ("change",))

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """There is one group, which needs no name."""
        return {}

    def members(self, problem: Problem) -> int:
        """All contacts that loads reach, or the one."""
        return sum(row.count for _, row in self.blocks(problem))

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (1, contacts), and g, (1, realisations, contacts)."""
        F, g = super().changes(problem, solved, realisations)
        return F.T, np.swapaxes(g, 0, 2)

    def ordered(self, problem: Problem) -> list[Fraction]:
        """Give the mean ordered force."""
        forces = super().ordered(problem)
        return [sum(forces, Fraction(0)) / len(forces)]


class ContactHistogram(SingleContact, Histogram):
    """Changes of one contact force over many packings."""


def histogram_of(scene: Scene) -> Quantity:
    """Ask about one contact or about all."""
    return Histogram(scene) if scene.ask.at is None else ContactHistogram(scene)
