"""Means at order σ²: exact packings less the same ones to first order.

The first-order change has mean zero and carries nearly all of the noise, so that the difference
shows a shift far smaller than the scatter of the forces.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Literal

import numpy as np

from ..arithmetic.systems import Array
from ..statistics.bands import averaged, simultaneous
from .packings import LEVEL
from .specification import Comparison

STD = 1e-3
"""σ/r: what is of order σ⁴ is a share (M^(3/2) σ/r)², 0.002 for M = 12, of the shift or so."""


def cosine(spacing: Fraction) -> float:
    """φ of a spacing in units of r."""
    return float(1 - 2 * (spacing / 4) ** 2)


def shift(
    of: str,
    changes: Callable[[Literal["exact", "first-order"]], Array],
    theory: Array,
    seed: int,
    unit: float = 1.0,
) -> Comparison:
    """Compare with theory, in units of (σ/r)².

    ``changes``: of the same packings in units of ``unit``, (realisations, L).
    """
    each = (changes("exact") - changes("first-order")) / unit / STD**2
    mean = each.mean(axis=0)
    band = simultaneous(averaged(mean, each - mean), LEVEL, seed, logarithmic=False)
    return Comparison(of, band, theory)


def facts(found: list[Comparison]) -> dict[str, list[float]]:
    """Say in numbers how far theory is off."""
    return {"largest_deviations_in_half_widths": [one.deviation() for one in found]}


def columns(name: str, found: list[Comparison]) -> dict[str, Array]:
    """Give the columns of a CSV file: all that was found, one after the other."""
    return {
        f"{name}_simulated": np.concatenate([one.band.value for one in found]),
        "band_half_width": np.concatenate([one.band.half for one in found]),
        f"{name}_exact": np.concatenate([one.theory for one in found]),
    }
