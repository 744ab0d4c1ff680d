"""What is false is refused by each rule of the kernel, and in the right words."""

import re
from dataclasses import replace

import pytest
from force_diffusion.derivations.framework import runner
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.record import KernelError
from force_diffusion.symbolic.attacks.attack import ATTACKS, REFUSALS, Attack
from force_diffusion.symbolic.attacks.every import succeeded
from force_diffusion.symbolic.kernel import rules
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.where import Where

RULES = {
    "statement", "rewrite", "follows", "along", "order", "solve", "below", "cases", "instance",
    "in_terms_of", "mirror", "suppose", "induct", "reach", "walk", "inverse", "differentiate",
    "moment", "mean_below", "asymptotic", "bounded", "negligible", "heaviest", "slope", "total",
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


@pytest.mark.parametrize("equation", [1, 11])
def test_a_kernel_that_lets_one_through_ends_the_run(
    monkeypatch: pytest.MonkeyPatch, equation: int
) -> None:
    monkeypatch.setattr(rules, "holds", lambda *_: True)
    with pytest.raises(KernelError, match=r"the checker is at fault.*does not refuse an attack on"):
        next(runner.run_all([load(equation)]))


def test_a_kernel_that_stumbles_ends_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    def stumble(*_: object) -> bool:
        raise ZeroDivisionError

    monkeypatch.setattr(rules, "holds", stumble)
    with pytest.raises(KernelError, match="does not refuse an attack on"):
        runner.attacked()


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
