"""Decimals that are written are the nearest ones, however far outside of a float's range."""

from fractions import Fraction

from force_diffusion.numeric.arithmetic.decimals import bound_string, decimal_string, short
from hypothesis import example, given
from hypothesis import strategies as st

wholes = st.integers(-(10**60), 10**60) | st.integers(-(2**60), 2**60)
powers = st.integers(-700, 700)
VALUES = st.builds(
    lambda n, d, power: Fraction(n, d) * Fraction(10) ** power,
    wholes.filter(bool),
    st.integers(1, 10**9) | st.integers(0, 200).map(lambda k: 2**k),
    st.just(0) | powers,
)


@given(VALUES)
@example(Fraction(1, 800))  # few zeros stand behind the point
def test_forty_digits_are_the_nearest(value):
    off = abs(Fraction(decimal_string(value)) - value)
    assert off * 2 * 10**39 <= abs(value)


@given(VALUES)
def test_a_few_digits_are_the_nearest_and_a_bound_is_above(value):
    assert abs(Fraction(short(value)) - value) * 2 * 10**5 <= abs(value)
    assert abs(value) <= Fraction(bound_string(abs(value))) <= abs(value) * Fraction(101, 100)
