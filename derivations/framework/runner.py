"""Runs a derivation: its proofs, its witnesses, and the mutants that must be refuted."""

import gc
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from itertools import chain
from time import perf_counter

import sympy
from force_diffusion.numeric.arithmetic.processes import Start
from force_diffusion.symbolic.kernel.decisions import Ruling, Verdict, all_of
from force_diffusion.symbolic.kernel.where import Where

from ..witnesses.draws import draw
from .catalogue import Number
from .loading import load
from .proving import Shown
from .record import (
    Check,
    Derivation,
    KernelError,
    Mutant,
    Outcome,
    Tried,
    Witness,
)

SEEDS = (20021, 20022, 20023)
"""Seeds of the witnesses' draws, so that two runs check the same packings."""

PRINTED = "printed equation"
"""How checks of it are called."""

UNLIKE = "proved, unlike the printed equation"
"""What is said of a change that makes a theorem of what is none."""

Watch = Callable[[Derivation, str], None]
"""Told which check of which derivation comes next."""


Rule = Callable[[Derivation, int, str, sympy.Eq, Where | None], Ruling]
"""Rules on a candidate for a part of an equation, described in words; on another domain, too."""


@contextmanager
def _rarely_collected() -> Iterator[None]:
    """Look for circles of objects seldom: expressions make few, and the search takes a tenth."""
    before = gc.get_threshold()
    gc.set_threshold(100_000)
    try:
        yield
    finally:
        gc.set_threshold(*before)


def _silent(_derivation: Derivation, _check: str) -> None:
    """Watch nothing."""


def _timed(kind: str, name: str, decide: Callable[[], Ruling]) -> Check:
    start = perf_counter()
    ruling = decide()
    return Check(kind, name, ruling.verdict, perf_counter() - start, ruling.note, ruling.assuming)


def proofs(derivation: Derivation, watch: Watch = _silent) -> Iterator[Check]:
    """Rule on each printed equation, on each step that leads to it, then on each further claim.

    Last come printed statements that are known not to hold.
    """
    several = len(derivation.printed) > 1
    found: dict[sympy.Eq, Check] = {}
    for place, equation in enumerate(derivation.printed):
        name = f"{PRINTED}, part {place + 1}" if several else PRINTED
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


def witnesses(derivation: Derivation, watch: Watch = _silent) -> Iterator[Check]:
    """Compare with numbers of another kind, drawn with the fixed seed."""
    for witness in derivation.witnesses:
        watch(derivation, witness.name)
        yield _timed("witness", witness.name, lambda w=witness: _on_all(w))  # type: ignore[misc]


def _on_all(witness: Witness) -> Ruling:
    """Ask a witness about every drawn packing; one that does not agree has the last word."""
    for seed in SEEDS:
        ruling = witness.run(draw(seed))
        if ruling.verdict is not Verdict.AGREES:
            return ruling
    return Ruling(Verdict.AGREES, f"{len(SEEDS)} packings; the last: {ruling.note}")


def _rule(
    derivation: Derivation, place: int, _words: str, candidate: sympy.Eq, where: Where | None
) -> Ruling:
    return derivation.rule_on(place, candidate, where)


def judged_mutants(
    derivation: Derivation, watch: Watch = _silent, rule: Rule = _rule
) -> Iterator[Mutant]:
    """Change each printed equation mechanically and let the same procedure rule on it.

    Raises:
        KernelError: one is proved that is not listed as an equivalent rewriting. Where the printed
            equation is not proved, such a change is told instead.
    """
    from force_diffusion.symbolic.search.mutants import mutants

    watch(derivation, "mutants")
    for place, equation in enumerate(derivation.printed):
        for kind, change, mutated in mutants(equation):
            ruling = rule(derivation, place, change, mutated, None)
            reason = derivation.equivalent.get(change, "")
            if ruling.verdict.is_proved and not reason:
                if not derivation.rule_on(place, equation).verdict.is_proved:
                    reason = UNLIKE
                else:
                    raise derivation.fault(
                        mutated, f"proved, a change that is not listed as equivalent: {change}"
                    )
            yield Mutant(kind, change, mutated, ruling, reason)


def tried(derivation: Derivation, watch: Watch = _silent, rule: Rule = _rule) -> Iterator[Tried]:
    """Try the same procedure on statements that are known to be false, or true.

    One of each kind for each printed equation; other ones for other equations.

    Raises:
        KernelError: a false one is proved, or a true one refuted.
    """
    watch(derivation, "false and true statements")
    turn = sum(map(ord, str(derivation.number)))
    for place in range(len(derivation.printed)):
        for statement in derivation.tries(derivation.source(place), turn):
            ruling = rule(derivation, place, statement.reason, statement.equation, statement.where)
            refuted = ruling.verdict is Verdict.REFUTED
            if refuted if statement.holds else ruling.verdict.is_proved:
                truth = "true" if statement.holds else "false"
                raise derivation.fault(
                    statement.equation, f"{ruling.words}, yet {truth}: {statement.reason}"
                )
            yield Tried(statement, ruling)


