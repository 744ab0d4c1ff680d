"""Derivations and their outcomes as plain text or JSON, for a terminal or a pipe."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from textwrap import fill
from typing import Any

from force_diffusion.symbolic.kernel.decisions import Verdict, in_words
from force_diffusion.symbolic.printing.lines import TEXT_WIDTH, text_lines
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.words import in_their_words

from ..coq.record import Certificate
from ..coq.statements import recorded
from ..framework.catalogue import Number
from ..framework.lists import both
from ..framework.proof import Step
from ..framework.record import Check, ProofOutcome, Statement, load

_PAIR = re.compile(r"\((\S+), (\S+)\)")


def _paragraph(words: str, first: str = "  ", later: str | None = None) -> str:
    filled = fill(
        _PAIR.sub("(\\1,\N{NO-BREAK SPACE}\\2)", words),  # (i, j) stays on one line
        TEXT_WIDTH,
        initial_indent=first,
        subsequent_indent=first if later is None else later,
        break_long_words=False,
        break_on_hyphens=False,
    )
    return filled.replace("\N{NO-BREAK SPACE}", " ")


def refuted_text(derivation: Statement) -> list[str]:
    """The printed statements that do not hold, each with how the paper's words are read in it."""
    lines = []
    for reading in derivation.proof.refuted:
        lines += ["", _paragraph(f"Printed as well; {reading.reading}.", "")]
        shown = text_lines(reading.formula, reading.domain.relation, TEXT_WIDTH - 2)
        lines += ["  " + line for line in shown]
    return lines


def expected_text(refuted: int) -> str:
    """How many printed statements were refuted as expected, in words; "" for none."""
    plural = "" if refuted == 1 else "s"
    return f"{refuted} printed statement{plural} refuted, as expected (see ERRATA)" * bool(refuted)


def counts_text(outcomes: Sequence[ProofOutcome]) -> str:
    """How many equations have which verdict, and how many printed statements are refuted."""
    counts = Counter(outcome.ruling.words.replace(",", "") for outcome in outcomes)
    refuted = expected_text(sum(len(outcome.refuted) for outcome in outcomes))
    verdicts = (f"{count} {words}" for words, count in counts.items())
    return "; ".join(filter(None, [*verdicts, refuted]))


def verdict_text(outcome: ProofOutcome) -> str:
    """The verdict on one equation; and printed statements of it that were refuted."""
    return "; ".join(filter(None, [outcome.ruling.words, expected_text(len(outcome.refuted))]))


def heading(derivation: Statement) -> str:
    """Number and title."""
    return f"Eq. {derivation.number}: {derivation.title}"


def statement_text(derivation: Statement) -> str:
    """What the equation says, in what symbols, under which assumptions."""
    lines = (f"  {line}" for line in derivation.lines(TEXT_WIDTH - 2))
    parts = [heading(derivation), "", *lines, "", "Symbols"]
    for symbol, meaning in derivation.symbols:
        parts.append(_paragraph(f"{text(symbol)}: {meaning}", later="      "))
    parts += ["", "Assumptions"]
    parts += [_paragraph(words, "  - ", "    ") for words in derivation.assumptions]
    if derivation.call:
        parts += ["", f"The calculator: {derivation.call}"]
    parts += ["", f"Coq: {recorded(derivation)}"]
    if derivation.remarks:
        parts += ["", "Remarks"]
        parts += [_paragraph(words, "  - ", "    ") for words in derivation.remarks]
    return "\n".join(parts)


def rests_text(derivation: Statement) -> str:
    """The equations that it rests on, in words, and those that only other steps and claims use."""
    premises = derivation.premises
    words = f"It rests on {_equations(premises) or 'no other equation'}."
    further = _equations(number for number in derivation.used if number not in premises)
    return f"{words} Steps and claims beside its proof use {further}." if further else words


def _equations(numbers: Iterable[Number]) -> str:
    listed = [str(number) for number in numbers]
    return f"Eq{'s' * (len(listed) > 1)}. {', '.join(listed)}" * bool(listed)


