"""All contact forces."""

from functools import lru_cache

import numpy as np

from ..arithmetic.systems import Array
from ..lattice.layers import Block, Region, full_layer
from ..mechanics.problem import Problem, Solved
from .base import (
    ContactQuantity,
    Listed,
    Table,
    contact_changes,
    joined,
)


class ContactForces(ContactQuantity, Listed):
    """All contact forces; of a periodic packing also those that no load reaches, exactly zero."""

    name = "contact_forces"
    numbers = 2
    roundings = 1

    def answer_rows(self, region: Region, realisations: int) -> int:
        """The contacts below each bead above the base."""
        beads = region.beads if self.width is None else self.width * self.height
        return len(self.branches) * beads * realisations

    def rows(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a contact, layer by layer from the base, "+" before "-"."""
        assert solved.forces is not None
        if self.at_once(problem, solved):
            return self._at_once(solved)
        blocks = self.blocks(problem)
        if self.width is not None:
            rows = [full_layer(j, self.width) for j in range(1, self.height + 1)]
            blocks = [Block(b, row) for row in rows for b in self.branches]
        found = list(contact_changes(solved, blocks, 1))
        return Table(
            self.naming.contacts(blocks),
            {
                "force": joined(solved.system, [F + g[0] for _, F, g in found]),
                "change": joined(solved.system, [g[0] for _, _, g in found]),
            },
            ("change",),
        )

    def at_once(self, problem: Problem, solved: Solved) -> bool:
        """Whether forces below whole layers of discs lie in one block."""
        forces = solved.forces
        return (
            forces is not None
            and self.width is not None
            and forces.g is not None
            and problem.dimension == 2
            and problem.region.has_whole(problem.force_rows)
            and forces.g.shape == (1, 2, self.height * self.width)
        )

    def _at_once(self, solved: Solved) -> Table:
        """Give the same rows, in order, from the blocks."""
        forces, width = solved.forces, self.width
        assert forces is not None
        assert forces.F is not None
        assert forces.g is not None
        assert width is not None
        change = by_lower_bead(forces.g[0], width)
        force = by_lower_bead(forces.F, width)
        force += change
        numbers = {"force": force.reshape(-1), "change": change.reshape(-1)}
        return Table(_names(self.height, width), numbers, ("change",), in_order=True)


def by_lower_bead(values: Array, width: int) -> Array:
    """Turn what belongs to contacts by their upper beads, (2, M W), into (M, W, 2) by the lower."""
    rows = values.reshape(2, -1, width)
    found = np.empty((rows.shape[1], width, 2), values.dtype)
    found[0::2, :, 0] = rows[0, 0::2]  # from an even layer up to the right: the same column
    found[1::2, :-1, 0], found[1::2, -1, 0] = rows[0, 1::2, 1:], rows[0, 1::2, 0]
    found[0::2, 1:, 1], found[0::2, 0, 1] = rows[1, 0::2, :-1], rows[1, 0::2, -1]
    found[1::2, :, 1] = rows[1, 1::2]
    return found


@lru_cache(maxsize=2)
def _names(height: int, width: int) -> dict[str, Array]:
    """Give the columns i, j and branch of all contacts."""
    layers, columns = np.arange(height)[:, None, None], 2 * np.arange(width)[:, None]
    parts = ("i", columns + layers % 2), ("j", layers), ("branch", np.array(["+", "-"]))
    shape = height, width, 2
    found = {name: np.broadcast_to(part, shape).reshape(-1) for name, part in parts}
    for column in found.values():
        column.flags.writeable = False  # all answers of this size share it
    return found
