"""What was recorded of Coq's verdicts, and how long it holds."""

import json
from dataclasses import replace

import pytest
from force_diffusion.derivations.coq import record
from force_diffusion.derivations.coq.record import Certificate, Change, Changes, Verdict, recorded
from force_diffusion.derivations.coq.statements import STATED
from force_diffusion.derivations.export.document import finding, section_latex
from force_diffusion.derivations.export.manifest import Manifest
from force_diffusion.derivations.framework.catalogue import Number
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.framework.record import Derivation, Outcome
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.as_printed import equation, times
from force_diffusion.symbolic.kernel.decisions import Verdict as Proof
from force_diffusion.symbolic.kernel.where import Where

import force_diffusion as fd
from force_diffusion.__main__ import main


def other_than_printed(number: int) -> Derivation:
    derivation = load(number)
    (printed,) = derivation.printed
    return replace(derivation, printed=(equation(printed.lhs, times(2, printed.rhs)),))


@pytest.mark.parametrize("number", STATED)
def test_every_equation_is_on_record_as_it_is_printed(number: Number) -> None:
    """If this fails, ask Coq again: CONTRIBUTING.md says how."""
    assert str(fd.equation(number).coq) == "accepted by Coq 8.16.1"


def test_the_record_holds_mutants_of_every_equation() -> None:
    said = record._record()["equations"]
    assert [one["number"] for one in said] == list(STATED)
    for one in said:
        assert one["changes"]["stated"] > 5
        assert all(change["equivalent"] for change in one["changes"]["accepted"])


def test_what_is_printed_otherwise_is_stale() -> None:
    changed = recorded(other_than_printed(13))
    assert changed.verdict == "stale"
    assert str(changed) == "accepted by Coq 8.16.1, and has changed since"
    narrower = Where.of(sy.j >= 0, sy.j < sy.M - 1)
    assert recorded(replace(load(11), where=narrower)).verdict == "stale"
    assert recorded(replace(load(11), loads=("bulk",))).verdict == "stale"
    assert recorded(replace(load(11), title="another")).verdict == "accepted"


def test_another_theory_makes_all_stale(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(record, "_theory_now", lambda: "0" * 64)
    assert recorded(load(1)).verdict == "stale"


@pytest.mark.parametrize("verdict", ["not accepted", "not stated", "Coq absent"])
def test_nothing_else_counts_as_accepted(monkeypatch: pytest.MonkeyPatch, verdict: str) -> None:
    said = json.loads(json.dumps(record._record()))
    for one in said["equations"]:
        one["verdict"] = verdict
    monkeypatch.setattr(record, "_record", lambda: said)
    assert str(recorded(load(1))) == "not on record"
    monkeypatch.setattr(record, "_record", lambda: {"theory": "", "equations": []})
    assert str(recorded(load(1))) == "not on record"


def test_lists_and_documents_say_so(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def shown(*command: str) -> str:
        assert main(list(command)) == 0
        return capsys.readouterr().out

    found = finding(Outcome(load(13), Proof.PROVED, ()))
    assert found.coq
    assert found.coq.theorems == dict(recorded(load(13)).theorems)
    assert Manifest.model_validate_json(
        Manifest(program="force-diffusion", files={}, equations=(found,)).text()
    ).equations == (found,)
    assert "Coq: accepted." in section_latex(load(13), found)
    assert "Coq: not on record." in section_latex(load(13), found.model_copy(update={"coq": None}))
    assert "accepted by Coq 8.16.1" in shown("show", "13")
    assert shown("list").count("accepted ") == len(STATED)
    monkeypatch.setattr(record, "_theory_now", lambda: "0" * 64)
    assert "has changed since" in shown("show", "13")
    assert shown("list").count("stale ") == len(STATED)


def test_verdicts_in_words() -> None:
    said = {str(Certificate(1, verdict, "Coq 8.16.1")) for verdict in Verdict}
    assert said == {
        "accepted by Coq 8.16.1",
        "not accepted by Coq 8.16.1",
        "not stated",
        "Coq absent",
    }


def test_an_accepted_change_that_is_another_equation_fails() -> None:
    def one(equivalent: bool) -> Certificate:
        changes = Changes(2, 2, 0, (Change(0, "2 → 3", equivalent),))
        return Certificate(1, Verdict.ACCEPTED, "Coq 8.16.1", changes=changes)

    assert one(equivalent=True).passed
    assert not one(equivalent=False).passed
