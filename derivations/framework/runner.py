"""Proves derivations, premises first, and rules on each."""

from collections.abc import Callable, Iterable, Iterator

from force_diffusion.symbolic.algebra.exact import NotProvedError
from force_diffusion.symbolic.kernel.decisions import Ruling, proved_by_rules, refuted, undecided

from .catalogue import Number
from .record import Check, ProofOutcome, Statement, load
from .rows import Row

Watch = Callable[[Statement], None]
"""Called with the statement that is proved next."""


def _check(kind: str, name: str, ruling: Ruling) -> Check:
    return Check(ruling.verdict, ruling.note, ruling.assuming, kind=kind, name=name)


def checks(statement: Statement) -> Iterator[Check]:
    """Each printed equation, each step that leads to it, each further claim, and what is refuted.

    Raises:
        NotProvedError: a step or a claim of a derivation is not proved.
    """
    steps = statement.proof
    if not isinstance(statement, Row):
        theorems = statement.theorems
        for part, theorem in enumerate(theorems, start=1):
            place = f", part {part}" if len(theorems) > 1 else ""
            yield _check("proof", f"printed equation{place}", proved_by_rules([theorem]))
    for step in steps:
        yield _check("step", f"step {step.number}", proved_by_rules(step.theorems))
    for claim in steps.claims:
        yield _check("proof", claim.reason, proved_by_rules(claim.theorems))
    if isinstance(statement, Row):
        for name, ruling in statement.claims:
            yield _check("proof", name, ruling)
    for reading in steps.refuted:
        yield _check("refutation", reading.reading, refuted(reading.reason))


def run(statement: Statement) -> ProofOutcome:
    """Prove all of one equation; what is not proved makes it undecided."""
    try:
        return ProofOutcome(statement, tuple(checks(statement)), statement.proof.seconds)
    except (NotProvedError, LookupError) as reason:
        failure = _check("proof", "its derivation", undecided(str(reason)))
        return ProofOutcome(statement, (failure,))


def with_premises(wanted: Iterable[Number], watch: Watch) -> Iterator[Statement]:
    """Those wanted and all that they rest on, premises first, each as soon as it is known.

    Proofs say what they rest on: each one is run.

    Args:
        wanted: their numbers.
        watch: called with each before its proof is run.
    """
    seen: set[Number] = set()

    def visit(number: Number) -> Iterator[Statement]:
        if number not in seen:
            seen.add(number)
            statement = load(number)
            watch(statement)
            for number_used in statement.used:
                yield from visit(number_used)
            yield statement

    for number in wanted:
        yield from visit(number)


def run_all(numbers: Iterable[Number], watch: Watch = lambda _: None) -> Iterator[ProofOutcome]:
    """Prove equations and all that they rest on, premises first."""
    return map(run, with_premises(numbers, watch))
