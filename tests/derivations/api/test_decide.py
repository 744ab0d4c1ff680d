"""``decide`` takes whatever is an equation: all lines, one, a component, an exact form."""

import re
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.api.equation import Equation
from force_diffusion.derivations.framework.catalogue import modules, paper
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import times
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, all_of, proved, refuted
from force_diffusion.symbolic.trees import equation as equal
from sympy import Rational, Tuple

import force_diffusion as fd
from tests.derivations import fakes
from tests.derivations.rows import late

BEYOND = [number for number in modules() if number not in paper()]
OF_VECTORS = (1, 2, 3, 4, 5, 6)
MILLIONTH = Rational(1, 10**6)


@pytest.mark.parametrize("number", [7, *late([8, 15])])
def test_all_lines_at_once_and_none_is_left_out(number):
    eq = fd.equation(number)
    lines = list(eq.expr)
    for whole in (eq.expr, eq.rhs, tuple(lines), list(eq.rhs), Tuple(*reversed(lines))):
        assert eq.decide(whole).verdict is Verdict.PROVED, whole
    last = lines[-1]
    for wrong in (equal(last.lhs, -last.rhs), -last.rhs):
        assert eq.decide((*lines[:-1], wrong)).verdict is Verdict.REFUTED
    for line in lines:
        assert eq.decide(line.rhs).verdict is Verdict.PROVED
    for some in (lines[:1], [*lines, lines[0]], ()):
        ruling = eq.decide(some)
        assert ruling.verdict is Verdict.NOT_A_STATEMENT
        assert f"{len(lines)} lines" in ruling.note
    assert not eq.decide([lines[0]] * len(lines)).verdict.is_proved


IN_CASES = {
    Verdict.PROVED: (lambda right: [(right, sy.j >= 5), (0, True)],
                     lambda right: [(2 * right, sy.j < 3), (right, True)]),
    Verdict.REFUTED: (lambda right: [(right, sy.j <= 5), (0, True)],
                      lambda right: [(2 * right, sy.j >= 5), (right, True)]),
    Verdict.UNDECIDED: (lambda right: [(right, 2 * sy.j >= sy.M), (0, True)],
                        lambda right: [(right, sy.i >= 0), (0, True)],
                        lambda right: [(right, sy.M <= 10**6), (0, True)],
                        lambda right: [(right, sy.j < 3)]),
}  # fmt: skip


@pytest.mark.parametrize(
    ("verdict", "cases"), [(verdict, cases) for verdict in IN_CASES for cases in IN_CASES[verdict]]
)
def test_a_limit_takes_the_case_that_holds_all_the_way(verdict, cases):
    eq = fd.equation(13)
    assert eq.decide(sympy.Piecewise(*cases(eq.rhs))).verdict is verdict


@pytest.mark.parametrize("index", [sy.k, sympy.Symbol("m"), sympy.Symbol("s", integer=True)])
def test_a_sum_runs_over_any_index(index):
    unit = (sy.sigma / sy.r) ** 2 / (1 - sy.phi**2) ** 2
    weights = sympy.Sum(12 * index * (sy.M - index), (index, sy.j + 1, sy.M))
    assert fd.equation(13).decide(unit * weights).verdict is Verdict.PROVED
    assert fd.equation(13).decide(unit * weights / 2).verdict is Verdict.REFUTED
    assert not fd.equation(13).decide(unit * weights * index).verdict.is_proved


def test_a_tuple_of_one_is_the_one_line():
    eq = fd.equation(13)
    assert eq.decide(Tuple(eq.expr)).verdict is Verdict.PROVED
    assert eq.decide((eq.expr, eq.expr)).verdict is Verdict.NOT_A_STATEMENT
    assert eq.decide([[eq.expr]]).verdict is Verdict.NOT_A_STATEMENT


DIRECTIONS = (sy.e_x, *sy.VECTORS)


@pytest.mark.long(sample=7)
@pytest.mark.parametrize("number", OF_VECTORS)
@pytest.mark.parametrize("vector", DIRECTIONS, ids=str)
def test_a_component_of_an_equation_between_vectors(number, vector):
    eq = fd.equation(number)
    left, right = eq.expr.args
    along = equal(sy.Dot(vector, left), sy.Dot(vector, right) if right else right)
    assert eq.decide(along).verdict is Verdict.PROVED
    doubled = equal(2 * along.lhs, 2 * along.rhs)
    assert eq.decide(doubled).verdict is Verdict.PROVED
    radius = sy.DeltaR(*next(iter(left.atoms(sy.SiteFunction))).args)
    more = equal(along.lhs, along.rhs + MILLIONTH * radius)
    assert eq.decide(more).verdict is Verdict.REFUTED, vector


