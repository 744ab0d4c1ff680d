"""One packing solved in both forms: what the measurements of stability have in common.

The *deviation form* is the engine's, in line-sum coordinates; the *plain form* solves for positions
and forces and subtracts the ordered values. Errors are relative to the largest |change| of any
contact force. The packings are periodic strips under a surface load, a valid problem of their own,
so that heights of thousands of layers stay small.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction
from statistics import median
from time import process_time
from typing import Any, TypeVar

import flint

from ...arithmetic.systems import Array, NumberSystem, zeros
from ...lattice.layers import whole
from ...mechanics import plain
from ...mechanics.loads import LoadSpec
from ...mechanics.local import cosine
from ...mechanics.sweep import Forces, SolvedPacking, deposit, sweep_down

SEED = 1
Changes = tuple[Sequence[Array], Sequence[Array]]
"""Changes of the plus and of the minus contacts, layer by layer, in units of the load on a bead."""
T = TypeVar("T")
# Seconds are the processor's, of the one thread there is: other programs don't count.
ENOUGH_SECONDS, MOST_ROUNDS = 0.05, 9


def deviation_form(
    n_x: Fraction, rho: Sequence[Array], system: NumberSystem
) -> tuple[SolvedPacking, Forces]:
    """Solve a whole packing for its deviations; the caller activates ``system``."""
    height, width = len(rho) - 1, len(rho[0])
    region, load = whole(width, height), LoadSpec("surface", height, width)
    solved = deposit(cosine(n_x), region, rho, system)
    strength = load.strength(n_x, system)
    return solved, sweep_down(solved, region.rows, load.on(region.rows, strength, system))


def changes(forces: Forces) -> Changes:
    """Give the changes of all contact forces."""
    return forces.change.plus, forces.change.minus


def plain_form(n_x: Fraction, rho: Sequence[Array], system: NumberSystem) -> Changes:
    """Solve for positions and forces, and subtract the ordered forces."""
    height, width = len(rho) - 1, len(rho[0])
    solved = plain.deposit(n_x, rho, system)
    down = plain.Vector(zeros(system, width), zeros(system, width) - 1)
    forces = plain.forces(solved, (None,) * height + (down,))
    ordered = 1 / (2 * solved.n[1])
    return tuple(f - ordered for f in forces.plus), tuple(f - ordered for f in forces.minus)


def flat(values: Changes) -> Iterator[Any]:
    """Give all numbers."""
    for side in values:
        for layer in side:
            yield from layer


def largest(reference: Changes) -> Any:
    """Give a lower bound of the largest |change| of enclosures."""
    found = flint.arb(0)
    for value in flat(reference):
        found = found.max(value.abs_lower())
    return found


def relative_radius(reference: Changes) -> Any:
    """Give the largest radius over the largest |change|, an arb; infinite where nothing is left."""
    radius, size = flint.arb(0), largest(reference)
    for value in flat(reference):
        if not value.is_finite():
            return flint.arb("inf")
        radius = radius.max(value.rad())
    return (radius / size).upper() if size > 0 else flint.arb("inf")


def bits_lost(radius: Any, bits: int) -> float | None:
    """Give the bits of ``bits`` that a relative radius leaves uncertain; None if it is infinite."""
    if not radius.is_finite():
        return None
    if radius.is_zero():
        return 0.0
    return max(bits + float((radius.log() / flint.arb.const_log2()).upper()), 0.0)


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """Give what a work gives and its seconds: the median of several runs, or of one long one."""
    start = process_time()
    result = work()
    seconds = process_time() - start
    return result, seconds if seconds > ENOUGH_SECONDS else in_turn(work)[0]


def in_turn(*works: Callable[[], Any]) -> list[float]:
    """Give the median seconds of each work; they take turns, so that a busy machine slows all."""
    rounds: list[list[float]] = []
    while not rounds or (
        len(rounds) < MOST_ROUNDS and math.fsum(map(math.fsum, rounds)) < ENOUGH_SECONDS
    ):
        rounds.append([])
        for work in works:
            start = process_time()
            work()
            rounds[-1].append(process_time() - start)
    return [median(seconds) for seconds in zip(*rounds, strict=True)]
