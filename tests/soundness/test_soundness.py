"""False statements that must not be proved, true ones that must not be refuted."""

from collections import Counter
from collections.abc import Callable

import pytest
import sympy
from force_diffusion.derivations.eq11_total_force import in_radii
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict
from force_diffusion.symbolic.symbols import (
    Braces,
    DeltaR,
    ForcePlus,
    M,
    SecondDifference,
    f_load,
    i,
    j,
    m,
    n_x,
    n_y,
    phi,
    r,
    sigma,
    z,
)
from sympy import Eq, Mul, Pow, Rational, Sum, sqrt

import force_diffusion as fd
from tests.properties.mutants import EQUIVALENT
from tests.soundness.corpus import FALSE as FALSE_KINDS
from tests.soundness.corpus import LARGER, statements
from tests.soundness.corpus import TRUE as TRUE_KINDS
from tests.soundness.trial import DERIVED, judged_mutants, source_of

Change = Callable[[sympy.Eq], sympy.Eq]


def on_the_right(change: Callable[[sympy.Expr], sympy.Expr]) -> Change:
    return lambda printed: Eq(printed.lhs, change(printed.rhs), evaluate=False)


def sides(change: Callable[[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]]) -> Change:
    return lambda printed: Eq(*change(printed.lhs, printed.rhs), evaluate=False)


def over_itself(divisor: sympy.Expr) -> Change:
    """The right-hand side times a/a, which has no value where a = 0."""
    one = Mul(divisor, Pow(divisor, -1, evaluate=False), evaluate=False)
    return on_the_right(lambda side: Mul(one, side, evaluate=False))


def plus(term: sympy.Expr) -> Change:
    return on_the_right(lambda side: sympy.Add(side, term, evaluate=False))


DELTA = SecondDifference(i - (j - m), m)
UNIT = (sigma / r) ** 2 / (1 - phi**2) ** 2


def sum_of_deltas(weight: sympy.Expr, high: sympy.Expr) -> Change:
    factor = -1 / (r * (1 - phi**2))
    return on_the_right(lambda _: factor * Sum(weight * DELTA, (m, 1, high)))


FALSE: list[tuple[int, str, Change]] = [
    *((n, "0/0 at z = ½", over_itself(2 * z - 1)) for n in (13, 14)),
    *((n, "0/0 at φ = ¼", over_itself(phi - Rational(1, 4))) for n in (1, 2, 3, 4, 11, 12, 13, 15)),
    *((n, "0/0 at φ = 0", over_itself(phi)) for n in (3, 6, 7, 9, 10, 13, 14, 15, 16)),
    *((n, "0/0 at φ = 0, in n", over_itself(n_x - n_y)) for n in (2, 4, 13)),
    *((n, "0/0 at M = 4", over_itself(M - 4)) for n in (11,)),
    *((n, "0/0 at j = 3", over_itself(j - 3)) for n in (3, 4, 11)),
    (13, "a pole at z = ½", plus(7 * M**2 / (2 * z - 1) * UNIT)),
    (14, "a pole at z = ½", plus(M**2 / (2 * z - 1) ** 2 * UNIT)),
    (13, "a pole at φ = ¼", plus(M**2 / (phi - Rational(1, 4)))),
    (16, "a pole at φ = ¼", plus(1 / (phi - Rational(1, 4)))),
    (13, "as large at z = ½", plus(7 * M**3 / (1 + M**2 * (2 * z - 1) ** 2))),
    (14, "as large at z = ½", plus(7 * M**3 / (1 + M**2 * (2 * z - 1) ** 2))),
    (13, "as large at φ = 0", plus(M**3 / (1 + M**2 * phi**2))),
    (14, "as large at φ = ¼", plus(M**3 / (1 + M * (4 * phi - 1) ** 2))),
    (13, "as large at z = ⅓", plus(M**4 / (M + M**2 * (3 * z - 1) ** 2))),
    (13, "another factor", on_the_right(lambda side: side * (1 + Rational(1, 10**6)))),
    (13, "times 1 + φ", on_the_right(lambda side: side * (1 + phi))),
    (12, "read as a sum to M", sum_of_deltas(Braces(M - j, M - m, m, M), j)),
    (12, "without its upper half", sum_of_deltas(Braces(M - j, M - m, m, j), j)),
    (12, "without its upper half", sum_of_deltas(M - j, j)),
    (12, "a case above the sum", sum_of_deltas(Braces(M - m, M - j, m, M), j)),
    (12, "its second case everywhere", sum_of_deltas(Braces(M - j, M - m, m, sympy.S.Zero), M)),
    (
        15,
        "a negative deviation",
        lambda eq: Eq(eq.lhs, (phi - 1) * M ** Rational(3, 2) * sigma / r),
    ),
    (15, "vanishes at φ = 0", lambda eq: Eq(eq.lhs, phi**2 * M ** Rational(3, 2) * sigma / r)),
    (15, "a pole at φ = 0", lambda eq: Eq(eq.lhs, M ** Rational(3, 2) * sigma / r / phi**2)),
    (15, "one power of √M less", lambda eq: Eq(eq.lhs, M * sigma / r)),
    (15, "a negative root", lambda eq: Eq(eq.lhs, -(M ** Rational(3, 2)) * sigma / r)),
    (6, "times zero", lambda eq: Eq(0 * eq.lhs, 0, evaluate=False)),
    (6, "nothing at φ = 0", lambda eq: Eq(phi * eq.lhs, 0, evaluate=False)),
    *((n, "divided by the index", plus(Sum(DeltaR(i, m) / m, (m, 1, j)))) for n in (11, 12)),
    (3, "divided by the index", plus(Sum(DeltaR(i, m) / m, (m, 1, j)) * sy.b_plus)),
    (12, "over M², of the wrong sign", sides(lambda a, b: (a / M**2, -b / M**2))),
    (12, "over M, five times", sides(lambda a, b: (a / M, 5 * b / M))),
    (12, "one Δ is zero", sides(lambda a, b: (SecondDifference(i, j), sympy.S.Zero))),
    (
        12,
        "a Δ is the next",
        sides(lambda a, b: (SecondDifference(i, j), SecondDifference(i, j + 1))),
    ),
    (12, "a large radius on both sides", sides(lambda a, b: (a + HUGE, 2 * b + HUGE))),
    (12, "0 = 0 at z = ½", sides(lambda a, b: ((2 * j - M) * a, (2 * j - M) * b))),
    (12, "neighbours", sides(lambda a, b: (ForcePlus(i, j) - ForcePlus(i + 2, j), sympy.S.Zero))),
    (13, "depends on l", plus(sy.l * M**2 * UNIT)),
    (13, "as large where z = φ + ½", plus(M**3 / (1 + M * (z - phi - Rational(1, 2)) ** 2))),
    (4, "0/0 at the base", over_itself(j)),
    (10, "a sum over n", plus(Sum(sy.n, (sy.n, 1, 2)) - Sum(sy.n, (sy.n, 1, 3)))),
    (16, "depends on z", plus(z)),
    (16, "as large for j = 0", plus(sy.l**2 / (1 + sy.l * phi**2))),
]

