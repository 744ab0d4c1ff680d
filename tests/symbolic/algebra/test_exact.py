"""The exact field against SymPy, on expressions that it does not share code with."""

from operator import add, mul, sub, truediv

import pytest
import sympy
from force_diffusion.symbolic.algebra import exact
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError
from force_diffusion.symbolic.sets import EVERYTHING
from force_diffusion.symbolic.signs import sign
from force_diffusion.symbolic.symbols import M, m, n_x, n_y, phi, r, z
from hypothesis import given
from hypothesis import strategies as st

small = st.integers(-5, 5)
polynomials = st.builds(
    lambda a, b, c, d: a + b * M + c * M * phi + d * phi**2, small, small, small, small
)
fractions_ = st.builds(lambda top, bottom: top / (1 + bottom**2 + phi**2), polynomials, polynomials)


THEIRS = sympy.QQ.frac_field(M, phi).field
"""SymPy's own field, which is fast where ``cancel`` is slow."""


@pytest.mark.long
@given(fractions_, fractions_)
def test_arithmetic_agrees_with_sympy(left, right):
    ours = FIELD.from_sympy(left), FIELD.from_sympy(right)
    theirs = THEIRS.from_expr(left), THEIRS.from_expr(right)
    for operation in (add, sub, mul, *([truediv] if theirs[1] else [])):
        assert THEIRS.from_expr(operation(*ours).to_sympy()) == operation(*theirs)
    assert ours[1].is_zero() == (not theirs[1])


@given(st.lists(small, min_size=1, max_size=5), st.integers(-4, 4), st.integers(0, 6))
def test_sums_of_polynomials(powers, low, length):
    term = sum((c * m**k for k, c in enumerate(powers)), sympy.Integer(0))
    ends = map(FIELD.constant, (low, low + length - 1))
    total = exact.sum_polynomial(FIELD.from_sympy(term), m, *ends)
    by_hand = sum(term.subs(m, value) for value in range(low, low + length))
    assert total.to_sympy() == by_hand


@given(st.lists(small, min_size=1, max_size=4))
def test_antidifference_starts_at_zero(powers):
    term = sum((c * m**k for k, c in enumerate(powers)), sympy.Integer(0))
    assert exact.antidifference(FIELD.from_sympy(term), m).substitute({m: FIELD.zero}).is_zero()


def vanishes(expression: sympy.Expr) -> bool:
    return FIELD.from_sympy(expression).is_zero()


def test_direction_cosines_are_reduced():
    assert vanishes(1 - phi**2 - 4 * n_x**2 * n_y**2)
    assert vanishes(n_x**4 + n_y**4 - (1 + phi**2) / 2)
    assert not vanishes(phi - n_x**2 + n_y**2)
    assert not vanishes(n_x**2 + n_y**2 - 2)


@given(st.integers(0, 5), st.integers(0, 5))
def test_what_is_reduced_is_the_same(across, up):
    element = FIELD.from_sympy(n_x**across * n_y**up + M)
    assert (element.reduced() - element).is_zero()
    assert element.reduced().degree(n_x) == across % 2
    assert element.reduced().degree(n_y) == up % 2


@pytest.mark.parametrize("expression", [sympy.sqrt(r), sympy.Float(0.5), sympy.exp(phi)])
def test_nothing_inexact_comes_in(expression):
    with pytest.raises(NotExactError):
        FIELD.from_sympy(expression)


def test_division_by_zero_is_refused():
    with pytest.raises(NotExactError, match="zero"):
        FIELD.from_sympy(sympy.Mul(1, sympy.Pow(phi - phi, -1, evaluate=False), evaluate=False))


@pytest.mark.parametrize(("factor", "known"), [(1 + z * phi**2, 1), (z - phi, 0), (1 - z * phi, 0)])
def test_the_sign_of_a_factor_in_z_and_phi_is_that_of_its_terms(factor, known):
    assert sign(FIELD.from_sympy(factor), EVERYTHING) == known
