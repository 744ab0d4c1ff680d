"""Sweeps of spheres in float64, compiled: bitwise the numbers of ``spheres`` for d = 3.

The same operations in the same order, each rounded by itself. What is out of the ordinary (a bead
that can't rest, a number that is not finite) is given back, and left to the NumPy sweeps, whose
errors name the bead. Neighbours in a periodic layer are no neighbours in memory: what a strip of
beads reads of those below or above is first copied beside each other.
"""

from collections.abc import Sequence
from math import isqrt, sqrt

import numpy as np

from ..arithmetic.compiling import borrowed, compiled, inlined, on_all_cores
from ..arithmetic.systems import FLOAT64, Array
from ..disorder.radii import Radii
from ..lattice.layers import Layer, LazyRows, Region
from .compiled import Drawing
from .compiled_packing import memory
from .forces import Ordered
from .spheres import Borne, CompiledPlaced, Metric, along, straight_down

Vector = tuple[float, float, float]
Rows = tuple[Array, Array, Array]

# Beads of a strip: what they read of others fits into the nearest cache.
_STRIP = 256
# Numbers of a bead: c, (3,), and δn of the contacts below, (3, 3).
_NUMBERS = 12


@inlined
def _rows(values: Array, row: int) -> Rows:
    """Give three rows: LLVM takes four numbers at a time of arrays of one dimension only."""
    return values[row], values[row + 1], values[row + 2]


@inlined
def _part(values: Array, row: int, start: int, stop: int) -> Rows:
    return values[row, start:stop], values[row + 1, start:stop], values[row + 2, start:stop]


@inlined
def _get(rows: Rows, q: int) -> Vector:
    return rows[0][q], rows[1][q], rows[2][q]


@inlined
def _put(rows: Rows, q: int, v: Vector) -> None:
    rows[0][q], rows[1][q], rows[2][q] = v


@inlined
def _plus(u: Vector, v: Vector) -> Vector:
    return u[0] + v[0], u[1] + v[1], u[2] + v[2]


@inlined
def _less(u: Vector, v: Vector) -> Vector:
    return u[0] - v[0], u[1] - v[1], u[2] - v[2]


@inlined
def _times(v: Vector, factor: float) -> Vector:
    return v[0] * factor, v[1] * factor, v[2] * factor


@inlined
def _dot(u: Vector, v: Vector) -> float:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]


@inlined
def _raised(v: Vector, own: float, cross: float) -> Vector:
    """Do what ``Metric.raised`` does."""
    common = (v[0] + v[1] + v[2]) * cross
    return v[0] * own + common, v[1] * own + common, v[2] * own + common


@inlined
def _turned(f: Vector, a: Vector, b: Vector, c: Vector) -> Vector:
    return _plus(_plus(_times(a, f[0]), _times(b, f[1])), _times(c, f[2]))


@inlined
def _square(v: Vector, own: float, cross: float) -> float:
    return _dot(_raised(v, own, cross), v) / 4


@inlined
def _solved(matrix: tuple[Vector, Vector, Vector], right: Vector) -> tuple[Vector, float]:
    """Solve (1 + matrix) x = right as ``spheres`` does; give x and the product of all pivots."""
    (a, b, c), (d, e, f), (g, h, i) = matrix
    first = 1 + a
    k, m = d / first, g / first
    y, z = right[1] - k * right[0], right[2] - m * right[0]
    f = f - k * c
    second = 1 + (e - k * b)
    k = (h - m * b) / second
    third = 1 + (i - m * c - k * f)
    z = (z - k * y) / third
    y = (y - f * z) / second
    return ((right[0] - b * y - c * z) / first, y, z), first * second * third


