"""One module's derivations as a program of its own."""

import sys
from collections.abc import Mapping, Sequence

from ..framework.catalogue import Number
from ..framework.record import Derivation
from ..framework.runner import run_all
from .guard import WRONG_USAGE, guarded
from .progress import PlainLines


def run_alone(
    derivations: Derivation | Mapping[Number, Derivation], arguments: Sequence[str] | None = None
) -> int:
    """Run derivations as a program: print them in full, their premises in a line; 0 if proved."""
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
        lines = PlainLines({one.number for one in own})
        proved = True
        for outcome in run_all([one.number for one in own]):
            lines.finished(outcome)
            proved = proved and outcome.verdict.is_proved
        return 0 if proved else 1

    return guarded(program)
