"""Numbers and arrays as Python users have them: taken exactly, or refused in words."""

import math
from decimal import Decimal
from fractions import Fraction

import flint
import mpmath
import numpy as np
import pytest
import sympy
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

import force_diffusion as fd

RADII = 1 + 1e-3 * np.random.default_rng(1).uniform(-1, 1, (4, 5, 12))
EXACT = [
    *(Fraction(16, 5), Decimal("3.2"), 3.2, np.float64(3.2)),
    *(sympy.Rational(16, 5), flint.fmpq(16, 5)),
    *(3, Fraction(3), np.int64(3), np.uint8(3), sympy.Integer(3), flint.fmpz(3), flint.fmpq(3)),
]


@pytest.mark.parametrize("at", range(len(EXACT)))
def test_exact_numbers_are_taken(at):
    packing = fd.Packing(height=2, spacing=EXACT[at])
    assert packing.spacing == (Fraction(16, 5) if at < 6 else Fraction(3))


REFUSED = [  # longer than float64, not one number, or too long
    *(mpmath.mpf("3.2"), mpmath.iv.mpf([3, 3.5]), mpmath.mpc(3, 0), sympy.Float("3.2", 40)),
    *(sympy.sqrt(10), sympy.oo, np.longdouble("3.2"), np.float32(3.2), flint.arb("3.2"), 3 + 0j),
    *(True, Decimal("1E+9999999"), Decimal("1E-9999999"), Decimal("NaN"), math.nan, 10**6000),
    *(Fraction(10**6000, 3), Fraction(1, 10**20000), flint.fmpq(10**6000)),
]


@pytest.mark.parametrize("number", REFUSED, ids=range(len(REFUSED)))
def test_other_numbers_are_refused_in_words(number):
    for name in ("spacing", "tolerance"):
        with pytest.raises(fd.SceneError, match=rf"^{name} = .*: must (be|have) "):
            fd.solve(RADII, **{name: number})


LONGER = [
    [[1, Fraction(4, 3)]] * 2, [[mpmath.mpf(1)] * 2] * 2, [[Decimal("1.1")] * 2] * 2,
    [[mpmath.iv.mpf([1, 2])] * 2] * 2, np.full((2, 3), 1 + np.longdouble(2) ** -60),
    np.full((2, 3), 2**53 + 1), np.full((2, 3), True),
]  # fmt: skip


@pytest.mark.parametrize("radii", LONGER, ids=range(len(LONGER)))
def test_radii_are_not_cut_in_silence(radii):
    with pytest.raises(fd.SceneError, match=r"(?s)^radii = .*by \.astype\(float\)"):
        fd.solve(radii)


@pytest.mark.parametrize("kind", [np.longdouble, np.float32, np.float16, np.int8, np.uint64])
def test_radii_that_float64_holds_are_taken(kind):
    radii = np.full((3, 6), 64).astype(kind)
    assert fd.solve(radii, radius=64).scene.disorder.values.dtype == np.float64  # type: ignore[union-attr]


def test_a_huge_number_can_be_shown():
    assert "radius=1e+4999" in repr(fd.Packing(height=4, width=9, radius=10**4999))
    assert "radius=2.5" in repr(fd.Packing(height=4, width=9, radius=2.5))


def test_warnings_and_errors_of_a_batch_name_the_packing():
    radii = RADII.copy()
    radii[2] += 0.13 * np.random.default_rng(2).uniform(-1, 1, (5, 12))
    physical = fd.solve(radii).forces.data()["physical"]
    assert physical["smallest_gap_realisation"] == 2
    assert physical["first_tensile"]["realisation"] == 2
    radii[3, 0, 5] = 5.0
    with pytest.raises(ForceDiffusionError) as caught:
        fd.solve(radii)
    assert caught.value.__notes__ == ["packing 3"]


def test_a_shifted_mean_and_a_height_above_the_critical_one_are_noted():
    delta = RADII[0] - 1
    solution = fd.solve(delta_r=delta + 0.01, spacing=2.88)
    (note,) = solution.forces.plan.notes
    assert "the mean of the given radii differs" in note
    assert f"Note: {note}" in str(solution)
    assert fd.solve(delta_r=delta, spacing=2.88).forces.plan.notes == []
    wide = 0.08 * np.random.default_rng(1).uniform(-1, 1, (9, 12))
    (note,) = fd.solve(delta_r=wide).forces.plan.notes
    assert "is above M*" in note
