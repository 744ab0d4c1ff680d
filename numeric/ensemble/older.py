"""Sums as stores of layout 2 hold them: exact, or those of each packing of unilateral contacts."""

import struct
from dataclasses import replace
from fractions import Fraction

import numpy as np

from .measure import Measurement
from .sums import NEVER, Block, Sums, blocks_of, nothing

_THREE, _TWO, _EXACT = struct.Struct("<3q"), struct.Struct("<2q"), struct.Struct("<iI")
# Bits of a digit of exact sums.
_DIGIT = 22
# Digits that a sum may have, and how far they may lie from the point.
MOST = 1000


def blocks_of_layout_2(content: bytes, m: Measurement, first: int, stop: int) -> list[Block]:
    """Read sums over realisations first … stop − 1. Raises ``ValueError`` where they are none.

    Exact sums are rounded once; a range that is no block stays one.
    """
    try:
        if m.of_networks:
            return blocks_of(_packings(content, m, first, stop), first)
        return [Block(first, stop, _rounded(content, m))]
    except (struct.error, IndexError):
        raise ValueError("sums end early") from None


def _packings(content: bytes, m: Measurement, first: int, stop: int) -> Sums:
    N, left_out = _TWO.unpack_from(content)
    whole = np.frombuffer(content, "<i8", N * (1 + m.counted) + left_out, _TWO.size)
    values = np.frombuffer(content, "<f8", offset=_TWO.size + whole.nbytes).reshape(N, 3, m.groups)
    at, bins, out = np.split(whole, (N, N * (1 + m.counted)))
    found = nothing(m, stop - first)
    if not np.array_equal(np.sort([*at, *out]), np.arange(first, stop)):
        raise ValueError("it holds other realisations than it says")
    found.packings[at - first], found.packings[out - first] = (1, 0), (0, 1)
    found.first[out - first] = out
    found.means[at - first] = values
    found.samples[at - first] = values[:, 0]
    found.held[at - first] = values[:, 0] > 0
    counts = bins.reshape(N, m.counted)
    all_of_it = counts.sum(axis=1, keepdims=True)
    found.bins[at - first] = np.stack([counts, counts**2, counts * all_of_it], axis=1)
    return found


def _rounded(content: bytes, m: Measurement) -> Sums:
    N, left_out, lowest = _THREE.unpack_from(content)
    G, V = m.groups, m.variables
    counts = np.frombuffer(content, "<i8", G + 2 * m.counted, _THREE.size)
    at, exact = _THREE.size + counts.nbytes, list[list[Fraction]]()
    for size in (G, G, 2 * G, 3 * G, V * (V + 1) // 2):
        low, digits = _EXACT.unpack_from(content, at)
        if abs(low) > MOST or digits > MOST:
            raise ValueError("a sum has more digits than there are")
        planes = np.frombuffer(content, "<i4", digits * size, at + _EXACT.size)
        at += _EXACT.size + planes.nbytes
        whole = np.zeros(size, object)
        for plane in planes.reshape(digits, size)[::-1]:
            whole = (whole << _DIGIT) + plane.astype(object)
        exact.append([int(one) * Fraction(2) ** (_DIGIT * low) for one in whole])
    if at != len(content) or N < 1 or left_out < 0 or (counts < 0).any():
        raise ValueError("sums are shorter or longer than they should be")
    means, products, pairs = exact[2:]
    crossed = [
        *(
            means[k * G + g] * means[q * G + g]
            for k, q in ((0, 0), (0, 1), (1, 1))
            for g in range(G)
        ),
        *(means[m.row * G + k] * means[m.row * G + q] for k in range(V) for q in range(k, V)),
    ]
    both = zip([*products, *pairs], crossed, strict=True)
    scatter = np.array([float(one - of_means / N) for one, of_means in both])
    found = nothing(m, 1)[0]
    found.packings[:], found.held[:], found.samples[:] = (N, left_out), N, N * m.members
    found.tensile[:], bins = counts[:G], counts[G:].reshape(2, m.counted)
    found.bins[:] = *bins, bins[0] * m.members
    found.means[:] = np.array([float(one / N) for one in means]).reshape(2, G)
    found.products[:] = scatter[: 3 * G].reshape(3, G)
    matrix, upper = np.zeros((V, V)), np.triu_indices(V)
    matrix[upper] = matrix.T[upper] = scatter[3 * G :]
    first = np.array(lowest if left_out else NEVER)
    return replace(found, first=first, pairs=matrix)
