"""All contact forces."""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from ..arithmetic.systems import Array, NumberSystem
from ..lattice.layers import Region, full_layer
from ..mechanics.problem import Problem, Solved
from .base import (
    Block,
    ContactQuantity,
    Gatherer,
    Listed,
    Listing,
    Table,
    above_stop,
    contact_changes,
    joined,
)


class ContactForces(ContactQuantity, Listed):
    """All contact forces; of a periodic packing also those that no load reaches, exactly zero."""

    name = "contact_forces"
    plain = True

    def answer_rows(self, region: Region, realisations: int) -> int:
        """The contacts below each bead above the base."""
        beads = region.beads if self.width is None else self.width * self.height
        return len(self.branches) * beads * realisations

    def gatherer(self, problem: Problem, system: NumberSystem) -> Gatherer:
        """Start a list."""
        return _Forces(self, problem, system)

    def rows_of(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a contact, layer by layer from the base, "+" before "-"."""
        assert solved.forces is not None
        if self.at_once(problem, solved):
            return self._at_once(solved)
        rows = problem.force_rows[1:]
        if self.width is not None:
            rows = tuple(full_layer(j, self.width) for j in range(1, self.height + 1))
        blocks = above_stop([Block(b, row) for row in rows for b in self.branches], solved.forces)
        found = list(contact_changes(solved, blocks, 1))
        return Table(
            self.contacts_of(blocks),
            {
                "force": joined(solved.system, [F + g[0] for _, F, g in found]),
                "change": joined(solved.system, [g[0] for _, _, g in found]),
            },
            ("change",),
        )

    def at_once(self, problem: Problem, solved: Solved) -> bool:
        """Whether all forces of a periodic packing of discs lie in one block."""
        forces = solved.forces
        return (
            forces is not None
            and self.width is not None
            and forces.g is not None
            and problem.dimension == 2
            and problem.region.has_whole(problem.force_rows)
            and forces.g.shape == (1, 2, problem.height * self.width)
        )

    def _at_once(self, solved: Solved) -> Table:
        """Give the same rows, sorted, from the blocks."""
        forces, width = solved.forces, self.width
        assert forces is not None
        assert forces.F is not None
        assert forces.g is not None
        assert width is not None
        change = by_lower_bead(forces.g[0], width)
        force = by_lower_bead(forces.F, width)
        force += change
        numbers = {"force": force.reshape(-1), "change": change.reshape(-1)}
        return Table(dict(_names(self.height, width)), numbers, ("change",), in_order=True)


class _Forces(Listing):
    """A list of forces, whose errors are what rounding left of them."""

    quantity: ContactForces

    def __init__(self, quantity: ContactForces, problem: Problem, system: NumberSystem) -> None:
        super().__init__(quantity, problem, system)
        self._left: float | None = 0.0

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Take in solved realisations."""
        super().add(solved, realisations)
        left = None if solved.forces is None else solved.forces.left
        exact = self.quantity.scene.load.magnitude == 1 and self._left is not None
        if not exact or left is None:
            self._left = None
        elif self._left is not None:
            self._left = max(self._left, left)

    def left(self) -> float | None:
        """Give the largest rest of a change."""
        return self._left


def by_lower_bead(values: Array, width: int) -> Array:
    """Turn what belongs to contacts by their upper beads, (2, M W), into (M, W, 2) by the lower."""
    rows = values.reshape(2, -1, width)
    found = np.empty((rows.shape[1], width, 2))
    found[0::2, :, 0] = rows[0, 0::2]  # from an even layer up to the right: the same column
    found[1::2, :-1, 0], found[1::2, -1, 0] = rows[0, 1::2, 1:], rows[0, 1::2, 0]
    found[0::2, 1:, 1], found[0::2, 0, 1] = rows[1, 0::2, :-1], rows[1, 0::2, -1]
    found[1::2, :, 1] = rows[1, 1::2]
    return found


@lru_cache(maxsize=2)
def _names(height: int, width: int) -> tuple[tuple[str, Array], ...]:
    """Give the columns i, j and branch of all contacts."""
    j = np.repeat(np.arange(height), 2 * width)
    i = 2 * np.tile(np.repeat(np.arange(width), 2), height) + j % 2
    found = ("i", i), ("j", j), ("branch", np.tile(np.array(["+", "-"]), height * width))
    for _, column in found:
        column.flags.writeable = False  # all answers of this size share it
    return found
