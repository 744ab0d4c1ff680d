"""Rows of the calculator: their formulas, their calls, and what is claimed of them."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.closed_form import ClosedForm
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.symbols import M, l, r, sigma, t
from force_diffusion.symbolic.weights import Weights

import force_diffusion as fd
from force_diffusion import symbols
from tests.derivations.rows import each

ROWS = [number for number in modules() if isinstance(number, str) and number != "B1"]
GOLDEN = Path(__file__).parents[2] / "golden" / "rows"


def row(number: str) -> Row:
    statement = load(number)
    assert isinstance(statement, Row)
    return statement


@pytest.mark.parametrize("number", each(ROWS))
def test_formulas_are_those_on_record(number):
    """To make the record anew write this text into the file, and look at what has changed."""
    forms = row(number).exact_forms.items()
    text = "".join(f"{name}: " + "\n".join([*form.lines(), ""]) for name, form in forms)
    assert text == (GOLDEN / f"{number}.txt").read_text(encoding="utf-8")


@pytest.mark.parametrize("number", each(ROWS))
def test_the_call_gives_the_first_form(number):
    names = {name: getattr(symbols, name) for name in symbols.__all__}
    names |= {name: getattr(fd, name) for name in CALLS}
    form = eval(row(number).call, {"__builtins__": {}}, names)
    first = next(iter(row(number).exact_forms.values()))
    assert form.domain == first.domain
    assert [piece.expr for piece in form.pieces] == [piece.expr for piece in first.pieces]


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
    copy = form.named(form.quantity)
    copy.function = replace(function, weights=wrong)
    return copy


def refutations(number: str) -> Iterator[str]:
    """The claims that are refuted of changed forms."""
    forms = row(number).exact_forms.items()
    for everywhere in (True, False):
        wrong = {name: changed(form, everywhere) for name, form in forms}
        for words, ruling in row(number).claimed(wrong).items():
            if str(ruling.verdict) == "refuted":
                yield words


@pytest.mark.parametrize("number", each(ROWS))
def test_claims_are_proved_and_false_of_other_forms(number):
    claims = dict(row(number).claims)
    assert claims
    assert not [words for words, ruling in claims.items() if not ruling.verdict.is_proved]
    assert {*refutations(number)} == {*claims}
