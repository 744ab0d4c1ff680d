"""A proof, in balls, that an exact packing touches where a computed one nearly does.

The gaps of the backbone are as many equations as its beads have coordinates. Newton and
Kantorovich: where β = ‖A⁻¹‖, K bounds the change of the Jacobian A a unit of distance, and
h = β² K |g| ≤ 1/2, an exact solution lies within 2 β |g|, one alone near there. Its forces, of
AᵀF + load = 0, are enclosed from residuals. If all of them are positive and all other gaps too, and
no bead outside of the backbone bears a load, the packing is a strict local minimum of the load's
energy in the backbone's coordinates: gaps serve as coordinates there, the energy rises with each of
them, and A can be inverted. Of beads that touch without force nothing can be proved in this way.

Norms are bounded from floating-point inverses whose own error is bounded: rounding to nearest, at
most 2⁻⁵³ an operation.
"""

from dataclasses import dataclass
from typing import Any

import flint
import numpy as np

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls, as_floats
from .grains import Grains, Pairs
from .network import Frame, UnfinishedError

# Columns of the inverse that are found together.
TOGETHER = 256
# Gaps are measured of pairs up to this far apart, in units of r; those of all others are larger.
FAR = 0.5
# Nine roundings, the most that an entry of A times a vector takes, and some room.
ROUNDED = 1e-15


@dataclass(frozen=True)
class Certificate:
    """An exact packing, enclosed: ``x`` (N, 2) and ``forces`` (contacts,) in balls.

    ``within`` bounds how far each coordinate of the backbone lies from the middle of its ball.
    """

    x: Array
    forces: Array
    within: float
    kantorovich: float


def certify(
    grains: Grains, contacts: Pairs, backbone: Array, known: Frame, system: Balls
) -> Certificate:
    """Enclose the exact packing near ``grains`` in which ``contacts`` touch.

    ``contacts``: twice as many as ``backbone``, the numbers of its free beads. Beads outside of it
    stay where they are, and bear no load. The caller activates ``system``. Raises
    ``UndecidedError`` where more bits may help, and ``UnfinishedError`` where they don't.
    """
    for bead in np.setdiff1d(np.arange(grains.fixed, len(grains.radii)), backbone):
        if not all(load == 0 for load in known.load[bead]):
            raise UnfinishedError(f"bead {bead} bears a load, and no contact holds it")
    place = grains.coordinates(backbone)
    A = grains.jacobian(contacts)[:, place].tocsc()
    factors = grains.factors(contacts, place)
    rows_norm, columns_norm, rows_off, columns_off = _inverse_norms(A, factors)
    x = _exactly(grains.x)
    x[: grains.fixed] = known.base
    for _ in range(4 + system.bits // 20):  # each gains about 30 bits
        gaps, directions = _geometry(x, contacts, known, grains)
        worst = _largest(gaps)
        if worst < 2.0 ** (8 - system.bits) * 64:
            break
        move = np.zeros(grains.unknowns)
        move[place] = factors.solve(np.array([float(g.mid()) for g in gaps]))
        x[grains.fixed :] = _middle(x[grains.fixed :] - _exactly(move.reshape(-1, 2)))
    gaps, directions = _geometry(x, contacts, known, grains)
    worst = _largest(gaps)
    # how much the Jacobian at x, in balls, differs from A, entry by entry
    off = _off(directions, grains.directions(contacts))
    touching = int(np.diff(A.indptr).max(initial=1))
    beta = rows_norm / _positive(1 - rows_off - rows_norm * 4 * off)
    shortest = float(min(float((known.radii[a] + known.radii[b]).lower()) for a, b in contacts))
    reach = 2 * beta * worst * (1 + 1e-9)
    shortest -= 3 * reach + worst
    h = beta**2 * 8 / shortest * worst * (1 + 1e-9)
    if not (h <= 0.5 and shortest > 0):
        raise UndecidedError(f"Kantorovich's h is {h:.2g}, and at most 1/2 proves that beads touch")
    turned = 2.83 * reach / shortest  # how much a direction changes within reach
    across = columns_norm / _positive(1 - columns_off - columns_norm * touching * (off + turned))
    forces = _balanced(grains, contacts, place, directions, known, factors, across, turned)
    radius = flint.arb(0, reach)
    enclosed = x.copy()
    for bead in backbone:
        for k in (0, 1):
            enclosed[bead, k] = enclosed[bead, k] + radius
    return Certificate(enclosed, forces, reach, h)


def smallest_gap(x: Array, known: Frame, touching: Pairs) -> float:
    """Bound from below the gaps of all pairs but those that touch, by ``FAR`` at most.

    ``x``: centres in balls. Pairs of two base beads and of nearest images are among them; with a
    period above four radii (see ``Frame``) all other images are further apart. Raises
    ``UnfinishedError`` unless no bead lies below the base and all those gaps are positive.
    """
    fixed = len(known.base)
    radii = as_floats(known.radii)
    grains = Grains(as_floats(x), radii, float(known.period), np.zeros(x.shape), fixed)
    fallen = [k for k in range(fixed, len(x)) if not x[k, 1] > known.base[0, 1]]
    if fallen:
        more = f", and {len(fallen) - 1} more" if len(fallen) > 1 else ""
        raise UnfinishedError(
            f"bead {fallen[0]} fell through the base{more}: {grains.hole_and_smallest()}"
        )
    near = grains.near(FAR, base=True)
    others = near[~np.isin(grains.named(near), grains.named(touching))]
    gaps = grains.gaps(others)
    # radii of the balls: of two beads' coordinates, √2 · 2 < 3, and of two radii of beads; then
    # what float64 rounds, some ten operations on numbers of this size
    off = 3 * _widest(x) + 2 * _widest(known.radii)
    off += 1e-13 * (1 + float(np.abs(grains.x).max()) + grains.period)
    smallest = min(float(gaps.min(initial=FAR)), FAR) - off
    if not smallest > 0:
        a, b = others[int(np.argmin(gaps))]
        raise UnfinishedError(
            f"degenerate: beads {a} and {b} overlap, or can't be told from touching without force: "
            f"the gap is {gaps.min():.2g} r"
        )
    return smallest


def _widest(balls: Array) -> float:
    return max((_upper(ball.rad()) for ball in balls.ravel()), default=0.0)


def _positive(value: float) -> float:
    """Give what remains of 1, or say that no inverse is shown to exist."""
    if not value > 0.01:
        raise UndecidedError("the inverse of the contacts' Jacobian is too inaccurate to bound")
    return value * (1 - 1e-9)


def _inverse_norms(A: Any, factors: Any) -> tuple[float, float, float, float]:
    """Bound, for R ≈ A⁻¹, the norms ‖R‖∞ and ‖R‖₁, and those of I − R A.

    Row i of R is solved for, so that R is never held as a whole.
    """
    n = A.shape[0]
    T = A.T.tocsr()
    size = abs(T)
    rows = rows_off = 0.0
    columns, columns_off = np.zeros(n), np.zeros(n)
    for at in range(0, n, TOGETHER):
        count = min(TOGETHER, n - at)
        unit = np.zeros((n, count))
        unit[at + np.arange(count), np.arange(count)] = 1
        y = factors.solve(unit, trans="T")
        left = np.abs(unit - T @ y) + ROUNDED * (size @ np.abs(y) + unit)
        rows = max(rows, float(np.abs(y).sum(axis=0).max()))
        rows_off = max(rows_off, float(left.sum(axis=0).max()))
        columns += np.abs(y).sum(axis=1)
        columns_off += left.sum(axis=1)
    room = 1 + 1e-9  # sums of up to a million terms
    return (
        rows * room,
        float(columns.max()) * room,
        rows_off * room,
        float(columns_off.max()) * room,
    )


def _exactly(values: Array) -> Array:
    """Turn floats into balls of radius zero."""
    return np.asarray(np.frompyfunc(flint.arb, 1, 1)(values), dtype=object)


def _middle(values: Array) -> Array:
    return np.asarray(np.frompyfunc(lambda ball: ball.mid(), 1, 1)(values), dtype=object)


def _upper(ball: Any) -> float:
    """Round the largest size of a ball up to a float."""
    return float(abs(ball).upper()) * (1 + 1e-15) + 1e-300


def _largest(balls: Array) -> float:
    return max((_upper(ball) for ball in balls), default=0.0)


def _geometry(x: Array, pairs: Pairs, known: Frame, grains: Grains) -> tuple[Array, Array]:
    """Give gaps and directions of pairs, in balls."""
    d = x[pairs[:, 0]] - x[pairs[:, 1]]
    floats = grains.x[pairs[:, 0], 0] - grains.x[pairs[:, 1], 0]
    around = np.round(floats / grains.period).astype(int)
    for k in np.flatnonzero(around):
        d[k, 0] = d[k, 0] - int(around[k]) * known.period
    length = np.asarray(np.sqrt(d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1]))
    gaps = length - known.radii[pairs[:, 0]] - known.radii[pairs[:, 1]]
    return gaps, d / length[:, None]


