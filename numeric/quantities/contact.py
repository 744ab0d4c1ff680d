"""One contact force."""

from typing import Any

from ..lattice import regions
from ..lattice.branch import Contact
from ..lattice.layers import Block, Region, Rows
from ..mechanics.loads import LoadSpec
from ..mechanics.problem import Problem
from .base import ContactQuantity


class SingleContact(ContactQuantity):
    """A question about one contact."""

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

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the one group, as the scene does."""
        assert self.scene.ask.at is not None
        names = self.naming.contacts(self.blocks(problem))
        return {name: [value] for name, value in zip(names, self.scene.ask.at, strict=True)}


class ContactForce(SingleContact):
    """One contact force f^±_ij and its change."""

    name = "contact"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a realisation."""
        return realisations
