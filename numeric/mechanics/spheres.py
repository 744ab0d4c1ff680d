"""Exact packings and forces of beads on d supports, in deviation form, for any dimension d.

Base vectors n^1 … n^d of one mutual dot product φ; a bead x rests on x − e_1 … x − e_d. A layer is
periodic in d − 1 directions: its beads have d − 1 columns, each from 0 to W − 1, the first numbers
of x modulo W. The step −e_a is one column back for a < d, and none for a = d.

Displacements are carried as c_a = n^a·δx: to first order each is a line sum of δr, as in two
dimensions (see ``packing`` and ``forces``, whose sweeps write d = 2 out by hand; the compiled ones
of ``compiled_spheres`` write d = 3). With p^a = δx less the displacement of the support x − e_a,
ρ^a the sum of the two δr, and r = 1, the contacts say exactly

    n^a·p^a + |p^a|²/4 = R^a,        R^a = ρ^a + ρ^a²/4.

Less that of a = d they are linear in p = p^d, but for A = |p|²/4, which obeys a quadratic: its
small root has a form without cancellation.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from itertools import product
from operator import add, mul
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import FLOAT64, Array, NumberSystem, as_floats, zeros
from .forces import NotStandingError, added
from .packing import UnbuildableError


class Metric(NamedTuple):
    """φ, b^a·b^a − b^a·b^c and b^a·b^c of the reciprocal vectors, in a number system."""

    dimension: int
    phi: Any
    own: Any
    cross: Any

    def raised(self, components: Array) -> Array:
        """Turn n^a·v, shape (d, …), into v^a of v = Σ v^a n^a: multiply by the inverse of G."""
        return np.asarray(components * self.own + reduce(add, components) * self.cross)

    def dot(self, raised: Array, components: Array) -> Array:
        """Give the dot product of two vectors, one of them ``raised``."""
        return np.asarray(reduce(add, raised * components))


def metric(dimension: int, phi: Fraction, system: NumberSystem) -> Metric:
    """Round what φ decides, each number once."""
    cross = -phi / ((1 - phi) * (1 + (dimension - 1) * phi))
    return Metric(dimension, system.scalar(phi), system.scalar(1 / (1 - phi)), system.scalar(cross))


def along(values: Array, axis: int, steps: int, dimension: int) -> Array:
    """Give a layer's values at x + steps·e_axis, for each x of the layer it lies below or above."""
    return values if axis == dimension - 1 else np.roll(values, -steps, axis + 1 - dimension)


def _solved(matrix: Sequence[Sequence[Array]], right: Array) -> tuple[Array, Array]:
    """Solve (1 + matrix) x = right by elimination, for a small matrix; give x and all pivots."""
    size = len(matrix)
    rows = [list(row) for row in matrix]
    x = list(right)
    for k in range(size):
        rows[k][k] = 1 + rows[k][k]
        for i in range(k + 1, size):
            factor = rows[i][k] / rows[k][k]
            x[i] = x[i] - factor * x[k]
            for c in range(k + 1, size):
                rows[i][c] = rows[i][c] - factor * rows[k][c]
    for k in reversed(range(size)):
        for c in range(k + 1, size):
            x[k] = x[k] - rows[k][c] * x[c]
        x[k] = x[k] / rows[k][k]
    return np.stack(x), np.stack([rows[k][k] for k in range(size)])


@dataclass(frozen=True)
class Placed:
    """Spheres at rest; layer by layer, shape (…, W, …, W) after the axes named.

    ``rho[j]``: δr/r. ``c[j]``, (d, …): n^a·δx/r. ``dn[j]``, (d, d, …), empty at j = 0: δn of the
    contact with x − e_a, as δn^a = Σ_b dn[j][a, b] n^b.
    """

    metric: Metric
    rho: Sequence[Array]
    c: Sequence[Array]
    dn: Sequence[Array]


@dataclass(frozen=True)
class CompiledPlaced(Placed):
    """Spheres of compiled sweeps, d = 3, layer after layer.

    ``flat``: δr/r, (batch, beads). ``block``, (batch, 12, …): c, and dn of contacts with the first,
    second and third support.
    """

    flat: Array
    block: Array