@pytest.mark.long(sample=3)
@pytest.mark.parametrize("number", OF_VECTORS)
def test_one_component_is_not_another(number):
    eq = fd.equation(number)
    left, right = eq.expr.args
    if right:
        mixed = equal(sy.Dot(sy.e_y, left), sy.Dot(sy.e_x, right))
        assert eq.decide(mixed).verdict is Verdict.REFUTED
    one_sided = equal(sy.Dot(sy.e_y, left) * sy.e_y, right)
    assert not eq.decide(one_sided).verdict.is_proved


_TOO_LOW = sympy.Sum(1, (sy.m, 1, sy.j - 3)) + sy.j + 1


def over_itself(factor: sympy.Expr, side: sympy.Expr) -> sympy.Expr:
    """The side, but without a value where the factor has none or vanishes."""
    return sympy.Mul(factor, sympy.Pow(factor, -1), side, evaluate=False)


NO_STATEMENTS: list[tuple[int | str, str, Callable[[sympy.Eq], Any]]] = [
    (3, "may be zero", lambda eq: equal(eq.lhs, over_itself(sy.j - 3, eq.rhs))),
    (13, "may be zero", lambda eq: equal(eq.lhs, over_itself(3 * sy.z - 1, eq.rhs))),
    (11, "more than one", lambda eq: equal(eq.lhs, over_itself(_TOO_LOW, eq.rhs))),
    (3, "a number", lambda eq: equal(eq.lhs, eq.rhs + 1)),
    (13, "not a number", lambda eq: sympy.oo),
    (13, "may be zero", lambda eq: sympy.Pow(0, -1, evaluate=False)),
    (13, "this M is not that of the equation", lambda eq: eq.rhs * sympy.Symbol("M") / sy.M),
]  # fmt: skip


@pytest.mark.parametrize(("number", "reason", "make"), NO_STATEMENTS)
def test_what_has_no_value_is_not_a_statement(number, reason, make):
    eq = fd.equation(number)
    line = eq.expr[0] if isinstance(eq.expr, Tuple) else eq.expr
    ruling = eq.decide(make(line))
    assert ruling.verdict is Verdict.NOT_A_STATEMENT, ruling
    assert reason in ruling.note


NOT_READ = [
    sympy.Float(2.5), sympy.I, sympy.sin(sy.phi), sympy.Derivative(sy.phi**2, sy.phi),
    sympy.Integral(sy.phi, sy.phi), sympy.Piecewise((sy.phi, sy.phi > 0), (1, True)),
    sympy.Order(sy.phi), sympy.UnevaluatedExpr(sy.phi),
]  # fmt: skip
NEVER_PROVED = [
    sy.MatrixTimes(1, 2, 3, 4, 5), sy.M**sy.M, sympy.sqrt(sy.M), sympy.Wild("a"), sy.M**1000,
    sympy.Dummy("M"), sympy.Sum(sy.Braces(sy.M, 1, sy.m, sy.j), (sy.m, 1, sy.M)), sy.n_plus,
    sy.DeltaR(1, 2), 1 / (1 - sy.z),
]  # fmt: skip


def test_what_depends_on_an_index_unseen_is_not_summed_over_it():
    """A moment depends on σ, φ, r and M; cases may depend on an index over which is averaged."""
    form = fd.variance(sy.ForcePlus(sy.i, sy.j))
    for symbol in (sy.sigma, sy.phi, sy.r, sy.M, sy.j):
        ruling = form.decide(sympy.Sum(form.statistic / 2, (symbol, 1, 2)))
        assert ruling.verdict is Verdict.NOT_A_STATEMENT, symbol
    assert form.decide(sympy.Sum(form.statistic / 2, (sympy.Symbol("a"), 1, 2))).verdict.is_proved
    cases = sympy.Piecewise((sy.i, sympy.Eq(sy.i, 0)), (1, True))
    ruling = fd.mean(sy.ForcePlus(sy.i, sy.j)).decide(sy.MeanOver(cases, 2, sy.i))
    assert ruling.verdict is Verdict.UNDECIDED
    assert "cases depend on i, which is summed or averaged over" in ruling.note


