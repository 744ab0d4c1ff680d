"""Proves derivations, premises first, and says what was found."""

import gc
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.kernel.decisions import Verdict

from .catalogue import Number
from .loading import with_premises
from .proof import Step
from .record import Check, ProofOutcome, Statement
from .rows import Row

Watch = Callable[[Statement], None]
"""Called with the statement that is proved next."""


@contextmanager
def _rarely_collected() -> Iterator[None]:
    """Look for circles of objects seldom: expressions make few, and the search takes a tenth."""
    before = gc.get_threshold()
    gc.set_threshold(100_000)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _check(kind: str, name: str, step: Step, place: int | None = None) -> Check:
    theorems = step.theorems if place is None else step.theorems[place : place + 1]
    assuming = tuple(sorted(set[str]().union(*(theorem.assuming for theorem in theorems))))
    rules = dict.fromkeys(theorem.rule for theorem in theorems)
    verdict = Verdict.ASSUMING if assuming else Verdict.PROVED
    return Check(kind, name, verdict, f"by the rule: {', '.join(rules)}", assuming)


def checks(statement: Statement) -> Iterator[Check]:
    """Each printed equation, each step that leads to it, each further claim, and what is refuted.

    Raises:
        NotProvedError: a step or a claim of a derivation is not proved.
    """
    steps = statement.proof
    if not isinstance(statement, Row):
        several = len(statement.printed) > 1
        for part in range(len(statement.printed)):
            name = f"printed equation, part {part + 1}" if several else "printed equation"
            yield _check("proof", name, *statement.step_of(part))
    for step in steps:
        yield _check("step", f"step {step.number}", step)
    for claim in steps.claims:
        yield _check("proof", claim.reason, claim)
    if isinstance(statement, Row):
        for name, ruling in statement.claims:
            yield Check("proof", name, ruling.verdict, ruling.note, ruling.assuming)
    for reading in steps.refuted:
        yield Check("refutation", reading.reading, Verdict.REFUTED, reading.reason)


def run(statement: Statement) -> ProofOutcome:
    """Prove all of one equation; what is not proved makes it undecided."""
    try:
        found = tuple(checks(statement))
        seconds = statement.seconds
    except (NotProvedError, LookupError) as reason:
        found = (Check("proof", "its derivation", Verdict.UNDECIDED, str(reason)),)
        seconds = 0.0
    return ProofOutcome(statement, _overall(found), found, seconds)


def _overall(found: Iterable[Check]) -> Verdict:
    """The verdict on an equation from all that was found about it."""
    verdicts = {check.verdict for check in found if check.kind != "refutation"}
    for verdict in (Verdict.REFUTED, Verdict.NOT_A_STATEMENT, Verdict.UNDECIDED, Verdict.ASSUMING):
        if verdict in verdicts:
            return verdict
    return Verdict.PROVED


def run_all(numbers: Iterable[Number], watch: Watch = lambda _: None) -> Iterator[ProofOutcome]:
    """Prove equations and all that they rest on, premises first."""
    with _rarely_collected():
        for statement in with_premises(numbers, watch):
            yield run(statement)