@inlined
def _place(strip: Array, rho: Array, phi: float, own: float, cross: float) -> bool:
    """Rest a strip of beads on their supports (``spheres.deposit``); say whether all of them rest.

    ``strip``, (12, beads), holds n^b·δx of the three supports and then δr/r of these, ``rho`` has
    that of the beads. In its place come c, and the δn of the contacts below.
    """
    under_a, under_b, under_c = _rows(strip, 0), _rows(strip, 3), _rows(strip, 6)
    rho_a, rho_b, rho_c = _rows(strip, 9)
    good = True
    for q in range(rho.size):
        A, B, C = _get(under_a, q), _get(under_b, q), _get(under_c, q)
        a, b, e = rho[q] + rho_a[q], rho[q] + rho_b[q], rho[q] + rho_c[q]
        more_a, more_b, more_c = a * a / 4, b * b / 4, e * e / 4
        to_a, to_b, to_c = _less(C, A), _less(C, B), _less(C, C)
        tilt_a, tilt_b = _raised(to_a, own, cross), _raised(to_b, own, cross)
        tilt_c = _raised(to_c, own, cross)
        right = (
            a + more_a - to_a[0] - _dot(tilt_a, to_a) / 4,
            b + more_b - to_b[1] - _dot(tilt_b, to_b) / 4,
            e + more_c - to_c[2] - _dot(tilt_c, to_c) / 4,
        )
        matrix = _times(tilt_a, 0.5), _times(tilt_b, 0.5), _times(tilt_c, 0.5)
        start, pivots = _solved(matrix, right)
        step, _ = _solved(matrix, (1.0, 1.0, 1.0))
        up = _raised(start, own, cross)
        size = _dot(up, start)
        half = 1 + _dot(up, step) / 2
        discriminant = half * half - _dot(_raised(step, own, cross), step) * size / 4
        p = _less(start, _times(step, size / (half + sqrt(discriminant)) / 2))
        square_a = _square(_plus(p, to_a), own, cross)
        square_b = _square(_plus(p, to_b), own, cross)
        square_c = _square(_plus(p, to_c), own, cross)
        lift = a + more_a - square_a, b + more_b - square_b, e + more_c - square_c
        under = A[0], B[1], C[2]
        _put(under_a, q, _plus(under, lift))
        x, y, z = _plus(lift, _less(under, A))
        across = more_a - square_a, y - a * phi, z - a * phi
        x, y, z = _raised(across, own, cross)
        length = 2 + a
        _put(under_b, q, (x / length, y / length, z / length))
        x, y, z = _plus(lift, _less(under, B))
        across = x - b * phi, more_b - square_b, z - b * phi
        x, y, z = _raised(across, own, cross)
        length = 2 + b
        _put(under_c, q, (x / length, y / length, z / length))
        x, y, z = _plus(lift, _less(under, C))
        across = x - e * phi, y - e * phi, more_c - square_c
        x, y, z = _raised(across, own, cross)
        length = 2 + e
        _put((rho_a, rho_b, rho_c), q, (x / length, y / length, z / length))
        good &= (
            (discriminant > 0)
            & (discriminant < np.inf)
            & (pivots > 0)
            & (pivots < np.inf)
            & (step[0] > 0)
            & (step[0] < np.inf)
            & (step[1] > 0)
            & (step[1] < np.inf)
            & (step[2] > 0)
            & (step[2] < np.inf)
            & (1 + rho[q] > 0)
            & (rho[q] < np.inf)
        )
    return good


@compiled
def _deposit(
    rho: Array, block: Array, supports: Array, phi: float, own: float, cross: float
) -> bool:
    """Deposit packings on the ordered base; say whether every bead rests.

    ``rho`` is (packings, beads), layer after layer, ``supports``, (3, W²), the three beads of the
    layer below on which each of a layer rests; filled is ``block``, (packings, 12, …): c, and the
    δn of contacts below, which those of the base lack.
    """
    good = True
    rho, block, supports = borrowed(rho), borrowed(block), borrowed(supports)
    size = supports.shape[1]
    strip = np.empty((_NUMBERS, _STRIP))
    for k in range(len(rho)):
        own_rho, of = rho[k], block[k]
        for q in range(size):
            of[0, q] = of[1, q] = of[2, q] = 0.0
            good &= (1 + own_rho[q] > 0) & (own_rho[q] < np.inf)
        for layer in range(size, rho.shape[1], size):
            for at in range(0, size, _STRIP):
                n = min(_STRIP, size - at)
                for a in range(3):
                    for q in range(n):
                        support = layer - size + supports[a, at + q]
                        for m in range(3):
                            strip[3 * a + m, q] = of[m, support]
                        strip[9 + a, q] = own_rho[support]
                start = layer + at
                good &= _place(strip, own_rho[start : start + n], phi, own, cross)
                for m in range(_NUMBERS):
                    for q in range(n):
                        of[m, start + q] = strip[m, q]
    return good


