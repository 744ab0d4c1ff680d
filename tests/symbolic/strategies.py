"""Hypothesis strategies for expressions that the reader reads, and for points to look at them."""

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.affine import Region
from hypothesis import strategies as st

REGION = Region({sy.j: 2, sy.M: sy.j + 2})

whole = st.integers(-3, 3)
rationals = st.builds(sympy.Rational, st.integers(-4, 4), st.integers(1, 3))


@st.composite
def coefficients(draw: st.DrawFn, *indices: sympy.Symbol) -> sympy.Expr:
    """A small polynomial in the given indices and φ, maybe over 1 − φ²."""
    total = draw(rationals)
    for symbol in (*indices, sy.phi):
        total += draw(rationals) * symbol ** draw(st.integers(0, 2))
    return total / draw(st.sampled_from([sympy.Integer(1), 1 - sy.phi**2]))


@st.composite
def line_sums(draw: st.DrawFn) -> sympy.Expr:
    """Σ over m of a weight times δr along one diagonal, either way, from a layer to another."""
    sign = draw(st.sampled_from([1, -1]))
    across = sy.i + sign * (sy.j - sy.m) + 2 * draw(whole)
    layer = draw(st.sampled_from([sy.m, sy.j - sy.m]))
    if layer != sy.m:
        across = sy.i + sign * sy.m + 2 * draw(whole)
    low = draw(st.sampled_from([sympy.Integer(0), sympy.Integer(1), sympy.Integer(2)]))
    high = draw(st.sampled_from([sy.j, sy.j + 1, sy.M, sy.M - 1]))
    return sympy.Sum(draw(coefficients(sy.m)) * sy.DeltaR(across, layer), (sy.m, low, high))


@st.composite
def nested_sums(draw: st.DrawFn) -> sympy.Expr:
    """Σ over n of line sums whose end, or whose weight, moves with n."""
    inner = sympy.Sum(
        draw(coefficients(sy.m, sy.n)) * sy.DeltaR(sy.i - sy.j + sy.m + 2 * draw(whole), sy.m),
        draw(
            st.sampled_from(
                [(sy.m, 1, sy.j + sy.n), (sy.m, sy.n, sy.M + 1), (sy.m, sy.M - sy.n, sy.M)]
            )
        ),
    )
    return sympy.Sum(inner, (sy.n, 1, draw(st.sampled_from([sy.M - sy.j, sy.M - sy.j - 1, sy.M]))))


@st.composite
def single_sites(draw: st.DrawFn) -> sympy.Expr:
    """One radius near (i, j), near the base or near the surface."""
    layer = draw(st.sampled_from([sy.j, sy.j + 1, sympy.Integer(0), sy.M, sy.M - 1]))
    across = sy.i + draw(st.sampled_from([1, -1])) * (sy.j - layer) + 2 * draw(whole)
    return draw(coefficients()) * sy.DeltaR(across, layer)


expressions = st.lists(
    st.one_of(single_sites(), line_sums(), nested_sums()), min_size=1, max_size=4
).map(lambda parts: sympy.Add(*parts))


@st.composite
def points(draw: st.DrawFn) -> dict[sympy.Symbol, int]:
    """A point of REGION."""
    layer = draw(st.integers(2, 6))
    return {sy.i: layer, sy.j: layer, sy.M: layer + draw(st.integers(2, 6))}
