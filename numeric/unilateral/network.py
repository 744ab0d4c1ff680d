"""Where beads came to rest under unilateral contacts."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError
from ..arithmetic.systems import Array
from ..lattice.branch import Branch
from ..mechanics.problem import Solved


class UnfinishedError(ForceDiffusionError, ArithmeticError):
    """Beads did not come to rest: no answer is given."""

    exit_status = NOT_REACHED


class MissingSolverError(ForceDiffusionError, ImportError):
    """A solver that a protocol needs is not installed."""

    def __init__(self, what: str, package: str) -> None:
        super().__init__(
            f'{what} need {package}: pip install "force-diffusion[unilateral]"; '
            'protocol = "event-driven" does without'
        )


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


@dataclass(frozen=True)
class Network:
    """Beads at rest under unilateral contacts; lengths in units of r, numbers in balls.

    Bead number j W + q is (i, j) of the lattice, i = 2q + j mod 2, where it was deposited.
    ``pairs``: the contacts that bear force, (contacts, 2), with ``forces``; ``x``: (N, 2), of which
    those of ``rattlers`` are any place without overlap. ``events``: contacts that opened one after
    the other, or programs; ``fall``: of the energy. ``rung``: which way of the protocol answered;
    empty where the deposited packing has no tension, and nothing moved.
    """

    width: int
    x: Array
    pairs: Array
    forces: Array
    rattlers: Array
    events: int
    fall: float
    smallest_gap: float
    frame: Frame
    kantorovich: float | None = None
    rung: str = ""

    @property
    def rest(self) -> str:
        """Say what is proved of where beads rest."""
        if not self.rung:
            return "as deposited: no contact pulls"
        return "a strict local minimum in the coordinates of beads that contacts hold"

    def pushes(self) -> Array:
        """Give the force of each contact on its first bead, (contacts, 2); the other way back."""
        d = self.x[self.pairs[:, 0]] - self.x[self.pairs[:, 1]]
        around = np.round([float(dx) / float(self.frame.period) for dx in d[:, 0]]).astype(int)
        d[:, 0] = d[:, 0] - around * self.frame.period
        length = np.sqrt(d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1])
        return np.asarray(d / length[:, None] * self.forces[:, None])

    def data(self) -> dict[str, Any]:
        """Give the packing as ``checker`` reads it: decimals of 60 digits, in units of r."""

        def decimal(ball: Any) -> str:
            return str(ball.mid().str(60, radius=False))

        return {
            "period": decimal(self.frame.period),
            "fixed": self.width,
            "radii": [decimal(r) for r in self.frame.radii],
            "loads": [[decimal(v) for v in load] for load in self.frame.load],
            "centres": [[decimal(v) for v in centre] for centre in self.x],
            "contacts": self.pairs.tolist(),
        }

    def bead(self, number: int) -> tuple[int, int]:
        """Name a bead (i, j)."""
        j, q = divmod(int(number), self.width)
        return 2 * q + j % 2, j

    def branch(self, pair: Array) -> str:
        """Give "+" or "-" where a pair are neighbours of the lattice, else an empty string."""
        (k, upper), (i, j) = self.bead(pair[0]), self.bead(pair[1])
        if upper != j + 1:
            return ""
        for branch in Branch:
            if (i + branch.side - k) % (2 * self.width) == 0:
                return branch.value
        return ""


@dataclass(frozen=True, kw_only=True)
class Relaxed(Solved):
    """A solved realisation under unilateral contacts."""

    network: Network
