"""The main job: prove what is asked for and what it rests on, and write it down."""

from collections import Counter
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from pathlib import Path

from force_diffusion.derivations.commands.folder import output_folder
from force_diffusion.derivations.commands.progress import Silence, display
from force_diffusion.derivations.framework.catalogue import load, modules, with_premises
from force_diffusion.derivations.framework.record import Derivation, Outcome
from force_diffusion.derivations.framework.runner import run
from force_diffusion.symbolic.kernel.decisions import Verdict


def everything() -> list[Derivation]:
    """All derivations, premises first."""
    return with_premises(load(number) for number in modules())


def outcomes_of(derivations: Iterable[Derivation], watch: Silence) -> list[Outcome]:
    """Derive these in their order, premises first, and tell ``watch`` of each."""
    outcomes: list[Outcome] = []
    with watch.showing():
        for derivation in derivations:
            known = {done.derivation.number: done.verdict for done in outcomes}
            outcomes.append(run(derivation, watch.checking, known))
            watch.finished(outcomes[-1])
    return outcomes


def verdict_counts(outcomes: Iterable[Outcome]) -> str:
    """How many equations have which verdict, in words."""
    counts = Counter(str(outcome.verdict) for outcome in outcomes)
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items())


def status_of(outcomes: Iterable[Outcome]) -> int:
    """Exit status: 0 if all are proved, else 1."""
    return 0 if all(outcome.verdict is Verdict.PROVED for outcome in outcomes) else 1


def derive(numbers: Sequence[int], out: Path | None, as_json: bool) -> int:
    """Derive these equations and their premises: 0 if all are proved, else 1.

    The output folder is claimed before the first proof, so that a wrong one costs no time.
    """
    with ExitStack() as stack:
        folder = stack.enter_context(output_folder(out)) if out else None
        derivations = with_premises(load(number) for number in numbers)
        watch = display(len(derivations), as_json=as_json)
        outcomes = outcomes_of(derivations, watch)
        if folder is not None:
            from force_diffusion.derivations.export.document import output_files

            folder.publish(output_files(outcomes))
    watch.summary(f"{verdict_counts(outcomes)}." + (f" Written to {out}." if out else ""))
    if as_json:
        from force_diffusion.derivations.export.report import outcomes_json

        print(outcomes_json(outcomes), flush=True)
    return status_of(outcomes)