@dataclass(frozen=True)
class Ruled:
    """Rulings on mutants and statements, in their order: part, words, ruling; plain values."""

    rulings: Sequence[tuple[int, str, Ruling]] = ()
    seconds: float = 0.0


@_rarely_collected()
def rulings(number: Number) -> Ruled:
    """Rule on all mutants and statements of an equation."""
    start = perf_counter()
    found = []

    def keep(
        derivation: Derivation, place: int, words: str, candidate: sympy.Eq, where: Where | None
    ) -> Ruling:
        ruling = derivation.rule_on(place, candidate, where)
        found.append((place, words, ruling))
        return ruling

    derivation = load(number)
    with suppress(KernelError):  # who reads the rulings comes to it as well
        for _ in chain(judged_mutants(derivation, rule=keep), tried(derivation, rule=keep)):
            pass
    return Ruled(found, perf_counter() - start)


def _read(known: Iterable[tuple[int, str, Ruling]]) -> Rule:
    """Read rulings off a list; what is not next in it is ruled on here."""
    left = iter(known)

    def rule(
        derivation: Derivation, place: int, words: str, candidate: sympy.Eq, where: Where | None
    ) -> Ruling:
        *about, ruling = next(left, (None, "", None))
        if ruling is None or about != [place, words]:
            return derivation.rule_on(place, candidate, where)
        return ruling

    return rule


def attacked() -> None:
    """Try to prove by the rules of the kernel what is false.

    Raises:
        KernelError: one of the attacks is not refused.
    """
    from force_diffusion.symbolic.attacks.every import succeeded

    for one in succeeded():
        raise KernelError(
            "the checker is at fault, and its verdicts count for nothing. It does not refuse an "
            f"attack on {one.rule}: {one.tried} ({one.false})"
        )


def overall(
    checks: Iterable[Check], mutants: Iterable[Mutant] = (), on: Iterable[Tried] = ()
) -> Verdict:
    """Verdict on an equation from all that was found about it.

    A printed statement that is known not to hold, and is not refuted, leaves it undecided.
    A mutant that is proved is a listed equivalent rewriting, and speaks for nobody; so does one
    that is not a statement. One of which the checker can't tell leaves the equation undecided, and
    so does a true statement that it does not prove.
    """
    checks = tuple(checks)
    found = {check.verdict for check in checks if check.kind != "refutation"}
    if found & {Verdict.REFUTED, Verdict.DISAGREES}:
        return Verdict.REFUTED
    proofs = found - {Verdict.AGREES}
    if not proofs or not all(one.is_proved for one in proofs):
        return Verdict.UNDECIDED
    if any(check.kind == "refutation" and not check.is_expected for check in checks):
        return Verdict.UNDECIDED
    if any(mutant.ruling.verdict is Verdict.UNDECIDED for mutant in mutants):
        return Verdict.UNDECIDED
    if any(one.is_open for one in on):
        return Verdict.UNDECIDED
    return Verdict.ASSUMING if Verdict.ASSUMING in proofs else Verdict.PROVED


def _open_premises(derivation: Derivation, known: Mapping[Number, Verdict]) -> Iterator[Check]:
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
    derivation: Derivation,
    watch: Watch = _silent,
    known: Mapping[Number, Verdict] | None = None,
    ruled: Callable[[], Ruled] = Ruled,
) -> Outcome:
    """Everything about one equation.

    Its premises are run apart: ``known`` holds the verdicts found, by number; a premise that is
    not in it is taken as proved. ``ruled`` gives what ``rulings`` found in another process.
    """
    start = perf_counter()
    checks = (
        *proofs(derivation, watch),
        *_open_premises(derivation, known or {}),
        *witnesses(derivation, watch),
    )
    watch(derivation, "mutants")
    asked = perf_counter()
    before = ruled()
    waited = perf_counter() - asked - before.seconds
    rule = _read(before.rulings)
    mutants = tuple(judged_mutants(derivation, watch, rule))
    stands = all(one.verdict.is_proved for one in checks if one.name.startswith(PRINTED))
    on = tuple(tried(derivation, watch, rule)) if stands else ()  # made from what is printed
    verdict = overall(checks, mutants, on)
    return Outcome(derivation, verdict, checks, mutants, on, perf_counter() - start - waited)


def run_all(
    derivations: Iterable[Derivation], watch: Watch = _silent, start: Start | None = None
) -> Iterator[Outcome]:
    """Run derivations in their order, premises first, each with the verdicts found before.

    ``start`` calls functions in another process: of many derivations mutants and statements are
    ruled on there, while proofs and witnesses are run here. The kernel is attacked first.

    Raises:
        KernelError: the checker is at fault.
    """
    wanted = list(derivations)
    known: dict[Number, Verdict] = {}
    ruled = [start(rulings, one.number) if start else Ruled for one in wanted]
    with _rarely_collected():
        if wanted:
            attacked()
        for derivation, found in zip(wanted, ruled, strict=True):
            outcome = run(derivation, watch, known, found)
            known[derivation.number] = outcome.verdict
            yield outcome
