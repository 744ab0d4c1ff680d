"""The normal form against plain loops over explicit small packings."""

from fractions import Fraction

import pytest
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine, explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import LAYER, NotExactError, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.reading import Reader, UnsafeBoundsError, UnsafeDivisorError
from force_diffusion.symbolic.kernel.decisions import GEOMETRIES
from hypothesis import given
from hypothesis import strategies as st

from tests.symbolic.strategies import REGION, expressions, points

VALUES = GEOMETRIES[0]
Point = dict[sympy.Symbol, int]


def evaluate(value: RationalFunction, point: Point, layer: int = 0) -> Fraction:
    at = {**VALUES, **point, LAYER: layer}
    return explicit.number(value.to_sympy(), at)


def place(expression: affine.Affine, point: Point) -> int:
    return int(explicit.number(affine.to_sympy(expression), point))


def unfold(form: LinearForm, point: Point, top: int) -> explicit.Weights:
    """Weights of a normal form at a point, rays followed up to a layer above all of them."""
    weights: explicit.Weights = {}

    def add(key: tuple[str, int, int], weight: Fraction) -> None:
        total = weights.pop(key, Fraction(0)) + weight
        if total:
            weights[key] = total

    for site, weight in form.sites.items():
        add((site.family, place(site.i, point), place(site.j, point)), evaluate(weight, point))
    for ray, weight in form.rays.items():
        line = place(ray.line, point)
        for layer in range(place(ray.start, point), top):
            add((ray.family, line + ray.slope * layer, layer), evaluate(weight, point, layer))
    return weights


@pytest.mark.long
@given(expressions, points())
def test_normal_form_unfolds_to_the_loops(expression: sympy.Expr, point: Point) -> None:
    form = Reader(None).scalar(expression)
    top = 3 * point[sy.M] + 12  # above every start, which are at most j + M + 3
    assert unfold(form, point, top) == explicit.weights(expression, {**VALUES, **point})


@given(expressions, expressions)
def test_the_difference_of_equal_sums_is_zero(one: sympy.Expr, other: sympy.Expr) -> None:
    left = Reader(None).scalar(one + other) - Reader(None).scalar(other)
    assert (left - Reader(None).scalar(one)).is_zero()


@pytest.mark.parametrize(
    "divisor", [sy.j - 20, sy.M - sy.j - 3, sy.phi, 1 - 16 * sy.phi**2, 3 * sy.phi - 1]
)
def test_what_is_divided_by_what_may_vanish_is_not_read(divisor: sympy.Expr) -> None:
    quotient = sy.DeltaR(sy.i, sy.j) / divisor
    with pytest.raises(UnsafeDivisorError):
        Reader(REGION).scalar(quotient)


@pytest.mark.long
@given(expressions, points(), st.integers(-2, 2))
def test_other_indices_are_put_in(expression: sympy.Expr, point: Point, across: int) -> None:
    """M = j + 2, so many places to the right."""
    image = {sy.i: sy.i + 2 * across, sy.M: sy.j + 2}
    form = Reader(None).scalar(expression)
    moved = form.put_in({symbol: affine.from_sympy(value) for symbol, value in image.items()})
    at = {**point, sy.M: point[sy.j] + 2}
    there = explicit.weights(expression, {**VALUES, **at, sy.i: at[sy.i] + 2 * across})
    assert unfold(moved, at, 3 * at[sy.M] + 12) == there


def test_a_shifted_start_gives_one_normal_form() -> None:
    split = sy.DeltaR(sy.i, sy.j) + sympy.Sum(
        sy.DeltaR(sy.i - sy.j + sy.m, sy.m), (sy.m, 0, sy.j - 1)
    )
    whole = sympy.Sum(sy.DeltaR(sy.i - sy.m, sy.j - sy.m), (sy.m, 0, sy.j))
    reader = Reader(Region({sy.j: 1}))
    assert (reader.scalar(split) - reader.scalar(whole)).is_zero()


def test_bounds_out_of_order_are_not_read() -> None:
    series = sympy.Sum(sy.DeltaR(sy.i, sy.m), (sy.m, 1, sy.j - 2))
    with pytest.raises(UnsafeBoundsError, match="j - 2"):
        Reader(Region({sy.j: 0})).scalar(series)


def test_an_empty_sum_is_nothing() -> None:
    series = sympy.Sum(sy.DeltaR(sy.i + sy.m, sy.m), (sy.m, 1, sy.j - sy.j))
    assert Reader(Region({})).scalar(series).is_zero()


def test_a_reversed_sum_is_not_read_as_empty() -> None:
    """Σ from 1 to −1 is minus the term at 0 by SymPy's convention, which others do not share."""
    series = sympy.Sum(sy.DeltaR(sy.i + sy.m, sy.m), (sy.m, 1, -1))
    with pytest.raises(UnsafeBoundsError):
        Reader(Region({})).scalar(series)


@pytest.mark.parametrize(
    "expression",
    [
        sy.DeltaR(sy.i, sy.j) ** 2,
        sy.DeltaR(sy.i, sy.j) * sy.DeltaR(sy.i, 0),
        sympy.Sum(sy.DeltaR(sy.i + 2 * sy.m, sy.j), (sy.m, 1, sy.j)),
        sympy.sin(sy.phi) * sy.DeltaR(sy.i, sy.j),
        sympy.Float(0.5) * sy.DeltaR(sy.i, sy.j),
        sy.n_plus + sy.DeltaR(sy.i, sy.j),
    ],
)
def test_what_lies_outside_is_not_read(expression: sympy.Expr) -> None:
    with pytest.raises(NotExactError):
        Reader(Region({sy.j: 1})).scalar(expression)