def deposit(rho: Sequence[Array], m: Metric, system: NumberSystem, *, linear: bool) -> Placed:
    """Deposit layer by layer on the ordered base; to first order only if ``linear``.

    ``rho[j]``: δr/r, (…, W, …, W). Raises ``UnbuildableError`` and ``UndecidedError``.
    """
    d = m.dimension
    _check_radii(rho[0], 0, d, system)
    c, dn = [zeros(system, d, *rho[0].shape)], [zeros(system, 0)]
    for j in range(1, len(rho)):
        _check_radii(rho[j], j, d, system)
        under = np.stack([along(c[-1], a, -1, d) for a in range(d)])
        both = np.stack([rho[j] + along(rho[j - 1], a, -1, d) for a in range(d)])
        own = np.stack([under[a, a] for a in range(d)])
        lift, square = both, both * 0
        if not linear:
            square = _squares(under, both, j, m, system)
            lift = both + both * both / 4 - square
        c.append(own + lift)
        turned = []
        for a in range(d):
            across = lift + (own - under[a]) - both[a] * m.phi
            across[a] = both[a] * 0 if linear else both[a] * both[a] / 4 - square[a]
            turned.append(m.raised(across) / (2 if linear else 2 + both[a]))
        dn.append(np.stack(turned))
    return Placed(m, rho, c, dn)


def _squares(under: Array, both: Array, j: int, m: Metric, system: NumberSystem) -> Array:
    """Give |p^a|²/4, shape (d, …), of beads on supports whose n^b·δx is ``under[a, b]``."""
    d = m.dimension
    reach = both + both * both / 4
    apart = [under[d - 1] - under[a] for a in range(d)]  # p^a − p^d
    tilts = [m.raised(u) for u in apart]
    right = np.stack([reach[a] - apart[a][a] - m.dot(tilts[a], apart[a]) / 4 for a in range(d)])
    matrix = [[tilts[a][b] / 2 for b in range(d)] for a in range(d)]
    start, pivots = _solved(matrix, right)  # p = start − A step
    step, _ = _solved(matrix, right * 0 + 1)
    up, step_up = m.raised(start), m.raised(step)
    size = m.dot(up, start)
    half = 1 + m.dot(up, step) / 2
    discriminant = half * half - m.dot(step_up, step) * size / 4
    _check_rest(discriminant, (reduce(mul, pivots), *step), j, d, system)
    p = start - step * (size / (half + system.sqrt(discriminant)) / 2)
    steps = [p + u for u in apart]
    return np.stack([m.dot(m.raised(v), v) / 4 for v in steps])


@dataclass(frozen=True)
class Borne:
    """Forces of the contacts below beads, layer by layer; (d, …), empty at j = 0.

    ``ordered[j]``: F, once for all packings; ``change[j]``: g = f − F. Indexed by the upper bead.
    """

    ordered: Sequence[Array]
    change: Sequence[Array]


def straight_down(
    loads: Sequence[Array | None], shape: tuple[int, ...], system: NumberSystem
) -> Iterator[tuple[int, Array]]:
    """Give layers from the highest down to j = 1, and the ordered forces below, (d, W, …, W)."""
    d = len(shape) + 1
    F = zeros(system, d, *shape)
    for j in range(len(loads) - 1, 0, -1):
        load = loads[j]
        F = F if load is None else F + load
        yield j, F
        F = np.stack([along(F[a], a, 1, d) for a in range(d)])


def bear(
    placed: Placed, loads: Sequence[Array | None], system: NumberSystem, *, linear: bool
) -> Borne:
    """Carry loads down (see ``forces``): Σ g N (lower) = Σ g N + Σ F δn (upper) − Σ F δn (lower).

    ``loads[j]``: what beads of layer j add to F of the contacts below, (d, W, …, W), or (W, …, W)
    if to all the same, or None. Raises ``NotStandingError``.
    """
    d = placed.metric.dimension
    top = len(placed.rho) - 1
    shape = placed.rho[0].shape
    batch = len(shape) - d + 1
    g = zeros(system, d, *shape)
    turn = zeros(system, d, *shape)
    ordered, change = [zeros(system, 0)] * (top + 1), [zeros(system, 0)] * (top + 1)
    for j, of_all in straight_down(loads, shape[batch:], system):
        dn, F = placed.dn[j], of_all.reshape(d, *(1,) * batch, *shape[batch:])
        turn = turn - _turned(F, dn)
        if not linear:  # (1 + D) h = s, written for h − s, which is small of second order
            s = g + turn
            matrix = [[dn[a, b] for a in range(d)] for b in range(d)]
            less, pivots = _solved(matrix, _turned(s, dn))
            _check_standing(reduce(mul, pivots), j, d, system)
            turn = turn - less
        g, lost = added(g, turn, system)
        ordered[j], change[j] = F, g
        turn = _turned(F if linear else F + g, dn, up=True)
        if lost is not None:
            turn = turn + np.stack([along(lost[a], a, 1, d) for a in range(d)])
        g = np.stack([along(g[a], a, 1, d) for a in range(d)])
    return Borne(ordered, change)