def test_symbols_that_units_or_divisors_cancel_are_no_names_of_the_quantity():
    force, (a, b) = sy.ForcePlus(sy.i, sy.j), sympy.symbols("a b")
    for observable, load in (
        (force / sy.n_y, "surface"), (force * (sy.M - sy.j), "bulk"), (force * sy.m_g, "bulk"),
        (force / ((1 - a) * (1 - b)), "surface"), (sy.ForceMinus(sy.i, sy.j), fd.leaning(sy.t)),
    ):  # fmt: skip
        form = fd.mean(observable, load=load)
        assert form.decide(form.expr).verdict.is_proved
        assert form.decide(2 * form.expr).verdict is Verdict.REFUTED
    circle = equal(sy.n_x**2 + sy.n_y**2, 1)
    assert fd.variance(force / sy.n_y).decide(circle).verdict.is_proved


def test_moments_of_others_are_not_read_where_quantities_have_units():
    form, other = fd.variance(sy.ForcePlus(sy.i, sy.j)), sy.Variance(sy.ForcePlus(sy.i + 2, sy.j))
    for candidate in (other, equal(form.quantity, 4 * sy.n_y**2 / sy.f_load**2 * other)):
        ruling = form.decide(candidate)
        assert ruling.verdict is Verdict.UNDECIDED
        assert "forces over their ordered values: give the closed forms" in ruling.note


def test_what_has_no_value_stays_without_one():
    form, a, j = fd.mean(sy.ForcePlus(sy.i, sy.j)), sympy.Symbol("a"), sy.j
    cancels = sympy.Mul(sympy.Sum(1, (a, 1, 1)), j - 1, 1 / (j - 1), evaluate=False)
    assert form.decide(cancels).verdict is Verdict.NOT_A_STATEMENT
    nested = sympy.Piecewise((sympy.Piecewise((1, j >= 3)), j >= 1), (1, True))
    assert form.decide(nested).verdict is Verdict.NOT_A_STATEMENT
    leaning = fd.variance(sy.ForcePlus(sy.i, sy.j), load=fd.leaning(sy.t))
    factors = sy.L_minus, 1 / sy.L_minus, j - 1, 1 / (j - 1), leaning.expr
    product = sympy.Mul(*factors, evaluate=False)
    assert leaning.decide(product).verdict is Verdict.NOT_A_STATEMENT
    assert leaning.decide(equal(sy.L_minus, sy.t * sy.L_plus)).verdict.is_proved
    first, second = sympy.symbols("A B", commutative=False)
    nothing = first * second - second * first
    assert fd.equation(11).decide(fd.equation(11).rhs + nothing).verdict is Verdict.NOT_A_STATEMENT


def test_several_functions_in_pieces_are_read_together():
    plus, minus = sy.ForcePlus(sy.i, sy.j), sy.ForceMinus(sy.i, sy.j)
    form, both = fd.variance(plus - minus), fd.covariance(plus, minus).expr
    each = fd.variance(plus).expr + fd.variance(minus).expr
    assert form.decide(each - 2 * both).verdict is Verdict.PROVED
    assert form.decide(each - 3 * both).verdict is Verdict.REFUTED


def test_sums_go_over_indices_that_are_free():
    eq = fd.equation(12)
    for index in (sy.k, sy.q, sympy.Symbol("a")):
        assert eq.decide(eq.rhs.xreplace({sy.m: index})).verdict.is_proved


def test_a_limit_that_may_be_one_is_not_refuted():
    eq = fd.equation(15)
    for line in eq.expr:
        candidate = equal(line.lhs, line.rhs * (1 + sy.H_M) / sy.H_M)
        assert eq.decide(candidate).verdict is Verdict.UNDECIDED


@pytest.mark.parametrize("number", [3, 13, 15, *late([12])])
def test_unreadable_candidates_are_undecided_with_the_reason(number):
    for candidate in NOT_READ + NEVER_PROVED:
        ruling = fd.equation(number).decide(candidate)
        assert ruling.note
        assert not ruling.verdict.is_proved, candidate
        assert ruling.verdict is Verdict.UNDECIDED or candidate in NEVER_PROVED, candidate


