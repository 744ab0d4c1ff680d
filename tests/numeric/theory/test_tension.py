"""The expected fraction of tensile contacts: against other formulas for it, and its limits."""

from typing import Any

import mpmath
import numpy as np
import pytest
from force_diffusion.numeric import closed_forms
from force_diffusion.numeric.figures.packings import PHI as PAPER_PHI
from force_diffusion.numeric.figures.packings import forces_of, planned, solved
from force_diffusion.numeric.theory.tension import (
    LOADS,
    critical_height,
    limiting_fraction,
    tensile_fraction,
)
from hypothesis import given
from hypothesis import strategies as st

PHI = 0.125

loads = pytest.mark.parametrize("load", LOADS)


def relative_error(found: Any, expected: Any) -> mpmath.mpf:
    """Relative alone: mpmath.almosteq and pytest.approx let any tiny number pass as absolute."""
    return abs(found - expected) / abs(expected) if found != expected else mpmath.mpf(0)


@loads
@given(height=st.integers(1, 30), strength=st.floats(1e-3, 10.0))
def test_it_is_the_mean_of_gaussian_tails(load: str, height: int, strength: float) -> None:
    """The normal distribution function by its own series, in place of erfc."""
    variances = {"surface": closed_forms.surface_variance, "bulk": closed_forms.bulk_variance}
    deviations = [variances[load](height, j, PHI, strength, 1.0) ** 0.5 for j in range(height)]
    tails = [mpmath.ncdf(-1 / mpmath.mpf(deviation)) for deviation in deviations]
    found = tensile_fraction(height, PHI, strength, 1.0, load)
    # the tail at −t is off by t²/2 times the relative error of σ², 3e-15; t < 1e3 here
    assert relative_error(found, mpmath.fsum(tails) / height) < 1e-8
    assert 0 <= found < 0.5


@pytest.mark.long(sample=1)
@loads
@pytest.mark.parametrize("ratio", [1, 3])
def test_the_limit_is_approached_as_one_over_m(load: str, ratio: float) -> None:
    strength = 1e-4
    height = critical_height(PHI, strength, 1.0, load)  # 459 or 785
    errors = []
    for scale in (1, 4):  # the same M/M* at a quarter of the height
        sigma = strength * scale**1.5
        M = round(float(ratio * height / scale))
        at = M / critical_height(PHI, sigma, 1.0, load)
        errors.append(tensile_fraction(M, PHI, sigma, 1.0, load) - limiting_fraction(at, load))
    assert abs(errors[0]) < 0.01 * limiting_fraction(ratio, load)
    assert 3 < errors[1] / errors[0] < 5


@pytest.mark.long(sample=3)
@loads
@pytest.mark.parametrize("ratio", [0.1, 0.4, 1, 20])
def test_the_integral_is_as_good_as_it_says(load: str, ratio: float) -> None:
    """Against Gauss-Legendre quadrature on 400 equal pieces, the integrand by another formula."""
    top, steepness = (2.0, 2.0) if load == "surface" else (1.5, 4.0)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    z = ((np.arange(400)[:, None] + (nodes + 1) / 2) / 400).ravel()
    t = 1 / np.sqrt(ratio**3 * top * (1 - z) ** 2 * (1 + steepness * z))
    tails = np.array([float(mpmath.ncdf(-x)) for x in t])
    whole = float(np.sum(tails * np.tile(weights, 400)) / 800)
    # t²/2, up to 250 at the peak, is rounded; that is the relative error of a tail
    assert float(limiting_fraction(ratio, load)) == pytest.approx(whole, rel=1e-12, abs=0)


@pytest.mark.long
@loads
def test_more_digits_agree_with_fewer(load: str) -> None:
    for ratio in ("0.02", 1, 50):
        few, many = (limiting_fraction(ratio, load, digits=digits) for digits in (20, 45))
        with mpmath.workdps(45):
            assert relative_error(few, many) < mpmath.mpf(10) ** -19


@pytest.mark.long(sample=1)
@loads
def test_it_grows_from_none_to_one_half(load: str) -> None:
    ratios = [0, 0.1, 0.3, 1, 3, 10, 1e4]
    fractions = [limiting_fraction(ratio, load) for ratio in ratios]
    assert fractions[0] == 0
    assert fractions == sorted(set(fractions))
    assert 0.49999 < fractions[-1] < 0.5
    assert tensile_fraction(7, PHI, 0, 1, load) == 0


