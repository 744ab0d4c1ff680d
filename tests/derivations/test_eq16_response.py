"""The response to a point load: closed forms against exact packings, and how cases are split."""

from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy
from force_diffusion.derivations import eq16_response as eq16
from force_diffusion.derivations.api.derived import Derived
from force_diffusion.derivations.api.proof import Proof
from force_diffusion.derivations.export import terminal
from force_diffusion.derivations.export.document import statement_latex
from force_diffusion.derivations.framework import runner
from force_diffusion.derivations.framework.layers import UNIT
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.proof import Steps
from force_diffusion.numeric import closed_forms
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.limits import asymptotic
from force_diffusion.symbolic.kernel.theorem import FalseStatementError, NotProvedError
from force_diffusion.symbolic.trees import equation
from hypothesis import given
from hypothesis import strategies as st
from sympy import Rational

from tests.soundness.witnesses.moments import DIRECTIONS, Packing

ONE = Fraction(1)
cosines = st.fractions(Fraction(-49, 100), Fraction(49, 100), max_denominator=1000)


@pytest.mark.parametrize("level", [*range(1, 7), 9])
def test_every_contact_and_bead_of_the_cone(level: int) -> None:
    """l = 9 is the first with a bead that is three steps away from both legs and the base."""
    n = DIRECTIONS[level % 6]
    phi = n[1] ** 2 - n[0] ** 2
    first = level % 2

    def variance(of: sympy.Expr, i: int, j: int) -> Fraction:
        packing = Packing(level, n, "point", at={sy.k: first, sy.i: i, sy.j: j}, order=1)
        found = packing.moment(sy.Variance(of / sy.f_load))
        return Fraction(int(found.p), int(found.q))

    forces = sy.ForcePlus(sy.i, sy.j), sy.ForceMinus(sy.i, sy.j)
    vertical = sy.VerticalPlus(sy.i, sy.j), sy.VerticalMinus(sy.i, sy.j)
    for layer in range(level):
        for across in range(layer - level, level - layer + 1, 2):
            site = across + first, layer
            at = *site, first, level
            for branch, force, push in zip("+-", forces, vertical, strict=True):
                stated = closed_forms.contact_response(*at, branch, phi, ONE, ONE)
                assert stated == variance(push, *site), (site, branch)
                if across == (layer - level if branch == "+" else level - layer):
                    of_leg = closed_forms.leg_variance(layer, level, phi, ONE, ONE)
                    assert of_leg == variance(2 * sy.n_y * force, *site), site
            both = variance(sympy.Add(*vertical), *site)
            assert closed_forms.bead_response(*at, phi, ONE, ONE) == both, site


def test_a_wrong_closed_form_is_found() -> None:
    exact = [one for one in eq16.steps() if one.formula.has(*eq16.EXACT) and one.relation == "="]
    assert exact
    for step in exact:
        left, right = step.formula.args
        for change in (Rational(1), sy.phi / 10**6, sy.j, sy.phi * sy.l):
            with pytest.raises(FalseStatementError):
                step.prove(0, equation(left, right + change * UNIT))


@given(
    phi=cosines,
    level=st.one_of(st.integers(1, 12), st.integers(1, 10**9)),
    data=st.data(),
)
def test_float64_is_accurate(phi: Fraction, level: int, data: st.DataObject) -> None:
    layer = data.draw(st.one_of(st.integers(0, min(level, 5)), st.integers(0, level)))
    reach = level - layer + 2
    steps = data.draw(st.one_of(st.integers(0, min(reach, 4)), st.integers(0, reach)))
    k = level % 2
    i = k - reach + 2 * steps
    rounded = Fraction(float(phi))
    forms: list[tuple[Any, tuple[Any, ...]]] = [
        (closed_forms.bead_response, (i, layer, k, level)),
        (closed_forms.contact_response, (i, layer, k, level, "+")),
        (closed_forms.contact_response, (i, layer, k, level, "-")),
        (closed_forms.response, (level, layer)),
    ]
    if layer < level:
        forms.append((closed_forms.leg_variance, (layer, level)))
    for form, site in forms:
        exact = form(*site, rounded, ONE, ONE)
        found = Fraction(form(*site, float(phi), 1.0, 1.0))
        # some 20 roundings; the least favourable, (1+φ)² near φ = −½, is enlarged tenfold
        assert abs(found - exact) <= 200 * Fraction(2) ** -53 * exact


@given(phi=cosines, level=st.integers(1, 30), across=st.integers(-30, 30), data=st.data())
def test_mirror_image_and_translation(
    phi: Fraction, level: int, across: int, data: st.DataObject
) -> None:
    layer = data.draw(st.integers(0, level))
    i = data.draw(st.integers(-40, 40).filter(lambda i: (i + layer) % 2 == 0))
    k = 2 * across + level % 2
    at, mirrored, moved = (i, layer, k, level), (-i, layer, -k, level), (i + 6, layer, k + 6, level)
    bead = closed_forms.bead_response(*at, phi, ONE, ONE)
    assert closed_forms.bead_response(*mirrored, phi, ONE, ONE) == bead
    assert closed_forms.bead_response(*moved, phi, ONE, ONE) == bead
    right = closed_forms.contact_response(*at, "+", phi, ONE, ONE)
    assert closed_forms.contact_response(*mirrored, "-", phi, ONE, ONE) == right
    if abs(i - k) > level - layer:
        assert bead == right == 0


