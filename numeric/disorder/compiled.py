"""Radii drawn number by number: bitwise those of ``radii``, for many packings at once.

The same words of Philox4x64-10 and the same operations on them as in ``radii`` and ``normal``, in
the same order and each rounded by itself. Nothing here but ``drawn`` is called but compiled.
"""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ..arithmetic import compiling
from ..arithmetic.carried import sqrt
from ..arithmetic.systems import Array
from ..lattice.layers import Layer
from . import normal

KINDS = {"two-point": 0, "uniform": 1, "normal": 2}
# Columns of a slab may be negative; counters must not be.
OFFSET = 2**62

_ARTANH, _COS, _SIN = tuple(normal.ARTANH), tuple(normal.COS), tuple(normal.SIN)
_LOG2, _ROOT_HALF, _TURN = math.log(2), math.sqrt(0.5), 2 * math.pi
_ROOT3 = float(np.sqrt(3.0))
_M0, _M1 = np.uint64(0xD2E7470EE14C6C93), np.uint64(0xCA5A826395121157)
_W0, _W1 = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBB67AE8584CAA73B)
_S11, _S32, _S52, _S63, _ONE = (np.uint64(n) for n in (11, 32, 52, 63, 1))
_HALF_WORD = np.uint64(2**32 - 1)
_MANTISSA, _HALF_BITS = np.uint64(2**52 - 1), np.uint64(0x3FE << 52)
# Words that are made before they become deviates: few enough for the nearest cache.
_TOGETHER = 512


def product(a: Any, b: Any) -> Any:
    """Give the upper and lower 64 bits, by products of 32 bits, of which registers hold several."""
    a_low, a_high, b_low, b_high = a & _HALF_WORD, a >> _S32, b & _HALF_WORD, b >> _S32
    lowest = a_low * b_low
    one = a_high * b_low + (lowest >> _S32)
    other = a_low * b_high + (one & _HALF_WORD)
    high = a_high * b_high + (one >> _S32) + (other >> _S32)
    return high, (other << _S32) | (lowest & _HALF_WORD)


def words(low: Any, high: Any, k0: Any, k1: Any, first: Any, second: Any, n: Any) -> None:
    """Fill in the first two of n words of Philox, of the counters (low + q, high, 0, 0)."""
    # Half of the first two rounds is the same for all of a row, and of the last one half is asked.
    p0, p1 = k0 + _W0, k1 + _W1
    row_high, row_low = product(_M0, np.uint64(high) ^ k0)
    for q in range(n):
        a_high, a_low = product(_M0, np.uint64(low + q))
        c_high, c_low = product(_M1, a_high ^ k1)
        a, b, c, d = c_high ^ p0, c_low, row_high ^ a_low ^ p1, row_low
        r0, r1 = p0 + _W0, p1 + _W1
        for _ in range(7):
            a_high, a_low = product(_M0, a)
            c_high, c_low = product(_M1, c)
            a, b, c, d = c_high ^ b ^ r0, c_low, a_high ^ d ^ r1, a_low
            r0 += _W0
            r1 += _W1
        c_high, c_low = product(_M1, c)
        first[q], second[q] = c_high ^ b ^ r0, c_low


def uniform(first: Any, rho: Any, at: Any, n: Any) -> None:
    """Fill in uniform deviates."""
    for q in range(n):
        odd = np.int64((first[q] >> _S11) << _ONE) + 1 - 2**53
        rho[at + q] = np.float64(odd) * 2.0**-53 * _ROOT3


