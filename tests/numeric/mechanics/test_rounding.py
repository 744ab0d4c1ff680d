"""What rounding leaves of a change: its last place, whatever the height."""

from fractions import Fraction

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array, Balls, as_floats
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.engine import solve
from force_diffusion.numeric.mechanics.loads import LoadSpec
from force_diffusion.numeric.mechanics.problem import Problem, Route
from force_diffusion.numeric.mechanics.work import Work

N_X = Fraction(3, 4)


def changes(problem: Problem, system: Balls | None = None) -> Array:
    own = system or FLOAT64
    with own.active():
        forces = solve(problem, [0], own, Work(), carried=system is None).forces
    assert forces is not None
    return as_floats(forces.g)


@pytest.mark.parametrize("height", [16, 1024])
@pytest.mark.parametrize("dimension", [2, 3])
def test_errors_do_not_pile_up_as_forces_pass_straight_down(height: int, dimension: int) -> None:
    width = (16, 9)[dimension - 2]
    height //= 1 + (dimension - 2) * 8
    radii = DrawnRadii("uniform", Fraction(1, 10**6), 1, width)
    region = whole(width, height, dimension)
    load = LoadSpec("surface", height, width, dimension=dimension)
    problem = Problem(N_X * 3 / 4, radii, load, Route.EXACT, region, region.rows, True)
    exact = changes(problem, Balls(200))
    error = np.abs(changes(problem) - exact).max() / np.abs(exact).max()
    # rounded once; as_floats rounds the other once
    assert error <= 2 * 2.0**-53
