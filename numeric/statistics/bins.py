"""Counting changes of forces into bins whose edges are exact decimals."""

import math
from bisect import bisect_right
from fractions import Fraction

import numpy as np

from ..arithmetic.decimals import decimal_string
from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls, NumberSystem, as_floats, midpoint


def histogram(
    values: Array, bins: int, system: NumberSystem
) -> list[tuple[Fraction, Fraction, int]]:
    """Count ``values`` into equal bins: [(low edge, high edge, count)], low ≤ value < high.

    The outer edges lie a little outside of the extreme values, by unequal shares of their distance:
    symmetric values then have no edge at zero, which no ball around zero could be told from.
    Values that are all alike make one bin. Every number system has the same bins. Raises
    ``UndecidedError`` where a ball lies across an edge all the same.
    """
    if not len(values):
        return []
    unit = Fraction(1)
    if isinstance(system, Balls):
        unit, rough = _scaled(values)
    else:
        rough = as_floats(values)
    edges = edges_between(float(rough.min()), float(rough.max()), bins)
    if isinstance(system, Balls):
        edges = [edge * unit for edge in edges]
        counts = _count(values, edges, system)
    else:
        counts = counted(rough, edges).tolist()
    return list(zip(edges[:-1], edges[1:], counts, strict=True))


def edges_between(least: float, most: float, bins: int) -> list[Fraction]:
    """Give the edges of the bins of values from ``least`` to ``most``."""
    span = Fraction(most) - Fraction(least)
    if not span:
        return [Fraction(float(np.nextafter(least, to))) for to in (-np.inf, np.inf)]
    low, high = float(Fraction(least) - span / 1009), float(Fraction(most) + span / 2003)
    first, step = Fraction(low) * bins, Fraction(high) - Fraction(low)
    # over one denominator, since a million sums of fractions take seconds
    below = math.lcm(first.denominator, step.denominator)
    start, each = int(first * below), int(step * below)
    return [Fraction(start + each * k, below * bins) for k in range(bins + 1)]


def counted(values: Array, edges: list[Fraction]) -> Array:
    """Count float64 into bins, shape (bins,)."""
    return np.histogram(values, [float(edge) for edge in edges])[0]


def printed(bins: list[tuple[Fraction, Fraction, int]]) -> dict[str, list[str]]:
    """Print bins as columns, edges as the decimals that they are; each begins where one ends."""
    highs = [decimal_string(high) for _, high, _ in bins]
    lows = [decimal_string(low) for low, *_ in bins[:1]] + highs[:-1]
    return {"low": lows, "high": highs, "count": [str(count) for *_, count in bins]}


def _scaled(values: Array) -> tuple[Fraction, Array]:
    """Give midpoints as floats of order 1, and the power of two that they were divided by."""
    if not all(value.is_finite() for value in values):
        raise UndecidedError("a change has no finite enclosure")
    exact = [midpoint(value) for value in values]
    largest = max(abs(value) for value in exact)
    shift = largest.numerator.bit_length() - largest.denominator.bit_length() if largest else 0
    unit = Fraction(2) ** shift
    return unit, np.array([float(value / unit) for value in exact])


def _count(values: Array, edges: list[Fraction], system: Balls) -> list[int]:
    bounds = [system.number(edge) for edge in edges]
    counts = [0] * (len(edges) - 1)
    for value in values:
        at = bisect_right(bounds, value)  # which a comparison that is open may have led astray
        if not (0 < at < len(bounds) and bounds[at - 1] <= value < bounds[at]):
            raise UndecidedError(f"the ball {value} lies across the edge of a bin")
        counts[at - 1] += 1
    return counts
