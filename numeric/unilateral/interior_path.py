"""The start for size: one interior path, on which gaps are linearised anew at every Newton step.

Of the load's energy with a barrier, −μ Σ log g over all near pairs, the minimum is followed while μ
falls: with a force λ of each pair,

    (Aᵀ diag(λ/g) A + δ) dx = load + Aᵀ(μ/g),    dλ = (μ − λ A dx)/g − λ

where A holds the derivatives of the gaps g. A gap is never smaller than its linearisation, and a
step never closes the linearised ones: beads never overlap. Where the path ends, all contacts are
open by about μ/λ, and linear programs take few steps to close them. Minima that are found so lie
deeper than those of programs from the deposited packing: this is another protocol.
"""

from collections.abc import Callable

import numpy as np
from scipy.sparse import diags_array, eye_array
from scipy.sparse.linalg import splu

from ..arithmetic.systems import Array
from .grains import Grains
from .network import UnfinishedError

# μ at the start and at the end, in units of the largest load times r.
FIRST, LAST = 1e-2, 1e-9
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
# Steps after which linear programs go on from wherever the path has come, as they do where
# rounding ends it.
MOST_STEPS = 500


def follow(grains: Grains, progress: Callable[[int], None]) -> None:
    """Move ``grains`` along the path; raises ``UnfinishedError`` where they overlap at first."""
    grains.x = grains.x * [1, STRETCHED]
    load = grains.weights / np.abs(grains.weights).max()
    pairs, looked, mu = grains.near(REACH), grains.x, FIRST
    gaps = grains.gaps(pairs)
    if not gaps.min() > 0:
        raise UnfinishedError("beads overlap where the interior path would start")
    forces = mu / gaps
    for step in range(1, MOST_STEPS + 1):
        if np.abs(grains.x - looked).max() > STEP:
            known = dict(zip(grains.named(pairs).tolist(), forces.tolist(), strict=True))
            pairs, looked = grains.near(REACH), grains.x
            gaps = grains.gaps(pairs)
            names = grains.named(pairs).tolist()
            forces = np.array([known.get(k, mu / g) for k, g in zip(names, gaps, strict=True)])
        A = grains.jacobian(pairs)
        stiff = A.T @ diags_array(forces / gaps) @ A + HELD * eye_array(grains.unknowns)
        try:
            factors = splu(
                stiff.tocsc(),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError:  # it is singular, to rounding
            return
        move = factors.solve(load + A.T @ (mu / gaps))
        opening = A @ move
        pressing = (mu - forces * opening) / gaps - forces
        along = min(_most(gaps, opening), STEP / np.abs(move).max(initial=STEP))
        across = _most(forces, pressing)
        x = grains.x.copy()
        x[grains.fixed :] += along * move.reshape(-1, 2)
        gaps = grains.gaps(pairs, x)
        if not gaps.min() > 0:  # by rounding
            return
        grains.x, forces = x, forces + across * pressing
        progress(step)
        full = min(along, across) > 0.9
        if full and mu == LAST:
            return
        if min(along, across) > 0.3:
            mu = max(min(mu, float((forces * gaps).mean())) * (0.2 if full else 0.5), LAST)


def _most(values: Array, changes: Array) -> float:
    """Give the part of a step, 1 at most, that keeps all values positive."""
    down = changes < 0
    return float((SHARE * values[down] / -changes[down]).min(initial=1.0))