def test_the_note_names_the_line_compared_or_asks_for_it():
    first, second = fd.equation(7).expr
    assert "f⁺_(k−1,l−1)" in fd.equation(7).decide(first.rhs).note  # which is proved for it
    assert "f⁻_(k+1,l−1)" in fd.equation(7).decide(second.rhs).note
    assert fd.equation(7).decide(equal(first.lhs, second.rhs)).verdict is Verdict.REFUTED
    ruling = fd.equation(7).decide(sympy.sin(sy.phi))
    assert ruling.verdict is Verdict.UNDECIDED
    assert "f⁺_(k−1,l−1) or f⁻_(k+1,l−1)" in ruling.note


NO_EQUATIONS = [
    *((value, f"is needed, not {type(value).__name__}") for value in ("1-z", None, object(), b"1")),
    *((value, "made it from an Eq, write Eq(left, right, evaluate=False)")
      for value in (True, sympy.true, sympy.Eq(1, 2))),
    *((value, "") for value in (sympy.Matrix([[sy.M]]), sy.M < 3, sympy.S.EmptySet, (), [[sy.M]])),
]  # fmt: skip


@pytest.mark.parametrize(("given", "says"), NO_EQUATIONS)
def test_what_is_no_equation_is_refused_by_its_type(given, says):
    for ask in (fd.equation(13).decide, fd.equation(13).exact().decide):
        ruling = ask(given)
        assert ruling.verdict is Verdict.NOT_A_STATEMENT
        assert ruling.note
        assert says in ruling.note


SWAPPED = {sy.b_plus: sy.b_minus, sy.b_minus: sy.b_plus}
REFUTED = [
    (1, lambda eq: 2 * eq.rhs, "at i = −2, j = 0: along n⁺, left minus right is 2 r (1 − φ)"),
    (4, lambda eq: eq.rhs.xreplace(SWAPPED), "at i = −1, j = 1: along n⁺, "),
    (12, lambda eq: 2 * eq.rhs, "the variance of left minus right goes as M³, and has to be of l"),
    (13, lambda eq: eq.rhs * (1 + Rational(1, 10**3000)), "to an expression of 6003 characters"),
    (15, lambda eq: equal(eq.expr[0].lhs, sy.M**2 * sy.sigma / sy.r),
     "as M → ∞, left over right, to the power 2, varies as 1/[M (1 − φ²)²], and not with φ alone"),
]  # fmt: skip


@pytest.mark.parametrize(("number", "make", "says"), REFUTED)
def test_a_refutation_says_what_differs_and_where(number, make, says):
    eq = fd.equation(number)
    ruling = eq.decide(make(eq))
    assert ruling.verdict is Verdict.REFUTED
    assert says in ruling.note


def test_roots_of_an_exact_form_are_decided_by_their_squares():
    """Of a root that is multiplied by −1 nothing is said."""
    form = fd.equation(13).exact()
    left, right = sympy.sqrt(form.quantity), sympy.sqrt(form.expr)
    assert form.decide(equal(left, right)).verdict is Verdict.PROVED
    ruling = form.decide(equal(left, sympy.sqrt(2) * right))
    assert ruling.verdict is Verdict.REFUTED
    assert ruling.note.startswith("both sides squared: at j = ")
    assert form.decide(equal(left, -right)).verdict is Verdict.UNDECIDED
    two = sympy.sqrt(form.pieces[0].expr) * sympy.sqrt(sy.j - 5) / sympy.sqrt(sy.j - 5)
    assert form.decide(equal(left, two), M=12, j=4).verdict is not Verdict.REFUTED


def test_at_one_height_its_harmonic_number_is_a_number():
    form = fd.equation(15).exact("bulk")
    value = form.on(sy.M >= 3).subs({sy.M: 7, sy.H_M: Rational(363, 140)})
    assert form.decide(value, M=7).verdict is Verdict.PROVED
    assert form.decide(value, M=8).verdict is Verdict.REFUTED


def test_t_is_also_the_ratio_of_both_components_of_a_load():
    form = fd.equation("B2").exact()
    ratio = sy.L_minus / sy.L_plus
    assert form.decide(form.expr.xreplace({sy.t: ratio})).verdict is Verdict.PROVED
    assert form.decide(form.expr.xreplace({sy.t: 1 / ratio})).verdict is Verdict.REFUTED


def test_large_numbers_are_too_large_and_many_terms_are_not():
    eq = fd.equation(13)
    terms = (sy.z**n / (n * (1 - sy.phi**2) ** (n % 4)) for n in range(1, 300))
    assert eq.decide(eq.rhs + sympy.Add(*terms)).verdict is Verdict.PROVED  # of a lower order
    power = sympy.Pow(sympy.Pow(Rational(3, 2), 300, evaluate=False), 300, evaluate=False)
    ruling = eq.decide(eq.rhs * (1 + power))
    assert ruling.verdict is Verdict.UNDECIDED
    assert "may hold numbers of more than 50000 bits" in ruling.note


