"""Averages over layers: closed forms against the layers one by one, and surds against numbers."""

import math
from fractions import Fraction

import pytest
import sympy
from force_diffusion.symbolic.algebra.exact import NotExactError
from force_diffusion.symbolic.as_printed import equation, power
from force_diffusion.symbolic.kernel import averages, rules, statistics
from force_diffusion.symbolic.kernel.surds import surd
from force_diffusion.symbolic.kernel.theorem import NotProvedError, Theorem
from force_diffusion.symbolic.kernel.where import Where, at_large_height
from force_diffusion.symbolic.symbols import Covariance, DeltaR, M, Variance, i, j, m, n, sigma, z
from hypothesis import given
from hypothesis import strategies as st
from sympy import Eq, Rational, Sum, sqrt

HEIGHTS = Where((M,), (M >= 3,))
LAYERS = Where.of(j >= 0, j <= M - 1)
HERE, AT = DeltaR(i, j), DeltaR(m, m)


def of_layers(*parts: tuple[sympy.Expr, Where]) -> list[Theorem]:
    """Variances of a radius times a weight, layer by layer."""
    return [
        statistics.moment()(equation(Variance(one * HERE), one**2 * sigma**2), where)
        for one, where in parts
    ]


def mean_of(weight: sympy.Expr) -> sympy.Expr:
    return Sum(Variance(weight.xreplace({j: m}) * AT), (m, 0, M - 1)) / M


def proved(rule: rules.Rule, left: sympy.Expr, right: sympy.Expr, where: Where) -> bool:
    try:
        return rule(equation(left, right), where).formula.lhs == left
    except (NotProvedError, NotExactError):
        return False


@pytest.mark.long
@given(st.lists(st.integers(-4, 4), min_size=1, max_size=4), st.integers(0, 3))
def test_the_mean_of_a_polynomial_is_that_of_its_layers(
    coefficients: list[int], wrong: int
) -> None:
    weight = sum((c * j**power for power, c in enumerate(coefficients)), sympy.Integer(0))
    total = sympy.summation((weight.subs(j, m) ** 2).expand(), (m, 0, M - 1))
    value = (total / M * sigma**2).factor() + wrong * sigma**2
    for height in (3, 7):
        each = [weight.subs(j, layer) ** 2 for layer in range(height)]
        true = sum(each, sympy.Integer(0)) / height + wrong
        assert (value / sigma**2).subs(M, height) == true
    if weight != 0:
        rule = averages.total(*of_layers((weight, LAYERS)))
        assert proved(rule, mean_of(weight), value, HEIGHTS) is (wrong == 0)


def test_layers_may_be_given_in_any_order_and_overlap() -> None:
    edge, inside = Where.of(Eq(j, 0), M >= 2), Where.of(j >= 1, j <= M - 2)
    top, all_but_base = Where.of(Eq(j, M - 1), M >= 2), Where.of(j >= 1, j <= M - 1)
    value = (M + 1) * (2 * M + 1) * sigma**2 / 6
    for wheres in ((top, inside, edge), (edge, inside, all_but_base), (all_but_base, edge)):
        layers = of_layers(*((M - j, one) for one in wheres))
        assert proved(averages.total(*layers), mean_of(M - j), value, HEIGHTS)


def test_a_harmonic_sum_is_kept_whatever_the_way_it_is_written_in() -> None:
    theorem = statistics.moment()(
        equation(Covariance(HERE, HERE / (M - j)), sigma**2 / (M - j)), LAYERS
    )
    left = Sum(Covariance(AT, AT / (M - m)), (m, 0, M - 1))
    rule = averages.total(theorem)
    for right in (
        Sum(1 / n, (n, 1, M)),
        Sum(1 / (n + 1), (n, 0, M - 1)),
        Sum(1 / (M - n), (n, 0, M - 1)),
        Sum((1 - n) / n, (n, 1, M)) + M,
    ):
        assert proved(rule, left, sigma**2 * right, HEIGHTS)
    for right in (Sum(1 / n, (n, 1, M - 1)), Sum(1 / n, (n, 2, M)), Sum(2 / n, (n, 1, M))):
        assert not proved(rule, left, sigma**2 * right, HEIGHTS)


def test_a_harmonic_sum_of_lower_order_is_dropped() -> None:
    rule, large = averages.expansion(), HEIGHTS.in_the_limit(at_large_height("∼"))
    inverses = Sum(1 / n, (n, 1, M))
    assert proved(rule, M**2 + inverses, M**2, large)
    assert not proved(rule, M**2 + M * inverses, M**2, large)  # so it is, but not by its bound
    assert not proved(rule, M**2 + inverses, 2 * M**2, large)


@given(st.integers(1, 30), st.integers(1, 30), st.integers(1, 4))
def test_mean_roots_are_numbers(a: int, b: int, scale: int) -> None:
    """∫ √(a + bz) dz from an antiderivative, against the midpoint rule."""
    root = sympy.Symbol("W", positive=True)
    base = a + b * z
    slope = rules.differentiate(root, base)(
        equation(sympy.Derivative(Rational(2, 3 * b) * base ** Rational(3, 2), z), sqrt(base)),
        Where(),
    )
    left = sympy.Integral(scale * sqrt(base), (z, 0, 1))
    right = Rational(2 * scale, 3 * b) * (
        power(sympy.Integer(a + b), Rational(3, 2)) - power(sympy.Integer(a), Rational(3, 2))
    )
    assert proved(averages.integral(slope), left, right, Where())
    assert not proved(averages.integral(slope), left, right + Rational(1, 10**9), Where())
    steps = 2000
    numeric = sum(math.sqrt(a + b * (k + 0.5) / steps) for k in range(steps)) / steps
    assert math.isclose(scale * numeric, float(right), rel_tol=1e-6)  # h²f''/24f' is below


@pytest.mark.long
@given(st.lists(st.tuples(st.fractions(-9, 9, max_denominator=9), st.integers(1, 60)), max_size=4))
def test_a_surd_is_read_as_the_number_that_it_is(terms: list[tuple[Fraction, int]]) -> None:
    written = sympy.Add(
        *(Rational(c) * power(sympy.Integer(root), Rational(1, 2)) for c, root in terms)
    )
    read = surd(written)
    assert all(sympy.factorint(root).get(2, 0) < 2 and factor for root, factor in read.items())
    value = sum(float(factor) * math.sqrt(root) for root, factor in read.items())
    assert math.isclose(value, sum(float(c) * math.sqrt(root) for c, root in terms), abs_tol=1e-9)
    assert surd(written - written) == {}


def test_what_is_no_surd_is_not_read() -> None:
    for one in (sqrt(-1), sympy.cbrt(2), sympy.pi, 1 / (1 + sqrt(2)), sqrt(1 + sqrt(2))):
        with pytest.raises(NotExactError):
            surd(one)
