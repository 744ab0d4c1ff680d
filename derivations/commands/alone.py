"""One module's derivations as a program of its own."""

import sys
from collections.abc import Mapping, Sequence

from ..export.terminal import outcome_text, summary_line
from ..framework.catalogue import Number
from ..framework.loading import with_premises
from ..framework.record import Derivation
from ..framework.runner import run_all
from .guard import WRONG_USAGE, guarded


def run_alone(
    derivations: Derivation | Mapping[Number, Derivation], arguments: Sequence[str] | None = None
) -> int:
    """Run derivations and their premises as a program: print them in full; 0 if proved, else 1."""
    own = list(derivations.values()) if isinstance(derivations, Mapping) else [derivations]

    def program() -> int:
        given = sys.argv[1:] if arguments is None else arguments
        if given:
            number = own[0].number
            print(
                f"force-diffusion: this program takes no arguments, but got '{given[0]}'. Leave "
                f"it out, or use 'force-diffusion derive {number}' or 'show {number}'; "
                "'force-diffusion --help' tells what they take.",
                file=sys.stderr,
            )
            return WRONG_USAGE
        outcomes = {one.derivation.number: one for one in run_all(with_premises(own))}
        shown = [outcomes.pop(one.number) for one in own]
        if outcomes:
            premises = map(summary_line, outcomes.values())
            print("It rests on", *premises, sep="\n", end="\n\n")
        print(*map(outcome_text, shown), sep="\n\n")
        return 0 if all(one.verdict.is_proved for one in shown) else 1

    return guarded(program)
