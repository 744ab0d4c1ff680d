"""Radii drawn by compiled loops: bitwise those of ``radii``, for many packings at once.

The same words of Philox4x64-10 and the same operations on them as in ``radii`` and ``normal``, in
the same order and each rounded by itself. Only ``mechanics.sweeps`` imports this file.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from llvmlite import binding, ir
from numba import types
from numba.extending import intrinsic

from ..arithmetic.compiling import compiled
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.layers import Layer
from . import normal
from .radii import NEARLY, OFFSET, DrawnRadii

KINDS = {"two-point": 0, "uniform": 1, "normal": 2}

_ARTANH, _COS, _SIN = tuple(normal.ARTANH), tuple(normal.COS), tuple(normal.SIN)
_NEARLY = float(NEARLY)
_LOG2, _ROOT_HALF, _TURN = math.log(2), math.sqrt(0.5), 2 * math.pi
_ROOT3 = float(np.sqrt(3.0))
_M0, _M1 = np.uint64(0xD2E7470EE14C6C93), np.uint64(0xCA5A826395121157)
_W0, _W1 = np.uint64(0x9E3779B97F4A7C15), np.uint64(0xBB67AE8584CAA73B)
_S11, _S32, _S52, _S63, _ONE = (np.uint64(n) for n in (11, 32, 52, 63, 1))
_HALF_WORD = np.uint64(2**32 - 1)
_MANTISSA, _HALF_BITS = np.uint64(2**52 - 1), np.uint64(0x3FE << 52)
# Words that are made before they become deviates: few enough for the nearest cache.
_TOGETHER = 512


def _product_code(typing: Any, a: Any, b: Any) -> Any:
    """Give the upper and lower 64 bits of a product."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        wide = ir.IntType(128)
        x, y = (builder.zext(value, wide) for value in arguments)
        product = builder.mul(x, y)
        high = builder.lshr(product, ir.Constant(wide, 64))
        halves = [builder.trunc(half, ir.IntType(64)) for half in (high, product)]
        return context.make_tuple(builder, signature.return_type, halves)

    pair: Any = types.UniTuple
    return pair(types.uint64, 2)(types.uint64, types.uint64), code


def _bits_code(typing: Any, x: Any) -> Any:
    """Read a double as a word."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.uint64(types.float64), code


def _double_code(typing: Any, x: Any) -> Any:
    """Read a word as a double."""

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.uint64), code


@compiled
def _product_of_halves(a: Any, b: Any) -> tuple[Any, Any]:
    """Do the same by four products of 32 bits, of which wide registers hold eight."""
    a_low, a_high, b_low, b_high = a & _HALF_WORD, a >> _S32, b & _HALF_WORD, b >> _S32
    lowest = a_low * b_low
    one = a_high * b_low + (lowest >> _S32)
    other = a_low * b_high + (one & _HALF_WORD)
    high = a_high * b_high + (one >> _S32) + (other >> _S32)
    return high, (other << _S32) | (lowest & _HALF_WORD)


_WIDE = binding.get_host_cpu_features().get("avx512dq", False)
_product: Any = _product_of_halves if _WIDE else intrinsic(_product_code)
_bits: Any = intrinsic(_bits_code)
_double: Any = intrinsic(_double_code)


@compiled
def _words(low: int, high: int, key: Array, first: Array, second: Array) -> None:
    """Fill in the first two words of Philox for the counters (low + q, high, 0, 0)."""
    # Half of the first two rounds is the same for all of a row, and of the last one half is asked.
    k0, k1 = key[0], key[1]
    p0, p1 = k0 + _W0, k1 + _W1
    row_high, row_low = _product(_M0, np.uint64(high) ^ k0)
    for q in range(first.size):
        a_high, a_low = _product(_M0, np.uint64(low + q))
        c_high, c_low = _product(_M1, a_high ^ k1)
        a, b, c, d = c_high ^ p0, c_low, row_high ^ a_low ^ p1, row_low
        r0, r1 = p0 + _W0, p1 + _W1
        for _ in range(7):
            a_high, a_low = _product(_M0, a)
            c_high, c_low = _product(_M1, c)
            a, b, c, d = c_high ^ b ^ r0, c_low, a_high ^ d ^ r1, a_low
            r0 += _W0
            r1 += _W1
        c_high, c_low = _product(_M1, c)
        first[q], second[q] = c_high ^ b ^ r0, c_low


@compiled
def _uniform(first: Array, own: Array) -> None:
    for q in range(own.size):
        odd = np.int64((first[q] >> _S11) << _ONE) + 1 - 2**53
        own[q] = np.float64(odd) * 2.0**-53 * _ROOT3


@compiled
def _normal(first: Array, second: Array, own: Array) -> None:
    """Do what ``normal.normal_deviates`` does."""
    for q in range(own.size):
        unit = (np.float64(first[q] >> _S11) + 0.5) * 2.0**-53
        turn = np.float64(second[q] >> _S11) * 2.0**-53
        word = _bits(unit)
        mantissa = _double((word & _MANTISSA) | _HALF_BITS)
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
        own[q] = np.sqrt(-2 * logarithm) * size


@compiled
def _draw(kind: int, std: float, keys: Array, runs: Array, rho: Array) -> float:
    """Draw δr/r of packings (packings, beads); give the smallest deviate.

    ``keys`` (packings, 2) are those of Philox; ``runs`` (runs, 4): where a run of beads begins,
    the two words of its first counter, and how many they are.
    """
    first, second = np.empty(_TOGETHER, np.uint64), np.empty(_TOGETHER, np.uint64)
    smallest = np.inf
    for k in range(len(keys)):
        for r in range(len(runs)):
            start, low, high, beads = runs[r, 0], runs[r, 1], runs[r, 2], runs[r, 3]
            for at in range(0, beads, _TOGETHER):
                n = min(beads - at, _TOGETHER)
                own = rho[k, start + at : start + at + n]
                _words(low + at, high, keys[k], first[:n], second[:n])
                if kind == 0:
                    for q in range(n):
                        own[q] = 1.0 if first[q] >> _S63 else -1.0
                elif kind == 1:
                    _uniform(first[:n], own)
                else:
                    _normal(first[:n], second[:n], own)
                for q in range(n):
                    smallest = min(smallest, own[q])
                    own[q] *= std
    return smallest


def runs_of(radii: DrawnRadii, rows: Sequence[Layer]) -> Array:
    """Give the runs of ``_draw`` for rows of beads that lie one after the other."""
    found, start = [], 0
    for layer in rows:
        column, at = (layer.first - layer.j % 2) // 2, 0
        while at < layer.count:  # up to where a periodic packing begins anew
            q = column + at if radii.width is None else (column + at) % radii.width
            n = layer.count - at if radii.width is None else min(layer.count - at, radii.width - q)
            found.append((start + at, q + OFFSET, layer.j, n))
            at += n
        start += layer.count
    return np.array(found, dtype=np.int64).reshape(-1, 4)


def draw(
    radii: DrawnRadii,
    runs: Array,
    realisations: Sequence[int],
    rho: Array,
    *,
    scaled: bool = True,
) -> bool:
    """Fill in δr/r, (packings, beads); say whether all radii are surely positive.

    If not ``scaled``, fill in the deviates, of unit variance.
    """
    keys = np.empty((len(realisations), 2), dtype=np.uint64)
    keys[:, 0], keys[:, 1] = radii.seed, realisations
    std = float(FLOAT64.scalar(radii.std))
    smallest = _draw(KINDS[radii.kind], std if scaled else 1.0, keys, runs, rho)
    return smallest * std > -_NEARLY
