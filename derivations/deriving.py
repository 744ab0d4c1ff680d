"""The main job: prove what is asked for and what it rests on, and write it down."""

from collections import Counter
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from derivations.catalogue import load, with_premises
from derivations.folder import output_folder
from derivations.progress import display
from derivations.record import Outcome
from derivations.runner import run
from symbolic.kernel import Verdict


def derive(numbers: Sequence[int], out: Path | None, as_json: bool) -> int:
    """Derive these equations and their premises: 0 if all are proved, else 1.

    The output folder is claimed before the first proof, so that a wrong one costs no time.
    """
    with ExitStack() as stack:
        folder = stack.enter_context(output_folder(out)) if out else None
        derivations = with_premises(load(number) for number in numbers)
        watch = display(len(derivations), as_json=as_json)
        outcomes: list[Outcome] = []
        with watch.showing():
            for derivation in derivations:
                known = {done.derivation.number: done.verdict for done in outcomes}
                outcomes.append(run(derivation, watch.checking, known))
                watch.finished(outcomes[-1])
        if folder is not None:
            from derivations.document import output_files

            folder.publish(output_files(outcomes))
    counts = Counter(str(outcome.verdict) for outcome in outcomes)
    words = ", ".join(f"{count} {verdict}" for verdict, count in counts.items())
    watch.summary(f"{words}." + (f" Written to {out}." if out else ""))
    if as_json:
        from derivations.report import outcomes_json

        print(outcomes_json(outcomes), flush=True)
    return 0 if set(counts) <= {str(Verdict.PROVED)} else 1