@loads
@pytest.mark.parametrize("digits", [1, 15, 40])
def test_the_critical_height_is_where_the_mean_variance_is_one(load: str, digits: int) -> None:
    with mpmath.workdps(digits + 10):
        found = critical_height("0.25", "1e-7", 2, load, digits)
        per_cube = mpmath.mpf(1) if load == "surface" else mpmath.mpf(1) / 5
        mean = found**3 * per_cube * (mpmath.mpf("1e-7") / 2) ** 2 / (1 - mpmath.mpf("0.0625")) ** 2
        assert relative_error(mean, 1) < 4 * mpmath.mpf(10) ** -digits


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((0, 0.1, 1, 1, "bulk"), "M = 0"),
        ((2.5, 0.1, 1, 1, "bulk"), "M = 2.5"),
        ((np.array([3]), 0.1, 1, 1, "bulk"), "M = "),
        ((3, 0.5, 1, 1, "bulk"), "phi = 0.5: -1/2 < phi < 1/2 is allowed"),
        ((3, "x", 1, 1, "bulk"), "phi = 'x'"),
        ((3, 0.1, -1, 1, "bulk"), "sigma = -1"),
        ((3, 0.1, float("nan"), 1, "bulk"), "sigma = nan"),
        ((3, 0.1, 1, 0, "bulk"), "r = 0"),
        ((3, 0.1, 1, 1j, "bulk"), "r = 1j"),
        ((3, 0.1, 1, 1, "both"), "'surface' or 'bulk' is allowed"),
        ((3, 0.1, 1, 1, "bulk", 0), "digits = 0"),
        ((3, 0.1, 1, 1, "bulk", 2.0), "digits = 2.0"),
    ],
)
def test_what_is_not_allowed(arguments: Any, says: str) -> None:
    with pytest.raises(ValueError, match="allowed") as refused:
        tensile_fraction(*arguments)
    assert says in str(refused.value)


def test_limits_that_do_not_exist() -> None:
    with pytest.raises(ValueError, match="ratio = -1"):
        limiting_fraction(-1, "bulk")
    with pytest.raises(ValueError, match="sigma = 0"):
        critical_height(0.1, 0, 1, "bulk")


def test_exact_packings_at_the_critical_height_have_that_many() -> None:
    """M = 21 at σ/r = 0.01, where M* = 21.3: exact and nonlinear, 200 packings of 42 beads a layer.

    Forces are nonlinear by about 1 % there, and 200 packings scatter by 1 %: 5 % is beyond both.
    """
    M, std = 21, 0.01
    ensemble = planned("profile", height=M, width=2 * M, seed=5, std=std, realisations=200)
    tensile = contacts = 0
    for answer, _ in solved(ensemble, range(200)):
        forces = forces_of(answer)
        for j in range(1, M + 1):
            F, change = forces.ordered.plus[j], forces.change.plus[j]
            tensile += int((F + change < 0).sum())
            contacts += change.size
    found = tensile / contacts
    assert found == pytest.approx(
        float(tensile_fraction(M, float(PAPER_PHI), std, 1, "surface")), rel=0.05
    )


@loads
@pytest.mark.parametrize("ratio", ["1e-6", "1e-9"])
def test_a_tiny_fraction_has_its_digits(load: str, ratio: str) -> None:
    """Against Laplace's method about the peak, good to (M/M*)^(3/2), the width of the peak."""
    with mpmath.workdps(80):
        cubed = mpmath.mpf(ratio) ** 3
        # the profile is top (1 − bend (z − peak)² + …), with its peak at the end z = 0 or at 1/6
        top, bend, sides = (
            (2, 3, 1) if load == "surface" else (mpmath.mpf(125) / 72, mpmath.mpf(108) / 25, 2)
        )
        t = 1 / mpmath.sqrt(2 * cubed * top)
        expected = sides * mpmath.erfc(t) / 4 * mpmath.sqrt(mpmath.pi / bend) / t
        assert relative_error(limiting_fraction(ratio, load, 25), expected) < 3 * cubed**0.5


def test_a_tiny_fraction_at_finite_height_has_its_digits() -> None:
    """At M = 1 there is one layer; 1/2σ_f² is about 7e29 here, so that many digits are lost."""
    with mpmath.workdps(80):
        sigma = mpmath.mpf("1e-15")
        std = mpmath.sqrt(closed_forms.surface_variance(1, 0, mpmath.mpf("0.125"), sigma, 1))
        found = tensile_fraction(1, "0.125", sigma, 1, "surface", 20)
        assert relative_error(found, mpmath.erfc(1 / std / mpmath.sqrt(2)) / 2) < 1e-19