def follows_text(step: Step, derivation: Statement) -> str:
    """The verdict on a step, where it holds, and what it follows from."""
    verdict = in_words(Verdict.ASSUMING if step.assuming else Verdict.PROVED, step.assuming)
    if where := derivation.where(step):
        verdict += f", {where}" if step.assuming else f" {where}"
    return f"{verdict}, from {both(step.uses)}" if step.uses else verdict


def step_lines(step: Step, room: int = TEXT_WIDTH) -> list[str]:
    """What a step shows; of several cases, each below where it holds."""
    if not step.cases:
        return text_lines(step.formula, step.relation, room)
    lines = []
    for case, equation in zip(step.cases, step.equations, strict=True):
        lines += [f"for {in_their_words(case)}:"] if case else []
        lines += text_lines(equation, step.relation, room)
    return lines


def steps_text(derivation: Statement) -> str:
    """The steps: the reason, the formula that it gives, the verdict, and what it follows from."""
    parts = []
    for step in derivation.proof:
        parts.append(_paragraph(step.reason, f"{step.number:3}. ", "     "))
        parts += ["       " + line for line in step_lines(step, TEXT_WIDTH - 7)]
        parts.append(_paragraph(follows_text(step, derivation), "     "))
    return "\n".join(parts)


def check_text(check: Check) -> str:
    """One check: what was checked, what was found, what that rests on."""
    head = f"{check.words}: {check.name} ({check.kind})"
    return _paragraph(head + (f". {check.note}" if check.note else ""), "  - ", "    ")


def outcome_text(outcome: ProofOutcome) -> str:
    """A derivation from its title to its verdict."""
    derivation = outcome.derivation
    if not outcome.verdict.is_proved:
        return "\n".join([statement_text(derivation), "", *map(check_text, outcome.checks)])
    parts = [statement_text(derivation), *refuted_text(derivation), "", rests_text(derivation)]
    parts += ["", "Steps", steps_text(derivation), "", "Claims"]
    parts += [check_text(check) for check in outcome.checks if check.kind != "step"]
    verdict = f"Eq. {derivation.number} is {verdict_text(outcome)}"
    parts += ["", f"{verdict} ({outcome.seconds:.2f} s)"]
    return "\n".join(parts)


def summary_text(outcome: ProofOutcome) -> str:
    """Number, verdict and title, and the seconds it took; below it what kept it from proof."""
    derivation, words = outcome.derivation, outcome.ruling.words
    line = f"{derivation.number!s:>3}  {words:<9}  {derivation.title} ({outcome.seconds:.2f} s)"
    open_checks = (
        check for check in outcome.checks if not (check.verdict.is_proved or check.is_expected)
    )
    return "\n".join([line, *map(check_text, open_checks)])


def statement_data(derivation: Statement) -> dict[str, Any]:
    """What JSON says of any equation."""
    return {
        "number": derivation.number,
        "name": derivation.name,
        "title": derivation.title,
        "premises": list(derivation.premises),
    }


def outcomes_data(outcomes: Iterable[ProofOutcome], *, timed: bool = True) -> dict[str, Any]:
    """What ``derive --json`` prints; verdicts are words, times, if they are wanted, seconds."""
    equations = [
        {
            **statement_data(outcome.derivation),
            "verdict": str(outcome.verdict),
            "assuming": list(outcome.ruling.assuming),
            "checks": [
                {
                    "kind": check.kind,
                    "name": check.name,
                    "verdict": str(check.verdict),
                    "note": check.note,
                    "assuming": list(check.assuming),
                }
                for check in outcome.checks
            ],
            "refuted as expected": len(outcome.refuted),
            **({"seconds": round(outcome.seconds, 6)} if timed else {}),
        }
        for outcome in outcomes
    ]
    return {"equations": equations}


def certificate_text(certificate: Certificate) -> str:
    """One line about an equation, and below it what it is about and what is wrong with it."""
    about = (re.sub(r"^\((.*)\)%Z$", r"\1", words) for words in certificate.about)
    shown = ", ".join(about).replace(">=", "≥").replace("<=", "≤")
    number, title = certificate.number, load(certificate.number).title
    line = f"Eq. {number!s:>2}  {certificate!s:<24}  {title}\n    for {shown}"
    return f"{line}\n    {certificate.note}" if certificate.note else line
