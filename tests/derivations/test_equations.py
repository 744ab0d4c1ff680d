"""Every printed equation is proved, and a wrong one is not."""

import re
from collections.abc import Iterable, Iterator

import pytest
import sympy
from force_diffusion.derivations.export.terminal import rests_text
from force_diffusion.derivations.framework.catalogue import Number, modules, paper
from force_diffusion.derivations.framework.decide import candidate_for
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.axioms import GAUSSIAN_FORCES
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.theorem import Theorem

from tests.derivations.rows import each


@pytest.mark.parametrize("number", each(modules()))
def test_proved(number):
    outcome = run(load(number))
    assert outcome.ruling.assuming == ((GAUSSIAN_FORCES,) if number == 15 else ())
    assert outcome.verdict is (Verdict.ASSUMING if number == 15 else Verdict.PROVED)
    for check in outcome.checks:
        if check.name.startswith("printed equation"):
            assert check.verdict is Verdict.PROVED
    assert len(outcome.refuted) == (number == 16)


@pytest.mark.parametrize(
    ("number", "left"),
    [
        (3, 7 * sy.DeltaX(sy.i + 3, sy.j)),
        (4, 2 * sy.r * sy.DeltaNMinus(sy.i + 5, sy.j)),
        (11, sy.ForceMinus(sy.i, sy.j) / sy.f_load),
        (12, sy.ForcePlus(sy.i, sy.j) / (sy.f_load / (2 * sy.n_y))),
        *((number, sy.M) for number in (14, 15, 16)),
    ],
)
def test_a_wrong_left_hand_side_is_not_proved(number, left):
    wrong = sympy.Eq(left, load(number).printed[0].rhs, evaluate=False)
    ruling = candidate_for(load(number), 0, wrong)
    assert not ruling.verdict.is_proved
    assert ruling.note


@pytest.mark.parametrize("stranger", [sy.M, sy.i, sy.p])
def test_a_term_that_is_not_of_the_cone_is_not_proved(stranger):
    derivation = load(16)
    left, right = derivation.printed[0].args
    wrong = sympy.Eq(left, right + stranger * (sy.sigma / sy.r) ** 2, evaluate=False)
    ruling = candidate_for(derivation, 0, wrong)
    assert not ruling.verdict.is_proved
    assert "neither grows nor is fixed" in ruling.note or "does not say what" in ruling.note


# premises


def _named(words: str) -> Iterator[Number]:
    """The equations that words put in: by Eq. 3, with Eqs. 4 and 5."""
    for match in re.finditer(r"\b(?:[Bb]y|[Ww]ith) Eqs?\. (\d+)(?: and (\d+))?", words):
        yield from (int(number) for number in match.groups() if number)


def _rests_on(theorems: Iterable[Theorem], but: Number | None = None) -> set[Number]:
    """The equations in whose steps and claims the premises of theorems stand, near and far.

    Without those of one equation, if one is given: then only the nearest others.
    """
    shown = {
        id(theorem): number
        for number in paper()
        if number != but
        for step in (*load(number).proof, *load(number).proof.claims)
        for theorem in step.theorems
    }
    queue, seen = list(theorems), set()
    while queue:
        theorem = queue.pop()
        if id(theorem) not in seen:
            seen.add(id(theorem))
            if but is None or id(theorem) not in shown:
                queue += theorem.premises
    return {shown[key] for key in seen & {*shown}}


@pytest.mark.parametrize("number", paper())
def test_an_equation_rests_on_what_its_own_theorems_need(number):
    derivation = load(number)
    assert {*derivation.premises} == _rests_on(derivation.theorems, but=number)
    assert {*derivation.premises} <= {*derivation.used}


def test_what_other_steps_use_is_said_apart():
    assert load(11).premises == (4, 5)
    words = rests_text(load(11))
    assert words == "It rests on Eqs. 4, 5. Steps and claims beside its proof use Eqs. 7, 9, 10."
    assert rests_text(load(2)) == "It rests on no other equation."


@pytest.mark.parametrize(("number", "premises"), [("B4", (3, 4, 5)), ("B5", (4, 5, 11))])
def test_a_row_rests_on_displacements_only_where_it_holds_one(number, premises):
    assert load(number).premises == premises


@pytest.mark.parametrize("number", paper())
def test_what_a_step_follows_from_is_among_its_premises(number):
    for step in load(number).proof:
        premises = _rests_on(step.theorems)
        assert {*step.equations_used} <= premises
        assert all(place < step.number for place in step.steps_used)
        assert {*_named(step.reason)} <= premises


def test_the_kurtosis_of_the_forces_of_a_packing():
    """The remark on Eq. 13: 3 ⟨P²⟩/⟨P⟩², P being the profile."""
    profile = (1 - sy.z) ** 2 * (2 * sy.z + 1)
    first, second = (sympy.integrate(profile**power, (sy.z, 0, 1)) for power in (1, 2))
    assert 3 * second / first**2 == sympy.Rational(156, 35)
    assert any("156/35" in remark for remark in load(13).remarks)
