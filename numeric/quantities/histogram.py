"""How changes of contact forces are distributed."""

from typing import Any

from ..arithmetic.systems import Array
from ..lattice.layers import Region
from ..mechanics.problem import Problem
from ..mechanics.sweep import Solved
from .base import ContactQuantity, Table, contact_forces

DEFAULT_BINS = 20


class Histogram(ContactQuantity):
    """Changes of the contact forces that loads reach, or those of some layers, in bins."""

    name = "histogram"
    numbers = 2

    @property
    def bins(self) -> int:
        """How many bins there are."""
        return self.scene.ask.bins or DEFAULT_BINS

    def answer_rows(self, region: Region, realisations: int) -> int:
        """Two a bin, for its edges as decimals; a change counts for a little."""
        return 2 * (self.scene.ask.bins or 1) + realisations * (1 + region.beads // 50)

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give the changes of contacts."""
        _, g = contact_forces(solved, self.blocks(problem), 1)
        return Table({}, {"change": g[0]}, ("change",))

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """There is one group, which needs no name."""
        return {}

    def members(self, problem: Problem) -> int:
        """All contacts that loads reach, or the one."""
        return sum(row.count for _, row in self.blocks(problem))

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (1, contacts), and g, (1, realisations, contacts)."""
        F, g = contact_forces(solved, self.blocks(problem), realisations)
        return F[None], g[None]
