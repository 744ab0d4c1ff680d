"""A whole scene: the packing, its disorder, the load, the effects and the question."""

from fractions import Fraction
from pathlib import Path
from typing import Any

from ..lattice.branch import Branch, Contact, Site
from .checks import check
from .sections import Sections


class Scene(Sections):
    """A whole scene; files are relative to ``folder``. Raises ``SceneError``."""

    folder: Path = Path()

    def __init__(self, /, **values: Any) -> None:
        """Check the sections, and what they say about each other."""
        super().__init__(**values)
        check(self)

    @property
    def spacing(self) -> Fraction:
        """s; 3 r unless named."""
        return self.packing.s

    @property
    def n_x(self) -> Fraction:
        """n_x = s/4r."""
        return self.packing.s / (4 * Fraction(self.packing.radius))

    @property
    def contact(self) -> Contact | None:
        """The one contact of two dimensions that is asked for, or None."""
        if self.ask.at is None or self.ask.quantity == "positions" or self.packing.dimension > 2:
            return None
        i, j, branch = self.ask.at
        return Contact(int(i), int(j), Branch(branch))

    @property
    def site(self) -> Site | None:
        """The one bead of two dimensions that is asked for, or None."""
        if self.ask.at is None or self.ask.quantity != "positions" or self.packing.dimension > 2:
            return None
        i, j = self.ask.at
        return int(i), int(j)
