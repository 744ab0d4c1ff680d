"""Domains of whole numbers: what they say of some indices, and what is fixed by them."""

from itertools import product

import pytest
import sympy
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.symbols import M, N, j, p, q

DOMAINS = (
    Where.of(N >= 2, sympy.Le(N, j - 1), sympy.Ge(M, j + 2)),
    Where.of(sympy.Eq(N, j), j >= 2, sympy.Ge(M, j + 1)),
    Where.of(sympy.Ge(M, j + 2), sympy.Le(M, j + N - 1), sympy.Le(N, j - 2)),
    Where.of(N >= 2, sympy.Le(2 * N, j), sympy.Le(j, 7), sympy.Ge(M, j)),
)
SIZE = 9


@pytest.mark.parametrize("where", DOMAINS, ids=str)
def test_what_is_said_without_an_index_holds_just_where_that_has_a_value(where: Where) -> None:
    rest = where.without((N,))
    assert N not in rest.indices
    for height, layer in product(range(SIZE), repeat=2):
        at = {M: height, j: layer}
        held = any(where.holds({**at, N: count}) for count in range(2 * SIZE))
        assert rest.holds(at) == held, at


def test_what_fixes_no_other_index_says_nothing_of_them() -> None:
    where = Where.of(j >= 0, N >= 2)
    assert where.without((N,)).relations == (j >= 0,)
    assert where.without(()) == where


def test_a_domain_is_covered_by_many_parts() -> None:
    whole = Where.of(j >= 0, p >= 0, q >= 0)
    choices = [
        [sympy.Eq(one, value) if value < 2 else one >= 2 for value in range(3)] for one in (j, p, q)
    ]
    parts = [whole.also(*relations) for relations in product(*choices)]
    assert whole.covered_by(parts)
    for place in range(len(parts)):
        assert not whole.covered_by(parts[:place] + parts[place + 1 :])
