"""The command ``calibrate``, and the cost model that other commands plan with."""

import json
import sys
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from force_diffusion.numeric.planning.cost_model import Model

STATUSES = "Exit status: 0 calibrated and stored, 3 it could not be stored, 130 interrupted."


def calibrate(
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    """Measure what this machine's arithmetic costs; a tolerance chooses the cheapest by it."""
    from force_diffusion.derivations.commands.shared import noticing
    from force_diffusion.numeric.arithmetic.errors import NotReachedError
    from force_diffusion.numeric.planning import stored_costs
    from force_diffusion.numeric.studies.calibrating import calibrate as measure

    with noticing() as notice:
        model = measure(lambda what: notice(f"timing {what}"), compiled=True)
    print(json.dumps(model.model_dump(), indent=2) if as_json else "\n".join(_lines(model)))
    try:
        path = stored_costs.store(model)
    except OSError as error:
        raise NotReachedError(f"calibrated, but it can't be stored: {_why(error)}") from None
    if not as_json:
        print(f"Stored in {path}")


def _lines(model: "Model") -> list[str]:
    lines = [
        "Seconds for a unit of work (limbs: a bead and 1000 bits; limbs2: their square); misfit: "
        "the largest",
        "factor between a fitted and a measured time",
        f"{'numbers':<11}{'step':<22}{'once':>9}{'calls':>9}{'beads':>9}{'limbs':>9}{'limbs2':>9}"
        f"{'misfit':>8}",
    ]
    for family, steps in model.families.items():
        for step, fitted in steps.items():
            terms = ("once", "calls", "beads", "limbs", "limbs2")
            shown = (f"{fitted.seconds[t]:.1e}" if t in fitted.seconds else "" for t in terms)
            columns = "".join(f"{value:>9}" for value in shown)
            lines.append(f"{family:<11}{step:<22}{columns}{fitted.misfit:>8.3g}")
    lines.append(f"Loading the compiled sweeps takes {model.load_seconds:.2g} s")
    return lines


def model_for(tolerance: bool) -> "Model":
    """Give the cost model of this machine.

    With a ``tolerance`` to choose a way for, and no calibration that holds, one is made and stored.
    """
    from force_diffusion.numeric.planning import stored_costs
    from force_diffusion.numeric.planning.cost_model import defaults

    try:
        return stored_costs.load()
    except stored_costs.StaleError as stale:
        if not tolerance:
            return defaults()
        why = stale
    from force_diffusion.numeric.studies.calibrating import calibrate as measure

    # One line, and only one: what was wrong with the old file, and what is done about it.
    print(f"force-diffusion: calibrating, a few seconds, once: {why}", file=sys.stderr, flush=True)
    model = measure()
    try:
        stored_costs.store(model)
    except OSError as error:
        print(
            f"force-diffusion: the calibration can't be stored ({_why(error)}); going on with it",
            file=sys.stderr,
        )
    return model


def _why(error: OSError) -> str:
    return f"{error.strerror or error}: {error.filename}" if error.filename else str(error)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(calibrate)
