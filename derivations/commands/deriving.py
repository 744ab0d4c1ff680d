"""The main job: prove what is asked for and what it rests on, and write it down."""

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from force_diffusion.derivations.commands.output import output
from force_diffusion.derivations.commands.progress import Silence, display
from force_diffusion.derivations.framework.catalogue import load, modules, with_premises
from force_diffusion.derivations.framework.record import Derivation, Outcome
from force_diffusion.derivations.framework.runner import run_all
from force_diffusion.symbolic.kernel.decisions import Verdict


def everything() -> list[Derivation]:
    """All derivations, premises first."""
    return with_premises(load(number) for number in modules())


def outcomes_of(derivations: Iterable[Derivation], watch: Silence) -> list[Outcome]:
    """Derive these in their order, premises first, and tell ``watch`` of each."""
    outcomes: list[Outcome] = []
    with watch.showing():
        for outcome in run_all(derivations, watch.checking):
            outcomes.append(outcome)
            watch.finished(outcome)
    return outcomes


def verdict_counts(outcomes: Iterable[Outcome]) -> str:
    """How many equations have which verdict, in words."""
    counts = Counter(str(outcome.verdict) for outcome in outcomes)
    return ", ".join(f"{count} {verdict}" for verdict, count in counts.items())


def status_of(outcomes: Iterable[Outcome]) -> int:
    """Exit status: 0 if all are proved, else 1."""
    return 0 if all(outcome.verdict is Verdict.PROVED for outcome in outcomes) else 1


def derive(numbers: Sequence[int], out: Path | None, as_json: bool, overwrite: bool = False) -> int:
    """Derive these equations and their premises: 0 if all are proved, else 1.

    The output folder is looked at before the first proof, so that a wrong one costs no time. The
    document in it is also about the equations that an earlier run has left there.
    """
    from force_diffusion.derivations.export.document import (
        DOCUMENT,
        document,
        finding,
        fragment_name,
        statement_latex,
    )

    derivations = with_premises(load(number) for number in numbers)
    names = [*map(fragment_name, derivations), DOCUMENT]
    with output(out, "derive", names, overwrite) as folder:
        watch = display(len(derivations), as_json=as_json)
        outcomes = outcomes_of(derivations, watch)
        if folder:
            parts = {
                found.number: (load(found.number), found)
                for found in (folder.manifest.equations if folder.manifest else ())
                if found.number in modules() and folder.holds(fragment_name(load(found.number)))
            }
            parts |= {one.derivation.number: (one.derivation, finding(one)) for one in outcomes}
            about = [parts[number] for number in sorted(parts)]
            folder.write(
                {
                    **{fragment_name(one): statement_latex(one) for one in derivations},
                    DOCUMENT: document(about),
                },
                [found for _, found in about],
            )
    watch.summary(f"{verdict_counts(outcomes)}." + (f" Written to {out}." if out else ""))
    if as_json:
        from force_diffusion.derivations.export.terminal import outcomes_json

        print(outcomes_json(outcomes), flush=True)
    return status_of(outcomes)