def _turned(force: Array, dn: Array, *, up: bool = False) -> Array:
    """Give Σ_a f_a δn^a of the contacts below beads, at those; or ``up`` from the beads below."""
    d = len(force)
    parts = [force[a] * dn[a] for a in range(d)]
    return np.asarray(reduce(add, (along(v, a, 1, d) if up else v for a, v in enumerate(parts))))


def _site(bad: Array, j: int, dimension: int) -> tuple[int, ...]:
    return (*map(int, np.argwhere(bad)[0][1 - dimension :]), j)


def _check_radii(rho: Array, j: int, dimension: int, system: NumberSystem) -> None:
    _, bad = system.signs(1 + rho)
    if bad.any():
        raise UnbuildableError(_site(bad, j, dimension), "its radius is no positive number")


def _check_rest(
    discriminant: Array, tilts: Sequence[Array], j: int, dimension: int, system: NumberSystem
) -> None:
    why = "its supports are too far apart to hold it, or too close to hold it up"
    steep = "the plane through its supports is steeper than a base vector, or they lie crosswise"
    open_question = False
    for values, reason in ((discriminant, why), *((tilt, steep) for tilt in tilts)):
        good, bad = system.signs(values)
        if bad.any():
            raise UnbuildableError(_site(bad, j, dimension), reason)
        open_question |= not good.all()
    if open_question:
        raise UndecidedError(f"layer {j}: the enclosures are too wide to tell whether beads rest")


def _check_standing(det: Array, j: int, dimension: int, system: NumberSystem) -> None:
    good, _ = system.signs(det * det)
    if not good.all():
        site = _site(~good, j, dimension)
        raise NotStandingError(site, "the contacts below it lie in one plane")


def near_pairs(dimension: int) -> list[tuple[int, ...]]:
    """Lattice distances at which beads could meet that are in no contact; each pair once.

    Of all others the square is above 2.6 (2r)² for −1/d < φ < ½ and d = 2, 3.

    >>> near_pairs(2), len(near_pairs(3))
    ([(1, -1), (1, 1)], 10)
    """
    found = []
    for steps in product((1, 0, -1), repeat=dimension):
        first = next((s for s in (sum(steps), *steps) if s), 0)
        if first > 0 and sum(map(abs, steps)) > 1:
            found.append(steps)
    return sorted(found, key=lambda steps: (sum(steps), steps))


def of_lattice(phi: Fraction, steps: tuple[int, ...]) -> tuple[float, ...]:
    """Give the steps, the square of the distance in the ordered packing, and that less 4."""
    exact = 4 * (sum(s * s for s in steps) * (1 - phi) + sum(steps) ** 2 * phi)
    return (*steps, float(exact), float(exact - 4))


def gaps(placed: Placed, phi: Fraction, j: int, steps: tuple[int, ...]) -> Array | None:
    """Give the gaps of the beads of layer j with those at lattice distance ``steps``, units of r.

    In float64, without cancelling, own images included; None above the highest layer.
    """
    d = len(steps)
    other = j + sum(steps)
    if other >= len(placed.rho):
        return None

    def there(values: Array) -> Array:
        for axis, count in enumerate(steps):
            values = along(values, axis, count, d)
        return values

    *_, square, least = of_lattice(phi, steps)
    u = there(as_floats(placed.c[other])) - as_floats(placed.c[j])
    both = there(as_floats(placed.rho[other])) + as_floats(placed.rho[j])
    floats = metric(d, phi, FLOAT64)
    tilt = reduce(add, (s * u[a] for a, s in enumerate(steps)))
    change = 4 * tilt + floats.dot(floats.raised(u), u)
    distance = np.sqrt(np.maximum(square + change, 0))
    excess = least + (change - 4 * both - both * both)
    return np.asarray(excess / (distance + 2 + both))
