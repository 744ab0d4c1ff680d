"""The reference protocol: one contact opens at a time, and beads follow the exact floppy motion.

As many contacts as there are coordinates are kept at zero gap (a basis). While one of them pulls,
the one with the largest tension opens; all others stay closed, which leaves a motion with one
parameter, along which the load's energy falls at the rate of that tension. Where a pair of beads
meets, it enters the basis. Ties go to the pair that comes first by the numbers of its beads.

While other contacts still pull, the energy may have a minimum on the way. The pair is then held at
the distance that it has, and counts as no contact: it is let go, either way, as soon as it bears
force.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from .grains import Grains, Pairs
from .network import UnfinishedError

# Gaps as small as this, in units of r, are those of contacts: float64 leaves about 1e-14.
CLOSED = 2e-12
# Tensions below this share of the largest force are roundings.
SLACK = 1e-11
# A motion ends where the force of its own pair has fallen below this share of the largest one.
HOLD = 1e-8
# No bead moves further than this in one step, in units of r.
STEP = 0.25
# Pairs with a larger gap are not looked at until some bead has moved by a fifth of it.
REACH = 0.6
# Newton's iterations before a step is halved, and halvings before it is given up.
ITERATIONS, HALVINGS = 12, 40
# Steps before a motion in which no pair meets is given up.
MOST_STEPS = 2000
# Events for each coordinate before the motion is given up as endless.
MOST_EVENTS = 50


@dataclass
class _Basis:
    """Pairs kept at the gaps ``rest``: contacts at zero, and pairs that are ``held`` apart."""

    pairs: Pairs
    rest: Array
    held: Array

    def worst(self, forces: Array) -> int:
        """Give the row whose force is most wrong: a contact that pulls, or a held pair's."""
        return int(np.argmin(np.where(self.held, -np.abs(forces), forces)))


@dataclass
class _Motion:
    """The floppy motion that opens (or for a held pair closes) the gap of one row of a basis."""

    factors: Any
    opened: int
    opens: bool  # or it closes again
    rate: float  # of the energy, negative
    forces: Array  # of all rows
    velocity: Array  # of all coordinates that may change, for a unit rate of the gap


def relax(grains: Grains, supports: Pairs, progress: Callable[[int], None]) -> tuple[Pairs, Array]:
    """Move ``grains`` until no contact of the basis pulls; gives its contacts, and their forces.

    ``supports``: pairs at zero gap, as many as unknowns. Raises ``UnfinishedError``.
    """
    basis = _Basis(supports.copy(), np.zeros(len(supports)), np.zeros(len(supports), dtype=bool))
    near, looked = grains.near(REACH), grains.x.copy()
    limit = MOST_EVENTS * grains.unknowns
    for event in range(limit):
        motion, slack = _motion(grains, basis)
        if motion.rate >= -slack:
            return basis.pairs[~basis.held], motion.forces[~basis.held]
        met: Array | None = None
        steps = 0
        while met is None and motion.rate < -slack:
            if (steps := steps + 1) > MOST_STEPS:
                raise UnfinishedError(f"beads move on and on: no pair met in {MOST_STEPS} steps")
            progress(event)
            if np.abs(grains.x - looked).max() > REACH / 5:
                near, looked = grains.near(REACH), grains.x.copy()
            kept = ~basis.held
            kept[motion.opened] &= motion.opens  # what opened may meet again, further along
            contacts = basis.pairs[kept]
            others = near[~np.isin(grains.named(near), grains.named(contacts))]
            at = grains.x
            met = _step(grains, basis, others, motion)
            if met is None and (grains.x == at).all():
                raise UnfinishedError("no step from here, however small, lowers the load's energy")
            if met is None:
                motion, slack = _motion(grains, basis, motion)
        row = motion.opened
        if met is None:
            basis.held[row] = True
            basis.rest[row] = grains.gaps(basis.pairs[row][None])[0]
        else:
            basis.pairs[row], basis.rest[row], basis.held[row] = met, 0.0, False
        progress(event + 1)
    raise UnfinishedError(f"contacts still pull after {limit} events: the packing is not settled")


def _motion(grains: Grains, basis: _Basis, before: _Motion | None = None) -> tuple[_Motion, float]:
    """Give the motion to follow and the size of forces that are roundings.

    A motion that goes on keeps its row, and its direction.
    """
    factors = grains.factors(basis.pairs)
    forces = factors.solve(-grains.weights, trans="T")
    opened = basis.worst(forces) if before is None else before.opened
    unit = np.zeros(grains.unknowns)
    unit[opened] = -1.0 if forces[opened] > 0 and basis.held[opened] else 1.0
    velocity = factors.solve(unit)
    if before is not None and velocity @ before.velocity < 0:
        velocity, unit = -velocity, -unit
    slack = SLACK if before is None else HOLD
    rate = float(forces[opened] * unit[opened])
    motion = _Motion(factors, opened, bool(unit[opened] > 0), rate, forces, velocity)
    return motion, slack * float(np.abs(forces).max())


def _step(grains: Grains, basis: _Basis, others: Pairs, motion: _Motion) -> Array | None:
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
    room = 1e-15 * float(np.abs(grains.load * grains.x).sum())
    for attempt in range(HALVINGS):
        met = others[target] if target is not None else None
        x = _corrected(grains, basis, motion, start + step * V, met)
        if x is not None:
            gaps = grains.gaps(others, x)
            if target is not None:
                gaps[target] = 0.0
            own = grains.gaps(basis.pairs[motion.opened][None], x)[0]
            along = float(((x - start) * V).sum() / (V * V).sum())
            lowest = int(np.argmin(gaps)) if len(gaps) else -1
            apart = not len(gaps) or gaps[lowest] >= -CLOSED
            gain = -float((grains.load * (x - start)).sum())
            if apart and own >= -CLOSED and along >= 0 and gain <= room:
                grains.x = x
                return met
            if not apart and attempt % 2 == 0:  # another pair meets before
                target = lowest
                step = min(step, float(times[lowest])) if np.isfinite(times[lowest]) else step / 2
                continue
            if apart and gain > room and along > 0:  # beyond a minimum: go to that of a parabola
                bend = gain - motion.rate * along
                target, step = None, min(-motion.rate * along**2 / (2 * bend), step / 2)
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
    grains: Grains, basis: _Basis, motion: _Motion, x: Array, met: Array | None
) -> Array | None:
    """Bring all pairs of the basis but the opened one, and ``met``, to their gaps, by Newton.

    The factors are those of the start, with the row of the opened contact replaced. Without
    ``met`` the beads stay in the plane across the motion. None where it does not converge.
    """
    opened, velocity = motion.opened, motion.velocity
    plane = velocity / np.linalg.norm(velocity)
    for _ in range(ITERATIONS):
        residual = grains.gaps(basis.pairs, x) - basis.rest
        residual[opened] = 0.0
        off = 0.0 if met is None else float(grains.gaps(met[None], x)[0])
        worst = max(float(np.abs(residual).max()), abs(off))
        if worst < CLOSED / 5:
            return x
        if not worst < 1:
            return None
        change = motion.factors.solve(residual)
        if met is None:
            own, rate = float(plane @ change), float(plane @ velocity)
        else:
            own, rate = (grains.rate(met, moves, x) for moves in (change, velocity))
        change += (off - own) / rate * velocity
        x = x.copy()
        x[grains.fixed :] -= change.reshape(-1, 2)
    return None