HUGE = M**2 * DeltaR(i, j)
SHADOWED = Sum(Sum(DeltaR(i, m), (m, 1, m)), (m, 1, j))

UNREADABLE: list[tuple[int, str, Change]] = [
    (3, "a shadowed index", plus(SHADOWED * sy.b_plus)),
    (3, "j is free and summed", on_the_right(lambda s: s.xreplace({m: j}))),
    (3, "i is free and summed", on_the_right(lambda s: s.xreplace({m: i}))),
    (12, "a force in a sum", lambda eq: Eq(Sum(ForcePlus(m, j), (m, 1, j)), eq.rhs)),
]

TRUE: list[tuple[int, str, Change]] = [
    *(
        (n, "1 − φ² = 4n_x²n_y²", lambda eq: eq.xreplace({1 - phi**2: 4 * n_x**2 * n_y**2}))
        for n in (4, 7, 8, 9, 10, 11, 12, 13, 14, 16)
    ),
    *(
        (n, "times n_x² + n_y²", on_the_right(lambda side: side * (n_x**2 + n_y**2)))
        for n in (1, 2, 7, 13, 14, 15, 16)
    ),
    (13, "a lower order", plus(M**2 * phi / (n_x * (1 + M)))),
    (13, "a lower order everywhere", plus(M**2 / (1 + z) * UNIT)),
    (13, "a divisor without root", plus(M**4 / (1 + M**2 * (1 + phi**2)) * UNIT)),
    (6, "−2 times", lambda eq: Eq(-2 * eq.lhs, 0, evaluate=False)),
    (6, "1 + φ times, which is not zero", lambda eq: Eq((1 + phi) * eq.lhs, 0, evaluate=False)),
    (15, "(M + 1)√M", lambda eq: Eq(eq.lhs, (M + 1) * sqrt(M) * sigma / r)),
    (15, "a positive factor", lambda eq: Eq(eq.lhs, M ** Rational(3, 2) * sigma / r / (1 - phi))),
    (15, "a positive factor", lambda eq: Eq(eq.lhs, M ** Rational(3, 2) * sigma / r / n_x)),
    (12, "the full count", sum_of_deltas(Braces(M - j, M - m + 1, m, j), M)),
    (12, "M times", sides(lambda a, b: (M * a, M * b))),
    (16, "in steps", lambda eq: eq.xreplace({sy.l: j + sy.p + sy.q})),
    (12, "with the force's unit", lambda eq: eq.xreplace({f_load: f_load})),
]