# exact forms


@pytest.mark.parametrize("number", [13, 14, 15, *late((16, *BEYOND), share=6)])
def test_exact_forms_are_decided_on_their_own(number):
    equation = fd.equation(number)
    for form in map(equation.exact, equation.forms):
        left, right = form.equation.args
        same = [form.equation, right, equal(right, left)]
        if form.divisor == 1:  # else both sides are divided by what may vanish
            same.append(equal(times(2, left), times(2, right)))
        asked = (*same, form, (form.equation,), right * sy.phi / sy.phi)
        # a long form takes seconds
        for candidate in asked if len(form.pieces) < 10 else (form, right):
            ruling = form.decide(candidate)
            assert ruling.verdict is Verdict.PROVED, ruling
        factors = (1 + MILLIONTH, -1) if right else ()  # zero, times anything, is the same
        for wrong in (right + MILLIONTH, *(right * factor for factor in factors)):
            ruling = form.decide(wrong)
            assert ruling.verdict is Verdict.REFUTED, ruling
            assert ruling.note.startswith("at ")
        assert form.decide(right + sympy.Symbol("y")).verdict is Verdict.NOT_A_STATEMENT


def test_one_formula_is_refuted_at_a_place_that_tells_it_apart():
    form = fd.equation(13).exact()
    at = {"phi": Fraction(1, 7), "sigma": 1, "r": 1}
    for piece in form.pieces:
        ruling = form.decide(piece.expr)
        assert ruling.verdict is Verdict.REFUTED
        layer, height = map(int, re.match(r"at j = (\d+), M = (\d+): ", ruling.note).groups())
        values = {sy.M: height, sy.j: layer, sy.phi: Rational(1, 7), sy.sigma: 1, sy.r: 1}
        assert form.at(M=height, j=layer, **at) != piece.expr.xreplace(values)


def test_a_difference_that_vanishes_along_a_line_is_found_off_it():
    form = fd.mean(sy.ForcePlus(sy.i, sy.j), order=2, where=(sy.j >= 2, sy.j <= sy.M - 3))
    for factors in ((1, 2), (2, 3), (2, 3, 4)):
        apart = sy.phi * sympy.Mul(*(sy.j - zero for zero in factors)) * (sy.sigma / sy.r) ** 2
        assert form.decide(form.expr + apart).verdict is Verdict.REFUTED


def test_the_printed_form_is_not_the_exact_one():
    """Eq. 13 is proved with its own sign, ∼, and refuted with "="."""
    eq, form = fd.equation(13), fd.equation(13).exact()
    assert form.decide(eq.rhs).verdict is Verdict.REFUTED
    for same in (eq.rhs, form, form.pieces[0].expr):
        assert eq.decide(same).verdict is Verdict.PROVED
    for other in (2 * form.expr, fd.equation(14).exact()):
        assert eq.decide(other).verdict is Verdict.REFUTED


def test_a_leading_order_is_that_of_the_exact_form():
    """By comparison with it, and not by a search: so without a root, which is not read."""
    eq = fd.equation(13)
    for factor, note in (
        (1 + 2 * sy.z, "left over right goes to 1/(2 z + 1), not to 1"),
        (1 / sy.M, "left minus right goes as "),
        (sympy.S.Zero, "left minus right goes as "),
    ):
        ruling = eq.decide(factor * eq.rhs)
        assert ruling.verdict is Verdict.REFUTED
        assert note in ruling.note
    ruling = eq.decide(sympy.sqrt(2) * eq.rhs)
    assert ruling.verdict is Verdict.UNDECIDED
    assert "√2 is not a rational function" in ruling.note


def test_a_divisor_must_not_vanish_anywhere_in_the_domain():
    form = fd.equation(13).exact("layer")
    inside = form.pieces[0].expr
    for divisor, verdict in (
        (sy.M - sy.j, Verdict.REFUTED),
        (sy.j + 1, Verdict.REFUTED),
        (sy.j, Verdict.NOT_A_STATEMENT),
        (sy.M - sy.j - 1, Verdict.NOT_A_STATEMENT),
        (sy.M + 5 * sy.phi * sy.j, Verdict.NOT_A_STATEMENT),
        (1 - sy.phi, Verdict.REFUTED),
        (1 - 3 * sy.phi, Verdict.NOT_A_STATEMENT),
    ):
        once = sympy.Mul(inside, divisor, sympy.Pow(divisor, -1), evaluate=False)
        assert form.decide(once).verdict is verdict, divisor


