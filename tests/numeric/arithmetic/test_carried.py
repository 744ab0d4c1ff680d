"""Numbers that carry their rounding errors, against fractions."""

from fractions import Fraction
from operator import add, mul, sub, truediv
from typing import Any

import pytest
from force_diffusion.numeric.arithmetic.carried import Carried, sqrt
from hypothesis import given
from hypothesis import strategies as st

# Of the numbers here, and of their results: what is left out is of second order in 2^-53.
NEARLY = Fraction(1, 2**100)
numbers = st.builds(
    lambda size, error: Carried(size, error * size * 2.0**-53), st.floats(0.5, 4), st.floats(-1, 1)
)


def whole(number: Any) -> Fraction:
    return Fraction(float(number.value)) + Fraction(float(number.error))


@pytest.mark.parametrize("operation", [add, sub, mul, truediv])
@given(first=numbers, second=numbers)
def test_an_operation_carries_what_it_rounds(operation, first, second):
    exact = operation(whole(first), whole(second))
    assert abs(whole(operation(first, second)) - exact) <= 8 * NEARLY


@given(numbers)
def test_a_root_carries_what_it_rounds(number):
    assert abs(whole(sqrt(number)) ** 2 - whole(number)) <= 16 * NEARLY