DEPENDENT: list[tuple[int, str, Change]] = [
    (3, "Eq. 2", lambda eq: load(2).printed[0]),
    (2, "Eq. 3", lambda eq: load(3).printed[0]),
    (1, "from the bead below", lambda eq: Eq(eq.lhs, BELOW + 2 * sy.r * sy.n_plus)),
    (11, "in the radii", on_the_right(in_radii)),
    (3, "at another bead", lambda eq: eq.xreplace({i: i + 2})),
    (12, "Eq. 11", lambda eq: Eq(eq.lhs, load(11).printed[0].rhs - 1, evaluate=False)),
]
"""True for a reason that the decision may not see."""
BELOW = sy.Position(i - 1, j - 1)


@pytest.mark.long(sample=3)
@pytest.mark.parametrize(("number", "change"), [(n, c) for n, _, c in DEPENDENT])
def test_what_is_true_for_another_reason_is_not_refuted(number: int, change: Change) -> None:
    assert ruling(number, change).verdict is not Verdict.REFUTED


def ruling(number: int, change: Change) -> Ruling:
    equation = fd.equation(number)
    return equation.decide(change(load(number).printed[0]))


def named(cases: list[tuple[int, str, Change]]) -> list[object]:
    return [pytest.param(n, change, id=f"{n}: {why}") for n, why, change in cases]


@pytest.mark.parametrize(("number", "change"), named(FALSE + UNREADABLE))
def test_a_false_statement_is_not_proved(number: int, change: Change) -> None:
    found = ruling(number, change)
    assert found.verdict is not Verdict.PROVED, found
    assert found.note


@pytest.mark.parametrize(("number", "change"), named(UNREADABLE))
def test_what_is_outside_of_the_language_is_not_decided(number: int, change: Change) -> None:
    assert ruling(number, change).verdict in (Verdict.UNDECIDED, Verdict.NOT_A_STATEMENT)


@pytest.mark.parametrize(("number", "change"), named(TRUE))
def test_a_true_statement_is_proved(number: int, change: Change) -> None:
    found = ruling(number, change)
    assert found.verdict is Verdict.PROVED, found


def test_an_order_that_fails_at_one_place_is_refuted_by_values() -> None:
    found = ruling(13, plus(7 * M**3 / (1 + M**2 * (2 * z - 1) ** 2)))
    assert found.verdict is Verdict.REFUTED
    assert "j = M/2" in found.note


@pytest.mark.long(share=3)
@pytest.mark.parametrize("number", DERIVED)
def test_the_whole_corpus(number: int | str) -> None:
    """Nothing false is proved; all that is true is."""
    derivation, found = load(number), Counter()
    for part in range(len(derivation.printed)):
        for one in statements(source_of(derivation, part)):
            verdict = derivation.rule_on(part, one.equation, one.where).verdict
            assert (verdict is Verdict.PROVED) is one.holds, one
            found[one.holds, verdict] += 1
    assert sum(found.values()) >= 140
    assert found[False, Verdict.REFUTED] >= 30


@pytest.mark.long
def test_every_kind_is_tried_where_it_can_be() -> None:
    kinds = {one.kind for n in DERIVED for one in statements(source_of(load(n), 0), 0)}
    assert kinds == {LARGER, *FALSE_KINDS, *TRUE_KINDS}
    for number in DERIVED:
        derivation = load(number)
        for part in range(len(derivation.printed)):
            every = list(statements(source_of(derivation, part)))
            some = list(statements(source_of(derivation, part), 5))
            assert {one.kind for one in some} == {one.kind for one in every}
            assert set(some) < set(every)


@pytest.mark.long(sample=2)
@pytest.mark.parametrize("number", DERIVED)
def test_mutants_are_refuted(number: int | str) -> None:
    refuted, equivalent = 0, []
    for mutant, ruling in judged_mutants(load(number)):
        assert ruling.verdict is not Verdict.UNDECIDED, (mutant.change, ruling.note)
        assert ruling.note
        if ruling.verdict is Verdict.PROVED:
            equivalent.append(mutant.change)
        else:
            refuted += 1
    assert refuted >= 5
    assert set(equivalent) == set(EQUIVALENT.get(number, ()))


def test_only_eq_12_drops_an_order_in_which_a_mechanical_change_can_hide() -> None:
    assert {number: len(listed) for number, listed in EQUIVALENT.items()} == {12: 6}
