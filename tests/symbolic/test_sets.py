"""Operations of integer sets, against brute force over all points of a box."""

from itertools import product

import pytest
import sympy
from force_diffusion.symbolic import sets, shortest
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError
from force_diffusion.symbolic.symbols import M, i, j
from hypothesis import given
from hypothesis import strategies as st
from sympy import Eq, Ge, Le

SYMBOLS = (i, j, M)
LOW, HIGH = -1, 3
BOX = tuple(product(range(LOW, HIGH + 1), repeat=3))
IN_BOX = [
    kind(symbol, bound, evaluate=False)  # SymPy knows that M > 0
    for symbol in SYMBOLS
    for kind, bound in ((Ge, LOW), (Le, HIGH))
]
POINTS = {
    point: sets.where(*(Eq(s, n, evaluate=False) for s, n in zip(SYMBOLS, point, strict=True)))
    for point in BOX
}
SIGNS = {Eq: int.__eq__, Ge: int.__ge__, Le: int.__le__}

factors = st.integers(-2, 2)
forms = st.builds(
    lambda a, b, c, d: a * i + b * j + c * M + d, factors, factors, factors, st.integers(-3, 3)
)
relations = st.builds(
    lambda kind, form: kind(form, 0, evaluate=False), st.sampled_from(list(SIGNS)), forms
)
several = st.lists(relations, max_size=4)


def value(form, point):
    return int(form.xreplace(dict(zip(SYMBOLS, map(sympy.Integer, point), strict=True))))


def holds(relation, point):
    return SIGNS[relation.func](value(relation.lhs, point), 0)


def points_of(points):
    """The points of the box that lie in a set, one by one."""
    return {point for point, here in POINTS.items() if not points.is_disjoint(here)}


def expected(given_relations):
    return {point for point in BOX if all(holds(relation, point) for relation in given_relations)}


@given(several)
def test_a_set_holds_the_points_at_which_its_relations_hold(given_relations):
    assert points_of(sets.where(*given_relations)) == expected(given_relations)


@given(several, several)
def test_a_union_is_the_same_in_disjoint_parts_and_joined(first, second):
    whole = sets.where(*first, *IN_BOX) | sets.where(*second, *IN_BOX)
    wanted = expected(first) | expected(second)
    parts = [points_of(part) for part in sets.parts(whole)]
    assert set().union(*parts) == wanted
    assert sum(map(len, parts)) == len(wanted)
    assert points_of(shortest.joined(sets.parts(whole))) == wanted


@given(several)
def test_a_projection_leaves_out_one_symbol(given_relations):
    shadow = {(a, c) for a, _, c in expected(given_relations)}
    flat = sets.without(sets.where(*given_relations, *IN_BOX), j)
    assert points_of(flat) == {(a, b, c) for a, b, c in BOX if (a, c) in shadow}


@given(several, forms)
def test_a_map_is_put_in(given_relations, form):
    moved = sets.at(sets.where(*given_relations), {j: form})
    assert points_of(moved) == {
        (a, b, c)
        for a, b, c in BOX
        if all(holds(relation, (a, value(form, (a, b, c)), c)) for relation in given_relations)
    }


@given(forms)
def test_even_forms(form):
    assert points_of(sets.even(form)) == {p for p in BOX if value(form, p) % 2 == 0}


@given(several)
def test_ranges_reach_every_value_once(given_relations):
    points = sets.where(*given_relations, *IN_BOX)
    triples = []
    for there, low, high in sets.ranges(points, j):
        for a, b, c in points_of(there):
            if b == 0:  # the set does not depend on j
                first, last = (_at(bound, {i: a, M: c}) for bound in (low, high))
                assert first.is_Integer
                assert last.is_Integer
                triples += [(a, n, c) for n in range(int(first), int(last) + 1)]
    assert sorted(triples) == sorted(expected(given_relations))


def _at(value, at):
    return value.substitute({symbol: FIELD.constant(n) for symbol, n in at.items()}).to_sympy()


@given(several)
def test_what_is_fixed_is_so_at_every_point(given_relations):
    points = sets.where(*given_relations)
    for symbol, formula in sets.fixed(points).items():
        for point in points_of(points):
            at = dict(zip(SYMBOLS, point, strict=True))
            assert _at(formula, at) == at[symbol]


@given(several, several, several)
def test_conditions_tell_a_part_from_the_rest_of_its_context(first, second, around):
    context = sets.where(*around, *IN_BOX)
    whole = (sets.where(*first) | sets.where(*second)) & context
    try:
        cases = shortest.conditions(whole, context)
    except sets.OpenSumError:  # a remainder, which equations leave
        return
    reached = set()
    for equations, bounds in cases:
        conditions = [Eq(_form(form), 0, evaluate=False) for form in equations]
        conditions += [Ge(_form(form), 0, evaluate=False) for form in bounds]
        reached |= points_of(sets.where(*conditions) & context)
        for left_out in conditions:
            others = [condition for condition in conditions if condition is not left_out]
            assert not points_of(sets.where(*others) & context) <= points_of(whole)
    assert reached == points_of(whole)


def _form(row):
    return sympy.Add(*(n * symbol for symbol, n in row[0].items()), row[1])


@pytest.mark.parametrize("form", [i * j, i / 2, i + sympy.Symbol("q"), i + 2**63])
def test_what_is_no_whole_affine_form_is_refused(form):
    with pytest.raises(NotExactError):
        sets.where(Ge(form, 0, evaluate=False))


def test_points_far_apart_are_not_joined_to_a_line():
    apart = [sets.where(sympy.Eq(i, n, evaluate=False), sympy.Eq(j, 3 * n, evaluate=False))
             for n in (0, 1)]  # fmt: skip
    together = [sets.where(sympy.Eq(i, n, evaluate=False), sympy.Eq(j, n, evaluate=False))
                for n in (0, 1)]  # fmt: skip
    assert len(sets.parts(shortest.joined(apart))) == 2
    assert len(sets.parts(shortest.joined(together))) == 1
    both = shortest.joined(apart)
    assert all(part.is_subset(both) for part in apart)


def test_numbers_beyond_64_bits_are_read_whole():
    points = sets.where(Eq(j, 2**40 * i, evaluate=False), Eq(M, 2**40 * j, evaluate=False))
    (((factors, _),), _) = sets.rows(sets.without(points, j))
    assert factors[i] == -(2**80) * factors[M]
