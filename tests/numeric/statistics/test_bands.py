"""Simultaneous bands contain the true curve as often as they claim."""

import numpy as np
import pytest
from force_diffusion.numeric.figures.comparison import curves
from force_diffusion.numeric.figures.packings import Options, moments, planned
from force_diffusion.numeric.statistics import bands
from force_diffusion.numeric.statistics.bands import critical_value, log_relative_std, simultaneous
from scipy.special import ndtri


def test_a_true_curve_falls_outside_as_often_as_it_should(monkeypatch):
    """Repeated ensembles of a small packing, whose exact σ_f is known to first order."""
    from scipy import stats  # a second to load, which collecting tests should not take

    monkeypatch.setattr(bands, "DRAWS", 4000)  # the quantile scatters: by 1.5 %, and both ways
    M, n, repetitions = 3, 50, 300
    # far below M*: what is nonlinear is a share M³(σ/r)² of σ_f, 2e-6
    ensemble = planned("profile", Options(realisations=n * repetitions, seed=5), height=M)
    mean, square = moments(ensemble, lambda _: None, "")
    truth = curves(M)[0]
    outside = {0.9: 0, 0.99: 0}
    for k in range(repetitions):
        part = slice(k * n, (k + 1) * n)
        estimates = log_relative_std(mean[part], square[part])
        for level in outside:
            outside[level] += simultaneous(*estimates, level, k).deviation(truth) > 1
    for level, count in outside.items():
        # a band of the right level gets past this in 999 of 1000 choices of the seed
        assert stats.binomtest(count, repetitions, 1 - level).pvalue > 1e-3, outside


def test_one_layer_needs_the_quantile_of_t():
    from scipy import stats

    expected = stats.t.ppf(0.995, 12)
    # the scatter of a simulated 99 % quantile, from its density: 3 standard errors
    error = np.sqrt(0.99 * 0.01 / bands.DRAWS) / (2 * stats.t.pdf(expected, 12))
    assert critical_value(np.eye(1), 12, 0.99, 1) == pytest.approx(expected, abs=3 * error)


def test_layers_that_always_agree_count_as_one_and_others_do_not():
    alike, apart = (critical_value(c, 10_000, 0.99, 1) for c in (np.ones((6, 6)), np.eye(6)))
    assert alike == pytest.approx(ndtri(0.995), abs=0.05)
    each = (1 - 0.99 ** (1 / 6)) / 2
    assert apart == pytest.approx(ndtri(1 - each), abs=0.06)


# the seed is fixed, since how well first order holds hangs on the sample
@pytest.mark.parametrize("shift", [-0.1, 0.02, 0.1])
@pytest.mark.parametrize("width", [0.05, 0.2, 0.5])
@pytest.mark.parametrize("seed", range(3))
def test_influences_are_what_leaving_a_realisation_out_changes(seed, width, shift):
    generator = np.random.default_rng(seed)
    samples = shift + width * generator.standard_normal((200, 12, 2))
    mean, square = samples.mean(axis=1), (samples**2).mean(axis=1)
    log, influence = log_relative_std(mean, square)
    for k in (0, 7):
        rest = np.arange(200) != k
        change = log - log_relative_std(mean[rest], square[rest])[0]
        # leaving one of n out moves the estimate by influence/(n − 1), to first order in 1/n
        slack = 20 * (1 + np.abs(influence).max() ** 2) / 199**2
        assert np.abs(change - influence[k] / 199).max() < slack
