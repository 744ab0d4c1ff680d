"""Every step of every derivation: proved, what it follows from, and mutants that must not be."""

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.proof import Step
from force_diffusion.derivations.framework.record import load
from force_diffusion.derivations.framework.rows import Row
from force_diffusion.symbolic.kernel.decisions import decide
from force_diffusion.symbolic.kernel.domain import Domain
from force_diffusion.symbolic.trees import equation, in_place
from force_diffusion.symbolic.words import equations

from tests.derivations.rows import each
from tests.properties.mutants import mutants

AT_RIGHT_ANGLES = "a change of direction is at right angles to its contact, at every bead; −0 is 0"
NOTHING_THERE = "the weight of the layer that is added, left out or counted elsewhere is zero there"
DROPPED_ANYWAY = "weights of order 1 change, and these are what the step drops"

SAME_HEIGHT = "b⁺ and b⁻ have one vertical component"
DERIVATIVE = "a derivative does not see what does not depend on its variable"

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
UP_TO_ONE_MORE, UP_TO_ONE_LESS = (f"upper bound m = M shifted to M {sign} 1" for sign in "+−")
CASE_LATER, CASE_EARLIER = (f"case m ≤ j shifted to j {sign} 1" for sign in "+−")
CHANGES_OF_1 = "sign of 1 flipped", "1 dropped", "1 changed to 2"


def on_the_left(*changes: str) -> tuple[str, ...]:
    """The same changes of left-hand sides."""
    return tuple(f"left: {change}" for change in changes)


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
    ("12", 4): (NOTHING_THERE, UP_TO_ONE_MORE, CASE_LATER),
    ("12", 5): (
        NOTHING_THERE, *on_the_left(UP_TO_ONE_MORE, CASE_LATER), UP_TO_ONE_LESS, CASE_EARLIER
    ),
    ("13", 1): (NOTHING_THERE, UP_TO_ONE_LESS),
    ("2", 4): (SAME_HEIGHT, "left: b⁺ replaced by b⁻", "left: b⁻ replaced by b⁺"),
    ("6", 1): (DERIVATIVE, *OF_ACROSS, *OF_UP),
    ("6", 2): (
        f"{DERIVATIVE}; its square has no sign",
        OF_UP[0], *OF_ACROSS, *OF_UP[:2], OF_ACROSS[0], *OF_UP[2:],
    ),
    ("14", 3): (
        NOTHING_THERE,
        *on_the_left("lower bound l = j + 1 shifted to j", "lower bound l = m shifted to m + 1"),
    ),
    ("14", 4): (
        DROPPED_ANYWAY,
        "lower bound m = 1 shifted to 2", UP_TO_ONE_MORE,
        "lower bound m = 1 shifted to 0", UP_TO_ONE_LESS,
        CASE_LATER, CASE_EARLIER, *CHANGES_OF_1, *CHANGES_OF_1,
    ),
    ("14", 5): (NOTHING_THERE, UP_TO_ONE_MORE, UP_TO_ONE_LESS),
    ("14", 6): (NOTHING_THERE, "left: lower bound m = 1 shifted to 0"),
}  # fmt: skip
"""Mutants of a step that say the same: why, and which."""


def is_the_same(shown: sympy.Eq, mutant: sympy.Eq, domain: Domain) -> bool:
    """Whether a mutant differs in powers alone of an index that is 1 there."""
    here = {eq.lhs: eq.rhs for eq in equations(domain.relations) if eq.rhs == 1}
    return bool(here) and mutant.subs(here) == shown.subs(here)


@pytest.mark.parametrize("number", each(modules()))
def test_the_steps_show_what_is_printed(number):
    statement = load(number)
    shown = {line for step in statement.proof for line in step.equations}
    assert [step.number for step in statement.proof] == [*range(1, len(statement.proof) + 1)]
    if isinstance(statement, Row):  # a step for each formula
        forms = statement.exact_forms.values()
        assert shown == {
            equation(form.divisor * form.quantity, form.divisor * piece.expr)
            for form in forms
            for piece in form.pieces
        }
    else:
        assert shown >= {*statement.printed}


def proves(step: Step, part: int, candidate: sympy.Eq) -> bool:
    """Whether the rule of a step proves a candidate for one of its equations."""
    formula = in_place(candidate, step.definitions[part])
    return decide(formula, step.domains[part], [step.rules[part]]).verdict.is_proved


@pytest.mark.long(share=12)
@pytest.mark.parametrize("number", modules())
def test_a_changed_step_is_not_proved(number):
    statement = load(number)
    for step in statement.proof:
        if all(line in statement.printed for line in step.equations):
            continue  # its mutants are judged in tests/soundness
        tried, survived = 0, []
        for part, shown in enumerate(step.equations):
            for change, mutant in mutants(shown):
                tried += 1
                if is_the_same(shown, mutant, step.domains[part]):
                    continue
                if proves(step, part, mutant):
                    survived.append(change)
        assert tried or step.equations[0].rhs == 0, step
        _, *same = SAME.get((str(number), step.number), ("",))
        assert survived == same, step
