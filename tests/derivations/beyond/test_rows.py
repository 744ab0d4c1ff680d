"""Rows of the calculator: their formulas, their calls, and what is claimed of them."""

from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.beyond import correlations, variances
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.closed_form import ClosedForm
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.sets import OpenSumError
from force_diffusion.symbolic.symbols import M, l, phi, r, sigma, t, z
from force_diffusion.symbolic.weights import Weights

import force_diffusion as fd
from force_diffusion import symbols
from tests.derivations.first_principles import covariance, weights

ROWS = [number for number in modules() if isinstance(number, str) and number != "B1"]
GOLDEN = Path(__file__).parents[2] / "golden" / "rows"
LOAD_OF_MEANS = {"B6": "B5", "B16": "B15", "B17": "B10"}
"""Means under a bulk load, and those under a surface load that they average."""


def row(number: str) -> Row:
    found = load(number)
    assert isinstance(found, Row)
    return found


@pytest.mark.long(sample=8)
@pytest.mark.parametrize("number", ROWS)
def test_formulas_are_those_on_record(number: str) -> None:
    """To make the record anew write this text into the file, and look at what has changed."""
    text = "".join(f"{name}: {form}\n" for name, form in row(number).exact_forms.items())
    assert text == (GOLDEN / f"{number}.txt").read_text(encoding="utf-8")


@pytest.mark.long(sample=8)
@pytest.mark.parametrize("number", ROWS)
def test_the_call_gives_the_first_form(number: str) -> None:
    names = {name: getattr(symbols, name) for name in symbols.__all__}
    names |= {name: getattr(fd, name) for name in CALLS}
    found = eval(row(number).call, {"__builtins__": {}}, names)
    stated = next(iter(row(number).exact_forms.values()))
    assert found.domain == stated.domain
    assert [piece.expr for piece in found.pieces] == [piece.expr for piece in stated.pieces]


CALLS = (
    "variance", "covariance", "mean", "mean_over", "response", "force_moment", "leaning", "point",
)  # fmt: skip


# claims


def changed(form: ClosedForm, everywhere: bool) -> ClosedForm:
    """Another form: −3 times this one, and more of a higher order, which depends on t."""
    function = form.function
    whole = function.points
    if not everywhere and (formulas := function.weights.formulas()):
        whole = formulas[0][0]
    more = FIELD.from_sympy(t * (M * l) ** 6 * sigma**2 / r**2)
    wrong = function.weights.scaled(FIELD.constant(-3)) + Weights(((whole, more),))
    found = form.named(form.quantity)
    found.function = replace(function, weights=wrong)
    return found


def refutations(decide: Any, forms: dict[str, ClosedForm]) -> Iterator[bool]:
    """Whether a claim is refuted of changed forms."""
    for everywhere in (True, False):
        wrong = {name: changed(form, everywhere) for name, form in forms.items()}
        try:
            yield str(decide(wrong).verdict) == "refuted"
        except OpenSumError:  # there is no sum over all columns of what is nowhere 0
            yield False


@pytest.mark.long(sample=6)
@pytest.mark.parametrize("number", ROWS)
def test_claims_are_proved_and_false_of_other_forms(number: str) -> None:
    forms = row(number).exact_forms
    assert row(number).claimed
    for words, decide in row(number).claimed.items():
        ruling = decide(forms)
        assert ruling.verdict.is_proved, f"{words}: {ruling}"
        if not words.startswith("f⁺ and f⁻ are uncorrelated"):  # that is of forms of its own
            assert any(refutations(decide, forms)), words


@pytest.mark.parametrize(
    ("domain", "is_proved"),
    [("4 − j ≤ p ≤ −4", True), ("2 − j ≤ p ≤ −4", False), ("4 ≤ p ≤ l − j − 1", False)],
)
def test_branches_are_correlated_nearer_to_where_diagonals_cross(
    domain: str, is_proved: bool
) -> None:
    ruling = correlations.uncorrelated([domain])({})
    assert ruling.verdict.is_proved == is_proved


def test_branches_are_uncorrelated_in_exact_packings_where_claimed() -> None:
    size = 13
    found = weights(size, Fraction(-1, 8), "surface")
    for lower, upper, above in product(range(size), range(size), range(-size, size)):
        layer = lower + above
        if lower <= upper and min(abs(above), abs(layer - upper), layer, size - layer) >= 4:
            value = covariance(found["+"][lower], found["-"][upper], 2 * above - (upper - lower))
            met_at_base = layer > upper and abs(layer - upper - lower) < 4
            assert value == 0 or met_at_base, (lower, upper, above)


# what ties rows to one another, and to other dimensions


def test_the_leading_order_in_d_dimensions() -> None:
    """κ² (d − 1)(2d − 1) and one profile: what B11 and B20 are at d = 2 and d = 3."""
    d = sympy.Symbol("d", positive=True)
    kappa = (1 + (d - 2) * phi) / ((1 - phi) * (1 + (d - 1) * phi))
    for number, of_load, slope in (("B11", Fraction(2, 3), 2), ("B20", Fraction(1, 10), 4)):
        profile = M**3 * (1 - z) ** 2 * (1 + slope * z)
        general = sympy.Rational(of_load) * (d - 1) * (2 * d - 1) * kappa**2 * profile
        for name, dimensions in (("discs", 2), ("spheres", 3)):
            stated = row(number).exact_forms[name].leading(1)
            expected = general.subs(d, dimensions) * (sigma / r) ** 2
            assert sympy.cancel(stated - expected) == 0
    shares = 2 * (variances.t_2 + variances.t_3) ** 2 + variances.t_2**2 + variances.t_3**2
    leaning = row("B24").exact_forms["first"].leading(1)
    upright = row("B11").exact_forms["spheres"].leading(1)
    assert sympy.cancel(leaning / upright - shares / 10) == 0


@pytest.mark.parametrize("number", LOAD_OF_MEANS)
def test_bulk_means_are_averages_of_surface_means_over_heights(number: str) -> None:
    numbers = {"phi": Fraction(2, 7), "sigma": 1, "r": 1, "t": Fraction(3, 5)}
    for name, bulk in row(number).exact_forms.items():
        surface = row(LOAD_OF_MEANS[number]).exact_forms[name]
        held = {one: numbers[one] for one in numbers if one in bulk.symbols}
        for height in range(1, 7):
            for layer in range(height):
                heights = range(layer + 1, height + 1)
                each = [surface.at(M=one, j=layer, **held) for one in heights]
                assert bulk.at(M=height, j=layer, **held) == sum(each) / len(each)
