"""Moments on explicit packings, against what is known by hand, and what they refute."""

from fractions import Fraction

import pytest
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.where import SURFACE, Where
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.search.dual import NotOfRadiiError, Weights
from force_diffusion.symbolic.symbols import (
    Covariance,
    DeltaR,
    DeltaX,
    Dot,
    ForcePlus,
    Load,
    M,
    Mean,
    SecondDifference,
    Variance,
    f_load,
    i,
    j,
    k,
    m,
    n_plus,
    n_y,
    phi,
    r,
    sigma,
)
from sympy import Eq, Sum

BEADS = Where.of(j >= 0)
SURFACE_LOAD = Where.of(j >= 0, j < M, loading=SURFACE)
FORCE = ForcePlus(i, j) / (f_load / (2 * n_y))


def found(left: sympy.Expr, right: sympy.Expr | int, where: Where = BEADS) -> str | None:
    return counterexample(equation(left, sympy.sympify(right)), where)


@pytest.mark.long
@pytest.mark.parametrize(
    ("left", "right", "where"),
    [
        # six is 2² + 1² + 1²
        (Variance(SecondDifference(i, j)), 6 * sigma**2, BEADS),
        (Variance(DeltaR(i, j) - DeltaR(i, j)), 0, BEADS),
        (Mean(3 + DeltaR(i, j)), 3, BEADS),
        (Covariance(DeltaR(i, j), 2 * DeltaR(i, j) + DeltaR(i + 2, j)), 2 * sigma**2, BEADS),
        (Variance(Sum(DeltaR(m, m), (m, 0, j))), (j + 1) * sigma**2, BEADS),
        # the sum of the radii below is counted twice but for both ends (Eq. 3)
        (Variance(Dot(n_plus, DeltaX(i, j))), (4 * j - 2) * sigma**2, Where.of(j >= 2)),
        (Mean(FORCE), 1, SURFACE_LOAD),
    ],
)
def test_what_is_known_is_not_refuted(left: sympy.Expr, right: sympy.Expr, where: Where) -> None:
    assert found(left, right, where) is None
    if right:
        wrong = found(left, right * (1 + phi / 10**6), where)
        assert wrong is not None
        assert "on the left" in wrong


def test_all_sites_that_coincide_are_seen() -> None:
    here = Where.of(j >= 0, k >= i, indices=(sy.l,)).also(Eq(sy.l, j))
    assert "k = " in str(found(Variance(DeltaR(i, j) + DeltaR(k, sy.l)), 2 * sigma**2, here))


def test_a_variance_of_what_is_drawn_otherwise_has_no_value() -> None:
    """Loads and forces that nothing fixes are drawn, and don't change with the radii alone."""
    assert found(Variance(ForcePlus(i, j)), 0) is None
    assert found(Variance(Dot(n_plus, Load(i, j))), 0) is None
    with pytest.raises(NotOfRadiiError):
        Weights({(0, 0): 1}) + Fraction(1, 2)


def test_weights_are_a_vector_space() -> None:
    one, two = Weights({(0, 0): 1, (2, 0): 3}), Weights({(0, 0): -1, (1, 1): Fraction(1, 2)})
    assert one + two == Weights({(2, 0): 3, (1, 1): Fraction(1, 2)})
    assert one - one == 0 * two
    assert not one - one
    assert one.times(two) == -1
    assert (one / Fraction(1, 2)).times(one) == 20


def test_a_radius_is_a_length() -> None:
    assert found(Variance(DeltaR(i, j) / r), sigma**2) is not None


def test_a_moment_and_what_is_drawn_do_not_mix() -> None:
    """One after the other on the same packings, in both orders."""
    wrong = 2 * DeltaX(i, j)
    for _ in range(2):
        assert found(DeltaX(i, j), wrong, Where.of(j >= 1)) is not None
        assert found(Variance(Dot(n_plus, DeltaX(i, j))), sigma**2, Where.of(j >= 2)) is not None
