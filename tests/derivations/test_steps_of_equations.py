"""Every step of every derivation: proved, what it follows from, and mutants that must not be."""

import re
from collections.abc import Callable
from copy import copy
from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations.eq15_general_form import HEIGHT
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.proving import Lines
from force_diffusion.derivations.framework.record import Derivation, Statement
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.derivations.framework.runner import proofs, run
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.decisions import Verdict

from tests.properties.mutants import mutants

ALL = [load(number) for number in modules()]
every_derivation = pytest.mark.parametrize(
    "derivation", [one for one in ALL if isinstance(one, Derivation)], ids=lambda d: f"eq{d.number}"
)
every_equation = pytest.mark.parametrize("derivation", ALL, ids=lambda d: f"eq{d.number}")

AT_RIGHT_ANGLES = "a change of direction is at right angles to its contact, at every bead; −0 is 0"
NOTHING_THERE = "the weight of the layer that is added, left out or counted elsewhere is zero there"
DROPPED_ANYWAY = "weights of order 1 change, and these are what the step drops"

SAME = {
    ("4", 4): (
        AT_RIGHT_ANGLES,
        "left: sign of n⁺·δn⁺_ij flipped",
        "left: δn⁺_ij shifted to δn⁺_(i+2,j)",
        "left: δn⁺_ij shifted to δn⁺_(i−1,j+1)",
    ),
    ("5", 5): (
        AT_RIGHT_ANGLES,
        "left: sign of n⁻·δn⁻_ij flipped",
        "left: δn⁻_ij shifted to δn⁻_(i+2,j)",
        "left: δn⁻_ij shifted to δn⁻_(i−1,j+1)",
    ),
    ("12", 4): (
        NOTHING_THERE,
        "upper bound m = M shifted to M + 1",
        "case m ≤ j shifted to j + 1",
    ),
    ("12", 5): (
        NOTHING_THERE,
        "left: upper bound m = M shifted to M + 1",
        "left: case m ≤ j shifted to j + 1",
        "upper bound m = M shifted to M − 1",
        "case m ≤ j shifted to j − 1",
    ),
    ("12", 7): (
        DROPPED_ANYWAY,
        "left: upper bound m = M shifted to M − 1",
        "left: case m ≤ j shifted to j + 1",
        "sign of -1 flipped",
        "-1 dropped",
    ),
    ("13", 1): (NOTHING_THERE, "upper bound m = M shifted to M − 1"),
    ("13", 3): (NOTHING_THERE, "left: upper bound m = M shifted to M − 1"),
    ("14", 3): (
        NOTHING_THERE,
        "left: lower bound l = j + 1 shifted to j",
        "left: lower bound l = m shifted to m + 1",
    ),
    ("14", 4): (NOTHING_THERE, "left: lower bound m = 1 shifted to 0"),
    ("14", 5): (
        NOTHING_THERE,
        "left: upper bound m = M shifted to M + 1",
        "left: upper bound m = M shifted to M − 1",
    ),
    ("B1", 1): (
        "all beads of the surface carry the same load",
        "left: Fˡᵒᵃᵈ_kl shifted to Fˡᵒᵃᵈ_(k+2,l)",
    ),
}
"""Mutants of a step that say the same: why, and which."""


@every_equation
def test_every_step_is_a_statement_and_proved(derivation: Statement) -> None:
    steps = list(derivation.steps())
    assert steps
    for place, step in enumerate(steps, start=1):
        assert all(isinstance(one, sympy.Eq) for one in step.equations), place
        assert step.verdict.is_proved, (place, step.ruling)
    shown = {one for step in steps for one in step.equations}
    if isinstance(derivation, Row):  # a step for each formula
        forms = derivation.exact_forms.values()
        printed = {equation(form.quantity, one.expr) for form in forms for one in form.pieces}
        assert shown == printed
    else:
        assert shown >= set(derivation.printed)


@every_derivation
def test_a_step_follows_from_premises_and_earlier_steps(derivation: Derivation) -> None:
    printed_at = {}
    numbers = {str(one.number) for one in derivation.premises}
    for place, step in enumerate(derivation.steps(), start=1):
        if all(one in derivation.printed for one in step.equations):
            printed_at[str(derivation.number)] = place
        for used in step.uses:
            equation, earlier = re.fullmatch(r"(?:Eq\. (\w+))|(?:step (\d+))", used).groups()
            if earlier:
                assert int(earlier) < place, (place, used)
            elif equation != str(derivation.number):
                assert equation in numbers, (place, used)
            elif derivation.number != 1:  # that what the printed equation says is checked on it
                assert place > 1, (place, used)
    assert printed_at


