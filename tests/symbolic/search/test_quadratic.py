"""Second order on explicit packings: against Taylor packings, and against what the kernel says."""

from fractions import Fraction

import pytest
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.derivations.beyond import t7_response as t7
from force_diffusion.derivations.framework.vocabulary import UNIT
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.where import SURFACE, Where
from force_diffusion.symbolic.search import quadratic
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.dual import TooLargeError
from force_diffusion.symbolic.search.packing import given
from force_diffusion.symbolic.symbols import (
    DeltaNPlus,
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

from tests.soundness.witnesses import second_order

N = (Fraction(3, 5), Fraction(4, 5))
ONE = Fraction(1)


@pytest.mark.parametrize("load", ["surface", "bulk"])
def test_it_is_what_taylor_packings_give(load: str) -> None:
    height = 3
    loads = given(load, (height,), ONE, ONE)
    forces, places = second_order.means(height, N, load)
    for layer in range(height):
        ordered = ONE / (2 * N[1]) * (height - layer if load == "bulk" else 1)
        assert quadratic.forces(N, ONE, loads, 1, (layer, layer)) / ordered == forces[layer]
        assert quadratic.displacement(N, ONE, loads, layer) == places[layer]


def test_a_load_on_one_bead_is_refused() -> None:
    with pytest.raises(TooLargeError):
        quadratic.forces(N, ONE, given("loaded", (0, 2), ONE, ONE), 1, (1, 1))


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("level", [1, 2, 4])
def test_below_one_load_it_is_what_taylor_packings_give(level: int) -> None:
    across = 5 - level % 2
    load = given("point", (across, level), 2 * N[1], ONE)
    pushes = second_order.pushes(level, N)
    total = dict.fromkeys(pushes, Fraction(0))
    for ((apart, layer), branch), force in second_order.response(level, N).items():
        side, site = (1 if branch == "+" else -1), (across + apart, layer)
        assert quadratic.forces(N, ONE, load, side, site) == force
        up = quadratic.forces(N, ONE, load, side, site, vertical=True)
        total[apart, layer] += up / (2 * N[1])
    assert total == pushes
    for layer in range(level):  # what goes down through a layer is the load, which is given
        assert sum(push for (_, at), push in pushes.items() if at == layer) == 0


def test_too_high_a_load_is_refused() -> None:
    top = quadratic.HIGHEST + 1
    with pytest.raises(TooLargeError):
        quadratic.forces(N, ONE, given("point", (top, top), ONE, ONE), 1, (0, 0))


@pytest.mark.long
def test_a_mean_below_a_load_that_is_off_by_little_is_refuted() -> None:
    for name in ("contact", "bead", "leg"):
        one = t7.MEANS[name]
        for piece, where in zip(one.pieces, one.domains, strict=True):
            right = piece.expression * UNIT
            assert counterexample(equation(one.of, right), where, at_most=40) is None, piece.where
            if right:
                assert counterexample(equation(one.of, right * (1 + phi / 1000)), where)


@pytest.mark.long
def test_a_push_is_read_as_one() -> None:
    """Under a surface load a whole one is half of the load, whatever the radii."""
    whole = Shift((n_y + Dot(e_y, DeltaNPlus(i, j))) * ForcePlus(i, j))
    where = Where.of(j >= 0, j + 1 <= M, loading=SURFACE)
    assert counterexample(equation(whole, 0), where, at_most=40) is None
    assert counterexample(equation(whole, f_load * phi**2), where, at_most=40)


@pytest.mark.long
def test_a_mean_that_is_off_by_little_is_refuted() -> None:
    where = Where.of(j >= 2, j + 2 <= M, loading=SURFACE)
    mean, printed = Shift(ForcePlus(i, j) / (f_load / (2 * n_y))), t4.ON_SURFACE.printed[0].rhs
    assert counterexample(equation(mean, printed), where, at_most=2) is None
    assert counterexample(equation(mean, printed * (1 + phi / 1000)), where, at_most=2)
    sunk, above = Shift(Dot(e_y, DeltaX(i, j))), Where.of(j >= 1)
    assert counterexample(equation(sunk, t4.SETTLING.rhs), above, at_most=4) is None
    assert counterexample(equation(sunk, 2 * t4.SETTLING.rhs), above, at_most=4)
