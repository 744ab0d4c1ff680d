"""One contact force."""

from ..lattice.layers import Region
from .base import ContactQuantity


class ContactForce(ContactQuantity):
    """One contact force f^±_ij and its change."""

    name = "contact"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a realisation."""
        return realisations
