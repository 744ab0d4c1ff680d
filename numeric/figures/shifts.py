"""Means at order σ²: exact packings less the same ones to first order.

The first-order change has mean zero and carries nearly all of the noise, so that the difference
shows a shift far smaller than the scatter of the forces.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Literal

import numpy as np

from ..arithmetic.systems import Array
from ..statistics.bands import Band, averaged, simultaneous

STD = 1e-3
"""σ/r: what is of order σ⁴ is a share (M^(3/2) σ/r)², 0.002 for M = 12, of the shift or so."""
LEVEL = 0.99


def cosine(spacing: Fraction) -> float:
    """φ of a spacing in units of r."""
    return float(1 - 2 * (spacing / 4) ** 2)


@dataclass(frozen=True)
class Shift:
    """A simultaneous band around means in units of (σ/r)² (no logarithms), shape (L,)."""

    band: Band

    @property
    def mean(self) -> Array:
        """What was estimated, shape (L,)."""
        return self.band.estimate.log

    @property
    def half(self) -> Array:
        """Half-width of the band, shape (L,)."""
        return self.band.half

    def deviation(self, curve: Array) -> float:
        """Largest deviation of a curve in half-widths of the band: inside is ≤ 1."""
        return float((np.abs(curve - self.mean) / self.half).max())


def shift(
    changes: Callable[[Literal["exact", "first-order"]], Array], seed: int, unit: float = 1.0
) -> Shift:
    """Estimate from changes in units of ``unit``, (realisations, L), of the same packings."""
    each = (changes("exact") - changes("first-order")) / unit / STD**2
    mean = each.mean(axis=0)
    return Shift(simultaneous(averaged(mean, each - mean), LEVEL, seed))
