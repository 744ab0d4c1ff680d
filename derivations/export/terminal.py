"""Derivations and their outcomes as plain text or JSON, for a terminal or a pipe."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from textwrap import fill
from typing import Any

from force_diffusion.symbolic.kernel.decisions import Verdict, in_words
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH, text_lines
from force_diffusion.symbolic.printing.text import text

from ..coq.record import recorded
from ..framework.catalogue import theorem_of
from ..framework.proving import Shown
from ..framework.record import Check, Derivation, Mutant, Outcome
from ..framework.runner import UNLIKE
from .manifest import FoundCheck
from .prose import both

_PAIR = re.compile(r"\((\S+), (\S+)\)")


def _paragraph(words: str, first: str = "  ", later: str | None = None) -> str:
    kept = _PAIR.sub("(\\1,\N{NO-BREAK SPACE}\\2)", words)  # (i, j) stays on one line
    filled = fill(
        kept,
        TEXT_WIDTH,
        initial_indent=first,
        subsequent_indent=first if later is None else later,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return filled.replace("\N{NO-BREAK SPACE}", " ")


def printed_text(derivation: Derivation, indent: str = "  ") -> str:
    """The printed equation or equations."""
    lines = [
        line
        for equation in derivation.printed
        for line in text_lines(equation, derivation.relation, TEXT_WIDTH - len(indent))
    ]
    return "\n".join(indent + line for line in lines)


def refuted_text(derivation: Derivation) -> list[str]:
    """The printed statements that do not hold, each with how the paper's words are read in it."""
    lines = []
    for one in derivation.refuted:
        lines += ["", _paragraph(f"Printed as well; {one.reading}.", "")]
        lines += ["  " + line for line in text_lines(one.formula, one.relation, TEXT_WIDTH - 2)]
    return lines


def verdicts_text(outcomes: Iterable[Outcome]) -> str:
    """How many equations have which verdict, in words."""
    counts = Counter(one.words for one in outcomes)
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items())


def expected_text(refuted: int) -> str:
    """How many printed statements were refuted as expected, in words; "" for none."""
    plural = "" if refuted == 1 else "s"
    return f"{refuted} printed statement{plural} refuted, as expected (see ERRATA)" * bool(refuted)


def heading(derivation: Derivation) -> str:
    """Number and title."""
    return f"Eq. {derivation.number}: {derivation.title}"


def statement_text(derivation: Derivation) -> str:
    """What the equation says, in what symbols, under which assumptions."""
    parts = [heading(derivation), "", printed_text(derivation), *refuted_text(derivation)]
    parts += ["", "Symbols"]
    for symbol, meaning in derivation.symbols:
        parts.append(_paragraph(f"{text(symbol)}: {meaning}", later="      "))
    parts += ["", "Assumptions"]
    parts += [_paragraph(words, "  - ", "    ") for words in derivation.assumptions]
    if theorem := theorem_of(derivation.number):
        parts += ["", f"A case of theorem {theorem.name}: {theorem.title}"]
    if derivation.premises:
        numbers = ", ".join(str(premise.number) for premise in derivation.premises)
        parts += ["", f"Rests on Eq{'s' * (len(derivation.premises) > 1)}. {numbers}"]
    parts += ["", f"Coq: {recorded(derivation.number)}"]
    if derivation.remarks:
        parts += ["", "Remarks"]
        parts += [_paragraph(words, "  - ", "    ") for words in derivation.remarks]
    return "\n".join(parts)


def relation_of(derivation: Derivation, step: Shown) -> str:
    """The sign between the sides of a step; the printed equation has its own."""
    printed = all(one in derivation.printed for one in step.equations)
    return derivation.relation if printed else step.relation


def follows_text(step: Shown, verdict: str) -> str:
    """What was decided of a step, and what it follows from."""
    return f"{verdict}, from {both(step.uses)}" if step.uses else verdict


def steps_text(derivation: Derivation, verdicts: Sequence[str]) -> str:
    """The steps: the reason, the formula that it gives, the verdict, and what it follows from."""
    parts = []
    steps = enumerate(zip(derivation.steps(), verdicts, strict=True), start=1)
    for place, (step, verdict) in steps:
        parts.append(_paragraph(step.reason, f"{place:3}. ", "     "))
        lines = text_lines(step.formula, relation_of(derivation, step), TEXT_WIDTH - 7)
        parts += ["       " + line for line in lines]
        said = verdict.partition(":")[0] if verdict.startswith(str(Verdict.PROVED)) else verdict
        parts.append(_paragraph(follows_text(step, said), "     "))
    return "\n".join(parts)


def step_verdicts(checks: Iterable[Check | FoundCheck]) -> list[str]:
    """The verdicts of the steps among the checks, in their order."""
    return [in_words(one.verdict, one.assuming) for one in checks if one.kind == "step"]


def check_text(check: Check) -> str:
    """One check: what was checked, what was found, what that rests on."""
    head = f"{check.words}: {check.name} ({check.kind}, {check.seconds:.3f} s)"
    return _paragraph(head + (f". {check.note}" if check.note else ""), "  - ", "    ")


def mutant_text(mutant: Mutant) -> str:
    """One changed equation that the checker did not refute."""
    kind = "equivalent rewriting" if mutant.equivalent else str(mutant.ruling.verdict)
    if mutant.reason == UNLIKE:
        return _paragraph(f"{mutant.change}: {mutant.reason}", "  - ", "    ")
    note = f". {mutant.note}" if mutant.note else ""
    return _paragraph(f"{kind}: {mutant.change}{note}", "  - ", "    ")


