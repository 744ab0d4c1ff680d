"""What holds in a limit is proved: a true example of each rule, and what it may not be used for."""

import pytest
import sympy
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.derivations import eq12_delta_weights as eq12
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations.framework.grounds import facts_of
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel import limits, rules
from force_diffusion.symbolic.kernel.theorem import DisprovedError, NotProvedError, Theorem
from force_diffusion.symbolic.kernel.where import SURFACE, Where, at_fixed_height, in_a_layer
from force_diffusion.symbolic.symbols import (
    DeltaR,
    ForcePlus,
    LargestShare,
    LargestWeight,
    M,
    Variance,
    f_load,
    i,
    j,
    m,
    n_y,
    phi,
    r,
    sigma,
    z,
)
from sympy import Derivative, Eq, Sum

HEIGHTS = Where.of(j >= 6, j + 6 <= M, loading=SURFACE)
FORCE = ForcePlus(i, j) / (f_load / (2 * n_y))
HERE, LINE = DeltaR(i, j), Sum(DeltaR(i - j + m, m), (m, 1, M))
TOP = Where.of(Eq(j, M - 1), M >= 3, loading=SURFACE)


def forces() -> tuple[tuple[Theorem, ...], ...]:
    return facts_of((eq11.IN_RADII,))


@pytest.mark.parametrize(
    ("most", "bound"),
    [
        (LargestWeight(HERE), 1),
        (LargestWeight(HERE), M),  # at most: M says less
        (LargestWeight(2 * M * HERE - LINE), M),
        (LargestWeight(Sum(m * DeltaR(i - j + m, m), (m, 1, M))), M),
        (LargestWeight(LINE / M), 1 / M),
        (LargestShare(LINE), 1 / M),
        (LargestShare(M * HERE), 1),
        (LargestWeight(FORCE), M),
        (LargestShare(FORCE), 1 / M),
    ],
)
def test_how_large_a_weight_may_be(most: sympy.Expr, bound: sympy.Expr | int) -> None:
    where, bound = HEIGHTS.in_the_limit(at_fixed_height("O")), sympy.sympify(bound)
    limits.bounded(*forces())(equation(most, bound), where)
    if (most, bound) != (LargestWeight(HERE), M):
        with pytest.raises(NotProvedError, match="a radius has more"):
            limits.bounded(*forces())(equation(most, bound / M), where)


def test_one_layer_below_the_surface_a_share_is_of_order_1_over_the_height() -> None:
    where = TOP.in_the_limit(in_a_layer("O"))
    limits.bounded(*forces())(equation(LargestShare(FORCE), 1 / M), where)
    with pytest.raises(NotProvedError, match="a radius has more"):
        limits.bounded(*forces())(equation(LargestShare(FORCE), M**-2), where)


@pytest.mark.parametrize("factor", [1, 3, -1, M, 1 / (M - j), z, 1 - phi**2], ids=str)
def test_what_eq_12_drops_is_negligible_times_any_factor(factor: sympy.Expr | int) -> None:
    where = HEIGHTS.in_the_limit(at_fixed_height("≈"))
    left, right = eq12.PRINTED.args
    told = equation(left * factor, right * factor)
    theorem = limits.negligible(*forces())(told, where)
    assert theorem.formula == told
    for part in (sympy.Rational(999, 1000), 2, 1 + z / 10**6):
        with pytest.raises(NotProvedError, match="varies as the power"):
            limits.negligible(*forces())(equation(left * factor, part * right * factor), where)


def test_what_both_sides_share_counts_for_nothing() -> None:
    """The sum of Eq. 12, left out, is not made small by what is put on both sides."""
    where = HEIGHTS.in_the_limit(at_fixed_height("≈"))
    left, right = eq12.PRINTED.args
    large = M**9 * HERE
    limits.negligible(*forces())(equation(left + large, right + large), where)
    with pytest.raises(NotProvedError, match="varies as the power 3"):
        limits.negligible(*forces())(equation(left + large, large), where)


def test_the_heaviest_of_what_eq_12_drops() -> None:
    where = HEIGHTS.in_the_limit(at_fixed_height("≈ by weight"))
    dropped = eq12.PRINTED.lhs - eq12.PRINTED.rhs
    limits.heaviest(*forces())(equation(dropped, -eq12.BASE_TERM), where)
    for other in (sympy.S.Zero, eq12.BASE_TERM, -2 * eq12.BASE_TERM):
        with pytest.raises(NotProvedError, match="of the order of the largest"):
            limits.heaviest(*forces())(equation(dropped, other), where)


def test_a_slope_by_height() -> None:
    rules.slope(equation(Derivative(phi * z**3, z), 3 * phi * z**2), Where())
    with pytest.raises(NotProvedError, match="differ"):
        rules.slope(equation(Derivative(phi * z**3, z), 2 * phi * z**2), Where())


def test_in_a_fixed_layer_z_is_that_of_the_layer() -> None:
    """(1 − z) M is 1 one layer below the surface."""
    where = TOP.in_the_limit(in_a_layer("∼"))
    limits.asymptotic()(equation((1 - z) * M**2, M), where)
    with pytest.raises(DisprovedError, match="the power -1"):
        limits.asymptotic()(equation((1 - z) * M**2, M**2), where)


def test_what_holds_in_a_limit_is_of_no_use_at_finite_size() -> None:
    printed = equation(Variance(FORCE), eq13.PRINTED.rhs.xreplace({z: j / M}))
    about = limits.asymptotic(*forces())(printed, HEIGHTS.in_the_limit(at_fixed_height("∼")))
    with pytest.raises(NotProvedError, match="does not hold"):
        rules.follows(about)(about.formula, HEIGHTS)
    weighed = limits.bounded()(
        equation(LargestWeight(HERE), r / sigma), HEIGHTS.in_the_limit(at_fixed_height("O"))
    )
    with pytest.raises(NotProvedError, match="does not hold"):
        rules.follows(weighed)(weighed.formula, HEIGHTS)
