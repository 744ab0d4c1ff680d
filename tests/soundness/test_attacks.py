"""What is false is refused by each rule of the kernel, and in the right words."""

import re
from dataclasses import replace

import pytest
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic.kernel import rules
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.where import Where

from tests.soundness.attacks.attack import ATTACKS, REFUSALS, Attack
from tests.soundness.attacks.every import succeeded

RULES = {
    "statement", "rewrite", "follows", "along", "order", "solve", "below", "cases", "instance",
    "in_terms_of", "mirror", "suppose", "induct", "reach", "walk", "inverse", "differentiate",
    "moment", "asymptotic", "bounded", "negligible", "heaviest", "slope", "total",
    "expansion", "proportional", "unit_height", "restated", "integral", "mean_of_roots", "tensile",
    "density", "disproof",
}  # fmt: skip


def test_each_rule_is_attacked() -> None:
    assert list(succeeded()) == []
    assert {one.rule for one in ATTACKS} == RULES
    assert len({(one.rule, one.tried) for one in ATTACKS}) == len(ATTACKS)


@pytest.mark.parametrize("attack", ATTACKS, ids=lambda one: f"{one.rule}: {one.tried}")
def test_it_is_refused(attack: Attack) -> None:
    with pytest.raises(REFUSALS, match=re.escape(attack.refused)):
        attack.attempt()


@pytest.mark.usefixtures("nothing_is_remembered")
def test_a_kernel_that_lets_one_through_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rules, "holds", lambda *_: True)
    assert list(succeeded())


@pytest.mark.usefixtures("nothing_is_remembered")
def test_a_kernel_that_stumbles_is_noticed(monkeypatch: pytest.MonkeyPatch) -> None:
    def stumble(*_: object) -> bool:
        raise ZeroDivisionError

    monkeypatch.setattr(rules, "holds", stumble)
    assert list(succeeded())


def test_a_domain_without_relations_can_be_shown() -> None:
    assert str(Where()) == ""


def test_what_rests_on_a_supposition_is_not_proved() -> None:
    """The step of Eq. 3's induction, without the induction."""
    whole = load(3)
    lines = whole.steps()
    step, induction = lines[-2:]
    alone = replace(induction, by=step.by, where=step.where)
    conditional = replace(whole, steps=lambda: [*lines[:-1], alone])
    assert alone.verdict is Verdict.PROVED
    ruling = conditional.rule_on(0, whole.printed[0])
    assert ruling.verdict is Verdict.UNDECIDED
    assert ruling.note == "it rests on what is only supposed"