@inlined
def _balance(strip: Array, F: Rows, dn: tuple[Rows, Rows, Rows]) -> bool:
    """Balance a strip of beads (one layer of ``spheres.bear``); say whether all is in order.

    ``strip``, (18, beads), holds g, what its sum has lost, F and the δn of the three contacts
    above; ``F`` are the ordered forces below, ``dn`` their δn, (beads,) each. In the place of the
    first six come g below, and what is lost.
    """
    g, lost, F_above = _rows(strip, 0), _rows(strip, 3), _rows(strip, 6)
    up_a, up_b, up_c = _rows(strip, 9), _rows(strip, 12), _rows(strip, 15)
    dn_a, dn_b, dn_c = dn
    good = True
    for q in range(F[0].size):
        before, own = _get(g, q), _get(F, q)
        f = _plus(_get(F_above, q), before)
        turn = _turned(f, _get(up_a, q), _get(up_b, q), _get(up_c, q))
        turn = _plus(turn, _get(lost, q))
        A, B, C = _get(dn_a, q), _get(dn_b, q), _get(dn_c, q)
        turn = _less(turn, _turned(own, A, B, C))
        small = _turned(_plus(before, turn), A, B, C)
        matrix = (A[0], B[0], C[0]), (A[1], B[1], C[1]), (A[2], B[2], C[2])
        less, pivots = _solved(matrix, small)
        turn = _less(turn, less)
        total = _plus(before, turn)
        part = _less(total, before)
        _put(g, q, total)
        _put(lost, q, _plus(_less(before, _less(total, part)), _less(turn, part)))
        good &= (
            (pivots * pivots > 0)
            & (pivots * pivots < np.inf)
            & (abs(total[0]) < np.inf)
            & (abs(total[1]) < np.inf)
            & (abs(total[2]) < np.inf)
        )
    return good


@compiled
def _bear(F: Array, block: Array, uppers: Array, g: Array) -> bool:
    """Sweep packings from the highest layer down; say if all is in order.

    ``F`` are the ordered forces below beads, (3, beads), ``uppers``, (3, W²), the three beads of
    the layer above that rest on each of a layer, ``block`` is that of ``_deposit``; filled is
    ``g``, (packings, 3, …), but for the base.
    """
    good = True
    F, block, uppers, g = borrowed(F), borrowed(block), borrowed(uppers), borrowed(g)
    size, beads = uppers.shape[1], F.shape[1]
    strip, lost = np.empty((18, _STRIP)), np.empty((3, 2 * size))
    for k in range(len(g)):
        of, own_g = block[k], g[k]
        for layer in range(beads - size, 0, -size):
            new = layer // size % 2 * size  # layers take turns to lose
            for at in range(0, size, _STRIP):
                n = min(_STRIP, size - at)
                if layer + size == beads:
                    strip[:] = 0.0
                else:
                    for a in range(3):
                        for q in range(n):
                            upper = uppers[a, at + q]
                            up = layer + size + upper
                            strip[a, q], strip[6 + a, q] = own_g[a, up], F[a, up]
                            strip[3 + a, q] = lost[a, size - new + upper]
                            for m in range(3):
                                strip[9 + 3 * a + m, q] = of[3 + 3 * a + m, up]
                start = layer + at
                stop = start + n
                good &= _balance(
                    strip,
                    _part(F, 0, start, stop),
                    (
                        _part(of, 3, start, stop),
                        _part(of, 6, start, stop),
                        _part(of, 9, start, stop),
                    ),
                )
                for m in range(3):
                    for q in range(n):
                        own_g[m, start + q] = strip[m, q]
                        lost[m, new + at + q] = strip[3 + m, q]
    return good


def _neighbours(width: int, step: int) -> Array:
    """Give the beads of a layer of W × W at ± e_1, e_2 and e_3 from each, (3, W²)."""
    index = np.arange(width**2).reshape(width, width)
    return np.stack([along(index, a, step, 3).reshape(-1) for a in range(3)])


