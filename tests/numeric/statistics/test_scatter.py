"""Standard errors from the scatter over packings, against sums of fractions and the jackknife."""

import math

import numpy as np
import pytest
from force_diffusion.numeric.statistics.moments import mean_and_std, standard_errors
from hypothesis import given
from hypothesis import strategies as st

# Of numbers up to 1, of which no two are nearer than 1/8, little cancels: what is compared keeps
# digits enough.
EIGHTHS = st.integers(-8, 8).map(lambda n: n / 8)
PACKINGS = st.integers(1, 5).flatmap(
    lambda size: st.lists(st.lists(EIGHTHS, min_size=size, max_size=size), min_size=2, max_size=9)
)


def errors(x: np.ndarray) -> tuple[float, float]:
    """Give the errors of the mean and of ln σ of packings (packings, contacts)."""
    of_mean, of_std = standard_errors(np.stack([x, x * x], axis=1).mean(axis=2, keepdims=True))
    # σ (e^2ε − 1)/2 is what is stated of σ
    return float(of_mean[0]), float(np.log1p(2 * of_std[0] / x.std())) / 2 if x.std() else math.nan


@given(PACKINGS)
def test_moments_of_packings_are_those_of_all_samples(packings):
    x = np.array(packings)
    mean, std = mean_and_std(x.mean(axis=1)[:, None], x.var(axis=1)[:, None])
    assert mean == pytest.approx(x.mean(), abs=1e-12)
    assert std == pytest.approx(x.std(), abs=1e-12)


@given(st.floats(0.01, 100), st.floats(0.01, 100), st.floats(-100, 100))
def test_two_samples_tell_nothing_of_the_error_of_their_deviation(above, below, about):
    assert math.isnan(errors(np.array([[about + above], [about - below]]))[1])


def test_of_one_packing_no_error_is_known():
    assert all(map(math.isnan, errors(np.array([[1.0, 2.0]]))))


def test_errors_are_those_of_the_jackknife():
    """Leaving out one packing after the other knows nothing of products of deviations."""
    x = np.random.default_rng(1).gamma(2.0, size=(400, 15)) + np.arange(15) / 9
    means = [np.delete(x, k, axis=0).mean() for k in range(len(x))]
    logs = [math.log(np.delete(x, k, axis=0).std()) for k in range(len(x))]
    for error, values in zip(errors(x), map(np.array, (means, logs)), strict=True):
        jackknife = np.sqrt(((values - values.mean()) ** 2).sum() * 399 / 400)
        assert error == pytest.approx(jackknife, rel=0.02)  # both are good to 1/packings
