"""Counting changes of forces into bins whose edges are exact decimals."""

from fractions import Fraction
from typing import Any

import flint
import numpy as np

from numeric.lattice import Array
from numeric.packing import UndecidedError
from numeric.systems import Balls, NumberSystem


def histogram(
    values: Array, bins: int, system: NumberSystem
) -> list[tuple[Fraction, Fraction, int]]:
    """Count ``values`` into equal bins: [(low edge, high edge, count)], low ≤ value < high.

    The edges are doubles just outside the extreme values, so that every number system has the
    same bins. Raises ``UndecidedError`` where a ball lies across an edge.
    """
    if not len(values):
        return []
    rough = np.array([float(v) for v in values])
    low, high = float(np.nextafter(rough.min(), -np.inf)), float(np.nextafter(rough.max(), np.inf))
    edges = [Fraction(low) + (Fraction(high) - Fraction(low)) * k / bins for k in range(bins + 1)]
    counts = [0] * bins
    if isinstance(system, Balls):
        _count_balls(values, edges, rough, counts, system)
    else:
        inner = np.array([float(e) for e in edges[1:-1]])
        for k in np.searchsorted(inner, rough, side="right"):
            counts[int(k)] += 1
    return list(zip(edges[:-1], edges[1:], counts, strict=True))


def _count_balls(
    values: Array, edges: list[Fraction], rough: Array, counts: list[int], system: Balls
) -> None:
    bounds: list[Any] = [system.number(e) for e in edges]
    places = np.searchsorted([float(e) for e in edges[1:-1]], rough, side="right")
    for value, place in zip(values, places.tolist(), strict=True):
        for k in (place, place - 1, place + 1):
            if 0 <= k < len(counts) and value >= bounds[k] and value < bounds[k + 1]:
                counts[k] += 1
                break
        else:
            raise UndecidedError(f"a ball lies across the edge of a bin: {flint.arb(value)}")
