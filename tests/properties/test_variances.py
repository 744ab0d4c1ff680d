"""Eqs. 13–16: how variances grow with the height of the packing."""

from collections.abc import Callable
from fractions import Fraction

import pytest
import sympy
from force_diffusion.symbolic.symbols import M, i, j, k, l, sigma, z
from hypothesis import given
from hypothesis import strategies as st

from tests.properties import growth
from tests.properties.drawn import FEWER, GEOMETRY, Geometry, exactly, geometries, lengths
from tests.properties.moments import ACCURATE
from tests.properties.orders import falls, printed
from tests.properties.packing import Number, Packing, mp
from tests.properties.reading import Plane

LOADS = {13: "surface", 14: "bulk"}
HEIGHTS = 10**8, 10**10
"""Where 1/M is as small as need be, and the digits that extrapolation leaves are enough."""

Deep = tuple[Geometry, Fraction, Fraction]
"""φ and r, σ, and z = j/M."""
tenths = st.fractions(Fraction(1, 10), Fraction(9, 10), max_denominator=10)
"""So many that whole layers lie there."""
deep = st.tuples(geometries, lengths, tenths)


def numbers(geometry: Geometry) -> Plane:
    """What φ and r are; no bead is looked at."""
    cosine, r = geometry
    return Plane(Packing(exactly(cosine), 1, 1, exactly(r)))


def is_the_leading_order(
    of_packings: Callable[[Geometry, int, int], Number], power: int
) -> Callable[[sympy.Eq, Deep], None]:
    """What is left beside the variance of tall packings is smaller by 1/M."""

    def check(equation: sympy.Eq, drawn: Deep) -> None:
        geometry, sd, height = drawn
        sizes = []
        for scale in HEIGHTS:
            top, layer = scale * height.denominator, scale * height.numerator
            left = exactly(sd) ** 2 * of_packings(geometry, top, layer)
            at = {M: top, l: top, j: layer, i: 0, k: 0, z: exactly(height), sigma: exactly(sd)}
            right = numbers(geometry).read(equation.rhs, at)
            sizes.append(abs(left - right) / mp.mpf(top) ** power)
        smaller = tuple(1 / mp.mpf(scale) for scale in HEIGHTS)
        shown = [mp.nstr(size, 5) for size in sizes]
        assert falls(sizes, 1, smaller), (
            f"at z = {height} both sides differ by {' and '.join(shown)} times M^{power} "
            f"for M = 1e8 and 1e10, which does not fall as 1/M"
        )

    return check


OF_LAYERS = {
    number: is_the_leading_order(
        lambda geometry, *at, load=load: growth.tall_variance(geometry, load, *at), 3
    )
    for number, load in LOADS.items()
}
OF_RESPONSE = is_the_leading_order(growth.deep_response, 1)


@pytest.mark.parametrize("load", LOADS.values())
@pytest.mark.parametrize("place", [(9, 2), (9, 5), (9, 7)])
def test_small_packings_tell_the_variances_of_taller_ones(load, place):
    variance = growth.variance(GEOMETRY, load, *place)
    assert abs(variance / growth.tall_variance(GEOMETRY, load, *place) - 1) < ACCURATE


@pytest.mark.parametrize("place", [(8, 3), (8, 4), (8, 5)])
def test_small_packings_tell_the_responses_of_taller_ones(place):
    response = growth.response(GEOMETRY, *place, across=place[1] % 2)
    assert abs(response / growth.deep_response(GEOMETRY, *place) - 1) < ACCURATE


# Eq. 15: the mean over all layers

System = tuple[int, Geometry, Fraction]
"""M, φ and r, and σ."""


def is_the_general_form(equation: sympy.Eq, systems: tuple[System, System]) -> None:
    """Left over right is a positive number which is the same for all M, r and σ, up to 1/M.

    σ_f²/⟨f⟩² of a system is the mean over the layers, and M* the height at which that is one.
    """
    deviation, height = (line.lhs for line in printed(15))
    for load in LOADS.values():
        quotients = []
        for top, geometry, sd in systems:
            of_radii = exactly(sd)
            at = {M: top, sigma: of_radii, height: unit_height(geometry, load, of_radii)}
            at[deviation] = of_radii * mp.sqrt(growth.mean_variance(geometry, load, top))
            left, right = (numbers(geometry).read(side, at) for side in equation.args)
            quotients.append(left / right)
        first, second = quotients
        # the next order of either side, and M* is a whole number: together less than 5/M (an
        # exponent that is another by one half is a factor of two)
        shown = [mp.nstr(quotient, 5) for quotient in quotients]
        assert min(quotients) > 0, f"{load} load: left over right is {' and '.join(shown)}"
        assert abs(second / first - 1) < mp.mpf(5) / systems[0][0], (
            f"{load} load: left over right is {' and '.join(shown)}, which is not constant"
        )


def unit_height(geometry: Geometry, load: str, sd: Number) -> int:
    """The least M at which the mean of σ_f²/⟨f⟩² is one."""
    low, high = 4, 1000
    while high - low > 1:
        middle = (low + high) // 2
        is_enough = sd**2 * growth.mean_variance(geometry, load, middle) >= 1
        low, high = (low, middle) if is_enough else (middle, high)
    return high


def systems(cosine: Fraction, r: Fraction, other: Fraction) -> tuple[System, System]:
    """So that M* is about M in both: with σ/r = 10⁻³, and an eighth of that."""
    return (60, (cosine, r), r / 1000), (240, (cosine, other), other / 8000)


@FEWER
@given(deep)
def test_eqs_13_to_15_are_the_leading_order_in_the_height(drawn):
    for number, check in OF_LAYERS.items():
        for equation in printed(number):
            check(equation, drawn)
    (cosine, r), *_ = drawn
    for equation in printed(15):
        is_the_general_form(equation, systems(cosine, r, r))


# Eq. 16: the response to a load on one bead


@FEWER
@given(deep)
def test_eq_16_is_the_leading_order_in_the_heights(drawn):
    for equation in printed(16):
        OF_RESPONSE(equation, drawn)


@FEWER
@given(geometries)
def test_inside_of_the_cone_the_response_depends_on_the_heights_alone(geometry):
    """It is completely independent of the horizontal position."""
    inside = [growth.response(geometry, 7, 3, across) for across in (-2, 0, 2)]
    assert max(inside) / min(inside) - 1 < ACCURATE


DEEP = GEOMETRY, Fraction(2, 3), Fraction(3, 7)
CHECKS = {
    **{number: (check, [DEEP]) for number, check in OF_LAYERS.items()},
    15: (is_the_general_form, [systems(*GEOMETRY, Fraction(2))]),
    16: (OF_RESPONSE, [DEEP]),
}
