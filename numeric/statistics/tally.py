"""The sums and counts of an ensemble by compiled loops: bitwise those of NumPy, in one pass.

Import it only for work that repays loading the compiler.
"""

import math

import numpy as np

from ..arithmetic.compiling import borrowed, compiled
from ..arithmetic.systems import Array


@compiled
def tally(
    g: Array,
    F: Array,
    blocks: Array,
    unit: float,
    edges: Array,
    sums: Array,
    negative: Array,
    counts: Array,
) -> None:
    """Add up, and count, the numbers of ``blocks`` of some packings.

    ``g`` is (packings, branches, numbers), and ``F`` what is added to each of them; a row of
    ``blocks`` says branch, first number, and the one behind the last. Filled are ``sums``
    (packings, 2, blocks), those ``by_halves`` of g unit and of (g unit)², and ``negative``
    (packings, blocks): how many F + g are. ``counts`` (packings, bins and 2) are counted up: how
    many g are below, in and above the bins between ``edges``.
    """
    g, most = borrowed(g), (blocks[:, 2] - blocks[:, 1]).max()
    least = np.array([F[branch, start:stop].min() for branch, start, stop in blocks])
    first, second, guesses = np.empty(most), np.empty(most), np.empty(most, np.int32)
    for k in range(len(g)):
        for p in range(len(blocks)):
            values = g[k, blocks[p, 0], blocks[p, 1] : blocks[p, 2]]
            half, odd = values.size // 2, values.size % 2
            for q in range(half):
                one, other = values[q] * unit, values[half + q] * unit
                first[q], second[q] = one + other, one * one + other * other
            if odd:
                one = values[values.size - 1] * unit
                first[0] = (first[0] if half else 0.0) + one
                second[0] = (second[0] if half else 0.0) + one * one
            while half > 1:
                size, half = half, half // 2
                for q in range(half):
                    first[q] += first[half + q]
                    second[q] += second[half + q]
                if size % 2:
                    first[0] += first[size - 1]
                    second[0] += second[size - 1]
            sums[k, 0, p], sums[k, 1, p] = first[0], second[0]
            below = 0
            # none is larger than the root of all squares; a little for rounding, and for underflow
            if least[p] * unit < 1.001 * math.sqrt(second[0]) + 1e-150:
                own = F[blocks[p, 0], blocks[p, 1] : blocks[p, 2]]
                for q in range(values.size):
                    below += own[q] + values[q] < 0
            negative[k, p] = below
            if edges.size:
                _count(values, edges, guesses, counts[k])


@compiled
def _count(values: Array, edges: Array, guesses: Array, counts: Array) -> None:
    """Count as ``np.searchsorted`` does, side "right": guess all bins, and mend the guesses."""
    bins, first = edges.size - 1, edges[0]
    scale = bins / (edges[bins] - first)
    for q in range(values.size):
        guesses[q] = np.int32(min(max((values[q] - first) * scale, -1.0), float(bins))) + 1
    for q in range(values.size):
        value, at = values[q], guesses[q]
        while at > 0 and value < edges[at - 1]:
            at -= 1
        while at <= bins and value >= edges[at]:
            at += 1
        counts[at] += 1
