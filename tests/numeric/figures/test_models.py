"""The simpler models: what they conserve, and their known limits."""

from math import asin

import numpy as np
import pytest
from force_diffusion.numeric.figures import double_y, q_model
from force_diffusion.numeric.figures.packings import N_X

TILT = asin(N_X)


def simulated(loads: np.ndarray, depth: int) -> np.ndarray:
    """Loads at depths 0 … D below those of the surface, (n, W) and periodic; (n, D + 1, W).

    What a bead carries goes to the two beads below it, of column i to i and i + 1.
    """
    generator, by_depth = np.random.default_rng(2), [loads]
    for _ in range(depth):
        share = generator.random(loads.shape)
        by_depth.append(share * by_depth[-1] + np.roll((1 - share) * by_depth[-1], 1, axis=1))
    return np.stack(by_depth, axis=1)


def test_the_recursion_of_the_q_model_is_what_simulation_finds():
    depth, width, n = 12, 32, 1500
    loads = simulated(np.ones((n, width)), depth)
    assert loads.sum(axis=2) == pytest.approx(np.full((n, depth + 1), width), rel=1e-13)
    squares = ((loads - 1) ** 2).mean(axis=2)
    error = squares.std(axis=0)[1:] / np.sqrt(n)
    off = np.abs(squares.mean(axis=0) - q_model.weight_variance(depth))
    assert off[0] == 0
    assert (off[1:] < 5 * error).all()


def test_q_model_weights_saturate_at_one_half():
    """P(w) = 4 w exp(−2w) at infinite depth, of variance 1/2; approached as depth^(−1/2)."""
    variance = q_model.weight_variance(4000)
    assert variance[1:3] == pytest.approx([1 / 6, 17 / 72])
    missing = 0.5 - variance
    assert (np.diff(missing) < 0).all()
    assert missing[1000] / missing[4000] == pytest.approx(2, rel=0.01)


def test_rays_without_defects_are_the_cone():
    end, at_base, force = double_y.walk(0, TILT, double_y.SPLITTING_ANGLE, 1000, 1)
    slope = float(N_X) / np.sqrt(1 - float(N_X) ** 2)
    assert np.abs(end) == pytest.approx(np.full(1000, slope), rel=1e-12)
    assert end.mean() == pytest.approx(0, abs=1e-12)
    assert at_base.all()
    assert force == pytest.approx(np.ones(1000), rel=1e-12)


@pytest.mark.parametrize("splits", [0.5, 4.0])
def test_rays_conserve_the_vertical_force(splits):
    _, at_base, force = double_y.walk(splits, TILT, double_y.SPLITTING_ANGLE, 100_000, 3)
    net = np.where(at_base, force, -force)  # of the base, less what lifts the surface
    error = net.std() / np.sqrt(len(net))
    assert net.mean() == pytest.approx(1, abs=5 * error)
    assert error < 0.02


def test_the_response_turns_from_two_peaks_to_a_broad_one():
    def shares(splits: float) -> tuple[float, float]:
        profile = double_y.profile(splits, TILT, seed=4, rays=100_000)
        middle = np.abs(double_y.BINS[:-1] + double_y.BINS[1:]) / 2
        whole = profile.sum()
        cone = np.abs(middle - 1.134) < 0.1
        return float(profile[cone].sum() / whole), float(profile[middle < 0.5].sum() / whole)

    shallow, deep = shares(0.25), shares(8.0)
    assert shallow[0] > 0.6
    assert shallow[1] < 0.02
    assert deep[0] < 0.15
    assert deep[1] > 0.2
