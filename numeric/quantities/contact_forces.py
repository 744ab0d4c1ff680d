"""All contact forces."""

from ..lattice.layers import Region, full_layer
from ..mechanics.problem import Problem, Solved
from .base import (
    Block,
    ContactQuantity,
    Listed,
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

    def rows_of(self, problem: Problem, solved: Solved) -> Table:
        """Give a row a contact, layer by layer from the base, "+" before "-"."""
        assert solved.forces is not None
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
