"""The start for size: one interior path, on which gaps are linearised anew at every Newton step.

Of the load's energy with a barrier, −μ Σ log g over all near pairs, the minimum is followed while μ
falls: with a force λ of each pair,

    (Aᵀ diag(λ/g) A + δ) dx = load + Aᵀ(μ/g),    dλ = (μ − λ A dx)/g − λ

where A holds the derivatives of the gaps g. A gap is never smaller than its linearisation, and a
step never closes the linearised ones: beads never overlap. A force far below μ/g would let a step
run into the gap, so none is. Where gaps come near the rounding of coordinates, they stay linear,
and μ falls on: contacts are open by μ/λ then, all others bear μ/g, and λ/g tells them apart. Minima
that are found so lie deeper than those of linear programs from the deposited packing: this is
another protocol.
"""

from collections.abc import Callable

import numpy as np

from ..arithmetic.systems import Array
from .grains import Grains, Pairs
from .network import MissingSolverError, UnfinishedError

# μ at the start, where gaps stay linear from then on, and at the end, in units of the largest load
# times r. The smallest force times the smallest gap is some 1e-20 at 64 × 128.
FIRST, LINEAR, LAST = 1e-2, 1e-13, 1e-24
# The start is stretched upwards by this much, so that no contact is closed.
STRETCHED = 1.01
# What keeps a bead that nothing presses where it is, in units of the largest load over r.
HELD = 1e-9
# No coordinate moves further in a step; neighbours are looked for when one has moved as far in all.
STEP = 0.2
# Pairs with larger gaps can't meet before neighbours are looked for again: 2√2 · 2 STEP.
REACH = 6 * STEP
# The share of the way to where a gap closes, or a force vanishes, that a step goes at most.
SHARE = 0.99
# No force is a smaller part of μ/g: with 1, 1/2 and 1/10 more paths stall.
LEAST_FORCE = 1 / 5
# Steps after which the path ends wherever it has come, as it does where rounding ends it.
MOST_STEPS = 1500


def follow(grains: Grains, progress: Callable[[int], None]) -> tuple[Pairs, Array]:
    """Move ``grains`` along the path; raises ``UnfinishedError`` where they overlap at first.

    Gives near pairs, and λ/g of each: contacts have the largest.
    """
    grains.x = grains.x * [1, STRETCHED]
    load = grains.weights / np.abs(grains.weights).max()
    pairs, looked, mu = grains.near(REACH), grains.x, FIRST
    gaps = grains.gaps(pairs)
    if not gaps.min() > 0:
        raise UnfinishedError("beads overlap where the interior path would start")
    forces = mu / gaps
    stiffness, curved = _Stiffness(pairs, grains), True
    for step in range(1, MOST_STEPS + 1):
        if curved and np.abs(grains.x - looked).max() > STEP:
            known = dict(zip(grains.named(pairs).tolist(), forces.tolist(), strict=True))
            pairs, looked = grains.near(REACH), grains.x
            gaps = grains.gaps(pairs)
            names = grains.named(pairs).tolist()
            forces = np.array([known.get(k, mu / g) for k, g in zip(names, gaps, strict=True)])
            stiffness = _Stiffness(pairs, grains)
        forces = np.maximum(forces, LEAST_FORCE * mu / gaps)
        if curved:
            A, directions = grains.jacobian(pairs), grains.directions(pairs)
        try:
            move = stiffness.solved(directions, forces / gaps, load + A.T @ (mu / gaps))
        except ArithmeticError:  # by rounding
            break
        opening = A @ move
        pressing = (mu - forces * opening) / gaps - forces
        along = min(_most(gaps, opening), STEP / np.abs(move).max(initial=STEP))
        across = _most(forces, pressing)
        x = grains.x.copy()
        x[grains.fixed :] += along * move.reshape(-1, 2)
        after = grains.gaps(pairs, x) if curved else gaps + along * opening
        if not after.min() > 0:  # by rounding
            if not curved:
                break
            curved = False
            continue
        grains.x, gaps, forces = x, after, forces + across * pressing
        progress(step)
        full = min(along, across) > 0.9
        if full and mu == LAST:
            break
        if full and mu == LINEAR:
            curved = False
        if min(along, across) > 0.3:
            less = (0.2 if full else 0.5) if curved else (0.01 if full else 0.2)
            least = LINEAR if curved else LAST
            mu = max(min(mu, float((forces * gaps).mean())) * less, least)
    return pairs, forces / gaps


def _most(values: Array, changes: Array) -> float:
    """Give the part of a step, 1 at most, that keeps all values positive."""
    down = changes < 0
    return float((SHARE * values[down] / -changes[down]).min(initial=1.0))


class _Stiffness:
    """The matrix Aᵀ diag(k) A + δ of one list of pairs: where its entries stand is found once.

    CHOLMOD factorises it, with one symbolic analysis for all k, in a fifth of the time of SciPy's
    LU. Another factorisation rounds otherwise, and long paths may end in another packing then:
    there is no second one. Raises ``MissingSolverError`` without cvxopt.
    """

    def __init__(self, pairs: Pairs, grains: Grains) -> None:
        try:
            from cvxopt import cholmod, matrix, spmatrix
        except ImportError:
            raise MissingSolverError("interior-path", "cvxopt") from None
        beads = pairs - grains.fixed
        self.free = beads[:, 1] >= 0
        self.first, self.second = beads[:, 0], beads[self.free, 1]
        own = 2 * np.arange(grains.unknowns // 2)
        row, column = 2 * self.first[self.free], 2 * self.second  # first beads have larger numbers
        rows = np.concatenate([own, own + 1, own + 1, row, row, row + 1, row + 1])
        columns = np.concatenate([own, own, own + 1, column, column + 1, column, column + 1])
        self.order = np.lexsort((rows, columns))
        self.lower = spmatrix(1.0, matrix(rows[self.order]), matrix(columns[self.order]))
        self.factors = cholmod.symbolic(self.lower)

    def solved(self, directions: Array, k: Array, right: Array) -> Array:
        """Solve it; raises ``ArithmeticError`` where it is not positive definite, to rounding.

        ``directions``: (pairs, 2), ``k``: (pairs,), ``right``: (unknowns,).
        """
        from cvxopt import cholmod, matrix

        xx, xy, yy = (k * directions[:, i] * directions[:, j] for i, j in ((0, 0), (0, 1), (1, 1)))
        own = [
            np.bincount(self.first, v, len(right) // 2)
            + np.bincount(self.second, v[self.free], len(right) // 2)
            for v in (xx, xy, yy)
        ]
        across = [-v[self.free] for v in (xx, xy, xy, yy)]
        values = np.concatenate([own[0] + HELD, own[1], own[2] + HELD, *across])[self.order]
        self.lower.V = matrix(values)
        cholmod.numeric(self.lower, self.factors)
        solution = matrix(right)
        cholmod.solve(self.factors, solution)
        return np.array(solution).ravel()
