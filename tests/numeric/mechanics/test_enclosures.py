"""Enclosures hold more digits, what is no packing is named, and where radii come from."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.accuracy import ToleranceError
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import Layer, Rows, whole
from force_diffusion.numeric.mechanics import sweep
from force_diffusion.numeric.theory.expected import critical_height

from tests.numeric.scenes import answer, basic


@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf, -1.0, -1.5])
@pytest.mark.parametrize("layer", [0, 1, 2])
def test_a_radius_that_is_none_names_the_bead(wrong, layer):
    rho, bead = np.zeros((1, 12)), rf"\({4 + layer % 2}, {layer}\)"
    rho[0, 4 * layer + 2] = wrong
    with FLOAT64.active(), pytest.raises(sweep.UnbuildableError, match=bead):
        sweep.deposit(Fraction(-1, 8), whole(4, 2), rho, FLOAT64)


# Radii


def row(radii: DrawnRadii, layer: Layer, k: int) -> np.ndarray[Any, Any]:
    """Give δr/r of a row of beads."""
    (deviations,) = radii.of(Rows([layer.first], [layer.count], layer.j), [k], FLOAT64)
    return deviations  # type: ignore[no-any-return]


@pytest.mark.parametrize("kind", ["uniform", "normal", "two-point"])
@pytest.mark.parametrize("seed", [0, 2**63 - 1, 2**63 + 5, 2**63 + 6, 2**64 - 1])
def test_rows_drawn_together_are_numpys_words_for_every_seed(kind, seed):
    """Words of NumPy's own generator, its key given as 64-bit words: no seed is rounded."""
    radii = DrawnRadii(kind, Fraction(1, 100), seed, 5)
    ring, together = Layer(3, 1, 5), [7, 0, 2**40]
    rows = radii.of(Rows([1], [5], 3), together, FLOAT64)
    for own, k in zip(rows, together, strict=True):
        key = np.array([seed, k], dtype=np.uint64)
        words = np.random.Philox(counter=[2**62 - 1, 3, 0, 0], key=key).random_raw(20)
        assert own.tolist() == row(radii, ring, k).tolist()
        if kind == "two-point":
            assert (np.sign(own) == np.where(words[::4] >= 2**63, 1, -1)).all()
        elif kind == "uniform":  # the upper 53 bits, in units of 2^-53
            whole = [Fraction(int(w) >> 11) + Fraction(1, 2) for w in words[::4]]
            exact = [float((2 * w / 2**53 - 1) / 100) * math.sqrt(3) for w in whole]
            assert own == pytest.approx(exact, rel=1e-14)


@pytest.mark.parametrize(
    ("kind", "fourth"), [("uniform", 9 / 5), ("normal", 3.0), ("two-point", 1.0)]
)
def test_deviates_have_the_moments_of_their_distribution(kind, fourth):
    """n = 4e5: five standard errors of each moment (those of x⁴ at most √96/√n)."""
    n = 400_000
    x = 100 * row(DrawnRadii(kind, Fraction(1, 100), 12, None), Layer(0, 0, n), 3)
    room = 5 / math.sqrt(n)
    assert abs(x.mean()) < room
    assert abs((x**2).mean() - 1) < room * math.sqrt(2)
    assert abs((x**3).mean()) < room * math.sqrt(15)
    assert abs((x**4).mean() - fourth) < room * math.sqrt(96)


def test_critical_height_far_outside_of_floats():
    assert critical_height(Fraction(1, 10**300)) == pytest.approx(1e200, rel=1e-9)
    assert critical_height(Fraction(0)) == math.inf
    assert critical_height(Fraction(1, 10**4999)) == math.inf
    assert critical_height(Fraction(10**4999)) == 0


def test_tolerances_below_the_smallest_float():
    outcome = answer(basic(4, None, quantity="contact", at=[0, 0, "+"], tolerance="=1e-400"))
    assert outcome.accuracy.arithmetic.startswith("arb balls, 13")
    bound = outcome.data()["accuracy"]["error_bound"]
    assert isinstance(bound, str)
    assert outcome.accuracy.error_bound <= Fraction(bound) <= Fraction(1, 10**400)


def test_the_error_states_a_tolerance_that_can_be_met():
    sections = basic(4, None, quantity="contact", at=[0, 0, "+"], tolerance="=1e-5000")
    with pytest.raises(ToleranceError, match=r"1e-5000 .* needs 16\d\d\d bits") as caught:
        answer(sections)
    assert "tried" not in str(caught.value)
    assert "M*" not in str(caught.value)
    assert caught.value.exit_status == 3
    least = str(caught.value).split("about ")[1].split()[0]
    sections["ask"]["tolerance"] = f"={least}"
    assert answer(sections).accuracy.error_bound <= Fraction(least)
