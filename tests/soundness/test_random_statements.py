"""Random changes of what is true, whose truth is known from how they are made.

A true statement is multiplied by a factor, or radii are added to it. What is added is a sum of
functions that are independent of each other: it vanishes only if all its numbers do. What is one or
nothing is disguised. None that is false may be proved, and none that is true refuted.
"""

from collections.abc import Callable

import pytest
import sympy
from force_diffusion.derivations.framework.decide import candidate_for
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict
from force_diffusion.symbolic.symbols import M, i, j, m, n_x, n_y, phi, r, z
from force_diffusion.symbolic.trees import equation
from hypothesis import given
from hypothesis import strategies as st
from sympy import Add, Integer, Mul, Pow, Rational, Sum

import force_diffusion as fd

DISGUISES = (
    n_x**2 + n_y**2,
    Mul(4 * n_x**2 * n_y**2, Pow(1 - phi**2, -1, evaluate=False), evaluate=False),
    phi + 2 * n_x**2,
    sy.spacing / (4 * r * n_x),
)
"""Of the number 1."""
SUMS = (
    Sum(1, (m, 1, M)) / M,
    2 * Sum(m, (m, 1, M)) / (M * (M + 1)),
    2 * Sum(m - j, (m, j, M)) / ((M - j) * (M - j + 1)),
)
"""Of the same, for packings of height M."""
numbers = st.just(Integer(0)) | st.builds(Rational, st.integers(-6, 6), st.integers(1, 7))
COSINES = (Integer(1), phi, phi**2, n_x, n_x * n_y, phi * n_y)


def sums_of(*functions: sympy.Expr) -> st.SearchStrategy[dict[sympy.Expr, sympy.Rational]]:
    return st.dictionaries(st.sampled_from(functions), numbers, max_size=3)


def total(terms: dict[sympy.Expr, sympy.Rational]) -> sympy.Expr:
    return Add(*(number * function for function, number in terms.items()))


def check(ruling: Ruling, *, true: bool, about: object) -> None:
    assert true or not ruling.verdict.is_proved, (about, str(ruling))
    assert not true or ruling.verdict is not Verdict.REFUTED, (about, str(ruling))


PLUS, MINUS = sy.ForcePlus(i, j), sy.ForceMinus(i, j)
FORMS: dict[str, Callable[[], fd.ClosedForm]] = {
    "surface": lambda: fd.variance(PLUS),
    "both": lambda: fd.covariance(PLUS, MINUS),
    "a shift": lambda: fd.mean(PLUS, order=2),
}
HEIGHT, LAYER = 12, 4


@pytest.mark.long(share=3)
@pytest.mark.parametrize("name", FORMS)
@given(
    disguises=st.lists(st.sampled_from([*DISGUISES, *SUMS]), max_size=2),
    terms=sums_of(*COSINES, M, j, M * phi, j**2),
    exponent=st.sampled_from([1, 2, -1]),
    at_one_place=st.booleans(),
    elsewhere=st.integers(0, 1),
)
def test_multiples_of_closed_forms(name, disguises, terms, exponent, at_one_place, elsewhere):
    """At one place, also times what vanishes there alone."""
    form = FORMS[name]()
    zero = (M - HEIGHT) ** elsewhere * (j - LAYER) ** (1 - elsewhere) if at_one_place else 1
    factor = 1 + zero * total(terms)
    candidate = Mul(*disguises, Pow(factor, exponent, evaluate=False), form.expr, evaluate=False)
    place = {"M": HEIGHT, "j": LAYER} if at_one_place else {}
    true = at_one_place or sympy.expand(factor ** abs(exponent)) == 1
    check(form.decide(candidate, **place), true=true, about=candidate)


SHRINKING = (M ** Rational(-1, 1000), 1 / M, phi / M, z / M**2, 1 / (M + M**3 * phi**2))
LASTING = (Integer(1), phi, phi**2, z, z**2, n_x, M * phi, M ** Rational(1, 1000))
NOT_UNIFORM = (M / (1 + M**2 * phi**2), 1 / (1 + M * phi**2), 1 / (1 + M * (phi - z + 2) ** 2))
"""What lasts at φ = 0; the last one shrinks, as φ − z + 2 is positive."""


@pytest.mark.long(share=2)
@pytest.mark.parametrize("number", [13, 14])
@given(
    disguises=st.lists(st.sampled_from([*DISGUISES, *SUMS]), max_size=2),
    shrinking=sums_of(*SHRINKING, NOT_UNIFORM[2]),
    lasting=sums_of(*LASTING) | st.just({}),
    not_uniform=st.sampled_from([Integer(0), *NOT_UNIFORM[:2]]),
    inverse=st.booleans(),
)
def test_multiples_of_leading_orders(number, disguises, shrinking, lasting, not_uniform, inverse):
    derivation = load(number)
    left, right = derivation.printed[0].args
    factor = Add(1, total(shrinking), total(lasting), not_uniform)
    power = Pow(factor, -1 if inverse else 1, evaluate=False)
    candidate = equation(left, Mul(*disguises, power, right, evaluate=False))
    true = not_uniform == 0 and not any(lasting.values())
    check(candidate_for(derivation, 0, candidate), true=true, about=candidate)


@pytest.mark.long(share=3)
@pytest.mark.parametrize("number", [3, 5, 11])
@given(
    disguise=st.sampled_from(DISGUISES),
    weights=st.dictionaries(
        st.tuples(
            st.sampled_from([(i, j), (i + 1, j + 1)]), st.sampled_from([sy.b_plus, sy.n_minus])
        ),
        st.tuples(numbers, st.sampled_from([*COSINES, j])),
        max_size=3,
    ),
    order=st.integers(0, 2),
)
def test_radii_that_are_added(number, disguise, weights, order):
    derivation = load(number)
    left, right = derivation.printed[0].args
    added = []
    for (place, vector), (factor, function) in weights.items():
        if number != 11:
            added.append(factor * function * vector * sy.DeltaR(*place))
        elif vector == sy.b_plus:
            added.append(factor * function * M**order * sy.DeltaR(*place))
    candidate = equation(left, Add(Mul(disguise, right, evaluate=False), *added, evaluate=False))
    check(candidate_for(derivation, 0, candidate), true=not any(added), about=candidate)
