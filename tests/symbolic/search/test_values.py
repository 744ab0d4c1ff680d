"""Expressions at explicit values: each kind of node, and what has no value."""

from fractions import Fraction

import pytest
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.search.counterexample import WORLDS
from force_diffusion.symbolic.search.dual import Dual, TooLargeError, Vector
from force_diffusion.symbolic.search.packing import AbsentError, Packing, given
from force_diffusion.symbolic.search.values import (
    MOST_TERMS,
    Budget,
    Evaluator,
    NoSumError,
    NotWholeError,
    NoValueError,
    UnreadableError,
)
from force_diffusion.symbolic.symbols import (
    Braces,
    DeltaR,
    Dot,
    ForceMinus,
    ForcePlus,
    M,
    MatrixTimes,
    SecondDifference,
    i,
    j,
    k,
    m,
    n,
    phi,
    r,
)
from hypothesis import given as examples
from hypothesis import strategies as st
from sympy import Integer, Pow, Rational, Sum

WORLD = WORLDS[0]
AT = {i: 1, j: 3, M: 5}
x, y = WORLD.n
NUMBERS = {phi: y**2 - x**2, sy.n_x: x, sy.n_y: y, r: WORLD.radius, **AT}
PACKING = Packing(WORLD.geometry, given("surface", (5,), Fraction(2), Fraction(3)))


def value(expression: sympy.Basic) -> Dual | Vector:
    return Evaluator(PACKING, NUMBERS).value(expression)


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        (j * (M - 1) - Rational(1, 2), Fraction(23, 2)),
        (phi + x**2, y**2),
        (Pow(j - 1, -3), Fraction(1, 8)),
        (Pow(j, 0, evaluate=False), 1),
        (Sum(m**2, (m, 1, j)), 14),
        (Sum(m, (m, j, j)), 3),
        (Sum(m, (m, j, j - 1)), 0),
        (Sum(m * n, (m, 1, n), (n, 1, j)), 25),  # the last limit is the outer one
        (Sum(Sum(m, (m, 1, m)), (m, 1, 3)), 10),  # bounds are read outside of their own sum
        (sympy.Add(Sum(j, (j, 1, 2)), j, evaluate=False), 6),
        (Braces(7, 1 / (j - 3), j, 3), 7),
        (Braces(1 / (j - 3), 8, j, 2), 8),
        (Dot(sy.n_plus, sy.n_minus), y**2 - x**2),
        (Dot(sy.n_plus, sy.b_plus), 1),
        (Dot(sy.n_plus, sy.b_minus), 0),
        (Dot(sy.e_y, sy.n_minus), y),
        (Dot(sy.n_plus, 0), 0),
        (Dot(sy.e_y, MatrixTimes(1, 2, 3, j, sy.n_plus)), 3 * x + 3 * y),
        (SecondDifference(i, j) - SecondDifference(i, j).doit(), 0),
        (ForcePlus(i, M), 0),
        (DeltaR((i + j) / 2, (j - i) / 2 + 1) - DeltaR(2, 2), 0),
        (Sum(1, (m, i / 2 + Rational(1, 2), (j + M) / 2)), 4),
    ],
)
def test_numbers(expression: sympy.Expr, expected: Fraction | int) -> None:
    assert value(expression) == Dual(expected)


def test_vectors() -> None:
    one = Dual(1)
    assert value(sy.n_plus + sy.n_minus) == Vector(Dual(0), Dual(2 * y))
    assert value((sy.b_plus + sy.b_minus) * sy.n_y) == Vector(Dual(0), one)
    assert value(0 * Integer(2) + sy.e_y) == Vector(Dual(0), one)
    assert value(Sum(sy.e_y, (m, 1, 3))) == Vector(Dual(0), Dual(3))


def test_radii_are_of_first_order() -> None:
    one = value(DeltaR(i, j))
    assert not one.value
    assert one.slope
    assert value(DeltaR(i, j) * DeltaR(i, 1)) == Dual(0)
    assert value((1 + DeltaR(i, j)) ** 3) == Dual(1, 3 * one.slope)
    assert value(1 / (2 + DeltaR(i, j))) == Dual(Fraction(1, 2), -one.slope / 4)


duals = st.builds(Dual, st.fractions(-4, 4, max_denominator=5), st.fractions(-4, 4))


@examples(duals, duals, st.integers(0, 5))
def test_dual_numbers_are_a_ring(a: Dual, b: Dual, power: int) -> None:
    assert (a + b) * (a - b) == a * a - b * b
    if a.value:
        assert a * a.inverse() == Dual(1)
        assert b / a * a == b
        assert a**power * a**-power == Dual(1)
    product = Dual(1)
    for _ in range(power):
        product = product * a
    assert a**power == product


@pytest.mark.parametrize(
    "expression",
    [
        Pow(j - 3, -1, evaluate=False),
        Pow(DeltaR(i, j), -1),
        ForcePlus(i, j) / ForceMinus(i, M),
        Dot(sy.n_plus, sy.b_minus) ** -2,
    ],
)
def test_a_division_by_zero(expression: sympy.Expr) -> None:
    with pytest.raises(NoValueError, match="divides by"):
        value(expression)


def test_a_sum_that_is_emptier_than_empty_has_no_agreed_value() -> None:
    with pytest.raises(NoSumError, match="from 3 to 1"):
        value(Sum(m, (m, j, j - 2)))
    with pytest.raises(NotWholeError, match="3/2"):
        value(Sum(m, (m, 1, j / 2)))


def test_there_is_no_half_of_a_bead() -> None:
    with pytest.raises(AbsentError, match="3/2 is no whole number"):
        value(DeltaR(i, j / 2))


t = sympy.Symbol("t")


@pytest.mark.parametrize(
    "expression",
    [
        t,
        sympy.Symbol("phi", real=True),
        k,
        sympy.Float("0.5"),
        sympy.pi,
        sympy.oo,
        sympy.nan,
        sympy.zoo,
        sympy.I,
        sympy.sqrt(M),
        phi**phi,
        sympy.sin(phi),
        sympy.Abs(phi),
        sympy.Function("f")(phi),
        sympy.Derivative(phi**2, phi),
        sympy.true,
        sympy.Tuple(phi),
        sympy.ImmutableMatrix([[1]]),
        sympy.Piecewise((1, j > 2), (0, True)),
        Pow(2, 1000, evaluate=False),
        Sum(m, (m, 1, MOST_TERMS + 1)),
        sy.n_plus + 1,
        sy.n_plus * sy.n_minus,
        1 / sy.n_plus,
        Dot(sy.n_plus, 1),
        DeltaR(i, j + sy.n_plus),
        DeltaR(i, j + DeltaR(i, j)),
        Braces(1, 2, DeltaR(i, j), 0),
        MatrixTimes(sy.n_plus, 0, 0, 1, sy.n_plus),
        Sum(1, (m, 1, DeltaR(i, j))),
    ],
)
def test_what_is_not_of_the_language(expression: sympy.Basic) -> None:
    with pytest.raises(UnreadableError):
        value(expression)


def test_numbers_do_not_grow_for_ever() -> None:
    tower = Integer(3)
    for _ in range(6):
        tower = Pow(tower, 60, evaluate=False)
    with pytest.raises(TooLargeError):
        value(tower)


def test_a_clock_that_has_run_out_ends_it() -> None:
    with pytest.raises(UnreadableError, match="too long"):
        Evaluator(PACKING, NUMBERS, Budget(100)).value(Sum(m, (m, 1, 900)))
