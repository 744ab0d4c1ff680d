"""Weights on integer sets, against their values at all points of a box."""

from collections import defaultdict
from fractions import Fraction

from flint import fmpq
from force_diffusion.symbolic import sets
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.symbols import j
from force_diffusion.symbolic.weights import Weights
from hypothesis import given
from hypothesis import strategies as st
from sympy import Eq

from .test_sets import BOX, HIGH, IN_BOX, LOW, SYMBOLS, expected, forms, points_of, several, value

functions = st.builds(lambda a, b, n: FIELD.from_sympy(a * b**n), forms, forms, st.integers(0, 2))
pieces = st.lists(st.tuples(several, functions), max_size=3)
RANGE = range(LOW, HIGH + 1)


def weights(drawn):
    return Weights(tuple((sets.where(*there, *IN_BOX), function) for there, function in drawn))


def at(function, point):
    coordinates = dict(zip(SYMBOLS, point, strict=True))
    numbers = [fmpq(coordinates.get(generator, 0)) for generator in FIELD.generators]
    quotient = function.numerator(*numbers) / function.denominator(*numbers)
    return Fraction(int(quotient.p), int(quotient.q))


def added(pairs):
    """The value at each point of functions on sets of points, where it is not 0."""
    table = defaultdict(Fraction)
    for there, function in pairs:
        for point in there:
            table[point] += at(function, point)
    return {point: number for point, number in table.items() if number}


def table(result):
    return added((points_of(points), function) for points, function in result.pieces)


def drawn_table(drawn):
    return added((expected(there), function) for there, function in drawn)


@given(pieces)
def test_cells_and_few_formulas_are_the_same_function(drawn):
    whole, wanted = weights(drawn), drawn_table(drawn)
    assert table(whole) == wanted
    for other in (whole.cells(), whole.merged(), Weights(tuple(whole.formulas()))):
        assert table(other) == wanted
        parts = [points_of(points) for points, _ in other.pieces]
        assert sum(map(len, parts)) == len(set().union(*parts))


@given(pieces)
def test_a_function_that_is_zero_is_seen_to_be(drawn):
    assert (weights(drawn) - weights(drawn[::-1])).is_zero()
    assert not (weights(drawn).is_zero() and drawn_table(drawn))


@given(pieces, pieces)
def test_sums_and_products_are_taken_at_each_point(first, second):
    first_values, second_values = drawn_table(first), drawn_table(second)
    left, right = weights(first), weights(second)
    total, product = table(left + right), table(left.times(right))
    for point in BOX:
        assert total.get(point, 0) == first_values.get(point, 0) + second_values.get(point, 0)
        assert product.get(point, 0) == first_values.get(point, 0) * second_values.get(point, 0)


@given(pieces)
def test_a_sum_over_a_symbol_has_the_sum_at_each_point(drawn):
    result, expected = table(weights(drawn).summed(j)), drawn_table(drawn)
    for a, b, c in BOX:  # whatever j is
        assert result.get((a, b, c), 0) == sum(expected.get((a, n, c), 0) for n in RANGE)


@given(pieces, forms)
def test_a_form_is_put_in_for_a_symbol(drawn, form):
    result, expected = table(weights(drawn).at({j: form})), drawn_table(drawn)
    for a, b, c in BOX:
        image = (a, value(form, (a, b, c)), c)
        assert result.get((a, b, c), 0) == expected.get(image, 0)


@given(pieces, forms)
def test_a_symbol_that_the_others_give_is_left_out(drawn, form):
    given_by = form.xreplace({j: 0 * j})
    restriction = weights(drawn).on(sets.where(Eq(j, given_by, evaluate=False)))
    assert table(restriction.without(j)) == table(restriction.summed(j))
