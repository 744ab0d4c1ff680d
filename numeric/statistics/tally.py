"""The sums and counts of an ensemble by compiled loops: bitwise those of NumPy, in one pass.

Import it only for work that repays loading the compiler.
"""

import numpy as np

from ..arithmetic.compiling import borrowed, compiled
from ..arithmetic.systems import Array


@compiled
def tally(g: Array, blocks: Array, unit: float, edges: Array, sums: Array, counts: Array) -> None:
    """Add up, and count, the numbers of ``blocks`` of some packings.

    ``g`` is (packings, branches, numbers); a row of ``blocks`` says branch, first number, and the
    one behind the last. Filled are ``sums`` (2, packings, blocks), those ``by_halves`` of g unit
    and of (g unit)², and counted up ``counts`` (packings, bins and 2): how many are below, in and
    above the bins between ``edges``.
    """
    g, most = borrowed(g), (blocks[:, 2] - blocks[:, 1]).max()
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
            sums[0, k, p], sums[1, k, p] = first[0], second[0]
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