def _off(directions: Array, floats: Array) -> float:
    return max(
        (
            _upper(ball - float(f))
            for ball, f in zip(directions.ravel(), floats.ravel(), strict=True)
        ),
        default=0.0,
    )


def _balanced(
    grains: Grains,
    contacts: Pairs,
    place: Array,
    directions: Array,
    known: Frame,
    factors: Any,
    across: float,
    turned: float,
) -> Array:
    """Enclose the forces: residuals in balls, times ``across`` ≥ ‖A⁻ᵀ‖∞ of the exact packing."""
    forces = _exactly(factors.solve(-grains.weights[place], trans="T"))
    residual = left = 0.0
    for _ in range(4 + flint.ctx.prec // 20):
        rest = known.load.copy()
        push = directions * forces[:, None]
        for (a, b), (px, py) in zip(contacts, push, strict=True):
            rest[a, 0], rest[a, 1] = rest[a, 0] + px, rest[a, 1] + py
            rest[b, 0], rest[b, 1] = rest[b, 0] - px, rest[b, 1] - py
        free = rest[grains.fixed :].ravel()[place]
        before, residual = residual, _largest(free)
        if before and residual > before / 16:
            break
        left = residual
        kept = forces
        step = factors.solve(np.array([-float(value.mid()) for value in free]), trans="T")
        forces = _middle(forces + _exactly(step))
    carried = np.zeros(len(grains.radii))
    for (a, b), force in zip(contacts, kept, strict=True):
        carried[a] += _upper(force)
        carried[b] += _upper(force)
    bound = across * (left + turned * float(carried.max()) * (1 + 1e-9)) * (1 + 1e-9)
    return np.asarray(kept + flint.arb(0, bound))
