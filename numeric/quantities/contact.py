"""One contact force."""

from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import FLOAT64, Array
from ..lattice import regions
from ..lattice.branch import Contact
from ..lattice.layers import Block, Region, Rows
from ..mechanics import first_order
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved
from .base import (
    ContactQuantity,
    Listed,
    Table,
    column,
    contact_changes,
    joined,
)


class SingleContact(ContactQuantity):
    """A question about one contact."""

    roundings = 1

    @property
    def contact(self) -> Contact:
        """The contact that is asked for, in two dimensions."""
        assert self.scene.contact is not None
        return self.scene.contact

    def blocks(self, problem: Problem) -> list[Block]:
        """Give the one contact, with the layer of its upper bead."""
        assert self.scene.ask.at is not None
        return [self.naming.contact(self.scene.ask.at)]

    def force_rows(self, load: LoadSpec) -> Rows:
        """Give the beads whose force balance decides the contact's force."""
        if load.loaded is None and self.width is None:
            # The slab: the contact's own cone is cut out of rows wide enough for it.
            reach = regions.upward_cone(self.contact.upper, self.height, None)
        else:
            reach = super().force_rows(load)
        return regions.contact_rows(self.contact, reach, self.width)

    def line_beads(self, load: LoadSpec) -> int:
        """Count the beads of the diagonals that decide the first-order force."""
        return first_order.beads_read(self.contact, load)

    def most_beads(self) -> int:
        """Bound the beads to be solved."""
        if self.scene.load.at is not None or self.by_layers:
            return super().most_beads()
        beads = regions.contact_beads(self.contact.j, self.height)
        return beads if self.width is None else min(beads, self.width * (self.height + 1))

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the one group, as the scene does."""
        assert self.scene.ask.at is not None
        names = self.naming.contacts(self.blocks(problem))
        return {name: [value] for name, value in zip(names, self.scene.ask.at, strict=True)}

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (1, 1), and g, (1, realisations, 1)."""
        if solved.single is not None:  # line sums
            force, change = solved.single
            return np.array([[force]]), np.array([[[change]]])
        return super().changes(problem, solved, realisations)

    def ordered(self, problem: Problem) -> list[Fraction]:
        """Give the ordered force."""
        if self.by_layers:
            return super().ordered(problem)
        strength = problem.load.strength(problem.n_x, FLOAT64)
        return [Fraction(float(problem.load.ordered_force(self.contact, strength, FLOAT64)))]

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give the contact."""
        system, blocks = solved.system, self.blocks(problem)
        if solved.single is not None:
            F, g = (column([one], system) for one in solved.single)
        else:
            assert solved.forces is not None
            found = contact_changes(solved, blocks, 1)
            F = joined(system, [F for _, F, _ in found])
            g = joined(system, [g[0] for _, _, g in found])
        return Table(self.naming.contacts(blocks), {"force": F + g, "change": g}, ("change",))


class ContactForce(SingleContact, Listed):
    """One contact force f^±_ij and its change."""

    name = "contact"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a realisation."""
        return realisations
