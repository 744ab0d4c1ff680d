"""Statements that nobody should get proved, of every equation, through ``fd.equation(n).decide``.

The exact forms are the counterpart: true, and never refuted. Nothing here knows how a statement is
decided.
"""

from collections.abc import Callable, Iterator
from itertools import chain
from typing import Any

import pytest
import sympy
from sympy import Add, Eq, Integer, Mul, Pow, Rational, Sum

import force_diffusion as fd

NUMBERS: tuple[int | str, ...] = (*range(1, 17), "B1")
VOCABULARY: dict[str, Any] = {}
"""Every symbol and function of any equation, by its name."""
for number in NUMBERS:
    VOCABULARY |= fd.equation(number).symbols

INDICES = ("i", "j", "k", "l", "m", "n", "p", "q", "site_r", "site_s", "M")
QUANTITIES = ("z", "t", "sigma", "f_load", "m_g", "L_plus", "L_minus")
GEOMETRY = ("r", "spacing", "n_x", "n_y", "phi")
"""What statements in the plane may be written in: n_x and n_y are functions of φ, s = 4rn_x."""
MILLIONTH = Rational(1, 10**6)


def lines(number: int | str) -> tuple[sympy.Eq, ...]:
    printed = fd.equation(number).expr
    return tuple(printed) if isinstance(printed, sympy.Tuple) else (printed,)


def changed(line: sympy.Eq, change: Callable[[sympy.Expr], sympy.Expr]) -> sympy.Eq:
    """The right-hand side changed; where that is zero, one term of the left-hand side."""
    left, right = line.args
    if right:
        return Eq(left, change(right), evaluate=False)
    first, *others = left.args
    return Eq(Add(change(first), *others, evaluate=False), right, evaluate=False)


def times(*factors: sympy.Expr) -> Callable[[sympy.Expr], sympy.Expr]:
    return lambda side: Mul(*factors, side, evaluate=False)


def plus(*terms: sympy.Expr) -> Callable[[sympy.Expr], sympy.Expr]:
    return lambda side: Add(side, *terms, evaluate=False)


def unit(number: int | str) -> sympy.Expr:
    """A vector for an equation of vectors, else 1."""
    of_vectors = {1: "n_plus", 2: "b_plus", 3: "b_plus", 4: "b_plus", 5: "b_plus", 6: "n_plus"}
    return VOCABULARY[of_vectors[number]] if isinstance(number, int) and number < 7 else Integer(1)


