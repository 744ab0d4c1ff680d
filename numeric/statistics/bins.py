"""Counting changes of forces into bins whose edges are exact decimals."""

import math
from collections.abc import Sequence
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from ..arithmetic.decimals import decimal_string
from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls, NumberSystem, as_floats, midpoint


class Bins(NamedTuple):
    """Edges of bins, one more than there are counts, (bins,); or none of both."""

    edges: Sequence[Fraction]
    counts: Array


def histogram(values: Array, bins: int, system: NumberSystem) -> Bins:
    """Count ``values`` into equal bins, low edge ≤ value < high edge.

    The outer edges lie a little outside of the extreme values, by unequal shares of their distance:
    symmetric values then have no edge at zero, which no ball around zero could be told from.
    Values that are all alike make one bin. Every number system has the same bins. Raises
    ``UndecidedError`` where a ball lies across an edge all the same.
    """
    if not len(values):
        return Bins([], np.zeros(0, np.int64))
    unit, rough, off = Fraction(1), values, np.zeros(len(values))
    if isinstance(system, Balls):
        unit, rough, off = _scaled(values)
    rough = as_floats(rough)
    edges = edges_between(float(rough.min()), float(rough.max()), bins)
    inner = [float(edge) for edge in edges[1:-1]]
    before, at = (np.searchsorted(inner, rough + side, "right") for side in (-off, off))
    if (before != at).any():
        raise UndecidedError("a change lies across the edge of a bin")
    return Bins([edge * unit for edge in edges], np.bincount(at, minlength=len(edges) - 1))


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


def printed(bins: Bins) -> dict[str, list[str]]:
    """Print bins as columns, edges as the decimals that they are."""
    edges = [*map(decimal_string, bins.edges)]
    return {"low": edges[:-1], "high": edges[1:], "count": [*map(str, bins.counts.tolist())]}


def _scaled(values: Array) -> tuple[Fraction, Array, Array]:
    """Give the power of two near balls, and in its units their midpoints and how far off these are.

    They are floats of order 1, rounded.
    """
    if not all(value.is_finite() for value in values):
        raise UndecidedError("a change has no finite enclosure")
    exact = [midpoint(value) for value in values]
    largest = max(abs(value) for value in exact)
    shift = largest.numerator.bit_length() - largest.denominator.bit_length() if largest else 0
    unit = Fraction(2) ** shift
    rough = np.array([float(value / unit) for value in exact])
    radii = np.array([float(midpoint(value.rad()) / unit) for value in values])
    return unit, rough, 2 * radii + 2.0**-52 * np.abs(rough)
