"""Exact sums by compiled loops: the very numbers of ``exact_sum``, for many packings at once.

A piece of up to 2^8 doubles is cut into three whole numbers each, of 26 bits, on a grid that fits
its largest: their products, and sums of these, are whole numbers that 64 bits hold. What does not
end after three is cut into six; what does not end there is left to ``exact_sum``. Sums are then put
on the grid of ``exact_sum``, in base 2^22, where their digits are canonical. So the order of
additions does not matter at all, and no rounding takes place but that of ``ExactSum.rounded``.
"""

import math
from typing import Any

import numpy as np

from ..arithmetic.compiling import borrowed, compiled
from ..arithmetic.systems import Array
from .exact_sum import BITS, ExactSum

_HALF = 1 << (BITS - 1)
_MASK = (1 << BITS) - 1
_SIZE = 0x7FFF_FFFF_FFFF_FFFF  # all bits of a double but its sign
# Exponents that are summed here: products of the last digits stay far above the smallest double.
_LEAST, _MOST = -400, 26
_PIECE, _CUT = 256, 26
# The lowest digits of sums and of sums of squares on the grid, and how many there are.
_LOW, _LOW_OF_SQUARES = -28, -56
_PLANES, _PLANES_OF_SQUARES = 36, 66


@compiled
def _put(limbs: Array, low: int, whole: int, exponent: int) -> None:
    """Add whole × 2^exponent to digits in base 2^22."""
    k = exponent // BITS
    shift = exponent - BITS * k
    limbs[k - low] += (whole & _MASK) << shift
    limbs[k - low + 1] += ((whole >> BITS) & _MASK) << shift
    limbs[k - low + 2] += (whole >> (2 * BITS)) << shift


@compiled
def _added(values: Array, e: int, sums: Array, squares: Array) -> bool:
    """Add doubles below 2^e and their squares; False, and nothing, if three cuts do not do."""
    scale, step = 2.0 ** (_CUT - e), 2.0**_CUT
    a: Any = 0
    b = c = aa = ab = bb = ac = bc = cc = rest = a
    for q in range(values.size):
        value = values[q] * scale
        first = np.int32(value)
        value = (value - first) * step
        second = np.int32(value)
        value = (value - second) * step
        third = np.int32(value)
        rest += value != third
        x, y, z = np.int64(first), np.int64(second), np.int64(third)
        a += x
        b += y
        c += z
        aa += x * x
        ab += x * y
        bb += y * y
        ac += x * z
        bc += y * z
        cc += z * z
    if rest:
        return False
    _put(sums, _LOW, a, e - _CUT)
    _put(sums, _LOW, b, e - 2 * _CUT)
    _put(sums, _LOW, c, e - 3 * _CUT)
    low = _LOW_OF_SQUARES
    _put(squares, low, aa, 2 * (e - _CUT))
    _put(squares, low, ab, 2 * e - 3 * _CUT + 1)
    _put(squares, low, bb, 2 * (e - 2 * _CUT))
    _put(squares, low, ac, 2 * e - 4 * _CUT + 1)
    _put(squares, low, bc, 2 * e - 5 * _CUT + 1)
    _put(squares, low, cc, 2 * (e - 3 * _CUT))
    return True


@compiled
def _added_slowly(values: Array, e: int, sums: Array, squares: Array) -> bool:
    """Do the same with six cuts, one number after the other; False if they do not do."""
    digits = np.zeros(6, np.int64)
    for q in range(values.size):
        value = values[q] * 2.0 ** (_CUT - e)
        for n in range(6):
            digits[n] = np.int64(value)
            value = (value - digits[n]) * 2.0**_CUT
        if value != 0:
            return False
        for n in range(6):
            at = e - (n + 1) * _CUT
            _put(sums, _LOW, digits[n], at)
            for m in range(6):
                product = digits[n] * digits[m]
                _put(squares, _LOW_OF_SQUARES, product, at + e - (m + 1) * _CUT)
    return True


@compiled
def _carried(limbs: Array, low: int, shift: int, total: Array, used: Array) -> float:
    """Make digits canonical, add them to ``total``, and forget them; give the rounded number.

    It is ``ExactSum.rounded(shift)``: digits are added as floats, the lowest first. ``used`` are
    the first and the last digit of a total that is not zero.
    """
    rounded = 0.0
    for k in range(limbs.size):
        if limbs[k]:
            carry = (limbs[k] + _HALF) >> BITS
            digit = limbs[k] - (carry << BITS)
            limbs[k] = 0
            if k + 1 < limbs.size:
                limbs[k + 1] += carry
            total[k] += digit
            used[0], used[1] = min(used[0], k), max(used[1], k)
            rounded += math.ldexp(np.float64(digit), BITS * (low + k) + shift)
    return rounded


@compiled
def _moved(total: Array, added: Array, first: int, last: int, good: bool) -> None:
    """Forget digits first … last of what was added; if it is ``good``, to the total."""
    for group in range(len(total)):
        for k in range(first, last + 1):
            if good:
                total[group, k] += added[group, k]
            added[group, k] = 0


@compiled
def _counted(values: Array, edges: Array, counts: Array) -> None:
    """Count into bins: below, in, and above ``edges`` (``np.searchsorted``, side "right")."""
    bins = edges.size - 1
    first, scale = edges[0], bins / (edges[bins] - edges[0])
    guesses = np.empty(_PIECE, np.int32)
    for start in range(0, values.size, _PIECE):
        part = values[start : start + _PIECE]
        for q in range(part.size):
            guesses[q] = np.int32(min(max((part[q] - first) * scale, -1.0), float(bins))) + 1
        for q in range(part.size):
            value, at = part[q], guesses[q]
            while at > 0 and value < edges[at - 1]:
                at -= 1
            while at <= bins and value >= edges[at]:
                at += 1
            counts[at] += 1


