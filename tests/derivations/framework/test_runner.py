"""The runner: verdicts from checks, premises first."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from force_diffusion.derivations.api.derived import Derived
from force_diffusion.derivations.commands.alone import run_alone
from force_diffusion.derivations.export.document import document
from force_diffusion.derivations.export.terminal import (
    outcome_text,
    summary_line,
    trouble_lines,
)
from force_diffusion.derivations.framework import loading
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load, with_premises
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic.kernel.decisions import Verdict

from tests.derivations import fakes

FOLDER = Path(__file__).parents[3] / "derivations" / "beyond"


def test_a_sound_derivation_is_proved() -> None:
    outcome = run(fakes.PREMISE)
    assert outcome.verdict is Verdict.PROVED
    assert [check.kind for check in outcome.checks] == ["proof", "step", "step", "proof"]
    assert all(check.seconds >= 0 for check in outcome.checks)


@pytest.mark.parametrize(
    ("derivation", "verdict"),
    [
        (fakes.with_claim(Verdict.REFUTED), Verdict.REFUTED),
        (fakes.with_claim(Verdict.UNDECIDED), Verdict.UNDECIDED),
        (fakes.with_claim(Verdict.NOT_A_STATEMENT), Verdict.UNDECIDED),
        (fakes.with_step(Verdict.NOT_A_STATEMENT), Verdict.UNDECIDED),
        (fakes.with_step(Verdict.REFUTED), Verdict.REFUTED),
        (fakes.with_step(Verdict.UNDECIDED), Verdict.UNDECIDED),
    ],
)
def test_anything_doubtful_spoils_the_verdict(derivation, verdict) -> None:
    outcome = run(derivation)
    assert outcome.verdict is verdict
    assert trouble_lines(outcome)


@pytest.mark.parametrize("verdict", [Verdict.REFUTED, Verdict.UNDECIDED])
def test_nothing_is_better_than_its_premises(verdict: Verdict) -> None:
    assert run(fakes.CONCLUSION, known={1: Verdict.PROVED}).verdict is Verdict.PROVED
    outcome = run(fakes.CONCLUSION, known={1: verdict})
    assert outcome.verdict is Verdict.UNDECIDED
    assert any(f"Eq. 1 is {verdict}" in line for line in trouble_lines(outcome))


@pytest.mark.parametrize("make", [fakes.with_claim, fakes.with_step])
def test_what_is_assumed_is_told_everywhere(make: Callable[[Verdict], Derivation]) -> None:
    outcome = run(make(Verdict.ASSUMING))
    assert outcome.verdict is Verdict.ASSUMING
    assert outcome.assuming == (fakes.GUESS,)
    words = f"proved, assuming {fakes.GUESS}"
    assert not trouble_lines(outcome)
    assert words in summary_line(outcome)
    assert outcome_text(outcome).splitlines()[-1].startswith(f"Eq. 2 is {words}")
    assert Derived((outcome,)).proved
    assert Derived((outcome,)).counts() == f"1 {words}"
    data = Derived((outcome,)).data()["equations"][0]
    assert data["verdict"] == "proved, assuming"
    assert data["assuming"] == [fakes.GUESS]
    latex = document([outcome])
    assert f"\\textbf{{{words}}}" in latex
    assert run_alone(replace(make(Verdict.ASSUMING), premises=()), []) == 0


def test_what_rests_on_an_assumption_assumes_it() -> None:
    outcome = run(fakes.CONCLUSION, known={1: Verdict.ASSUMING})
    assert outcome.verdict is Verdict.ASSUMING
    assert outcome.words == "proved, assuming what Eq. 1 assumes"
    assert run(fakes.with_claim(Verdict.UNDECIDED), known={1: Verdict.ASSUMING}).assuming == ()


def test_premises_come_first_and_once() -> None:
    third = replace(fakes.CONCLUSION, number=3, premises=(fakes.CONCLUSION, fakes.PREMISE))
    assert [d.number for d in with_premises([third, fakes.PREMISE])] == [1, 2, 3]


def test_run_alone_prints_everything(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_alone(fakes.PREMISE, []) == 0
    printed = capsys.readouterr().out
    for part in ("A premise", "Symbols", "Assumptions", "Steps", "Claims", "is proved"):
        assert part in printed
    assert run_alone(fakes.with_claim(Verdict.UNDECIDED), []) == 1


def test_run_alone_proves_the_premises_too(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_alone(fakes.CONCLUSION, []) == 0
    printed = capsys.readouterr().out
    assert printed.index("1  proved") < printed.index("Eq. 2: B")
    doubtful = replace(fakes.with_claim(Verdict.UNDECIDED), number=1, premises=())
    assert run_alone(replace(fakes.CONCLUSION, premises=(doubtful,)), []) == 1
    assert "Eq. 2 is undecided" in capsys.readouterr().out


def test_run_alone_prints_every_equation_of_a_module(capsys: pytest.CaptureFixture[str]) -> None:
    doubtful = replace(fakes.with_claim(Verdict.UNDECIDED), number=3)
    several = {2: fakes.CONCLUSION, 3: doubtful}
    assert run_alone(several, []) == 1
    printed = capsys.readouterr().out
    assert printed.index("1  proved") < printed.index("Eq. 2: B") < printed.index("Eq. 3")
    assert "Eq. 3 is undecided" in printed


def test_a_module_may_derive_several(monkeypatch: pytest.MonkeyPatch) -> None:
    several = SimpleNamespace(DERIVATIONS={2: fakes.CONCLUSION, 1: fakes.PREMISE})
    monkeypatch.setattr(loading, "import_module", lambda _: several)
    assert [load(1).number, load(2).number] == [1, 2]


def test_every_module_beyond_the_paper_has_labels() -> None:
    stems = {module for number, module in modules().items() if isinstance(number, str)}
    files = {f"beyond.{path.stem}" for path in FOLDER.glob("*.py") if path.stem != "__init__"}
    assert stems == {"leaning", *files}


def test_a_line_has_number_verdict_title_and_seconds() -> None:
    line = summary_line(run(fakes.PREMISE))
    assert re.fullmatch(rf"  1  proved     {re.escape(fakes.PREMISE.title)} \(\d+\.\d\d s\)", line)


def test_modules_are_found_by_name_in_order() -> None:
    paper = [number for number in modules() if isinstance(number, int)]
    beyond = [number for number in modules() if isinstance(number, str)]
    assert paper == list(range(1, 17))
    assert beyond == [f"B{place}" for place in range(1, len(beyond) + 1)]
    assert list(modules()) == [*paper, *beyond]
    assert modules()[2] == "eq02_displacement"
