"""What rounding leaves of a change: a few units in the last place, whatever the height."""

from fractions import Fraction

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    Array,
    Balls,
    NumberSystem,
    as_floats,
)
from force_diffusion.numeric.disorder.radii import DrawnRadii, rows_of
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.loads import LoadSpec
from force_diffusion.numeric.mechanics.local import cosine
from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down

N_X = Fraction(3, 4)


def changes(system: NumberSystem, height: int, width: int) -> Array:
    region = whole(width, height)
    radii = DrawnRadii("uniform", Fraction(1, 10**6), 1, width)
    load = LoadSpec("surface", height, width)
    with system.active():
        packing = deposit(cosine(N_X), region, rows_of(radii, region.rows, [0], system), system)
        loads = load.on(region.rows, load.strength(N_X, system), system)
        forces = sweep_down(packing, region.rows, loads)
    return as_floats(np.concatenate([*forces.change.plus, *forces.change.minus]))


@pytest.mark.parametrize("height", [16, 1024])
def test_errors_do_not_pile_up_as_forces_pass_straight_down(height: int) -> None:
    exact = changes(Balls(200), height, 16)
    error = np.abs(changes(FLOAT64, height, 16) - exact).max() / np.abs(exact).max()
    assert error < 16 * 2.0**-FLOAT64.bits