@compiled
def _least(F: tuple[Array, ...], pieces: Array) -> Array:
    """Give the smallest F of each of the ``pieces`` of ``_tally``."""
    least = np.empty(len(pieces))
    for p in range(len(pieces)):
        start, count = pieces[p, 3], pieces[p, 4]
        least[p] = F[pieces[p, 1]][start : start + count].min()
    return least


@compiled
def _tally(
    g: Array,
    words: Array,
    F: tuple[Array, ...],
    pieces: Array,
    members: int,
    unit: int,
    edges: Array,
    least: Array,
    totals: tuple[Array, Array],
    used: Array,
    means: Array,
    tensile: Array,
    counts: Array,
) -> bool:
    """Sum up packings; False where ``exact_sum`` has to.

    ``g`` is (packings, branches, …), ``words`` its bits, ``F`` the ordered forces of branches.
    ``pieces`` (pieces, 5): group, branch, where it begins in g and in F, contacts; groups come in
    their order; ``least`` (pieces,) is the smallest F of each. Added to are ``totals``, digits of
    sums and sums of squares (groups, …), of which some lie within ``used`` (2, 2), and ``tensile``
    (groups,); filled are ``means`` (2, groups, packings), counted up ``counts`` (packings, bins
    and 2).
    """
    sums, squares = np.zeros(_PLANES, np.int64), np.zeros(_PLANES_OF_SQUARES, np.int64)
    g, words = borrowed(g), borrowed(words)
    for k in range(len(g)):
        for p in range(len(pieces)):
            group, branch, start, ordered = pieces[p, 0], pieces[p, 1], pieces[p, 2], pieces[p, 3]
            stop, bound = start + pieces[p, 4], 0.0
            for at in range(start, stop, _PIECE):
                end = min(at + _PIECE, stop)
                own = words[k, branch, at:end]
                largest: Any = np.int64(0)
                for q in range(own.size):
                    largest = max(largest, own[q] & _SIZE)
                if largest:
                    e = (largest >> 52) - 1022
                    if e < _LEAST or e > _MOST:
                        return False
                    bound = max(bound, 2.0**e)
                    values = g[k, branch, at:end]
                    if not _added(values, e, sums, squares) and not _added_slowly(
                        values, e, sums, squares
                    ):
                        return False
            own_g = g[k, branch, start:stop]
            if least[p] < bound:
                pull, own_F = 0, F[branch][ordered : ordered + stop - start]
                for q in range(own_g.size):
                    pull += own_F[q] + own_g[q] < 0
                tensile[group] += pull
            if edges.size:
                _counted(own_g, edges, counts[k])
            if p + 1 == len(pieces) or pieces[p + 1, 0] != group:
                mean = _carried(sums, _LOW, -unit, totals[0][group], used[0])
                square = _carried(squares, _LOW_OF_SQUARES, -2 * unit, totals[1][group], used[1])
                means[0, group, k], means[1, group, k] = mean / members, square / members
    return True


class Tally:
    """Sums over packings, group by group, as they come; arrays as in ``ensemble.sums``."""

    def __init__(
        self,
        pieces: Array,
        F: tuple[Array, ...],
        groups: int,
        members: int,
        unit: int,
        edges: tuple[float, ...],
    ) -> None:
        """``pieces`` and ``F`` are those of ``_tally``; the rest is that of a measurement."""
        self.pieces, self.F, self.members, self.unit = pieces, F, members, unit
        self.least, self.edges = _least(F, pieces), np.array(edges)
        shapes = (groups, _PLANES), (groups, _PLANES_OF_SQUARES)
        self.totals = np.zeros(shapes[0], np.int64), np.zeros(shapes[1], np.int64)
        self._added = np.zeros(shapes[0], np.int64), np.zeros(shapes[1], np.int64)
        self.tensile = np.zeros(groups, np.int64)
        self.bins = np.zeros((2, len(edges) + 1 if edges else 0), np.int64)

    def add(self, g: Array) -> Array | None:
        """Add packings; give their a and b, (2, groups, packings). None, and nothing, where not.

        Then some number is too large, too small, or none.
        """
        means = np.zeros((2, len(self.tensile), len(g)))
        counts = np.zeros((len(g), self.bins.shape[1]), np.int64)
        tensile = np.zeros_like(self.tensile)
        used = np.array([[_PLANES, 0], [_PLANES_OF_SQUARES, 0]])
        good = _tally(
            g, g.view(np.int64), self.F, self.pieces, self.members, self.unit, self.edges,
            self.least, self._added, used, means, tensile, counts,
        )  # fmt: skip
        for total, added, (first, last) in zip(self.totals, self._added, used, strict=True):
            _moved(total, added, first, last, good)
        if not good:
            return None
        self.tensile += tensile
        self.bins += [counts.sum(axis=0), (counts**2).sum(axis=0)]
        return means

    def sums(self) -> tuple[ExactSum, ExactSum]:
        """Give the sums of g and of g², (groups,) each."""
        return _exact(self.totals[0], _LOW), _exact(self.totals[1], _LOW_OF_SQUARES)


def _exact(limbs: Array, low: int) -> ExactSum:
    planes = ((low + k, plane) for k, plane in enumerate(limbs.T) if plane.any())
    return ExactSum.of(planes, (len(limbs),))
