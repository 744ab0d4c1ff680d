"""Deviates by counter: Philox4x64-10, and normal ones by arithmetic alone, on any machine alike.

Words and deviates are written once, for numbers and arrays; where numba is installed it compiles
the same functions, bit for bit. Box and Muller's transform needs a logarithm and a cosine, and
libraries differ in their last place. Both are therefore written with +, −, ×, ÷ and √ of IEEE
doubles. Their own error, a few units in the last place, only means that a draw's probability is off
by as much.
"""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from ..arithmetic import compiling
from ..arithmetic.carried import sqrt
from ..arithmetic.systems import Array

KINDS = ("two-point", "uniform", "normal")

# 2/(2k + 1): the series of 2 artanh(t); |t| <= 0.172 makes the 12th term smaller than 2^-60.
_ARTANH = tuple(2 / (2 * k + 1) for k in range(12))
# Taylor coefficients of cos and sin in y²; |y| <= π/4 makes the 10th term smaller than 2^-60.
_COS = tuple((-1) ** k / math.factorial(2 * k) for k in range(10))
_SIN = tuple((-1) ** k / math.factorial(2 * k + 1) for k in range(10))
_LOG2, _ROOT_HALF, _TURN, _ROOT3 = math.log(2), math.sqrt(0.5), 2 * math.pi, math.sqrt(3)
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


def words(low: Any, high: Any, k0: Any, k1: Any) -> Any:
    """Give the first two words of Philox, of the counter (low, high, 0, 0)."""
    # Of the first two rounds half is the product of 0, and of the last half is asked for.
    p0, p1 = k0 + _W0, k1 + _W1
    row_high, row_low = product(_M0, high ^ k0)
    a_high, a_low = product(_M0, low)
    c_high, c_low = product(_M1, a_high ^ k1)
    a, b, c, d = c_high ^ p0, c_low, row_high ^ a_low ^ p1, row_low
    r0, r1 = p0 + _W0, p1 + _W1
    for _ in range(7):
        a_high, a_low = product(_M0, a)
        c_high, c_low = product(_M1, c)
        a, b, c, d = c_high ^ b ^ r0, c_low, a_high ^ d ^ r1, a_low
        r0 = r0 + _W0
        r1 = r1 + _W1
    c_high, c_low = product(_M1, c)
    return c_high ^ b ^ r0, c_low


def two_point(first: Any, second: Any) -> Any:
    """Give ±1."""
    return 2.0 * np.float64(first >> _S63) - 1.0


def uniform(first: Any, second: Any) -> Any:
    """Give a uniform deviate."""
    odd = np.int64((first >> _S11) << _ONE) + 1 - 2**53
    return np.float64(odd) * 2.0**-53 * _ROOT3


def normal(first: Any, second: Any) -> Any:
    """Give a normal deviate."""
    unit = (np.float64(first >> _S11) + 0.5) * 2.0**-53
    turn = np.float64(second >> _S11) * 2.0**-53
    return sqrt(-2 * logarithm(unit)) * cosine_of_turn(turn)


def logarithm(x: Any) -> Any:
    """Natural logarithm of normal positive doubles, within a few units in the last place."""
    word = np.float64(x).view(np.uint64)
    mantissa = np.uint64((word & _MANTISSA) | _HALF_BITS).view(np.float64)
    low = np.float64(mantissa < _ROOT_HALF)
    mantissa, exponent = mantissa + low * mantissa, np.int64(word >> _S52) - 1022 - low
    t = (mantissa - 1) / (mantissa + 1)
    square = t * t
    total = _ARTANH[11]
    for k in range(10, -1, -1):
        total = total * square + _ARTANH[k]
    return exponent * _LOG2 + t * total


def cosine_of_turn(turn: Any) -> Any:
    """cos(2π turn) for 0 ≤ turn < 1."""
    quarter = np.floor(4 * turn + 0.5)
    y = (turn - quarter / 4) * _TURN
    square = y * y
    cos, sin = _COS[9], _SIN[9]
    for k in range(8, -1, -1):
        cos, sin = cos * square + _COS[k], sin * square + _SIN[k]
    which = np.int64(quarter)  # modulo 4: cos, −sin, −cos, sin
    odd, sign = np.float64(which & 1), 1.0 - np.float64((which + 1) & 2)
    return sign * (odd * (y * sin) + (1.0 - odd) * cos)


def draw(
    kind: Any, keys: Any, low: Any, high: Any, found: Any, first: Any, second: Any,
    batch: Any, beads: Any,
) -> int:  # fmt: skip
    """Draw deviates of packings, (batch, beads), whose keys are (batch, 2)."""
    for k in range(batch):
        for start in range(0, beads, _TOGETHER):
            n, own = min(beads - start, _TOGETHER), k * beads + start
            for q in range(n):
                first[q], second[q] = words(
                    low[start + q], high[start + q], keys[2 * k], keys[2 * k + 1]
                )
            if kind == 0:
                for q in range(n):
                    found[own + q] = two_point(first[q], second[q])
            elif kind == 1:
                for q in range(n):
                    found[own + q] = uniform(first[q], second[q])
            else:
                for q in range(n):
                    found[own + q] = normal(first[q], second[q])
    return 0


@lru_cache(maxsize=1)
def _loop() -> Any:
    kinds = ("number", *["word"] * 3, "float", "word", "word", "number", "number")
    called: list[Any] = [product, words, two_point, uniform, logarithm, cosine_of_turn, normal]
    made = compiling.compiled([(draw, kinds)], called)
    return None if made is None else made[0]


def deviates(kind: str, seed: int, realisations: Sequence[int], low: Array, high: Array) -> Array:
    """Give deviates of zero mean and unit variance of the counters (low, high).

    Shape (realisations, counters); all are arrays of 64-bit words.
    """
    keys = np.empty((len(realisations), 2), np.uint64)
    keys[:, 0], keys[:, 1] = seed, realisations
    if (loop := _loop()) is None:
        form = (two_point, uniform, normal)[KINDS.index(kind)]
        return np.asarray(form(*words(low, high, keys[:, :1], keys[:, 1:])))
    found = np.empty((len(keys), len(low)))
    arrays = (keys, low, high, found, *np.empty((2, _TOGETHER), np.uint64))
    loop(KINDS.index(kind), *(array.ctypes.data for array in arrays), len(keys), len(low))
    return found