def gaussian(first: Any, second: Any, rho: Any, at: Any, n: Any) -> None:
    """Do what ``normal.normal_deviates`` does."""
    for q in range(n):
        unit = (np.float64(first[q] >> _S11) + 0.5) * 2.0**-53
        turn = np.float64(second[q] >> _S11) * 2.0**-53
        word = np.float64(unit).view(np.uint64)
        mantissa = np.uint64((word & _MANTISSA) | _HALF_BITS).view(np.float64)
        exponent = np.int64(word >> _S52) - 1022
        low = mantissa < _ROOT_HALF
        mantissa = 2 * mantissa if low else mantissa
        exponent = exponent - 1 if low else exponent
        t = (mantissa - 1) / (mantissa + 1)
        x = t * t
        total = _ARTANH[11]
        for k in range(10, -1, -1):
            total = total * x + _ARTANH[k]
        logarithm = exponent * _LOG2 + t * total
        quarter = np.floor(4 * turn + 0.5)
        y = (turn - quarter / 4) * _TURN
        x = y * y
        cos, sin = _COS[9], _SIN[9]
        for k in range(8, -1, -1):
            cos, sin = cos * x + _COS[k], sin * x + _SIN[k]
        sin = y * sin
        which = np.int64(quarter) % 4  # cos, −sin, −cos, sin
        size = sin if which % 2 else cos
        size = -size if which % 3 else size
        rho[at + q] = sqrt(-2 * logarithm) * size


def draw(
    kind: Any, keys: Any, runs: Any, rho: Any, first: Any, second: Any,
    batch: Any, count: Any, beads: Any,
) -> int:  # fmt: skip
    """Draw deviates of packings, (batch, beads).

    ``keys`` (batch, 2) are those of Philox; ``runs`` (count, 4): where a run of beads begins, the
    two words of its first counter, and how many they are. Words are made in ``first`` and
    ``second`` before they become deviates.
    """
    for k in range(batch):
        for r in range(count):
            start, low, high = runs[4 * r], runs[4 * r + 1], runs[4 * r + 2]
            for at in range(0, runs[4 * r + 3], _TOGETHER):
                n, own = min(runs[4 * r + 3] - at, _TOGETHER), k * beads + start + at
                words(low + at, high, keys[2 * k], keys[2 * k + 1], first, second, n)
                if kind == 0:
                    for q in range(n):
                        rho[own + q] = 1.0 if first[q] >> _S63 else -1.0
                elif kind == 1:
                    uniform(first, rho, own, n)
                else:
                    gaussian(first, second, rho, own, n)
    return 0


@lru_cache(maxsize=1)
def _loop() -> Any:
    kinds = ("number", "word", "whole", "float", "word", "word", *["number"] * 3)
    made = compiling.compiled([(draw, kinds)], [product, words, uniform, gaussian])
    return None if made is None else made[0]


@lru_cache(maxsize=4)
def _runs_of(rows: Sequence[Layer], width: int | None) -> Array:
    """Give the runs of ``draw`` for rows of beads that lie one after the other."""
    found, start = [], 0
    for layer in rows:
        column, at = (layer.first - layer.j % 2) // 2, 0
        while at < layer.count:  # up to where a periodic packing begins anew
            q = column + at if width is None else (column + at) % width
            n = layer.count - at if width is None else min(layer.count - at, width - q)
            found.append((start + at, q + OFFSET, layer.j, n))
            at += n
        start += layer.count
    return np.array(found, dtype=np.int64).reshape(-1, 4)


def drawn(
    kind: str, seed: int, width: int | None, rows: Sequence[Layer], realisations: Sequence[int]
) -> Array | None:
    """Give deviates of unit variance, (realisations, beads); None where nothing compiles."""
    if (loop := _loop()) is None:
        return None
    keys, runs = np.empty((len(realisations), 2), np.uint64), _runs_of(rows, width)
    keys[:, 0], keys[:, 1] = seed, realisations
    found = np.empty((len(keys), int(runs[:, 3].sum())))
    first, second = np.empty(_TOGETHER, np.uint64), np.empty(_TOGETHER, np.uint64)
    arrays = (one.ctypes.data for one in (keys, runs, found, first, second))
    loop(KINDS[kind], *arrays, len(keys), len(runs), found.shape[1])
    return found
