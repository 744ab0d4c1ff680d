"""The runner: verdicts from checks, premises first, mutants judged."""

import time
from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations.commands.alone import run_alone
from force_diffusion.derivations.export.terminal import (
    mutant_counts,
    outcome_text,
    summary_line,
    trouble_lines,
)
from force_diffusion.derivations.framework.catalogue import modules
from force_diffusion.derivations.framework.loading import load, with_premises
from force_diffusion.derivations.framework.record import KernelError
from force_diffusion.derivations.framework.runner import Ruled, rulings, run
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict
from force_diffusion.symbolic.search.corpus import Statement

from tests.derivations import fakes


def test_a_sound_derivation_is_proved() -> None:
    outcome = run(fakes.PREMISE)
    assert outcome.verdict is Verdict.PROVED
    assert [check.kind for check in outcome.checks] == [
        *["proof", "step", "step", "proof"],
        "witness",
    ]
    assert all(check.seconds >= 0 for check in outcome.checks)
    counts = mutant_counts(outcome)
    assert counts["made"] == counts["refuted"] >= 5
    assert counts["equivalent"] == 0


@pytest.mark.parametrize(
    ("derivation", "verdict"),
    [
        (fakes.with_claim(Verdict.REFUTED), Verdict.REFUTED),
        (fakes.with_claim(Verdict.UNDECIDED), Verdict.UNDECIDED),
        (fakes.with_step(Verdict.REFUTED), Verdict.REFUTED),
        (fakes.with_step(Verdict.UNDECIDED), Verdict.UNDECIDED),
        (fakes.with_witness(Verdict.DISAGREES), Verdict.REFUTED),
        (fakes.with_blind_checker(), Verdict.UNDECIDED),
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


def test_an_equivalent_mutant_is_listed_with_its_proof() -> None:
    outcome = run(fakes.lenient())
    counts = mutant_counts(outcome)
    assert counts["equivalent"] == counts["made"] > 0
    assert outcome.verdict is Verdict.PROVED
    assert outcome_text(outcome).count("equivalent rewriting: ") == counts["made"]
    assert outcome_text(outcome).count(". for a reason. said so") == counts["made"]


def test_an_equivalent_mutant_that_is_not_listed_is_a_fault_of_the_checker() -> None:
    with pytest.raises(KernelError, match="not listed as equivalent"):
        run(replace(fakes.lenient(), equivalent={}))


@pytest.mark.parametrize(
    ("holds", "verdict", "faulty"),
    [
        (True, Verdict.REFUTED, True),
        (False, Verdict.PROVED, True),
        (True, Verdict.UNDECIDED, False),
        (False, Verdict.UNDECIDED, False),
    ],
)
def test_statements_of_known_truth_try_the_checker(
    holds: bool, verdict: Verdict, faulty: bool
) -> None:
    other = sympy.Eq(fakes.TRUE.lhs, fakes.TRUE.lhs, evaluate=False)
    statement = Statement(holds, "a kind", "because", other)

    def decide(part: int, candidate: sympy.Eq) -> Ruling:
        return fakes.always(verdict) if candidate == other else fakes.decide(part, candidate)

    derivation = replace(fakes.PREMISE, decide=decide, tries=lambda *_: [statement])
    if faulty:
        with pytest.raises(KernelError, match="because"):
            run(derivation)
    else:
        outcome = run(derivation)
        assert outcome.verdict is (Verdict.UNDECIDED if holds else Verdict.PROVED)
        assert bool(trouble_lines(outcome)) is holds


def test_premises_come_first_and_once() -> None:
    third = replace(fakes.CONCLUSION, number=3, premises=(fakes.CONCLUSION, fakes.PREMISE))
    assert [d.number for d in with_premises([third, fakes.PREMISE])] == [1, 2, 3]


def test_run_alone_prints_everything(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_alone(fakes.PREMISE, []) == 0
    printed = capsys.readouterr().out
    for part in ("A premise", "Symbols", "Assumptions", "Steps", "Checks", "mutants", "is proved"):
        assert part in printed
    assert run_alone(fakes.with_claim(Verdict.UNDECIDED), []) == 1


def test_run_alone_proves_the_premises_too(capsys: pytest.CaptureFixture[str]) -> None:
    assert run_alone(fakes.CONCLUSION, []) == 0
    printed = capsys.readouterr().out
    assert printed.index("1  proved") < printed.index("Eq. 2: B")
    doubtful = replace(fakes.with_claim(Verdict.UNDECIDED), number=1, premises=())
    assert run_alone(replace(fakes.CONCLUSION, premises=(doubtful,)), []) == 1
    assert "Eq. 2 is undecided" in capsys.readouterr().out


def test_the_summary_counts(capsys: pytest.CaptureFixture[str]) -> None:
    line = summary_line(run(fakes.PREMISE))
    assert "2 steps, 2 proofs, 1 witness," in line
    assert "proved" in line


def test_modules_are_found_by_name_in_order() -> None:
    paper = [number for number in modules() if isinstance(number, int)]
    beyond = [number for number in modules() if isinstance(number, str)]
    assert paper == list(range(1, 17))
    assert beyond == [f"B{place}" for place in range(1, len(beyond) + 1)]
    assert list(modules()) == [*paper, *beyond]
    assert modules()[2] == "eq02_displacement"


def test_rulings_of_another_process_change_nothing() -> None:
    derivation = load(6)
    alone = run(derivation)
    found = rulings(6)
    assert len(found.rulings) == len(alone.mutants) + len(alone.tried)
    calls = []

    def ruled() -> Ruled:
        calls.append(1)
        return found

    beside = run(derivation, ruled=ruled)
    assert calls
    for name in ("verdict", "mutants", "tried"):
        assert getattr(beside, name) == getattr(alone, name)
    wrong = [(place, words + "?", Ruling(Verdict.PROVED)) for place, words, _ in found.rulings]
    assert run(derivation, ruled=lambda: Ruled(wrong)).mutants == alone.mutants
    wrong = [(place, words, Ruling(Verdict.PROVED)) for place, words, _ in found.rulings]
    with pytest.raises(KernelError):  # what is read off the list counts as if it were ruled here
        run(derivation, ruled=lambda: Ruled(wrong))


def test_seconds_count_the_work_wherever_it_was_done_and_no_waiting() -> None:
    derivation = load(6)

    def late() -> Ruled:
        time.sleep(1)
        return Ruled()

    start = time.perf_counter()
    waited = run(derivation, ruled=late).seconds
    assert waited < time.perf_counter() - start - 0.9
    assert run(derivation, ruled=lambda: Ruled((), 100)).seconds > 100
