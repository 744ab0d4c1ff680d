"""Coq's verdicts. They take minutes, so they are asked for: FORCE_DIFFUSION_TEST_COQ=required."""

import os
from dataclasses import replace

import pytest
from force_diffusion.derivations.api import certificates
from force_diffusion.derivations.api.certificates import Verdict, Workshop, certify
from force_diffusion.derivations.export.coq import Statement, header
from force_diffusion.derivations.export.coq_packings import packing_statement
from force_diffusion.derivations.framework.catalogue import load, modules
from force_diffusion.derivations.framework.runner import SEEDS

pytestmark = [
    pytest.mark.skipif(
        os.environ.get("FORCE_DIFFUSION_TEST_COQ") != "required",
        reason="takes minutes; asked for by FORCE_DIFFUSION_TEST_COQ=required",
    ),
    pytest.mark.xdist_group("coq"),
]


@pytest.fixture(scope="module")
def shop(tmp_path_factory: pytest.TempPathFactory) -> Workshop:
    made = Workshop(tmp_path_factory.mktemp("coq"))
    assert made.compile_theory() == ""
    return made


def test_every_equation_and_packing_is_accepted() -> None:
    found = certify()
    assert found.passed
    assert [one.number for one in found.equations] == list(modules())
    assert [one.number for one in found.packings] == list(SEEDS)
    for one in (*found.equations, *found.packings):
        assert one.verdict is Verdict.ACCEPTED, one
        assert set(one.axioms) <= certificates.ALLOWED


def test_another_packing_is_not_accepted(shop: Workshop) -> None:
    true = packing_statement(SEEDS[0])
    for number, other in (("(29 / 50)", "(29 / 51)"), ("n_x G = (20 / 29)", "n_x G = (3 / 5)")):
        assert number in true.proposition
        changed = replace(
            true,
            hypotheses=tuple(line.replace(number, other) for line in true.hypotheses),
            conclusion=true.conclusion.replace(number, other),
        )
        found = certificates.certificate(shop, 0, lambda _, made=changed: [made], "")
        assert found.verdict is Verdict.NOT_ACCEPTED


@pytest.mark.parametrize("number", modules())
def test_changed_statements_are_not_accepted(shop: Workshop, number: int) -> None:
    every_seventh = list(certificates.tried(shop, load(number), lambda at: at % 7 == number % 7))
    assert every_seventh
    wrong = [one for one in every_seventh if one.accepted and not one.equivalent]
    assert not wrong


@pytest.mark.parametrize(
    ("says", "proof", "trouble"),
    [
        ("0 = 1", "exact I. Qed.", "0 = 1"),
        ("0 = 1", "lra. Qed.", "Cannot find witness"),
        ("0 = 1", "Admitted.", "rests on planted"),
        (
            "True \\/ ~ True",
            "apply Classical_Prop.classic. Qed.",
            "rests on Classical_Prop.classic",
        ),
    ],
)
def test_what_is_not_proved_is_not_accepted(
    shop: Workshop, says: str, proof: str, trouble: str
) -> None:
    planted = Planted("planted", (), says, proof)
    found = certificates.certificate(shop, 0, lambda _: [planted], "")
    assert found.verdict is Verdict.NOT_ACCEPTED
    assert trouble in found.note


class Planted(Statement):
    """A statement with a proof that is given."""

    @property
    def source(self) -> str:
        stated = f"Theorem {self.name} : {self.conclusion}.\nProof. {self.tactic}\n"
        return f"{header()}{stated}Print Assumptions {self.name}.\n"


def test_a_theory_that_does_not_compile_accepts_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    broken = {**certificates.theory(), "Model.v": "Definition r := ."}
    monkeypatch.setattr(certificates, "theory", lambda: broken)
    found = certify([1])
    assert not found.passed
    (one,) = found.equations
    assert one.verdict is Verdict.NOT_ACCEPTED
    assert "Model.v" in one.note
