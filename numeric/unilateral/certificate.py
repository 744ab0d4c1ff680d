"""A proof, in balls, that an exact packing touches where a computed one nearly does.

The gaps of the backbone are as many equations as its beads have coordinates. Newton and
Kantorovich, in Euclidean norms: where β = ‖A⁻¹‖, K bounds the change of the Jacobian A a unit of
distance, and h = β² K |g| ≤ 1/2, an exact solution lies within 2 β |g|, one alone near there. Its
forces, of AᵀF + load = 0, are enclosed from residuals. If all of them are positive and all other
gaps too, and no bead outside of the backbone bears a load, the packing is a strict local minimum of
the load's energy in the backbone's coordinates: gaps serve as coordinates there, the energy rises
with each of them, and A can be inverted. Of beads that touch without force nothing can be proved in
this way.

β is the inverse of A's smallest singular value, which one sparse factorisation bounds.
"""

from collections.abc import Iterable
from typing import Any

import flint
import numpy as np
from scipy.sparse import diags_array, eye_array
from scipy.sparse.linalg import splu

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls, as_floats
from .grains import Grains, Pairs
from .network import Frame, Network, UnfinishedError

# Steps of inverse iteration, which estimate the smallest singular value.
ITERATIONS = 10
# Forces that are this small, as a share of the largest, are never told from zero.
ZERO = 1e-60
# Gaps are measured of pairs up to this far apart, in units of r; those of all others are larger.
FAR = 0.5
# The share of a rounding to nearest, and some room for what is computed with it.
ROUNDED = 2.0**-53 * (1 + 1e-6)


def certify(grains: Grains, contacts: Pairs, known: Frame, system: Balls) -> Network:
    """Prove that a packing near ``grains`` in which ``contacts`` touch is a strict local minimum.

    Beads that no contact touches stay where they are, and bear no load. The caller activates
    ``system``. Raises ``UndecidedError`` where more bits may help, and ``UnfinishedError`` where
    they don't.
    """
    backbone, rattlers = grains.backbone(contacts), grains.rattlers(contacts)
    if len(contacts) != 2 * len(backbone):
        raise UnfinishedError(
            f"degenerate: {len(contacts)} contacts hold {len(backbone)} beads, and a strict "
            "minimum needs twice as many"
        )
    for bead in rattlers:
        if not all(load == 0 for load in known.load[bead]):
            raise UnfinishedError(f"bead {bead} bears a load, and no contact holds it")
    x, forces, h = _enclosed(grains, contacts, backbone, known, system)
    if any(force < 0 for force in forces):
        raise UnfinishedError("a contact of the settled packing pulls")
    if not all(force > 0 for force in forces):
        largest = max(float(force.mid()) for force in forces)
        if any(abs(force) < ZERO * largest for force in forces if not force > 0):
            raise UnfinishedError(
                f"degenerate: a contact bears less than {ZERO:g} of the largest force, if any"
            )
        raise UndecidedError("the enclosures are too wide to tell whether all forces are positive")
    smallest = smallest_gap(x, known, contacts)
    return Network(x, contacts, forces, rattlers, smallest, known, h)


