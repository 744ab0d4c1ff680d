"""Integer points: of the domain, on the lattice, and none of the small ones left out."""

from itertools import pairwise

import pytest
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.where import LATTICE, Where
from force_diffusion.symbolic.search.points import GENERIC, generic, points, small
from force_diffusion.symbolic.symbols import M, i, j, k, l, n, p, q, site_s

from tests.symbolic.search.domains import DOMAINS


@pytest.mark.long(sample=3)
@pytest.mark.parametrize("number", DOMAINS)
def test_points_are_beads_of_the_domain(number: int) -> None:
    where = DOMAINS[number]
    found = list(points(where))
    assert len({tuple(at.items()) for at in found}) == len(found) > 60
    assert len(generic(where)) == GENERIC
    for at in found:
        assert set(at) == set(where.indices)
        assert all(one.subs(at) == sympy.true for one in where.relations)
        assert not any((at[a] + at[b]) % 2 for a, b in LATTICE if a in at)


def test_generic_points_are_inside() -> None:
    for at in generic(DOMAINS[10]):
        assert at[j] > 1
        assert at[n] > 1


def test_all_small_layers_and_heights_are_there() -> None:
    surface = {(at[j], at[M]) for at in points(DOMAINS[11])}
    assert surface >= {(a, b) for b in range(1, 8) for a in range(b)}
    cone = {(at[j], at[l], at[n]) for at in points(DOMAINS[10])}
    assert cone >= {(a, b, c) for a in range(4) for b in range(a + 2, 7) for c in range(1, b - a)}


def test_all_small_places_are_there() -> None:
    found = {(at[i], at[j]) for at in points(DOMAINS[4])}
    assert found >= {(a, b) for b in range(8) for a in range(-4, 5) if (a + b) % 2 == 0}


def test_a_domain_that_is_one_place_or_none() -> None:
    only = Where.of(sympy.Eq(j, 1), sympy.Eq(i, 3))
    assert list(points(only)) == [{i: 3, j: 1}]
    assert list(points(Where.of(j >= 2, j <= 1))) == []
    assert list(points(Where())) == [{}]


def test_the_height_is_positive_by_its_name() -> None:
    assert all(at[M] >= 1 for at in points(Where.of(indices=(M,))))
    assert {at[M] for at in points(Where.of(indices=(M,)))} >= set(range(1, 9))


def test_indices_that_have_no_bound_are_of_both_signs() -> None:
    found = {at[p] for at in points(Where.of(indices=(p,)))}
    assert found >= set(range(-5, 6))


def test_many_free_indices_are_still_few_points() -> None:
    where = Where(tuple(one for one in sy.INDICES))
    assert 0 < len(list(points(where))) < 300
    bounded = Where.of(j >= 0, l > j, site_s > l, q >= 0, p >= 0)
    assert all(
        low < high for at in points(bounded) for low, high in pairwise((at[j], at[l], at[site_s]))
    )


def test_places_bound_by_a_relation_are_looked_for() -> None:
    where = Where.of(j >= 0, i >= j, k > i, l >= 0)
    found = small(where)
    assert len(found) > 60
    assert all(at[k] > at[i] >= at[j] for at in found)
    narrow = list(points(Where.of(j >= 0, i >= 5, i <= 6)))
    assert {at[j] for at in narrow} >= set(range(10))
