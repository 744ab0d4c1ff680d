"""Inequalities decided in a region, against its points."""

from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.symbols import M, j, n
from hypothesis import given
from hypothesis import strategies as st

REGION = Region({j: 1, M: j + 2, n: 1})
whole = st.integers(-3, 3)


def points() -> list[dict[object, int]]:
    return [
        {j: at, M: at + 2 + extra, n: 1 + more}
        for at in range(1, 7)
        for extra in range(6)
        for more in range(6)
    ]


@given(whole, whole, whole, st.integers(-12, 12))
def test_nonnegative_is_decided(a: int, b: int, c: int, d: int) -> None:
    value = affine.from_sympy(a * j + b * M + c * n + d)
    values = [a * p[j] + b * p[M] + c * p[n] + d for p in points()]
    if REGION.nonnegative(value):
        assert min(values) >= 0
    else:
        # it is negative at the corner, or falls without end along an edge; 40 steps show it
        corner = {j: 1, M: 3, n: 1}
        edges = [{j: 40, M: 42, n: 1}, {j: 1, M: 43, n: 1}, {j: 1, M: 3, n: 40}]
        assert min(a * p[j] + b * p[M] + c * p[n] + d for p in [corner, *edges]) < 0


@given(whole, whole, st.integers(-9, 9))
def test_round_trip(a: int, b: int, d: int) -> None:
    expression = a * j + b * M + d
    assert affine.to_sympy(affine.from_sympy(expression)) == expression