def mutant_counts(outcome: Outcome) -> dict[str, int]:
    """How many changed equations were made, refuted, no statements, proved to be equivalent."""
    verdicts = [mutant.ruling.verdict for mutant in outcome.mutants]
    return {
        "made": len(verdicts),
        "refuted": verdicts.count(Verdict.REFUTED),
        "no_statements": verdicts.count(Verdict.NOT_A_STATEMENT),
        "equivalent": sum(m.equivalent and m.reason != UNLIKE for m in outcome.mutants),
    }


def counts_text(outcome: Outcome) -> str:
    """The same in words."""
    counts = mutant_counts(outcome)
    words = f"{counts['refuted']} of {counts['made']} mutants refuted"
    if counts["no_statements"]:
        words += f", {counts['no_statements']} not a statement"
    if counts["equivalent"]:
        words += f", {counts['equivalent']} equivalent"
    return words


def tried_counts(outcomes: Iterable[Outcome]) -> dict[str, int]:
    """How many statements were false, of these refuted or no statements, and true and proved."""
    on = [one for outcome in outcomes for one in outcome.tried]
    false = [one.ruling.verdict for one in on if not one.statement.holds]
    true = [one.ruling.verdict for one in on if one.statement.holds]
    return {
        "false": len(false),
        "refuted": false.count(Verdict.REFUTED),
        "no_statements": false.count(Verdict.NOT_A_STATEMENT),
        "true": len(true),
        "proved": sum(verdict.is_proved for verdict in true),
    }


def tried_text(counts: Mapping[str, int]) -> str:
    """The same in words; "" where none was tried."""
    if not counts["false"] + counts["true"]:
        return ""
    none, false, true = counts["no_statements"], counts["false"], counts["true"]
    left, missed = false - counts["refuted"] - none, true - counts["proved"]
    words = (
        f"The checker itself was tried. Of {false} false statements it proved none: "
        f"{counts['refuted']} are refuted, {none} no statements, and {left} undecided, which is no "
        f"failure where a statement is false. Of {true} true ones it proved {counts['proved']}"
    )
    return words + (f" and left {missed} undecided, which is a failure." if missed else ".")


def outcome_text(outcome: Outcome) -> str:
    """A derivation from its title to its verdict."""
    derivation = outcome.derivation
    survivors = [m for m in outcome.mutants if m.ruling.verdict is not Verdict.REFUTED]
    steps = steps_text(derivation, step_verdicts(outcome.checks))
    parts = [statement_text(derivation), "", "Steps", steps, "", "Checks"]
    parts += [check_text(check) for check in outcome.checks if check.kind != "step"]
    parts += [f"  - {counts_text(outcome)}", *map(mutant_text, survivors)]
    parts += [
        _paragraph(words, "  - ", "    ")
        for words in [tried_text(tried_counts([outcome]))]
        if words
    ] + [""]
    said = [f"Eq. {derivation.number} is {outcome.words}", expected_text(len(outcome.refuted))]
    parts.append(f"{'; '.join(filter(None, said))} ({outcome.seconds:.2f} s)")
    return "\n".join(parts)


def _count(number: int, one: str, more: str) -> str:
    return f"{number} {one if number == 1 else more}"


def summary_line(outcome: Outcome) -> str:
    """One line for one equation."""
    kinds = [check.kind for check in outcome.checks]
    steps = _count(kinds.count("step"), "step", "steps")
    proofs = _count(kinds.count("proof"), "proof", "proofs")
    witnesses = _count(kinds.count("witness"), "witness", "witnesses")
    found = [steps, proofs, witnesses, counts_text(outcome), expected_text(len(outcome.refuted))]
    return (
        f"{outcome.derivation.number!s:>3}  {outcome.words:<9}  {outcome.derivation.title}: "
        f"{', '.join(filter(None, found))} ({outcome.seconds:.2f} s)"
    )


def trouble_lines(outcome: Outcome) -> list[str]:
    """What kept an equation from being proved."""
    lines = [
        check_text(check)
        for check in outcome.checks
        if not (check.verdict.is_proved or check.verdict is Verdict.AGREES or check.is_expected)
    ]
    lines += [
        mutant_text(mutant)
        for mutant in outcome.mutants
        if mutant.ruling.verdict is Verdict.UNDECIDED or mutant.reason == UNLIKE
    ]
    lines += [
        _paragraph(
            f"{one.ruling.verdict}: a true statement ({one.statement.reason}). {one.ruling.note}",
            "  - ",
            "    ",
        )
        for one in outcome.tried
        if one.is_open
    ]
    return lines


def outcomes_data(outcomes: Iterable[Outcome]) -> dict[str, Any]:
    """What ``derive --json`` prints; verdicts are words, times are seconds."""
    equations = [
        {
            "number": outcome.derivation.number,
            "name": outcome.derivation.name,
            "verdict": str(outcome.verdict),
            "assuming": list(outcome.assuming),
            "checks": [
                {
                    "kind": check.kind,
                    "verdict": str(check.verdict),
                    "assuming": list(check.assuming),
                    "seconds": round(check.seconds, 6),
                }
                for check in outcome.checks
            ],
            "refuted as expected": len(outcome.refuted),
            "mutants": mutant_counts(outcome),
            "statements": tried_counts([outcome]),
            "seconds": round(outcome.seconds, 6),
        }
        for outcome in outcomes
    ]
    return {"equations": equations}
