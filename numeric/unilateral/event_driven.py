"""The reference protocol: one contact opens at a time, and beads follow the exact floppy motion.

As many contacts as there are coordinates are kept at zero gap (a basis). While one of them pulls,
the one with the largest tension opens; all others stay closed, which leaves a motion with one
parameter, along which the load's energy falls at the rate of that tension. Where a pair of beads
meets, it enters the basis. Ties go to the pair that comes first by the numbers of its beads.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse.linalg import splu

from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError
from ..arithmetic.systems import Array
from .grains import Grains, Pairs

# Gaps as small as this, in units of r, are those of contacts: float64 leaves about 1e-14.
CLOSED = 2e-12
# Tensions below this share of the largest force are roundings.
SLACK = 1e-11
# No bead moves further than this in one step, in units of r.
STEP = 0.25
# Pairs with a larger gap are not looked at until some bead has moved by a fifth of it.
REACH = 0.6
# Newton's iterations before a step is halved, and halvings before it is given up.
ITERATIONS, HALVINGS = 12, 40
# Events for each coordinate before the motion is given up as endless.
MOST_EVENTS = 50


class UnfinishedError(ForceDiffusionError, ArithmeticError):
    """Beads did not come to rest: no answer is given."""

    exit_status = NOT_REACHED


@dataclass
class _Motion:
    """The floppy motion after the contact ``opened`` of a basis."""

    factors: Any
    velocity: Array  # of all coordinates that may change, for a unit rate of the opened gap
    opened: int


def relax(grains: Grains, basis: Pairs, progress: Any = None) -> tuple[Pairs, int]:
    """Move ``grains`` until no contact of the basis pulls; gives that basis and the events.

    ``basis``: pairs at zero gap, as many as unknowns. Raises ``UnfinishedError`` and, where the
    energy does not fall, ``AssertionError``: that would be an error of this program.
    """
    basis = basis.copy()
    near, looked = grains.near(REACH), grains.x.copy()
    energy = grains.energy()
    limit = MOST_EVENTS * grains.unknowns
    for event in range(limit):
        factors = splu(grains.jacobian(basis).tocsc())
        forces = factors.solve(-grains.weights, trans="T")
        opened = int(np.argmin(forces))
        if forces[opened] >= -SLACK * np.abs(forces).max():
            return basis, event
        while True:
            if np.abs(grains.x - looked).max() > REACH / 5:
                near, looked = grains.near(REACH), grains.x.copy()
            unit = np.zeros(grains.unknowns)
            unit[opened] = 1
            motion = _Motion(factors, factors.solve(unit), opened)
            others = near[~np.isin(grains.named(near), grains.named(basis))]
            met = _step(grains, basis, others, motion)
            fallen, energy = energy - grains.energy(), grains.energy()
            assert fallen > -1e-12 * abs(energy), "the energy of the load has risen"
            if met is not None:
                basis[opened] = met
                break
            factors = splu(grains.jacobian(basis).tocsc())
        if progress is not None:
            progress(event + 1)
    raise UnfinishedError(f"contacts still pull after {limit} events: the packing is not settled")


def _step(grains: Grains, basis: Pairs, others: Pairs, motion: _Motion) -> Array | None:
    """Move until a pair of ``others`` meets, and give it; None where the step ends before."""
    V = np.zeros_like(grains.x)
    V[grains.fixed :] = motion.velocity.reshape(-1, 2)
    fastest = float(np.hypot(V[:, 0], V[:, 1]).max())
    times = _meeting(grains, others, V)
    first = int(np.argmin(times)) if len(times) else -1
    longest = STEP / fastest
    target: int | None = None
    step = longest
    if len(times) and times[first] <= longest:
        target, step = first, float(times[first])
    start = grains.x
    for attempt in range(HALVINGS):
        met = others[target] if target is not None else None
        x = _corrected(grains, basis, motion, start + step * V, met)
        if x is not None:
            gaps = grains.gaps(others, x)
            if target is not None:
                gaps[target] = 0.0
            own = grains.gaps(basis[motion.opened][None], x)[0]
            forward = float(((x - start) * V).sum()) > 0 or step == 0
            lowest = int(np.argmin(gaps)) if len(gaps) else -1
            apart = not len(gaps) or gaps[lowest] >= -CLOSED
            if apart and own >= -CLOSED and forward:
                grains.x = x
                return met
            if not apart and attempt % 2 == 0:  # another pair meets before
                target = lowest
                step = min(step, float(times[lowest])) if np.isfinite(times[lowest]) else step / 2
                continue
        target, step = None, step / 2
    raise UnfinishedError(
        f"no step from here keeps the contacts closed: {HALVINGS} halvings were tried"
    )


def _meeting(grains: Grains, pairs: Pairs, V: Array) -> Array:
    """Give the times at which pairs meet if all beads go on straight; infinite for those apart."""
    d = grains.differences(pairs)
    v = V[pairs[:, 0]] - V[pairs[:, 1]]
    both = grains.radii[pairs].sum(axis=1)
    a, b = (v * v).sum(axis=1), (d * v).sum(axis=1)
    c = (d * d).sum(axis=1) - both**2
    root = b * b - a * c
    meets = (b < 0) & (root > 0)
    times = np.full(len(pairs), np.inf)
    times[meets] = np.maximum(c[meets] / (-b[meets] + np.sqrt(root[meets])), 0)
    return times


def _corrected(
    grains: Grains, basis: Pairs, motion: _Motion, x: Array, met: Array | None
) -> Array | None:
    """Close all gaps of the basis but the opened one, and that of ``met``, by Newton's method.

    The factors are those of the start, with the row of the opened contact replaced. Without
    ``met`` the beads stay in the plane across the motion. None where it does not converge.
    """
    opened, velocity = motion.opened, motion.velocity
    plane = velocity / np.linalg.norm(velocity)
    for _ in range(ITERATIONS):
        residual = grains.gaps(basis, x)
        residual[opened] = 0.0
        row, off = plane, 0.0
        if met is not None:
            row = grains.jacobian(met[None], x).toarray()[0]
            off = float(grains.gaps(met[None], x)[0])
        worst = max(float(np.abs(residual).max()), abs(off))
        if worst < CLOSED / 5:
            return x
        if not worst < 1:
            return None
        change = motion.factors.solve(residual)
        change += (off - row @ change) / (row @ velocity) * velocity
        x = x.copy()
        x[grains.fixed :] -= change.reshape(-1, 2)
    return None
