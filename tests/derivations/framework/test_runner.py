"""The runner: verdicts from checks, premises first."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from force_diffusion.derivations.api.derived import Derived
from force_diffusion.derivations.export.document import document
from force_diffusion.derivations.export.terminal import outcome_text, summary_text
from force_diffusion.derivations.framework import record, runner
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.proof import Steps
from force_diffusion.derivations.framework.record import Derivation, load
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.kernel.axioms import base
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.rules import rewrite
from force_diffusion.symbolic.trees import equation

from tests.derivations import fakes

FOLDER = Path(__file__).parents[3] / "derivations" / "beyond"
MAKERS = pytest.mark.parametrize("make", [fakes.with_claim, fakes.with_step])


@pytest.fixture
def catalogue(monkeypatch: pytest.MonkeyPatch) -> dict[int, Derivation]:
    """The derivations that are loaded by number in place of those of the paper."""
    derivations = {1: fakes.PREMISE, 2: fakes.CONCLUSION}
    monkeypatch.setattr(runner, "load", derivations.__getitem__)
    return derivations


@MAKERS
def test_one_undecided_check_makes_the_verdict_undecided(make):
    outcome = run(make(fakes.baffled))
    assert outcome.verdict is Verdict.UNDECIDED
    summary = " ".join(summary_text(outcome).split())
    assert "nobody knows" in summary
    assert ("step 2, 'So it is.'" in summary) == (make is fakes.with_step)


def test_a_printed_equation_that_no_step_shows_is_undecided():
    other = replace(fakes.PREMISE, printed=(equation(sy.phi, sy.phi),))
    outcome = run(other)
    assert outcome.verdict is Verdict.UNDECIDED
    assert "no step of Eq. 1 shows what is printed" in " ".join(summary_text(outcome).split())


@MAKERS
def test_an_assumption_is_named_in_every_report(make):
    outcome = run(make(fakes.guessed))
    assert outcome.verdict is Verdict.ASSUMING
    assert outcome.ruling.assuming == (fakes.GUESS,)
    words = f"proved, assuming {fakes.GUESS}"
    (line,) = summary_text(outcome).splitlines()
    assert words in line
    assert outcome_text(outcome).splitlines()[-1].startswith(f"Eq. 2 is {words}")
    assert Derived((outcome,)).proved
    assert Derived((outcome,)).counts() == f"1 {words}".replace(", assuming", " assuming")
    data = Derived((outcome,)).data()["equations"][0]
    assert data["verdict"] == "proved, assuming"
    assert data["assuming"] == [fakes.GUESS]
    latex = document([outcome])
    assert f"& {words} &" in latex


def test_what_rests_on_an_assumption_assumes_it():
    def conclusion(steps: Steps) -> None:
        steps.show("Twice that:", twice, rewrite(fakes.ASSUMED.theorem))

    left, right = fakes.PRINTED.args
    twice = equation(2 * left, 2 * right)
    outcome = run(replace(fakes.CONCLUSION, printed=(twice,), show_steps=conclusion))
    assert outcome.verdict is Verdict.ASSUMING
    assert outcome.ruling.words == f"proved, assuming {fakes.GUESS}"
    assert run(fakes.with_claim(fakes.baffled)).ruling.assuming == ()


def test_a_step_defines_new_symbols_alone_and_rests_on_nothing_supposed():
    steps = Steps(1, fakes.BEADS, {})
    with pytest.raises(NotProvedError, match="r has a meaning of its own"):
        steps.show("So.", equation(sy.r, sy.phi), rewrite(), definitions={sy.r: sy.phi})
    assert not steps


def test_a_refutation_of_what_holds_is_no_refutation():
    steps = Steps(1, fakes.BEADS, {})
    with pytest.raises(NotProvedError, match="was to be refuted: a reading"):
        steps.refute("a reading", fakes.TWICE, rewrite(), fakes.BEADS)
    steps.refute("another", equation(sy.DeltaR(sy.i, sy.j), 0), rewrite(), fakes.BEADS)
    assert [refutation.reading for refutation in steps.refuted] == ["another"]
    with pytest.raises(NotProvedError):  # what is not decided is not refuted
        steps.refute("a third", equation(sy.DeltaX(sy.i, sy.j), 0), rewrite(base()), fakes.BEADS)


def test_premises_come_first_and_once(catalogue):
    catalogue[3] = replace(fakes.CONCLUSION, number=3)
    assert [derivation.number for derivation in runner.with_premises([3, 2, 1], print)] == [1, 3, 2]
    assert fakes.CONCLUSION.premises == (1,)


def test_a_module_may_derive_several(monkeypatch):
    several = SimpleNamespace(DERIVATIONS={2: fakes.CONCLUSION, 1: fakes.PREMISE})
    monkeypatch.setattr(record, "import_module", lambda _: several)
    assert [load(1).number, load(2).number] == [1, 2]


def test_every_module_beyond_the_paper_has_labels():
    stems = {module for number, module in modules().items() if isinstance(number, str)}
    files = {f"beyond.{path.stem}" for path in FOLDER.glob("*.py") if path.stem != "__init__"}
    assert stems == {"leaning", *files}


def test_modules_are_found_by_name_in_order():
    paper = [number for number in modules() if isinstance(number, int)]
    beyond = [number for number in modules() if isinstance(number, str)]
    assert paper == list(range(1, 17))
    assert beyond == [f"B{place}" for place in range(1, len(beyond) + 1)]
    assert list(modules()) == [*paper, *beyond]
    assert modules()[2] == "eq02_displacement"
