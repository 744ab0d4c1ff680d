"""The plain form: positions by circle intersection, forces by balance, ordered values subtracted.

This is what one would write first, and the thing to compare the deviation form with. It loses
the digits of every change: all of them once σ/r falls below the last place of the arithmetic,
and in balls about three bits a layer. It is written for periodic packings, in Cartesian
coordinates, r = 1, for any number system.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, NumberSystem, array, zeros
from ..lattice.layers import Layer, Region, full_layer, pick, whole
from .sweep import UnbuildableError


class Vector(NamedTuple):
    """Cartesian components; arrays over the beads of a layer."""

    x: Array
    y: Array


@dataclass(frozen=True)
class PlainPacking:
    """Positions and unit contact vectors per layer, (columns,) each; units of r.

    ``plus[j]`` (``minus[j]``): N from the support x − e₊ (x − e₋) to the bead; empty at j = 0.
    """

    n: tuple[Any, Any]
    system: NumberSystem
    region: Region
    position: tuple[Vector, ...]
    plus: tuple[Vector, ...]
    minus: tuple[Vector, ...]


def axes(n_x: Fraction, system: NumberSystem) -> tuple[Any, Any]:
    """Give (n_x, n_y) with n_y = √(1 − n_x²)."""
    return system.scalar(n_x), system.root(1 - n_x**2)


def deposit(n_x: Fraction, rho: Sequence[Array], system: NumberSystem) -> PlainPacking:
    """Deposit a periodic packing by intersecting circles around the supports.

    ``rho[j]``: δr/r of the W beads of layer j. Raises ``UnbuildableError`` naming the bead,
    and ``UndecidedError`` where balls are too wide to tell. The caller activates ``system``.
    """
    width, height = len(rho[0]), len(rho) - 1
    nx, ny = axes(n_x, system)
    period = 4 * width * nx
    base = array(system, [Fraction(2 * i) for i in full_layer(0, width).sites()]) * nx
    nothing = Vector(zeros(system, 0), zeros(system, 0))
    position, plus, minus = [Vector(base, zeros(system, width))], [nothing], [nothing]
    for j in range(1, height + 1):
        layer, under = full_layer(j, width), full_layer(j - 1, width)
        left = Layer(j - 1, layer.first - 1, width)
        right = Layer(j - 1, layer.first + 1, width)
        before = position[-1]
        A = Vector(_unwrapped(before.x, under, left, period), pick(before.y, under, left, width))
        B = Vector(_unwrapped(before.x, under, right, period), pick(before.y, under, right, width))
        size_a = 2 + rho[j] + pick(rho[j - 1], under, left, width)
        size_b = 2 + rho[j] + pick(rho[j - 1], under, right, width)
        dx, dy = B.x - A.x, B.y - A.y
        square = dx * dx + dy * dy
        along = ((size_a * size_a - size_b * size_b) / square + 1) / 2
        high = size_a * size_a / square - along * along
        good, bad = system.signs(high)
        if bad.any():
            q = int(np.argwhere(bad)[0][0])
            raise UnbuildableError(
                (layer.first + 2 * q, j), "its supports are too far apart, or too close, to hold it"
            )
        if not good.all():
            raise UndecidedError(f"layer {j}: balls are too wide to tell whether beads rest")
        up = system.sqrt(high)
        x = A.x + along * dx - up * dy
        y = A.y + along * dy + up * dx
        position.append(Vector(x, y))
        plus.append(Vector((x - A.x) / size_a, (y - A.y) / size_a))
        minus.append(Vector((x - B.x) / size_b, (y - B.y) / size_b))
    return PlainPacking(
        (nx, ny), system, whole(width, height), tuple(position), tuple(plus), tuple(minus)
    )


def _unwrapped(x: Array, of: Layer, at: Layer, period: Any) -> Array:
    """Read x of the supports; a support across the periodic boundary is moved by a period."""
    picked = pick(x, of, at, of.count).copy()
    if at.first < 0:
        picked[0] = picked[0] - period
    if at.last >= 2 * of.count:
        picked[-1] = picked[-1] + period
    return picked


def displacements(packing: PlainPacking) -> tuple[Vector, ...]:
    """Subtract the ordered positions (Eq. 1) from the solved ones."""
    nx, ny = packing.n
    system = packing.system
    result = []
    for layer, (x, y) in zip(packing.region.rows, packing.position, strict=True):
        ordered = array(system, [Fraction(2 * i) for i in layer.sites()]) * nx
        result.append(Vector(x - ordered, y - 2 * layer.j * ny))
    return tuple(result)


@dataclass(frozen=True)
class PlainForces:
    """Contact forces below the beads of layer j, indexed by the upper bead; empty at j = 0."""

    plus: tuple[Array, ...]
    minus: tuple[Array, ...]


def forces(packing: PlainPacking, load: tuple[Vector | None, ...]) -> PlainForces:
    """Carry the loads (Cartesian, one entry a layer) down by 2×2 force balance (Eq. 6)."""
    system, region = packing.system, packing.region
    width = region.rows[0].count
    nothing = zeros(system, 0)
    plus, minus = [nothing], [nothing]
    for j in range(region.top, 0, -1):
        layer = region.rows[j]
        Sx, Sy = zeros(system, width), zeros(system, width)
        if (own := load[j]) is not None:
            Sx, Sy = Sx - own.x, Sy - own.y
        if j < region.top:
            above = region.rows[j + 1]
            right = Layer(j + 1, layer.first + 1, width)
            left = Layer(j + 1, layer.first - 1, width)
            fp, fm = pick(plus[-1], above, right, width), pick(minus[-1], above, left, width)
            Np = [pick(v, above, right, width) for v in packing.plus[j + 1]]
            Nm = [pick(v, above, left, width) for v in packing.minus[j + 1]]
            Sx, Sy = Sx + fp * Np[0] + fm * Nm[0], Sy + fp * Np[1] + fm * Nm[1]
        P, Q = packing.plus[j], packing.minus[j]
        det = P.x * Q.y - P.y * Q.x
        plus.append((Sx * Q.y - Sy * Q.x) / det)
        minus.append((Sy * P.x - Sx * P.y) / det)
    return PlainForces((nothing, *reversed(plus[1:])), (nothing, *reversed(minus[1:])))