def _enclosed(
    grains: Grains, contacts: Pairs, backbone: Array, known: Frame, system: Balls
) -> tuple[Array, Array, float]:
    """Enclose centres and forces of the packing in which ``contacts`` touch, and give h."""
    place = grains.coordinates(backbone)
    factors = grains.factors(contacts, place)
    least = smallest_singular_value(grains.jacobian(contacts)[:, place].tocsc(), factors)
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
    # entry by entry, how much the Jacobian at x, in balls, differs from that in floats
    off = _largest((directions - grains.directions(contacts)).ravel())
    root = np.sqrt(len(contacts)) * (1 + 1e-9)  # ‖v‖ ≤ root · max|v|; a row has four entries
    beta = 1 / _remaining(least, 2 * root * off)
    shortest = float(min(float((known.radii[a] + known.radii[b]).lower()) for a, b in contacts))
    reach = 2 * beta * root * worst * (1 + 1e-9)
    shortest -= 3 * reach + worst
    # a direction changes by |d(x_a − x_b)|/shortest at most, and stands in its row twice
    bends = 2 * np.sqrt(np.bincount(contacts.ravel())[grains.fixed :].max()) / shortest
    h = beta**2 * bends * root * worst * (1 + 1e-9)
    if not (h <= 0.5 and shortest > 0):
        raise UndecidedError(f"Kantorovich's h is {h:.2g}, and at most 1/2 proves that beads touch")
    turned = 1.42 * reach / shortest  # how much a direction changes within reach
    across = root / _remaining(least, 2 * root * (off + turned))
    forces = _balanced(grains, contacts, place, directions, known, factors, across, turned)
    enclosed = x.copy()
    enclosed[backbone] += flint.arb(0, reach)
    return enclosed, forces, h


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
    off = 3 * _largest(ball.rad() for ball in x.flat)
    off += 2 * _largest(ball.rad() for ball in known.radii)
    off += 1e-13 * (1 + float(np.abs(grains.x).max()) + grains.period)
    smallest = min(float(gaps.min(initial=FAR)), FAR) - off
    if not smallest > 0:
        a, b = others[int(np.argmin(gaps))]
        raise UnfinishedError(
            f"degenerate: beads {a} and {b} overlap, or can't be told from touching without force: "
            f"the gap is {gaps.min():.2g} r"
        )
    return smallest


def _remaining(least: float, change: float) -> float:
    """Bound the smallest singular value after a change of the matrix, or say that it may be 0."""
    if not least - change > 0.01 * least:
        raise UndecidedError("the inverse of the contacts' Jacobian is too inaccurate to bound")
    return (least - change) * (1 - 1e-9)


def smallest_singular_value(A: Any, factors: Any) -> float:
    """Bound the smallest singular value of a square matrix of floats from below.

    Where AᵀA − s = H Hᵀ + E, it is √(s − ‖E‖) or more. The factor H may come from anywhere: E is
    what it leaves, entry by entry, and the rounding of that. Where s would be below ‖E‖, about
    1e-12, raises ``UndecidedError``. ``factors``, of A, only serve to choose s.
    """
    n = A.shape[0]
    vector = np.random.default_rng(1).standard_normal(n)
    for _ in range(ITERATIONS):
        vector = factors.solve(factors.solve(vector / np.linalg.norm(vector), trans="T"))
    shift = 0.5 / float(np.linalg.norm(vector))
    square, size = (A.T @ A).tocsc(), abs(A)
    ones = np.ones(n)
    rounded = (int(np.diff(A.indptr).max()) + 2) * ROUNDED * (size.T @ (size @ ones) + shift)
    while shift > float(rounded.max()):
        shifted = square - shift * eye_array(n)
        lu = splu(shifted, "MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
        pivots = lu.U.diagonal()
        if (pivots > 0).all():
            H = (lu.L @ diags_array(np.sqrt(pivots))).tocsr()
            order = np.argsort(lu.perm_c)
            left = abs(shifted[order][:, order] - H @ H.T) @ ones * (1 + 1e-9)
            positive = abs(H)
            left += (np.diff(H.indptr) + 2) * ROUNDED * (positive @ (positive.T @ ones))
            off = float((left + rounded[order]).max()) * (1 + 1e-9)
            if shift > 2 * off:
                return float(np.sqrt(shift - off)) * (1 - 1e-9)
            break
        shift /= 4
    raise UndecidedError("the inverse of the contacts' Jacobian is too inaccurate to bound")


def _exactly(values: Array) -> Array:
    """Turn floats into balls of radius zero."""
    return np.asarray(np.frompyfunc(flint.arb, 1, 1)(values), dtype=object)


def _middle(values: Array) -> Array:
    return np.asarray(np.frompyfunc(lambda ball: ball.mid(), 1, 1)(values), dtype=object)


def _upper(ball: Any) -> float:
    """Round the largest size of a ball up to a float."""
    return float(abs(ball).upper()) * (1 + 1e-15) + 1e-300


def _largest(balls: Iterable[Any]) -> float:
    """Bound the sizes of balls; NaN where one of them is none."""
    return float(np.max([*map(_upper, balls)], initial=0.0))


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
    carried = np.bincount(contacts.ravel(), np.repeat([*map(_upper, kept)], 2))
    bound = across * (left + turned * float(carried.max()) * (1 + 1e-9)) * (1 + 1e-9)
    return np.asarray(kept + flint.arb(0, bound))