class SphereDescent:
    """Carries loads down through packings of one region, in memory that is used again."""

    def __init__(self, region: Region, loads: Sequence[Array | None]) -> None:
        """``region`` has layers of W² beads, ``loads`` are those of ``spheres.bear``."""
        self.rows, self.starts, self.lowest = region.rows, region.starts, 1
        self._width = isqrt(region.widest)
        self._above = _neighbours(self._width, 1)
        self.table = np.zeros((3, region.beads))
        for j, F in straight_down(loads, (self._width, self._width), FLOAT64):
            self.table[:, self.starts[j] : self.starts[j + 1]] = F.reshape(3, -1)
        self.F = Ordered(tuple(self.table), (self.starts,) * 3, (0, 0))
        self._g = np.empty((0, 3, 0))

    def changes(self, block: Array) -> Array | None:
        """Give ``g`` of ``_bear``, for packings whose ``block`` that is; None where it fails."""
        if len(self._g) < len(block):
            self._g = memory(len(block), 3, self.table.shape[1], 0)
        g = self._g[: len(block)]

        def part(of: slice) -> bool:
            return _bear(self.table, block[of], self._above, g[of])

        return g if on_all_cores(part, len(block)) else None


class SphereSweeps:
    """Draws, deposits and balances packings of one problem, in memory that is used again.

    Its functions are those of ``rows_of``, ``spheres.deposit`` and ``spheres.bear``, for one batch
    after the other: what they gave for the last is overwritten.
    """

    def __init__(self, radii: Radii, m: Metric, region: Region) -> None:
        """``region`` has layers of W² beads."""
        self._draw, self._metric, self._region = Drawing(radii, region), m, region
        self._width = isqrt(region.widest)
        self._below = _neighbours(self._width, -1)
        self._block = np.empty((0, _NUMBERS, 0))
        self._flat = np.empty((0, 0))
        self._descent: tuple[Sequence[Array | None], SphereDescent] | None = None

    def radii(self, realisations: Sequence[int]) -> Sequence[Array]:
        """Give δr/r, row by row of W² beads."""
        self._flat, rows = self._draw(realisations)
        return rows

    def deposit(self, rho: Sequence[Array]) -> CompiledPlaced | None:
        """Deposit what was drawn last, whose layers are ``rho``; None: not all rest."""
        block = self._rested(self._flat)
        if block is None:
            return None
        c, dn = self._layers(block[:, :3], 0), self._layers(block[:, 3:], 1)

        def turned(j: int) -> Array:
            return dn[j].reshape(3, 3, *dn[j].shape[1:]) if j else dn[j]

        turns = LazyRows(len(dn), turned)
        return CompiledPlaced(self._metric, rho, c, turns, self._flat, block)

    def _rested(self, flat: Array) -> Array | None:
        if len(self._block) < len(flat):
            self._block = memory(len(flat), _NUMBERS, flat.shape[1], 0)
        block, m = self._block[: len(flat)], self._metric
        constants = float(m.phi), float(m.own), float(m.cross)

        def part(of: slice) -> bool:
            return _deposit(flat[of], block[of], self._below, *constants)

        return block if on_all_cores(part, len(flat)) else None

    def bear(self, placed: CompiledPlaced, loads: Sequence[Array | None]) -> Borne | None:
        """Balance what was deposited last; None where not all is in order."""
        descent = self.descent(self._region.rows, loads)
        g = descent.changes(placed.block)
        if g is None:
            return None
        return Borne(self._layers(descent.table[None], 1), self._layers(g, 1))

    def descent(self, rows: tuple[Layer, ...], loads: Sequence[Array | None]) -> SphereDescent:
        """Give what balances, the same for the same ``loads``; ``rows`` are all of the region."""
        assert rows == self._region.rows
        if self._descent is None or self._descent[0] is not loads:
            self._descent = loads, SphereDescent(self._region, loads)
        return self._descent[1]

    def changes(self, realisations: Sequence[int], descent: SphereDescent) -> Array | None:
        """Draw, deposit and balance; give g, (packings, 3, …), and nothing else.

        None where something is out of the ordinary.
        """
        rho = self._draw.drawn(realisations)
        block = None if rho is None else self._rested(rho)
        return None if block is None else descent.changes(block)

    def _layers(self, values: Array, lowest: int) -> LazyRows[Array]:
        """Give the layers of (batch, numbers, …) as ``spheres`` has them, (numbers, …, W, W)."""
        starts = self._region.starts

        def layer(j: int) -> Array:
            if j < lowest:
                return np.empty(0)
            own = values[:, :, starts[j] : starts[j + 1]].swapaxes(0, 1)
            own = own[:, 0] if own.shape[1] == 1 else own
            return own.reshape(*own.shape[:-1], self._width, self._width)

        return LazyRows(len(self._region.rows), layer)
