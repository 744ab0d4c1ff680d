"""Every step of every derivation: proved, what it follows from, and mutants that must not be."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
import sympy
from force_diffusion.derivations.eq15_general_form import HEIGHT
from force_diffusion.derivations.framework.catalogue import Number, modules
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.proof import Step, Steps
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.kernel.decisions import Verdict, decide
from force_diffusion.symbolic.trees import equation, in_place

from tests.properties.mutants import mutants

every_equation = pytest.mark.parametrize("number", modules())

AT_RIGHT_ANGLES = "a change of direction is at right angles to its contact, at every bead; −0 is 0"
NOTHING_THERE = "the weight of the layer that is added, left out or counted elsewhere is zero there"
DROPPED_ANYWAY = "weights of order 1 change, and these are what the step drops"

OF_ACROSS = (
    "left: sign of (y − Y)² flipped",
    "left: (y − Y)² dropped",
    "left: sign of y flipped",
    "left: y dropped",
    "left: sign of −Y flipped",
    "left: −Y dropped",
    "left: 2 changed to 3",
)
OF_UP = tuple(change.replace("y", "x").replace("Y", "X") for change in OF_ACROSS)
"""Changes that a derivative by x, or by y, does not see."""
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
    ("13", 1): (NOTHING_THERE, "upper bound m = M shifted to M − 1"),
    ("13", 3): (NOTHING_THERE, "left: upper bound m = M shifted to M − 1"),
    ("2", 4): (
        "b⁺ and b⁻ have one vertical component",
        "left: b⁺ replaced by b⁻",
        "left: b⁻ replaced by b⁺",
    ),
    ("6", 1): (
        "a derivative does not see what does not depend on its variable",
        *OF_ACROSS,
        *OF_UP,
    ),
    ("6", 2): (
        "a derivative does not see what does not depend on its variable; its square has no sign",
        OF_UP[0],
        *OF_ACROSS,
        *OF_UP[:2],
        OF_ACROSS[0],
        *OF_UP[2:],
    ),
    ("14", 3): (
        NOTHING_THERE,
        "left: lower bound l = j + 1 shifted to j",
        "left: lower bound l = m shifted to m + 1",
    ),
    ("14", 4): (
        DROPPED_ANYWAY,
        "lower bound m = 1 shifted to 2",
        "upper bound m = M shifted to M + 1",
        "lower bound m = 1 shifted to 0",
        "upper bound m = M shifted to M − 1",
        "case m ≤ j shifted to j + 1",
        "case m ≤ j shifted to j − 1",
        "sign of 1 flipped",
        "1 dropped",
        "1 changed to 2",
        "sign of 1 flipped",
        "1 dropped",
        "1 changed to 2",
    ),
    ("14", 5): (
        NOTHING_THERE,
        "upper bound m = M shifted to M + 1",
        "upper bound m = M shifted to M − 1",
    ),
    ("14", 6): (
        NOTHING_THERE,
        "left: lower bound m = 1 shifted to 0",
    ),
    ("14", 7): (
        NOTHING_THERE,
        "left: upper bound m = M shifted to M + 1",
        "left: upper bound m = M shifted to M − 1",
    ),
    ("B7", 18): (
        "j = 1 there, and all of its powers are 1",
        "3 changed to 4",
        "2 changed to 3",
        "2 changed to 3",
    ),
    ("B7", 19): (
        "j = 1 there, and all of its powers are 1",
        "3 changed to 4",
        "2 changed to 3",
        "2 changed to 3",
    ),
    ("B21", 10): (
        "M = 1 there, and all of its powers are 1",
        "4 changed to 5",
        "3 changed to 4",
        "2 changed to 3",
        "2 changed to 3",
        "2 changed to 3",
    ),
}
"""Mutants of a step that say the same: why, and which."""


@every_equation
def test_the_steps_show_what_is_printed(number: Number) -> None:
    statement = load(number)
    shown = {one for step in statement.proof for one in step.equations}
    assert [step.number for step in statement.proof] == [*range(1, len(statement.proof) + 1)]
    if isinstance(statement, Row):  # a step for each formula
        forms = statement.exact_forms.values()
        assert shown == {
            equation(form.divisor * form.quantity, form.divisor * one.expr)
            for form in forms
            for one in form.pieces
        }
    else:
        assert shown >= {*statement.printed}


def proves(step: Step, part: int, candidate: sympy.Eq) -> bool:
    """Whether the rule of a step proves a candidate for one of its equations."""
    formula = in_place(candidate, step.definitions[part])
    return decide(formula, step.domains[part], [step.rules[part]]).verdict.is_proved


@pytest.mark.long(share=6)
@every_equation
def test_a_changed_step_is_not_proved(number: Number) -> None:
    statement = load(number)
    for step in statement.proof:
        if all(one in statement.printed for one in step.equations):
            continue  # its mutants are judged in tests/soundness
        tried, survived = 0, []
        for part, shown in enumerate(step.equations):
            for change, mutant in mutants(shown):
                tried += 1
                if proves(step, part, mutant):
                    survived.append(change)
        assert tried or step.equations[0].rhs == 0, step
        _, *same = SAME.get((str(number), step.number), ("",))
        assert survived == same, step


def changed(old: sympy.Basic, new: sympy.Basic) -> Callable[[sympy.Basic], sympy.Basic]:
    return lambda formula: formula.xreplace({old: new})


@pytest.mark.long(sample=1)
@pytest.mark.parametrize(
    ("number", "place", "change"),
    [
        (2, 5, changed(sy.DeltaR(sy.i - 1, sy.j - 1), sy.DeltaR(sy.i - 2, sy.j))),
        (13, 3, changed(sy.M + 2 * sy.j, sy.M + 3 * sy.j)),
        (15, -2, lambda formula: formula.func(formula.lhs, 2 * formula.rhs, evaluate=False)),
        (15, -1, changed(HEIGHT, 2 * HEIGHT)),
    ],
    ids=["a support's radius", "(M − j)²(M + 3j)", "a factor of erfc", "the height in erfc"],
)
def test_a_wrong_step_fails_the_run(
    number: int, place: int, change: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is wrong in the derivation itself makes the equation undecided, and is named."""
    derivation, show = load(number), Steps.show
    wanted = derivation.proof[place - (place > 0)].number

    def wrong(steps: Steps, reason: str, formula: sympy.Basic, *args: Any, **kwargs: Any) -> Step:
        if len(steps) + 1 == wanted and not kwargs.get("is_claim"):
            assert change(formula) != formula
            formula = change(formula)
        return show(steps, reason, formula, *args, **kwargs)

    monkeypatch.setattr(Steps, "show", wrong)
    outcome = run(replace(derivation))
    assert outcome.verdict is Verdict.UNDECIDED
    assert outcome.checks[0].note.startswith(f"step {wanted}, ")
