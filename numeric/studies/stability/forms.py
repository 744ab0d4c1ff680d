"""One packing solved in both forms: what the measurements of stability have in common.

The *deviation form* is the engine's, in line-sum coordinates; the *plain form* solves for positions
and forces and subtracts the ordered values. Errors are relative to the largest |change| of any
contact force. The packings are periodic strips under a surface load, a valid problem of their own,
so that heights of thousands of layers stay small.
"""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import flint
import numpy as np

from ...arithmetic.systems import Array, NumberSystem, largest_of, zeros
from ...lattice.layers import whole
from ...mechanics import plain
from ...mechanics.loads import LoadSpec
from ...mechanics.local import cosine
from ...mechanics.sweep import Forces, SolvedPacking, deposit, sweep_down

SEED = 1


def deviation_form(
    n_x: Fraction, rho: Sequence[Array], system: NumberSystem
) -> tuple[SolvedPacking, Forces]:
    """Solve a whole packing for its deviations; the caller activates ``system``."""
    height, width = len(rho) - 1, len(rho[0])
    region, load = whole(width, height), LoadSpec("surface", height, width)
    solved = deposit(cosine(n_x), region, rho, system)
    strength = load.strength(n_x, system)
    return solved, sweep_down(solved, region.rows, load.on(region.rows, strength, system))


def changes(forces: Forces) -> Array:
    """Give the changes of all plus, then of all minus contacts, in units of the load on a bead."""
    return np.concatenate([*forces.change.plus, *forces.change.minus])


def plain_form(n_x: Fraction, rho: Sequence[Array], system: NumberSystem) -> Array:
    """Solve for positions and forces, and subtract the ordered forces; gives all changes."""
    height, width = len(rho) - 1, len(rho[0])
    solved = plain.deposit(n_x, rho, system)
    down = plain.Vector(zeros(system, width), zeros(system, width) - 1)
    forces = plain.forces(solved, (None,) * height + (down,))
    ordered = 1 / (2 * solved.n[1])
    return np.concatenate([f - ordered for f in (*forces.plus, *forces.minus)])


def largest(enclosures: Array) -> Any:
    """Give a lower bound of the largest |change| of enclosures."""
    return largest_of(value.abs_lower() for value in enclosures)


def relative_radius(enclosures: Array) -> Any:
    """Give the largest radius over the largest |change|, an arb; infinite where nothing is left."""
    size = largest(enclosures)
    if not all(value.is_finite() for value in enclosures) or not size > 0:
        return flint.arb("inf")
    return (largest_of(value.rad() for value in enclosures) / size).upper()


def bits_lost(radius: Any, bits: int) -> float | None:
    """Give the bits of ``bits`` that a relative radius leaves uncertain; None if it is infinite."""
    if not radius.is_finite():
        return None
    if radius.is_zero():
        return 0.0
    return max(bits + float((radius.log() / flint.arb.const_log2()).upper()), 0.0)
