"""Decimals that are written are the nearest ones, however far outside of a float's range."""

from fractions import Fraction

from force_diffusion.numeric.arithmetic.decimals import bound_string, decimal_string, short
from hypothesis import given
from hypothesis import strategies as st

wholes = st.integers(-(10**60), 10**60) | st.integers(-(2**60), 2**60)
powers = st.integers(-700, 700)
VALUES = st.builds(
    lambda n, d, power: Fraction(n, d) * Fraction(10) ** power,
    wholes.filter(bool),
    st.integers(1, 10**9) | st.integers(0, 200).map(lambda k: 2**k),
    st.just(0) | powers,
)


def unit(text: str) -> Fraction:
    """One in the last of the digits that are written."""
    mantissa, _, exponent = text.partition("e")
    return Fraction(10) ** (int(exponent or 0) - len(mantissa.partition(".")[2]))


@given(VALUES)
def test_without_an_error_forty_digits_are_the_nearest(value: Fraction) -> None:
    off = abs(Fraction(decimal_string(value, None)) - value)
    assert off * 2 * 10**39 <= abs(value)


@given(VALUES, st.integers(1, 30), st.integers(1, 999))
def test_digits_end_where_the_error_begins(value: Fraction, digits: int, share: int) -> None:
    error = abs(value) * Fraction(share, 10 ** (digits + 3))
    text = decimal_string(value, error)
    assert abs(Fraction(text) - value) <= 5 * error
    assert unit(text) <= 100 * error  # 9950 to 100 is 1e+04
    assert error <= 10 * unit(text)


@given(VALUES)
def test_a_few_digits_are_the_nearest_and_a_bound_is_above(value: Fraction) -> None:
    assert abs(Fraction(short(value)) - value) * 2 * 10**5 <= abs(value)
    assert abs(value) <= Fraction(bound_string(abs(value))) <= abs(value) * Fraction(101, 100)
