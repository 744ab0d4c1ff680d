"""Answers that were wrong once, and numbers of unusual types and sizes."""

from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np
import pytest
import sympy
from flint import fmpq, fmpz
from force_diffusion.derivations.framework.evaluation import ArgumentError
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic.kernel.decisions import Verdict

import force_diffusion as fd

PHI, STD = Fraction(1, 8), Fraction(1, 100)
BULK = (14, "B3", "B6", "B14", "B16", "B17", "B25")


@pytest.mark.parametrize("number", BULK)
def test_under_a_bulk_load_the_highest_layer_is_one_of_the_interior(number: int | str) -> None:
    for form in load(number).exact_forms.values():
        assert [piece.domain for piece in form.pieces] == ["j ≥ 2", "j = 1", "j = 0"]


def test_the_mean_force_of_the_highest_layer_under_a_bulk_load() -> None:
    value = fd.equation("B6").at(M=6, j=5, phi=PHI, sigma=1, r=1)
    assert value == sympy.Rational(4486, 567)


def test_loads_on_spheres_are_told_by_both_ratios() -> None:
    """So no τ₁ and τ₂ can be asked for that no load has: τ₁²/2 ≤ τ₂ < τ₁²."""
    for number in ("B24", "B25"):
        form = fd.equation(number).exact()
        assert {"t_2", "t_3"} <= {*form.symbols}
        with pytest.raises(ArgumentError):
            form.at(M=5, j=2, phi=PHI, sigma=STD, r=1, t_2=-1, t_3=1)


def test_averages_over_loads_with_beads_of_their_own_are_known_for_every_number_of_them() -> None:
    form = fd.equation("B23").exact()
    place = {"l": 12, "phi": PHI, "sigma": 1, "r": 1}
    for layer in (0, 3):
        for across in (-1, 0, 2):  # (i − k)/2 is half of q − p
            for number in range(2, layer + 5):
                k = 12
                value = form.at(j=layer, i=k + 2 * across + layer % 2, k=k, N=number, **place)
                assert value > 0


@pytest.mark.parametrize(
    ("number", "profile", "crossover"),
    [(13, "superdiffusive near the surface", "z = 1/4"), (14, "superdiffusive", "z = 3/8")],
)
def test_the_crossover_is_claimed(number: int, profile: str, crossover: str) -> None:
    claims = [claim.reason for claim in load(number).proof.claims]
    assert any(profile in claim and crossover in claim for claim in claims)


def test_the_exponents_of_the_profiles() -> None:
    """Independently, with SymPy: d ln P/d ln (1 − z)."""
    z = sympy.Symbol("z")
    for slope, exponent in ((2, 6 * z / (2 * z + 1)), (4, (12 * z - 2) / (4 * z + 1))):
        profile = (1 - z) ** 2 * (slope * z + 1)
        found = -(1 - z) * sympy.diff(profile, z) / profile
        assert sympy.simplify(found - exponent) == 0
    assert sympy.Rational(3) * _mean(4) / _mean(2) ** 2 == sympy.Rational(156, 35)


def _mean(power: int) -> sympy.Expr:
    """The mean of the profile of Eq. 13 to half a power, over all heights."""
    z = sympy.Symbol("z")
    return sympy.integrate(((1 - z) ** 2 * (2 * z + 1)) ** (power // 2), (z, 0, 1))


def test_generated_code_has_the_cases_of_small_packings() -> None:
    form, space = fd.equation(13).exact(), {}
    exec(form.python("variance"), space)
    for height in range(1, 6):
        for layer in range(height):
            given = {"M": height, "j": layer, "phi": PHI, "sigma": STD, "r": Fraction(1)}
            assert space["variance"](**given) == Fraction(str(form.at(**given)))
    with pytest.raises(ValueError, match="outside"):
        space["variance"](M=3, j=3, phi=PHI, sigma=STD, r=1)


def _at(**given: object) -> object:
    return fd.equation(13).at(**given)


def _at_finite_size(**given: object) -> object:
    return fd.equation(13).exact().at(**given)


EXACT_FORMS = {"printed": _at, "form": _at_finite_size}
GIVEN = {"M": 10, "j": 3, "phi": -PHI, "r": 1}


@pytest.mark.parametrize("at", EXACT_FORMS.values(), ids=EXACT_FORMS)
def test_exact_numbers_of_any_kind_give_the_same(at) -> None:  # type: ignore[no-untyped-def]
    values = [
        at(sigma=sigma, **GIVEN)
        for sigma in (STD, Decimal("0.01"), sympy.Rational(1, 100), fmpq(1, 100))
    ]
    assert all(isinstance(value, sympy.Rational) for value in values)
    assert len({*values}) == 1
    assert at(sigma=fmpz(2), **GIVEN) == at(sigma=2, **GIVEN)


@pytest.mark.parametrize("at", EXACT_FORMS.values(), ids=EXACT_FORMS)
@pytest.mark.parametrize(
    "sigma",
    [
        mpmath.mpf("0.1"),
        sympy.Float("0.1", 50),
        np.longdouble("0.1"),
        mpmath.iv.mpf([0.1, 0.2]),
        [mpmath.mpf(1)],
        Decimal("1E+9999999"),
        Decimal("1E-9999999"),
        1j,
        "0.1",
        None,
    ],
    ids=repr,
)
def test_what_is_no_number_or_a_longer_float_is_refused(at, sigma) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(ArgumentError, match="allowed"):
        at(sigma=sigma, **GIVEN)


def test_numbers_of_thousands_of_digits_get_an_answer_or_a_sentence() -> None:
    equation = fd.equation(13)
    form, huge = equation.exact(), 10**5000
    assert form.at(M=huge, j=3, phi=0, sigma=1, r=1) > huge
    assert form.decide(form.pieces[0].expr + huge).verdict is Verdict.REFUTED
    assert "digits" in equation.decide(equation.rhs * huge).note
    assert equation.decide(equation.rhs + huge).verdict is Verdict.PROVED  # of a lower order
    for ask in (
        lambda: form.at(M=3, j=huge, phi=0, sigma=1, r=1),
        lambda: form.decide(form.pieces[0].expr, M=huge, j=4),
    ):
        with pytest.raises(ArgumentError) as raised:
            ask()
        assert len(str(raised.value)) < 200
