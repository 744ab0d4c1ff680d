"""One derivation as a program of its own."""

import sys
from collections.abc import Sequence

from force_diffusion.derivations.commands.guard import WRONG_USAGE, guarded
from force_diffusion.derivations.export.terminal import outcome_text, summary_line
from force_diffusion.derivations.framework.loading import with_premises
from force_diffusion.derivations.framework.record import Derivation
from force_diffusion.derivations.framework.runner import run_all


def run_alone(derivation: Derivation, arguments: Sequence[str] | None = None) -> int:
    """Run one derivation and its premises as a program: print it in full; 0 if proved, else 1."""

    def program() -> int:
        given = sys.argv[1:] if arguments is None else arguments
        if given:
            number = derivation.number
            print(
                f"force-diffusion: this program takes no arguments, but got '{given[0]}'. Leave "
                f"it out, or use 'force-diffusion derive {number}' or 'show {number}'; "
                "'force-diffusion --help' tells what they take.",
                file=sys.stderr,
            )
            return WRONG_USAGE
        *premises, outcome = run_all(with_premises([derivation]))
        if premises:
            print("It rests on", *map(summary_line, premises), sep="\n", end="\n\n")
        print(outcome_text(outcome))
        return 0 if outcome.verdict.is_proved else 1

    return guarded(program)
