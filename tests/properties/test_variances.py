"""Eqs. 12–14: weights and variances, from one radius at a time."""

from collections.abc import Callable
from fractions import Fraction
from functools import lru_cache

import pytest
import sympy
from force_diffusion.symbolic.symbols import M, f_load, j, sigma, z
from hypothesis import given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.properties.drawn import cosines, exactly, lengths
from tests.properties.one_radius import (
    QUOTIENT_ROUNDING,
    left_out,
    loaded,
    mean_force,
    one_larger_each,
    variance,
)
from tests.properties.orders import ROUNDING, STRENGTHS, falls, printed
from tests.properties.packing import Number, Packing, mp
from tests.properties.reading import Plane

LOADS = {13: "surface", 14: "bulk"}
Geometry = tuple[Fraction, Fraction]
geometries = st.tuples(cosines, lengths)
"""φ and r."""


@lru_cache(maxsize=16)  # all layers, and all changes of an equation, see the same packings
def larger(
    geometry: Geometry, height: int, epsilon: Number, load: str, weight: Fraction
) -> tuple[Plane, ...]:
    """One bead of each layer larger by ε r, and the forces under a load."""
    each = one_larger_each(*geometry, height, epsilon)
    return tuple(loaded(packing, load, exactly(weight)) for packing in each)


FEWER = settings(max_examples=max(3, settings().max_examples // 8))
"""An example takes a second, and more."""


# Eq. 12: weights

Line = tuple[Geometry, Fraction, tuple[tuple[int, int], ...]]
"""φ and r, the load on a bead, and four contacts (M, j) at equal distances, 2 ≤ j ≤ M − 2."""

Place = tuple[int, int]
"""M and j."""

LINES: tuple[tuple[Place, Place], ...] = (((7, 2), (0, 1)), ((4, 2), (1, 0)), ((4, 2), (1, 1)))
"""Along each coordinate, and along both at once."""


def contacts(start: Place, along: Place) -> tuple[Place, ...]:
    (height, layer), (up, by) = start, along
    return tuple((height + t * up, layer + t * by) for t in range(4))


@st.composite
def lines(draw: st.DrawFn) -> Line:
    start, along = draw(st.sampled_from(LINES))
    return draw(geometries), draw(lengths), contacts(start, along)


def leaves_out_order_two(equation: sympy.Eq, line: Line) -> None:
    """The mean is the same, and of the variance an order of M is left out.

    The variance of what is left out is a polynomial in M and j of degree two, while that of the
    force is one of degree three: along a line its third difference vanishes.
    """
    geometry, weight, contacts = line

    def left(height: int, layer: int, epsilon: Number) -> Number:
        planes = larger(geometry, height, epsilon, "surface", weight)
        return left_out(equation, planes, layer, {f_load: exactly(weight)})

    assert left(*contacts[0], mp.mpf(0)) <= ROUNDING**2, "the mean is another"
    sizes = []
    for epsilon in STRENGTHS:
        a, b, c, d = (left(*contact, epsilon) / epsilon**2 for contact in contacts)
        sizes.append(abs(d - 3 * c + 3 * b - a))
    assert falls(sizes, 1, rounding=QUOTIENT_ROUNDING), [mp.nstr(size, 5) for size in sizes]


@FEWER
@given(lines())
def test_eq_12_leaves_out_one_order_of_the_height(line: Line) -> None:
    for equation in printed(12):
        leaves_out_order_two(equation, line)


# Eqs. 13 and 14: variances


def exact_form(number: int, height: int, layer: int) -> sympy.Expr:
    """The exact variance of a layer, as the package has it."""
    form = fd.equation(number).exact().expr
    return next(value for value, where in form.args if where.xreplace({M: height, j: layer}))


@pytest.mark.parametrize("number", [13, 14])
@FEWER
@given(geometry=geometries, sd=lengths, weight=lengths, height=st.integers(1, 8))
def test_the_exact_variance_is_the_sum_of_squared_weights(
    number: int, geometry: Geometry, sd: Fraction, weight: Fraction, height: int
) -> None:
    """In every layer and of both contacts.

    Times M − j the sum is, for 2 ≤ j ≤ M − 2, a polynomial in M and j of degree four at most, as
    the weights are such of lower degree; its 15 values at 4 ≤ M ≤ 8, 2 ≤ j ≤ M − 2 determine it.
    """
    for layer in range(height):
        for name in ("ForcePlus", "ForceMinus"):
            sizes = []
            for epsilon in STRENGTHS:
                planes = larger(geometry, height, epsilon, LOADS[number], weight)
                packing = planes[0].packing
                mean = mean_force(packing, LOADS[number], exactly(weight), layer)
                squares = variance(planes, name, layer, mean) / epsilon**2
                exact = planes[0].read(
                    exact_form(number, height, layer), {j: layer, sigma: exactly(sd)}
                )
                sizes.append(abs(squares * (exactly(sd) / packing.r) ** 2 - exact))
            assert falls(sizes, 1, rounding=QUOTIENT_ROUNDING), (layer, name, sizes)


HEIGHTS = 10**8, 10**10
"""Where 1/M is as small as need be."""

Deep = tuple[Geometry, Fraction, Fraction]
deep = st.tuples(
    geometries, lengths, st.fractions(Fraction(1, 10), Fraction(9, 10), max_denominator=10)
)
"""φ and r, σ, and z = j/M."""


def is_the_leading_order(number: int) -> Callable[[sympy.Eq, Deep], None]:
    """What is left beside the exact variance is smaller by 1/M."""

    def check(equation: sympy.Eq, drawn: Deep) -> None:
        (cosine, r), sd, height = drawn
        plane = Plane(Packing(exactly(cosine), 1, 1, exactly(r)))
        sizes = []
        for scale in HEIGHTS:
            top = scale * height.denominator
            at = {M: top, j: int(height * top), z: exactly(height), sigma: exactly(sd)}
            exact = plane.read(fd.equation(number).exact().pieces[0].expr, at)
            left, right = (
                plane.read(side, {**at, printed(number)[0].lhs: exact}) for side in equation.args
            )
            sizes.append(abs(left - right) / mp.mpf(top) ** 3)
        smaller = tuple(1 / mp.mpf(scale) for scale in HEIGHTS)
        assert falls(sizes, 1, smaller), [mp.nstr(size, 5) for size in sizes]

    return check


@pytest.mark.parametrize("number", [13, 14])
@given(drawn=deep)
def test_eqs_13_and_14_are_the_leading_order_in_the_height(number: int, drawn: Deep) -> None:
    for equation in printed(number):
        is_the_leading_order(number)(equation, drawn)


GEOMETRY = Fraction(1, 7), Fraction(3, 4)
DEEP = GEOMETRY, Fraction(2, 3), Fraction(3, 7)
CHECKS = {
    12: (leaves_out_order_two, [(GEOMETRY, Fraction(5, 3), contacts(*line)) for line in LINES]),
    13: (is_the_leading_order(13), [DEEP]),
    14: (is_the_leading_order(14), [DEEP]),
}
