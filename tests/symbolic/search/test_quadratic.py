"""Second order on explicit packings: against Taylor packings, and against what the kernel says."""

from fractions import Fraction

import pytest
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.witnesses import second_order
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.where import SURFACE, Where
from force_diffusion.symbolic.search import quadratic
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.dual import TooLargeError
from force_diffusion.symbolic.search.packing import given
from force_diffusion.symbolic.symbols import (
    DeltaX,
    Dot,
    ForcePlus,
    M,
    Shift,
    e_y,
    f_load,
    i,
    j,
    n_y,
    phi,
)

N = (Fraction(3, 5), Fraction(4, 5))
ONE = Fraction(1)


@pytest.mark.parametrize("load", ["surface", "bulk"])
def test_it_is_what_taylor_packings_give(load: str) -> None:
    height = 3
    loads = given(load, (height,), ONE, ONE)
    forces, places = second_order.means(height, N, load)
    for layer in range(height):
        ordered = ONE / (2 * N[1]) * (height - layer if load == "bulk" else 1)
        assert quadratic.forces(N, ONE, loads, 1, layer) / ordered == forces[layer]
        assert quadratic.displacement(N, ONE, loads, layer) == places[layer]


def test_a_load_on_one_bead_is_refused() -> None:
    with pytest.raises(TooLargeError):
        quadratic.forces(N, ONE, given("loaded", (0, 2), ONE, ONE), 1, 1)


def test_a_mean_that_is_off_by_little_is_refuted() -> None:
    where = Where.of(j >= 2, j + 2 <= M, loading=SURFACE)
    mean, printed = Shift(ForcePlus(i, j) / (f_load / (2 * n_y))), t4.ON_SURFACE.printed[0].rhs
    assert counterexample(equation(mean, printed), where, at_most=2) is None
    assert counterexample(equation(mean, printed * (1 + phi / 1000)), where, at_most=2)
    sunk, above = Shift(Dot(e_y, DeltaX(i, j))), Where.of(j >= 1)
    assert counterexample(equation(sunk, t4.SETTLING.rhs), above, at_most=4) is None
    assert counterexample(equation(sunk, 2 * t4.SETTLING.rhs), above, at_most=4)
