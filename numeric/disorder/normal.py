"""Normal deviates from random words by arithmetic alone, so that every machine draws the same.

Box and Muller's transform needs a logarithm and a cosine, and libraries differ in their last
place. Both are therefore written here with +, −, ×, ÷ and √ of IEEE doubles, which are rounded
alike everywhere, whatever the length of an array. Their own error, a few units in the last place,
only means that a draw's probability is off by as much.
"""

import math

import numpy as np

from ..arithmetic.systems import Array

# 2/(2k + 1): the series of 2 artanh(t); |t| <= 0.172 makes the 12th term smaller than 2^-60.
ARTANH = [2 / (2 * k + 1) for k in range(12)]
# Taylor coefficients of cos and sin in y²; |y| <= π/4 makes the 10th term smaller than 2^-60.
COS = [(-1) ** k / math.factorial(2 * k) for k in range(10)]
SIN = [(-1) ** k / math.factorial(2 * k + 1) for k in range(10)]


def _polynomial(coefficients: list[float], x: Array) -> Array:
    total = np.full_like(x, coefficients[-1])
    for c in reversed(coefficients[:-1]):
        total = total * x + c
    return total


def logarithm(x: Array) -> Array:
    """Natural logarithm of normal positive doubles, within a few units in the last place."""
    mantissa, exponent = np.frexp(x)
    low = mantissa < math.sqrt(0.5)
    mantissa = np.where(low, 2 * mantissa, mantissa)
    exponent = exponent - low
    t = (mantissa - 1) / (mantissa + 1)
    return np.asarray(exponent * math.log(2) + t * _polynomial(ARTANH, t * t))


def cosine_of_turn(turn: Array) -> Array:
    """cos(2π turn) for 0 ≤ turn < 1."""
    quarter = np.floor(4 * turn + 0.5)
    y = (turn - quarter / 4) * (2 * math.pi)
    square = y * y
    cos, sin = _polynomial(COS, square), y * _polynomial(SIN, square)
    by_quarter = [cos, -sin, -cos, sin]
    return np.asarray(np.choose(quarter.astype(int) % 4, by_quarter))


def normal_deviates(first: Array, second: Array) -> Array:
    """Give standard normal deviates from two arrays of 64-bit random words (Box and Muller)."""
    unit = ((first >> np.uint64(11)).astype(np.float64) + 0.5) * 2.0**-53
    turn = (second >> np.uint64(11)).astype(np.float64) * 2.0**-53
    return np.asarray(np.sqrt(-2 * logarithm(unit)) * cosine_of_turn(turn))
