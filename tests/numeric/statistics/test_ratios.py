"""Means of samples whose number varies, against sums of fractions and the definition."""

import math
from fractions import Fraction

import numpy as np
import pytest
from force_diffusion.numeric.statistics.ratios import moments
from hypothesis import given
from hypothesis import strategies as st

PACKINGS = st.lists(
    st.lists(st.integers(-8, 8).map(lambda n: n / 8), max_size=5), min_size=2, max_size=9
)
"""Of numbers up to 1, of which no two are nearer than 1/8: what cancels then takes less than six
digits (the worst found takes eight of sixteen), and all that is compared below keeps as many."""


@given(PACKINGS)
def test_means_and_errors_are_those_of_their_definition(packings: list[list[float]]) -> None:
    sums = [[[len(p)], [sum(p)], [sum(x * x for x in p)]] for p in packings]
    mean, std, of_mean, of_std = (float(v[0]) for v in moments(*np.swapaxes(sums, 0, 1)))
    every = [Fraction(x) for p in packings for x in p]
    held = sum(map(bool, packings))
    if not every:
        assert math.isnan(mean)
        return
    exact = sum(every) / len(every)
    variance = sum((x - exact) ** 2 for x in every) / len(every)
    assert mean == pytest.approx(float(exact), rel=1e-14, abs=1e-14)
    assert std == pytest.approx(math.sqrt(variance), rel=1e-7, abs=1e-7)
    if held < 2:
        assert math.isnan(of_mean)
        assert math.isnan(of_std)
        return

    def error(off: list[Fraction]) -> float:
        n = len(packings)
        return math.sqrt(sum(x * x for x in off) * n / (n - 1)) / len(every)

    off = [sum((Fraction(x) - exact for x in p), Fraction(0)) for p in packings]
    assert of_mean == pytest.approx(error(off), rel=1e-9, abs=1e-7)
    squares = [
        sum(((Fraction(x) - exact) ** 2 - variance for x in p), Fraction(0)) for p in packings
    ]
    of_variance = error(squares)
    if of_variance > 1e-6 * variance:  # else it may be taken for rounding
        assert of_std == pytest.approx(of_variance / (2 * math.sqrt(variance)), rel=1e-6)


@given(st.floats(0.01, 100), st.floats(0.01, 100), st.floats(-100, 100))
def test_two_samples_tell_nothing_of_the_error_of_their_deviation(
    above: float, below: float, about: float
) -> None:
    x = np.array([[about + above], [about - below]])
    _, std, _, of_std = moments(np.ones_like(x), x, x * x)
    assert std[0] > 0
    assert math.isnan(of_std[0])