@pytest.mark.long(share=3)
@every_equation
def test_a_changed_step_is_not_proved(derivation: Statement) -> None:
    for place, step in enumerate(derivation.steps(), start=1):
        if all(one in derivation.printed for one in step.equations):
            continue  # its mutants are judged in tests/soundness
        tried, survived = 0, []
        for part, shown in enumerate(step.equations):
            for _, change, mutant in mutants(shown):
                tried += 1
                ruling = step.rule_on(part, mutant)
                assert ruling.note, change
                if ruling.verdict is Verdict.PROVED:
                    survived.append(change)
        assert tried or step.equations[0].rhs == 0, place
        _, *same = SAME.get((str(derivation.number), place), ("",))
        assert survived == same, place


def with_step(derivation: Derivation, place: int, formula: sympy.Basic) -> Derivation:
    """The derivation with another formula in one of its steps."""

    def steps() -> Lines:
        told = copy(derivation.steps())
        told[place - 1] = replace(told[place - 1], formula=formula)
        return told

    return replace(derivation, steps=steps)


def changed(old: sympy.Basic, new: sympy.Basic) -> Callable[[sympy.Basic], sympy.Basic]:
    return lambda formula: formula.xreplace({old: new})


@pytest.mark.long(sample=1)
@pytest.mark.parametrize(
    ("number", "place", "change"),
    [
        (2, 4, changed(sy.DeltaR(sy.i - 1, sy.j - 1), sy.DeltaR(sy.i - 2, sy.j))),
        (15, 20, lambda formula: formula.func(formula.lhs, 2 * formula.rhs, evaluate=False)),
        (15, 21, changed(HEIGHT, 2 * HEIGHT)),
        (13, 4, changed(sy.M + 2 * sy.j, sy.M + 3 * sy.j)),
    ],
    ids=["a support's radius", "a factor of erfc", "the height in erfc", "(M − j)²(M + 3j)"],
)
def test_a_wrong_step_fails_the_run(number: int, place: int, change) -> None:
    derivation = load(number)
    formula = list(derivation.steps())[place - 1].formula
    wrong = change(formula)
    assert wrong != formula
    outcome = run(with_step(derivation, place, wrong))
    assert not outcome.verdict.is_proved
    (failed,) = (
        check for check in outcome.checks if not check.verdict.is_proved and check.kind == "step"
    )
    assert failed.name == f"step {place}"


@pytest.mark.long(sample=4)
@pytest.mark.parametrize(
    ("number", "place", "divisor"),
    [(2, 4, sy.phi), (4, 2, sy.j - 3), (11, 5, sy.n_x - sy.n_y), (13, 4, 2 * sy.z - 1),
     (14, 5, sy.M - 4), (16, 4, sy.phi), (13, 13, 2 * sy.z - 1)],
)  # fmt: skip
def test_what_may_vanish_is_not_cancelled_in_a_step(number: int, place: int, divisor) -> None:
    step = list(load(number).steps())[place - 1]
    left, right = step.equations[0].args
    one = sympy.Mul(divisor, sympy.Pow(divisor, -1, evaluate=False), evaluate=False)
    wrong = sympy.Eq(left, sympy.Mul(one, right, evaluate=False), evaluate=False)
    assert step.rule_on(0, wrong).verdict is not Verdict.PROVED


def test_the_constraint_that_is_shown_is_what_eq_2_is_compared_with(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """With a wrong radius in the exact constraint neither the steps nor Eq. 2 follow."""
    from force_diffusion.derivations import eq02_displacement as eq02
    from force_diffusion.symbolic.mechanics import contacts

    def wrong(ordered: sympy.Matrix) -> contacts.Linearised:
        apart = contacts.separation(ordered)
        exact = apart.dot(apart) - (2 * sy.r + 2 * sy.epsilon * contacts.radii) ** 2
        slope = sympy.diff(exact, sy.epsilon).subs(sy.epsilon, 0)
        return contacts.Linearised(exact, exact.subs(sy.epsilon, 0), slope)

    cached = (eq02.constraints, eq02.steps)
    monkeypatch.setattr(contacts, "contact_constraint", wrong)
    for one in cached:
        one.cache_clear()
    try:
        derivation = replace(eq02.DERIVATION)  # one that has not kept its lines
        found = {check.name: check.verdict for check in proofs(derivation)}
        assert found["step 1"] is Verdict.REFUTED
        assert found["printed equation"] is not Verdict.PROVED
    finally:
        for one in cached:
            one.cache_clear()