def test_only_the_height_matters_but_next_to_the_load_and_the_base() -> None:
    level, phi = 40, Fraction(7, 25)
    for layer in range(3, level - 2):
        inside = range(-(level - layer) + 2, level - layer - 1, 2)
        found = {closed_forms.bead_response(i, layer, 0, level, phi, ONE, ONE) for i in inside}
        assert len(found) == 1
        contacts = {
            closed_forms.contact_response(i, layer, 0, level, "+", phi, ONE, ONE) for i in inside
        }
        assert len(contacts) == len(inside)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((1, 0, 0, 4), r"\(1, 0\) is not a site"),
        ((0, 0, 1, 4), r"\(1, 4\) is not a site"),
        ((0.5, 0, 0, 4), "i = 0.5: one whole number is allowed"),
        ((0, -2, 0, 4), "j = -2: one whole number from 0 on"),
        ((0, 0, float("nan"), 4), "k = nan"),
        ((0, 0, 0, None), "l = None"),
        ((np.array([0, 2]), 0, 0, 4), "i = "),
    ],
)
def test_what_is_not_allowed(arguments: tuple[Any, ...], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        closed_forms.bead_response(*arguments, 0.1, 1.0, 1.0)
    with pytest.raises(ValueError, match=says):
        closed_forms.contact_response(*arguments, "+", 0.1, 1.0, 1.0)


def test_what_is_not_allowed_of_legs_and_branches() -> None:
    with pytest.raises(ValueError, match="branch = 1: '\\+' or '-' is allowed"):
        closed_forms.contact_response(0, 0, 0, 4, 1, 0.1, 1.0, 1.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="0 <= j < l = 4 is allowed"):
        closed_forms.leg_variance(4, 4, 0.1, 1.0, 1.0)


@pytest.mark.parametrize("kind", [float, np.float64, Fraction, mpmath.mpf])
def test_the_result_is_of_the_type_of_phi(kind: Any) -> None:
    quarter, one = kind(1) / kind(4), kind(1)
    for site in ((0, 2, 0, 8), (-6, 2, 0, 8), (10, 2, 0, 8), (0, 8, 0, 8)):
        found = closed_forms.bead_response(*site, quarter, one, one)
        assert type(found) is type(quarter)


def test_the_printed_statement_for_one_contact_is_refuted_and_no_failure() -> None:
    derivation = load(16)
    (reading,) = derivation.proof.refuted
    assert reading.formula.rhs == derivation.printed[0].rhs
    assert reading.relation == "∼"
    assert "goes to (j + p)/(2 j + p + q), not to 1" in reading.reason


def test_what_holds_for_one_contact_is_not_refuted() -> None:
    proof = Steps(16, eq16.CONE, eq16.MEANING)
    (of_contact,) = (
        one.formula.rhs
        for one in load(16).proof.claims
        if one.reason.startswith("to leading order")
    )
    rule = asymptotic(*eq16.in_radii())
    for rhs in (of_contact, of_contact * (1 + 1 / sy.l)):
        with pytest.raises(NotProvedError, match="was to be refuted"):
            proof.refute("true", equation(eq16.ONE_CONTACT, rhs), rule, eq16.CONE)


def test_all_that_is_said_of_the_run_counts_it() -> None:
    outcome = runner.run(load(16))
    words = "1 printed statement refuted, as expected (see ERRATA)"
    derived, proof = Derived((outcome,)), Proof((outcome,))
    assert outcome.verdict is proof.verdict is Verdict.PROVED
    assert derived.proved
    assert derived.counts() == f"1 proved, {words}"
    assert [check.kind for check in proof.refuted] == ["refutation"]
    for said in (str(derived), str(proof), terminal.outcome_text(outcome)):
        assert words in said
    assert terminal.trouble_lines(outcome) == []
    (found,) = derived.data()["equations"]
    assert found["refuted as expected"] == 1
    assert [c["verdict"] for c in found["checks"] if c["kind"] == "refutation"] == ["refuted"]
    (reading,) = outcome.derivation.proof.refuted
    for document in (derived.latex()["equations.tex"], terminal.outcome_text(outcome)):
        assert reading.reading[1:] in " ".join(document.split())  # a sentence, or part of one


def test_the_statement_for_one_contact_is_in_no_fragment() -> None:
    """A fragment is to be pasted."""
    assert "contact" not in statement_latex(load(16))
    assert statement_latex(load(16)).count(r"\sim") == 1