def test_pieces_that_leave_a_part_of_the_domain_out_are_no_statement():
    form = fd.equation(13).exact()
    some = sympy.Piecewise(*form.expr.args[:-1], evaluate=False)
    ruling = form.decide(some)
    assert ruling.verdict is Verdict.NOT_A_STATEMENT
    assert ruling.note == "it has no value for M = 1"


def test_pieces_within_pieces_are_read_from_outside():
    form = fd.equation(13).exact()
    for factor, verdict in ((1, Verdict.PROVED), (2, Verdict.REFUTED)):
        within = factor * form.expr
        for bound in range(6):
            within = sympy.Piecewise((within, sy.j >= -bound), (0, True), evaluate=False)
        assert form.decide(within).verdict is verdict


def test_z_stands_for_the_height_of_a_layer():
    form = fd.equation(13).exact()
    in_z = form.pieces[0].expr.subs(sy.j, sy.z * sy.M)
    candidate = sympy.Piecewise((in_z, form.expr.args[0][1]), *form.expr.args[1:], evaluate=False)
    assert form.decide(candidate).verdict is Verdict.PROVED


def test_a_quantity_is_the_same_on_both_sides():
    """Here the variance of a force over its mean."""
    form = fd.variance(sy.ForcePlus(sy.i, sy.j))
    rest = 2 * form.expr - form.quantity
    for side, verdict in ((rest, Verdict.PROVED), (2 * rest, Verdict.REFUTED)):
        assert form.decide(equal(form.quantity, side)).verdict is verdict
    shift = fd.equation("B5").exact()  # a symbol less 1
    both = equal(shift.quantity, 2 * shift.expr - shift.quantity)
    assert shift.decide(both).verdict is Verdict.PROVED


def test_a_statistic_is_its_quantity_times_the_divisor():
    """Eq. B18 divides by 1 − t, and what is divided is not the quotient."""
    form = fd.equation("B18").exact("shear_surface")
    assert form.decide(equal(form.quantity, form.expr)).verdict is Verdict.PROVED
    assert not form.decide(equal(form.statistic, form.expr)).verdict.is_proved


def test_cases_within_a_sum_are_read_unless_they_depend_on_its_index():
    form = fd.equation(13).exact()
    for bound, verdict in ((sy.j, Verdict.REFUTED), (sy.m, Verdict.UNDECIDED)):
        cases = sympy.Piecewise((1, bound <= 3), (0, True))
        assert form.decide(sympy.Sum(cases, (sy.m, 1, sy.M))).verdict is verdict


# what is assumed


def test_an_assumption_is_named_wherever_it_is_used():
    eq = Equation(fakes.ASSUMED)
    ruling = eq.decide(eq.expr)
    assert ruling.verdict is Verdict.ASSUMING
    assert ruling.assuming == (fakes.GUESS,)
    assert str(ruling).startswith(f"proved, assuming {fakes.GUESS}: by a guess")


def test_assumptions_add_up():
    both = all_of(proved("a", ("one",)), proved("b", ("two", "one")), proved("c"))
    assert both.words == "proved, assuming one and two"
    assert all_of(proved("a"), proved("b"), proved("a")) == proved("a; b")
    undecided = Ruling(Verdict.UNDECIDED, "b")
    assert all_of(proved("a"), undecided) == undecided
    assert all_of(proved("a"), undecided, refuted("c")) == refuted("c")
    for verdict, assuming in ((Verdict.PROVED, ("x",)), (Verdict.ASSUMING, ())):
        with pytest.raises(ValueError, match="assumptions"):
            Ruling(verdict, "", assuming)


def test_the_note_on_decimals_says_what_to_write_instead():
    eq = fd.equation(13)
    M = eq.symbols["M"]
    for candidate, decimal in ((1.5 * M, 1.5), (M + 0.1, 0.1), (M**2.5, 2.5), (1e200 * M, 1e200)):
        assert eq.decide(candidate).note == (
            f"it holds the decimal {decimal!r}: write exact numbers, such as Rational(3, 2) for 1.5"
        )