def over_itself(one: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """Two factors that cancel, if they are read."""
    return one, Pow(one, -1, evaluate=False)


@pytest.mark.parametrize("number", NUMBERS)
def test_what_is_printed_is_proved(number: int | str) -> None:
    """So that what follows is not true of a checker that proves nothing."""
    for line in lines(number):
        assert fd.equation(number).decide(line).verdict == "proved"


def meddled(number: int | str, symbol: sympy.Symbol) -> Iterator[sympy.Eq]:
    """A symbol multiplied or added where the printed equation has none."""
    for line in lines(number):
        yield changed(line, times(symbol))
        yield changed(line, times(1 + symbol))
        yield changed(line, times(1 + MILLIONTH * symbol**2))


def told_of(number: int | str, symbol: sympy.Symbol) -> Iterator[sympy.Eq]:
    """The same where it may say nothing, or what is of lower order."""
    for line in lines(number):
        for term in (symbol * unit(number), MILLIONTH / symbol * unit(number)):
            yield changed(line, plus(term))
        yield changed(line, times(*over_itself(symbol)))
        one = Mul(*over_itself(symbol), unit(number), evaluate=False)
        yield changed(line, plus(one, -unit(number)))
        yield Eq(*(times(symbol)(side) for side in line.args), evaluate=False)


def names_known_to(number: int | str) -> set[str]:
    """Indices and quantities that it declares; z is j/M wherever there are both."""
    known = {*INDICES, *QUANTITIES} & {*fd.equation(number).symbols}
    return known | {"z"} if {"j", "M"} <= known else known


@pytest.mark.long(sample=27)
@pytest.mark.parametrize("number", NUMBERS)
def test_with_a_symbol_that_is_not_the_equations_it_is_no_statement(number: int | str) -> None:
    strange = {*INDICES, *QUANTITIES} - names_known_to(number)
    assert len(strange) >= 9
    for name in sorted(strange):
        symbol = VOCABULARY[name]
        for candidate in chain(meddled(number, symbol), told_of(number, symbol)):
            found = fd.equation(number).decide(candidate)
            assert found.verdict == "not a statement", (name, candidate, str(found))


@pytest.mark.long(sample=2)
@pytest.mark.parametrize("number", [n for n in NUMBERS if n != 15])
def test_a_factor_in_the_equations_own_symbols_is_not_proved(number: int | str) -> None:
    """Eq. 15 is a proportion, in which factors that hold φ alone are free."""
    for name in sorted({*names_known_to(number), *GEOMETRY}):
        for candidate in meddled(number, VOCABULARY[name]):
            found = fd.equation(number).decide(candidate)
            assert found.verdict != "proved", (name, candidate, str(found))


def test_a_proportion_has_no_factor_that_differs_from_layer_to_layer() -> None:
    z, j, M = (VOCABULARY[name] for name in "zjM")
    for line in lines(15):
        for factor in (z, 1 + z, 1 + z**2, 1 / (1 + z), z / M + 1, j, 1 + j / M, 1 + j**2 / M**2):
            found = fd.equation(15).decide(changed(line, times(factor)))
            assert found.verdict == "not a statement", (factor, str(found))


@pytest.mark.parametrize("name", ["i", "k", "l", "n", "p", "q", "m", "site_r", "site_s"])
def test_a_place_is_no_number_that_a_radius_is_multiplied_by(name: str) -> None:
    """How large i is, against M, Eq. 12 does not say: what it multiplies is not of lower order."""
    i, j, DeltaR = (VOCABULARY[name] for name in ("i", "j", "DeltaR"))
    place, radius = VOCABULARY[name], DeltaR(i, j)
    equation, told = fd.equation(12), "undecided" if name == "i" else "not a statement"
    for term in (place**20 * radius, place * radius, place**2 * DeltaR(i - j, 0), radius / place):
        for line in (changed(lines(12)[0], plus(term)), changed(lines(12)[0], plus(-term))):
            found = equation.decide(line)
            assert found.verdict == told, (term, str(found))
    if name not in ("m", "n"):
        counted = Sum(DeltaR(i, j), (VOCABULARY["n"], 1, place))
        assert equation.decide(changed(lines(12)[0], plus(counted))).verdict == told


WITH_SUMS = [n for n in NUMBERS if any(line.has(Sum) for line in lines(n))]


def sums(number: int | str) -> Iterator[tuple[sympy.Eq, sympy.Sum]]:
    for line in lines(number):
        for series in sorted(line.atoms(Sum), key=str):
            yield line, series


def test_there_are_sums_to_try() -> None:
    assert WITH_SUMS == [3, 4, 5, 11, 12, "B1"]


@pytest.mark.parametrize("number", WITH_SUMS)
def test_a_reversed_sum_is_no_statement(number: int | str) -> None:
    """A loop reads it as empty; by SymPy's convention it is minus the terms in between."""
    for line, series in sums(number):
        (index, low, high), body = series.limits[0], series.function
        whole = (index, high + 1, low - 1)
        for other in (
            -Sum(body, whole),
            series + Sum(body, whole),
            series + Sum(body, (index, high + 3, high)),
            series + Sum(body, (index, low, low - 2)),
            series + Sum(body, (index, 5, 1)),
        ):
            found = fd.equation(number).decide(line.xreplace({series: other}))
            assert found.verdict == "not a statement", (other, str(found))
            assert "sum" in found.note


@pytest.mark.parametrize("number", WITH_SUMS)
def test_a_sum_whose_bounds_may_cross_is_not_proved(number: int | str) -> None:
    """Three too many at an end, taken off again: in a low packing these are not in order."""
    for line, series in sums(number):
        (index, low, high), body = series.limits[0], series.function
        for other in (
            Sum(body, (index, low, high - 9)) + Sum(body, (index, high - 8, high)),
            Sum(body, (index, low, low + 8)) + Sum(body, (index, low + 9, high)),
            series + Sum(body, (index, low + 9, high)) - Sum(body, (index, low + 9, high)),
        ):
            twice = Add(*other.args, evaluate=False) if isinstance(other, Add) else other
            if twice != series:
                found = fd.equation(number).decide(line.xreplace({series: twice}))
                assert found.verdict != "proved", (other, str(found))


@pytest.mark.parametrize("number", [n for n in WITH_SUMS if n != 12])
def test_other_bounds_are_not_proved(number: int | str) -> None:
    """Of Eq. 12 a term at an end is of an order that it drops."""
    for line, series in sums(number):
        (index, low, high), body = series.limits[0], series.function
        for first, last in ((1, 0), (-1, 0), (0, 1), (0, -1), (2, 0), (0, 2), (0, -2), (-1, -1)):
            other = Sum(body, (index, low + first, high + last))
            found = fd.equation(number).decide(line.xreplace({series: other}))
            assert found.verdict != "proved", (other, str(found))


@pytest.mark.parametrize("number", NUMBERS)
def test_a_sum_without_terms_is_no_way_to_write_zero_unless_it_is_one(number: int | str) -> None:
    m = VOCABULARY["m"]
    for line in lines(number):
        reversed_ = Sum(1, (m, 5, 1)) * unit(number)
        factor = 1 + Sum(m, (m, 7, 2))
        for change in (plus(reversed_), times(factor)):
            found = fd.equation(number).decide(changed(line, change))
            assert found.verdict == "not a statement", str(found)


FORMS = [(number, form) for number in NUMBERS for form in fd.equation(number).forms]


@pytest.mark.long(sample=4)
@pytest.mark.parametrize(("number", "name"), FORMS)
def test_an_exact_form_is_proved_and_a_millionth_more_is_not(number: int | str, name: str) -> None:
    form = fd.equation(number).exact(name)
    assert form.decide(form.expr).verdict == "proved"
    if form.expr == 0:
        return
    for factor in (1 + MILLIONTH, 1 - MILLIONTH):
        values = [(value * factor, where) for value, where in pieces(form.expr)]
        wrong = sympy.Piecewise(*values, evaluate=False) if len(values) > 1 else values[0][0]
        assert form.decide(wrong).verdict == "refuted"


def pieces(expr: sympy.Expr) -> list[tuple[sympy.Expr, Any]]:
    return list(expr.args) if expr.is_Piecewise else [(expr, True)]


@pytest.mark.parametrize("number", [13, 14])
def test_to_leading_order_the_interior_alone_is_what_is_printed(number: int) -> None:
    equation = fd.equation(number)
    interior, *edges = equation.exact().pieces
    assert equation.decide(interior.expr).verdict == "proved"
    assert equation.decide(interior.expr * (1 + MILLIONTH)).verdict == "refuted"
    assert edges
    assert all(equation.decide(one.expr).verdict != "proved" for one in edges)


def of_eq_12() -> Iterator[tuple[str, sympy.Eq]]:
    """Statements that are true of little, or of nothing."""
    left, right = fd.equation(12).expr.args
    force = left + 1
    i, j, M, z, m = (VOCABULARY[name] for name in ("i", "j", "M", "z", "m"))
    radius = VOCABULARY["DeltaR"](i, j)
    one_layer = {i: i + j, j: Integer(6)}
    yield "one layer", Eq(*(side.xreplace(one_layer) for side in (left, right)), evaluate=False)
    yield "nothing", Eq(Integer(0), Integer(0), evaluate=False)
    yield "f ≈ f", Eq(force, force, evaluate=False)
    yield "f ≈ f and a radius", Eq(force, force + radius, evaluate=False)
    yield "nothing at z = ½", Eq((2 * z - 1) * left, (2 * z - 1) * right, evaluate=False)
    yield "0/0 at z = ½", Eq(left, times(*over_itself(2 * z - 1))(right), evaluate=False)
    over = Mul(2 * z - 1, Pow(2 * j / M - 1, -1), right, evaluate=False)
    yield "0/0 at j = M/2", Eq(left, over, evaluate=False)
    yield "a pole at j = 7", Eq(left, right + radius / (j - 7), evaluate=False)
    yield "half the sum", Eq(left, right / 2, evaluate=False)
    yield "hidden by a large part", Eq(left + M**9 * radius, M**9 * radius, evaluate=False)
    yield "a sum that is reversed", Eq(left, right + radius * Sum(1, (m, M, 2)), evaluate=False)


@pytest.mark.parametrize("candidate", [pytest.param(one, id=name) for name, one in of_eq_12()])
def test_what_says_less_than_eq_12_is_not_proved(candidate: sympy.Eq) -> None:
    found = fd.equation(12).decide(candidate)
    assert found.verdict != "proved", str(found)


@pytest.mark.parametrize("number", [13, 14])
def test_what_is_lost_in_the_limit_of_a_variance_is_not_hidden(number: int) -> None:
    left, right = fd.equation(number).expr.args
    M, z, phi = (VOCABULARY[name] for name in ("M", "z", "phi"))
    half = 2 * z - 1
    for hidden in (
        Eq(half * left, half * right, evaluate=False),
        Eq(left, times(*over_itself(half))(right), evaluate=False),
        Eq(left, right * (1 + 1 / (half * M + Rational(1, 2))), evaluate=False),
        Eq(left * phi, right * phi, evaluate=False),
        Eq(left**2, right**2, evaluate=False),
        Eq(left, left, evaluate=False),
        Eq(left - right, left - right, evaluate=False),
        Eq(left, right + MILLIONTH * left, evaluate=False),
        Eq(left, right * (1 + MILLIONTH * z * (1 - z)), evaluate=False),
    ):
        found = fd.equation(number).decide(hidden)
        assert found.verdict != "proved", (hidden, str(found))
    same = Eq(left, right * (1 + 10**6 / M), evaluate=False)
    assert fd.equation(number).decide(same).verdict == "proved"


LARGE = 10**300
IN_M = [13, 14, "B2", "B3", "B11", "B13", "B14", "B20"]


@pytest.mark.parametrize("number", IN_M)
def test_a_large_factor_of_a_lower_order_is_no_counterexample(number: int | str) -> None:
    """It vanishes at one large M, and counts for much at its square."""
    M, r, sigma = (VOCABULARY[name] for name in ("M", "r", "sigma"))
    lower = LARGE * M * (M - 10**100) * (sigma / r) ** 2
    equation = fd.equation(number)
    for line in lines(number):
        assert equation.decide(changed(line, plus(lower))).verdict == "proved"
        other = changed(line, plus(lower * M / 10**310))
        assert equation.decide(other).verdict == "refuted"


@pytest.mark.long
def test_a_large_number_beside_m_is_still_in_proportion() -> None:
    M, r, sigma = (VOCABULARY[name] for name in ("M", "r", "sigma"))
    equation = fd.equation(15)
    deviation, _ = lines(15)
    same = Eq(deviation.lhs, (M + 10**80) * sympy.sqrt(M) * sigma / r)
    assert equation.decide(same).verdict == "proved"
    for other in (same.rhs * M, same.rhs / M, same.rhs * (M + LARGE), same.rhs / sigma):
        assert equation.decide(Eq(deviation.lhs, other)).verdict == "refuted"


def tower(base: sympy.Expr) -> sympy.Expr:
    """A power of a power of a power, none of which is high."""
    for _ in range(4):
        base = Pow(base, 40, evaluate=False)
    return base


def doubled(one: sympy.Expr) -> sympy.Expr:
    """2¹¹⁰⁰ times the same, in a tree of 1100 nodes."""
    for _ in range(1100):
        one = Add(one, one, evaluate=False)
    return one


@pytest.mark.parametrize("number", [12, 13, 15, 16, "B4", "B7", "B9", "B12", "B19"])
def test_what_would_take_for_ever_is_left_open(number: int | str) -> None:
    """Each of these would fill the memory, or Python would refuse to show how large it is."""
    line, r = lines(number)[0], VOCABULARY["r"]
    every = sum(by_hand := sorted(line.rhs.free_symbols, key=str), r + 1)
    assert len(by_hand) > 2
    for change in (
        times(tower(Integer(2))),
        plus(tower(1 + r)),
        plus(doubled(r)),
        plus(every**40, -(Integer(3) ** 40) * (every + VOCABULARY["spacing"]) ** 39),
    ):
        assert fd.equation(number).decide(changed(line, change)).verdict != "proved"


def steps_of(number: int | str, words: str) -> list[tuple[Any, sympy.Eq]]:
    """Its steps that hold these words, with what they show."""
    found = [step for step in fd.equation(number).steps() if words in str(step.formula)]
    return [(step, step.equations[0]) for step in found]


@pytest.mark.parametrize("words", ["Derivative((", "f_rel", "tensile", "Integral(sqrt"])
def test_what_sympy_cancels_in_a_step_of_eq_15_is_not_proved(words: str) -> None:
    z, phi, n_x, n_y = (VOCABULARY[name] for name in ("z", "phi", "n_x", "n_y"))
    half = (1 + Mul(*over_itself(2 * z - 1), evaluate=False)) / 2
    v = sympy.Symbol("v", positive=True)
    for step, shown in steps_of(15, words):
        assert step.rule_on(0, shown).verdict.is_proved
        for inside in (shown.lhs, shown.rhs):
            for one in inside.atoms(sympy.Derivative, sympy.Integral, sympy.erfc):
                for change in (
                    times(*over_itself(2 * z - 1)),
                    times(*over_itself(phi)),
                    times(half),
                    plus(1 / (phi - Rational(1, 4))),
                    plus(sympy.Piecewise((0, z < Rational(1, 2)), (1, True))),
                ):
                    args = (change(one.args[0]), *one.args[1:])
                    image = {one: one.func(*args)}
                    candidate = Eq(*(side.xreplace(image) for side in shown.args), evaluate=False)
                    if candidate != shown:
                        assert not step.rule_on(0, candidate).verdict.is_proved, candidate
        for change in (times(*over_itself(v - 1)), times(*over_itself(phi))):
            assert not step.rule_on(0, changed(shown, change)).verdict.is_proved
        for slope, by in ((n_x, phi), (n_y**2 - n_x**2, phi), (z, VOCABULARY["j"])):
            false = Eq(sympy.Derivative(slope, by), Integer(0), evaluate=False)
            assert not step.rule_on(0, false).verdict.is_proved


@pytest.mark.long
def test_a_root_that_no_one_factors_is_left_open() -> None:
    """The product of two primes of 39 digits."""
    hard = Integer(sympy.nextprime(10**38) * sympy.nextprime(3 * 10**38))
    for step, shown in steps_of(15, "Integral(sqrt"):
        for term in (Pow(hard, Rational(1, 2), evaluate=False), Pow(2, Rational(10**9 + 1, 2))):
            candidate = Eq(shown.lhs, Add(shown.rhs, term, evaluate=False), evaluate=False)
            assert step.rule_on(0, candidate).verdict == "undecided"
