"""Runs derivations, premises first: proves what is printed, its steps and its claims."""

import gc
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from time import perf_counter

import sympy
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, all_of

from .catalogue import Number
from .proving import Shown
from .record import Check, Outcome, Statement

Watch = Callable[[Statement, str], None]
"""Told which check of which derivation comes next."""


@contextmanager
def _rarely_collected() -> Iterator[None]:
    """Look for circles of objects seldom: expressions make few, and the search takes a tenth."""
    before = gc.get_threshold()
    gc.set_threshold(100_000)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _silent(_derivation: Statement, _check: str) -> None:
    """Watch nothing."""


def _timed(kind: str, name: str, decide: Callable[[], Ruling]) -> Check:
    start = perf_counter()
    ruling = decide()
    return Check(kind, name, ruling.verdict, perf_counter() - start, ruling.note, ruling.assuming)


def proofs(derivation: Statement, watch: Watch = _silent) -> Iterator[Check]:
    """Rule on each printed equation, on each step that leads to it, then on each further claim.

    Last come printed statements that are known not to hold.
    """
    several = len(derivation.printed) > 1
    found: dict[sympy.Eq, Check] = {}
    for place, equation in enumerate(derivation.printed):
        name = f"printed equation, part {place + 1}" if several else "printed equation"
        watch(derivation, name)
        found[equation] = _timed(
            "proof",
            name,
            lambda p=place, e=equation: derivation.rule_on(p, e),  # type: ignore[misc]
        )
        yield found[equation]
    watch(derivation, "steps")
    for place, step in enumerate(derivation.steps(), start=1):
        yield _timed("step", f"step {place}", lambda s=step: _ruling(s, found))  # type: ignore[misc]
    for claim in derivation.all_claims:
        watch(derivation, claim.name)
        yield _timed("proof", claim.name, claim.decide)
    for one in derivation.refuted:
        watch(derivation, one.reading)
        yield _timed("refutation", one.reading, lambda r=one: r.ruling)  # type: ignore[misc]


def _ruling(step: Shown, found: Mapping[sympy.Eq, Check]) -> Ruling:
    """What is decided of a step; a printed equation is ruled on once."""
    known = [found[one] for one in step.equations if one in found]
    if len(known) < len(step.equations):
        return step.ruling
    return all_of(*(Ruling(one.verdict, one.note, one.assuming) for one in known))


def overall(checks: Iterable[Check]) -> Verdict:
    """Verdict on an equation from all that was found about it.

    A printed statement that is known not to hold, and is not refuted, leaves it undecided.
    """
    checks = tuple(checks)
    proofs = {check.verdict for check in checks if check.kind != "refutation"}
    if Verdict.REFUTED in proofs:
        return Verdict.REFUTED
    if not proofs or not all(one.is_proved for one in proofs):
        return Verdict.UNDECIDED
    if any(check.kind == "refutation" and not check.is_expected for check in checks):
        return Verdict.UNDECIDED
    return Verdict.ASSUMING if Verdict.ASSUMING in proofs else Verdict.PROVED


def _open_premises(derivation: Statement, known: Mapping[Number, Verdict]) -> Iterator[Check]:
    """What is derived from an equation is no better than that equation."""
    for premise in derivation.premises:
        verdict = known.get(premise.number, Verdict.PROVED)
        name, note = f"rests on Eq. {premise.number}", f"Eq. {premise.number} is {verdict}"
        if verdict is Verdict.ASSUMING:
            assumed = tuple(premise.assumed or [f"what Eq. {premise.number} assumes"])
            yield Check("proof", name, verdict, 0.0, assuming=assumed)
        elif verdict is not Verdict.PROVED:
            yield Check("proof", name, Verdict.UNDECIDED, 0.0, note)


def run(
    derivation: Statement,
    watch: Watch = _silent,
    known: Mapping[Number, Verdict] | None = None,
) -> Outcome:
    """Prove all of one equation.

    Its premises are run apart: ``known`` holds the verdicts found, by number; a premise that is
    not in it is taken as proved.
    """
    start = perf_counter()
    checks = (*proofs(derivation, watch), *_open_premises(derivation, known or {}))
    return Outcome(derivation, overall(checks), checks, perf_counter() - start)


def run_all(derivations: Iterable[Statement], watch: Watch = _silent) -> Iterator[Outcome]:
    """Run derivations in their order, premises first, each with the verdicts found before."""
    known: dict[Number, Verdict] = {}
    with _rarely_collected():
        for derivation in derivations:
            outcome = run(derivation, watch, known)
            known[derivation.number] = outcome.verdict
            yield outcome
