"""Heights, places of loads, roots, and forces that a load makes zero."""

import pytest
import sympy
from force_diffusion.derivations.framework.decide import candidate_for
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotAStatementError, NotProvedError
from force_diffusion.symbolic.kernel import axioms, rules
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.kernel.statistics import moment
from force_diffusion.symbolic.symbols import M, e_y, f_load, i, j, k, l, m, n, phi, r, sigma, z
from sympy import Abs, Rational, sqrt

import force_diffusion as fd


def equal(left: sympy.Expr, right: sympy.Expr) -> sympy.Eq:
    return sympy.Eq(left, right, evaluate=False)


def test_z_is_the_height_of_one_layer():
    domain = Domain.of(j >= 1, j <= M - 1, l >= 0)
    theorem = rules.rewrite()(equal(z * M * sy.DeltaR(k, l), j * sy.DeltaR(k, l)), domain)
    with pytest.raises(NotProvedError, match="height of one layer"):
        rules.instance(theorem, {M: M + 1}, Domain.of(j >= 1, j <= M, l >= 0))


def test_a_theorem_with_z_is_not_put_in_elsewhere():
    surface, positions = axioms.SURFACE, load(1).theorem
    value = positions.formula.rhs + (z * M - j) * r * sy.n_plus
    domain = Domain.of(j >= 0, loading=surface)
    theorem = rules.rewrite(positions)(equal(sy.Position(i, j), value), domain)
    apart = equal(sy.Position(i, j) - sy.Position(i - 1, j - 1), r * sy.n_plus)
    with pytest.raises(NotProvedError, match="height of one layer"):
        rules.rewrite(theorem)(apart, Domain.of(j >= 1, loading=surface))


@pytest.mark.parametrize("height", [m, l])
def test_no_sum_is_over_the_place_of_a_load(height):
    surface = axioms.SURFACE.put_in({M: height})
    total = equal(sympy.Sum(sy.LoadForce(i, j), (height, 1, 3)), -f_load * e_y)
    with pytest.raises(NotAStatementError, match="place of the load"):
        rules.rewrite(axioms.loads(surface))(total, Domain.of(sympy.Eq(j, 1), loading=surface))


def test_no_mean_is_over_the_place_of_a_load():
    surface = axioms.SURFACE.put_in({M: n})
    mean = equal(sy.Mean(sy.MeanOver(sy.Dot(e_y, sy.LoadForce(i, j)), 2, k)), -f_load / 2)
    domain = Domain.of(sympy.Eq(j, 0), loading=surface, indices=(k,))
    with pytest.raises(NotAStatementError, match="place of the load"):
        moment(axioms.loads(surface))(mean, domain)


VARIANCE = load(13).printed[0].lhs
DEVIATION = sqrt(2) * M ** Rational(3, 2) * sigma / r / (1 - phi**2)


@pytest.mark.parametrize(
    ("number", "statement"),
    [
        (1, equal(sqrt(phi - 1) * sqrt(phi - 2), sqrt((1 - phi) * (2 - phi)))),
        (1, equal(sqrt(phi) * sqrt(phi * (1 + phi)), Abs(phi) * sqrt(1 + phi))),
        (13, equal(sqrt(VARIANCE), DEVIATION * sqrt(z - 1) * sqrt((z - 1) * (2 * z + 1)))),
        (13, equal(sqrt(VARIANCE), -DEVIATION * (1 - z) * sqrt(2 * z + 1))),
    ],
)
def test_roots_of_what_may_be_negative_are_not_squared(number, statement):
    assert not candidate_for(load(number), 0, statement).verdict.is_proved


def test_the_root_of_a_variance_is_decided():
    right = DEVIATION * (1 - z) * sqrt(2 * z + 1)
    assert candidate_for(load(13), 0, equal(sqrt(VARIANCE), right)).verdict is Verdict.PROVED
    wrong = equal(sqrt(VARIANCE), 2 * right)
    assert candidate_for(load(13), 0, wrong).verdict is Verdict.REFUTED


@pytest.mark.parametrize(
    ("number", "force"),
    [
        (7, sy.ForcePlus(k, l)),
        (8, sy.ForceMinus(sy.site_r, sy.site_s)),
        (9, sy.ForceMinus(k + 1, l - 1)),
        (10, sy.ForcePlus(k - 3, l - 1)),
    ],
)
def test_forces_that_a_load_makes_zero_are_zero(number, force):
    assert candidate_for(load(number), 0, equal(force, sympy.S.Zero)).verdict is Verdict.PROVED


def test_nothing_lies_above_the_surface():
    at = {M: sympy.Integer(3), j: sympy.Integer(2)}
    statement = equal(sy.ForcePlus(i + 1, j + 1), sympy.S.Zero)
    assert candidate_for(load(11), 0, statement, at).verdict is Verdict.PROVED


@pytest.mark.parametrize("side", [sympy.Derivative(z**2, z), sympy.Integral(z, (z, 0, 1))], ids=str)
def test_derivatives_and_integrals_by_z_are_undecided(side):
    assert fd.equation(13).decide(side).verdict is Verdict.UNDECIDED


def test_a_case_that_never_holds_has_no_value():
    form = fd.variance(sy.ForcePlus(i, j))
    ruling = form.decide(sympy.Piecewise((1, False), evaluate=False))
    assert ruling.verdict is Verdict.NOT_A_STATEMENT
