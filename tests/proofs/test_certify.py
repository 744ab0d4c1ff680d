"""Coq's verdicts. They take minutes, so they are asked for: FORCE_DIFFUSION_TEST_COQ=required."""

import json
import os
from pathlib import Path

import pytest
from force_diffusion.derivations.api import certificates
from force_diffusion.derivations.api.certificates import Verdict, Workshop, certify
from force_diffusion.derivations.export.coq import HEADER
from force_diffusion.derivations.framework.catalogue import load, modules

from force_diffusion.__main__ import main

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


def test_every_equation_is_accepted() -> None:
    found = certify()
    assert [one.number for one in found] == list(modules())
    for one in found:
        assert one.verdict is Verdict.ACCEPTED, one
        assert one.passed
        assert set(one.axioms) <= certificates.ALLOWED


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
    shop: Workshop, monkeypatch: pytest.MonkeyPatch, says: str, proof: str, trouble: str
) -> None:
    made = certificates.Statement("planted", (), says, "", "")
    source = f"{HEADER}Theorem planted : {says}.\nProof. {proof}\nPrint Assumptions planted.\n"
    monkeypatch.setattr(type(made), "source", property(lambda _: source))
    monkeypatch.setattr(certificates, "statements", lambda _: [made])
    found = certificates.certificate(shop, load(1), "")
    assert found.verdict is Verdict.NOT_ACCEPTED
    assert trouble in found.note


def test_a_theory_that_does_not_compile_accepts_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    broken = {**certificates.theory(), "Model.v": "Definition r := ."}
    monkeypatch.setattr(certificates, "theory", lambda: broken)
    (found,) = certify([1])
    assert found.verdict is Verdict.NOT_ACCEPTED
    assert "Model.v" in found.note


def test_statements_and_hashes_are_written(tmp_path: Path) -> None:
    out = tmp_path / "certificate"
    assert main(["certify", "1", "--out", str(out)]) == 0
    said = json.loads((out / "certificate.json").read_text())
    (one,) = said["equations"]
    assert one["verdict"] == "accepted"
    assert (out / "Equation_1.v").read_text() == certificates.sources([1])["Equation_1.v"]
    assert said["theory"]["Model.v"] == certificates.sha256((out / "Model.v").read_text())
    listed = json.loads((out / "manifest.json").read_text())["files"]
    assert {"Model.v", "Equation_1.v", "certificate.json"} <= set(listed)
