"""What ``derive --json`` prints."""

import json
from collections.abc import Iterable

from force_diffusion.derivations.export.terminal import mutant_counts
from force_diffusion.derivations.framework.record import Outcome


def outcomes_json(outcomes: Iterable[Outcome]) -> str:
    """The outcomes in the documented form; verdicts are words, times are seconds."""
    equations = [
        {
            "number": outcome.derivation.number,
            "name": outcome.derivation.name,
            "verdict": str(outcome.verdict),
            "checks": [
                {
                    "kind": check.kind,
                    "verdict": str(check.verdict),
                    "seconds": round(check.seconds, 6),
                }
                for check in outcome.checks
            ],
            "mutants": mutant_counts(outcome),
            "seconds": round(outcome.seconds, 6),
        }
        for outcome in outcomes
    ]
    return json.dumps({"equations": equations}, indent=2)
