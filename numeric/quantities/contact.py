"""One contact force."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import FLOAT64, Array
from ..lattice import regions
from ..lattice.branch import Contact
from ..lattice.layers import Layer, Region
from ..lattice.regions import Rows
from ..mechanics import first_order
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem, Solved
from .base import (
    ContactQuantity,
    Listed,
    Table,
    column,
)


class SingleContact(ContactQuantity):
    """A question about one contact, ``scene.contact``."""

    @property
    def contact(self) -> Contact:
        """The contact that is asked for."""
        assert self.scene.contact is not None
        return self.scene.contact

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
        if self.scene.load.at is not None and not self.scene.load.pressure:
            return super().most_beads()
        beads = regions.contact_beads(self.contact.j, self.height)
        return beads if self.width is None else min(beads, self.width * (self.height + 1))

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the one group."""
        i, j, branch = self.contact
        return {"i": [i], "j": [j], "branch": [branch.value]}

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (1, 1), and g, (1, realisations, 1)."""
        if solved.single is not None:  # line sums
            force, change = solved.single
            return np.array([[force]]), np.array([[[change]]])
        assert solved.forces is not None
        _, j, branch = self.contact
        F, g = solved.forces.ordered[branch][j + 1], solved.forces.change[branch][j + 1]
        return F[:1, None], g.reshape(realisations, -1)[None, :, :1]

    def ordered(self, problem: Problem) -> list[Fraction]:
        """Give the ordered force."""
        strength = problem.load.strength(problem.n_x, FLOAT64)
        return [Fraction(float(problem.load.ordered_force(self.contact, strength, FLOAT64)))]

    def rows(self, problem: Problem, solved: Solved, layers: range) -> Table:
        """Give the contact, with the layer of its upper bead; not where a sweep stopped above."""
        _, j, branch = self.contact
        found: Sequence[tuple[Any, Any]] = []
        if j + 1 not in layers:
            pass
        elif solved.single is not None:
            F, g = solved.single
            found = [(F + g, g)]
        elif solved.forces is not None and len(solved.forces.ordered[branch][j + 1]):
            g = solved.forces.change[branch][j + 1][0]
            found = [(solved.forces.ordered[branch][j + 1][0] + g, g)]
        lower = Layer(j, self.contact.i, len(found))
        return Table(
            {**self.sites_of([lower]), "branch": np.array([branch.value] * len(found), dtype="U1")},
            {
                "force": column([force for force, _ in found], solved.system),
                "change": column([change for _, change in found], solved.system),
            },
            ("change",),
        )


class ContactForce(SingleContact, Listed):
    """One contact force f^±_ij and its change."""

    name = "contact"
    plain = True

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a realisation."""
        return realisations
