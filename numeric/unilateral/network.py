"""Where beads came to rest under unilateral contacts."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.errors import NotReachedError
from ..arithmetic.systems import Array
from ..mechanics.sweep import Solved


class UnfinishedError(NotReachedError, ArithmeticError):
    """Beads did not come to rest: no answer is given."""


class ImpossibleError(UnfinishedError):
    """No packing can stand: that is proved."""


@dataclass(frozen=True)
class Frame:
    """What is exactly known, in balls: ``radii`` (N,), ``base`` (fixed, 2), ``load`` (N, 2).

    Radii are positive, and the ``period`` is above four of any, so that no two images of one bead
    are near another one: raises ``UnfinishedError`` where that is not sure.
    """

    radii: Array
    base: Array
    period: Any
    load: Array

    def __post_init__(self) -> None:
        for bead, radius in enumerate(self.radii):
            if not radius > 0:
                raise UnfinishedError(f"the radius of bead {bead} is not positive")
            if not self.period > 4 * radius:
                raise UnfinishedError(
                    f"bead {bead} is so large that others may touch it and its image at once: "
                    f"its radius must be below a quarter of the period, {float(self.period):.4g} r"
                )


class Network(NamedTuple):
    """Beads at rest under unilateral contacts; lengths in units of r, numbers in balls.

    Bead number j W + q is (i, j) of the lattice, i = 2q + j mod 2, where it was deposited.
    ``pairs``: the contacts that bear force, (contacts, 2), with ``forces``; ``x``: (N, 2), of which
    those of ``rattlers`` are any place without overlap. ``smallest_gap``: a lower bound for pairs
    that bear no force. ``programs`` is 0 where the deposited packing has no tension, and nothing
    moved; ``fall``: of the energy. ``kantorovich``: h of that theorem, None as deposited.
    """

    x: Array
    pairs: Array
    forces: Array
    rattlers: Array
    smallest_gap: float
    frame: Frame
    kantorovich: float | None = None
    programs: int = 0
    fall: float = 0.0

    @property
    def width(self) -> int:
        """W, the beads of the base."""
        return len(self.frame.base)

    @property
    def rest(self) -> str:
        """Say what is proved of where beads rest."""
        if self.kantorovich is None:
            return "as deposited: no contact pulls"
        return "a strict local minimum in the coordinates of beads that contacts hold"

    @property
    def bearing(self) -> Array:
        """How many contacts bear force on each bead, (N,)."""
        return np.bincount(self.pairs.ravel(), minlength=len(self.x))

    def names(self, numbers: Any) -> tuple[Any, Any]:
        """Name a bead, or an array of them, (i, j)."""
        j, q = divmod(numbers, self.width)
        return 2 * q + j % 2, j

    def branches(self, pairs: Array) -> Array:
        """Give "+" or "-" of pairs that are neighbours of the lattice, else an empty string."""
        (k, upper), (i, j) = self.names(pairs[:, 0]), self.names(pairs[:, 1])
        above, across = upper == j + 1, (k - i) % (2 * self.width)
        sides = [above & (across == 1), above & (across == 2 * self.width - 1)]
        return np.select(sides, ["+", "-"], "")


@dataclass(frozen=True, kw_only=True)
class Relaxed(Solved):
    """A solved packing under unilateral contacts."""

    network: Network
