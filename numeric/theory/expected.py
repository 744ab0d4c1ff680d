"""How many contacts of a packing are expected to pull, and from which height on.

Estimates: to first order in δr (Eqs. 13, 14, B2, B3, B13 and B14), with Gaussian forces. M*
(Eq. 15) is where forces scatter as widely as they are large; in a packing of many contacts some
pull far below it.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

from .stds import std_of_spheres, stds_of_discs

# A typical packing has tension: the chance of none, exp(−number), is below one half.
TYPICAL = math.log(2)
# Layers that are looked at, spread evenly, of packings that are higher.
LAYERS = 400
HIGHEST = 10_000_000


@dataclass(frozen=True)
class ExpectedTension:
    """About so many ``contacts`` pull, in one packing.

    ``height_of_one``: the height from which on it is one or more, at the same width; None beyond
    the highest packings.
    """

    contacts: float
    height_of_one: int | None

    @property
    def typical(self) -> bool:
        """Whether more than half of such packings have a contact that pulls."""
        return self.contacts > TYPICAL


@lru_cache(maxsize=16)
def expected_tension(
    height: int,
    width: int,
    phi: float,
    relative_std: float,
    load: str,
    components: tuple[float, float] = (1.0, 1.0),
) -> ExpectedTension:
    """Estimate how many of the 2 W M contacts of a packing of discs pull.

    ``height``: M; ``width``: W; ``phi``: n⁺·n⁻; ``relative_std``: σ/r; ``load``: "surface" or
    "bulk"; ``components``: (L⁺, L⁻) of the load, in any unit; straight down by default.

    >>> found = expected_tension(16, 32, -1 / 8, 0.0055, "surface")
    >>> round(found.contacts, 1), found.height_of_one
    (7.0, 14)
    """

    def pulling(M: int, j: int) -> float:
        stds = stds_of_discs(load, M, j, phi, components)
        return sum(
            _negative(mean, relative_std * std) for mean, std in zip(components, stds, strict=True)
        )

    return _counted(height, width, pulling)


def expected_tension_of_spheres(
    height: int, beads: int, phi: float, relative_std: float, load: str
) -> ExpectedTension:
    """Estimate how many of a packing's contacts pull, three a bead, of spheres.

    ``beads``: of a layer; the load is straight down. Otherwise as ``expected_tension``.
    """

    def pulling(M: int, j: int) -> float:
        return 3 * _negative(1.0, relative_std * std_of_spheres(load, M, j, phi))

    return _counted(height, beads, pulling)


def _counted(height: int, beads: int, pulling: Callable[[int, int], float]) -> ExpectedTension:
    """Count contacts that pull: ``pulling`` says how many of a bead's contacts do, of M and j."""

    def contacts(M: int) -> float:
        layers = min(M, LAYERS)
        chosen = ((2 * k + 1) * M // (2 * layers) for k in range(layers))
        return beads * M / layers * sum(pulling(M, j) for j in chosen)

    low, high = 0, 1
    while contacts(high) < 1:
        low, high = high, 2 * high
        if low > HIGHEST:
            return ExpectedTension(contacts(height), None)
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if contacts(middle) >= 1 else (middle, high)
    return ExpectedTension(contacts(height), high)


def _negative(mean: float, std: float) -> float:
    """Give the chance of a Gaussian number below zero."""
    return math.erfc(mean / (math.sqrt(2) * std)) / 2 if std else float(mean < 0)
