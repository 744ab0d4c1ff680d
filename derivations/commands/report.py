"""The command ``report``: everything that the package finds, as one page."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from force_diffusion.derivations.commands.output import Overwrite, out_option, output
from force_diffusion.derivations.commands.shared import noticing
from force_diffusion.numeric.arithmetic.errors import NotReachedError

if TYPE_CHECKING:
    from force_diffusion.derivations.framework.record import Outcome

PAGE = "report.html"
STATUSES = (
    "Exit status: 0 all proved, 1 something refuted or undecided, 2 wrong usage or input, "
    "3 the disk or a pipe failed or a package is missing, 130 interrupted."
)


def report(
    out: Annotated[Path, out_option("the page")] = Path("report"),
    overwrite: Overwrite = False,
) -> None:
    """Write all results as one HTML page: derivations, checks, figures, costs, stability."""
    import shlex

    try:
        import jinja2  # noqa: F401
        import math_core  # noqa: F401
        import matplotlib  # noqa: F401
    except ImportError as missing:
        raise NotReachedError(
            f"{missing.name} is missing; pip install 'force-diffusion[report]'"
        ) from None
    from force_diffusion.derivations.commands.deriving import status_of, verdict_counts

    command = shlex.join(["force-diffusion", "report", "--out", str(out)])
    with output(out, "report", [PAGE], overwrite) as folder:
        outcomes, text = _made(command)
        if folder:
            folder.write({PAGE: text})
    size = len(text.encode()) / 1e6
    print(f"{verdict_counts(outcomes)}. Written to {out / PAGE}, {size:.2f} MB.", flush=True)
    raise typer.Exit(status_of(outcomes))


def _made(command: str) -> "tuple[list[Outcome], str]":
    """Derive, measure, draw, and put the page together."""
    from datetime import UTC, datetime

    from force_diffusion.derivations.commands.deriving import everything, outcomes_of
    from force_diffusion.derivations.commands.progress import display
    from force_diffusion.derivations.export.page.page import page
    from force_diffusion.derivations.export.page.sections import parts

    derivations = everything()
    outcomes = outcomes_of(derivations, display(len(derivations), as_json=False))
    with noticing() as notice:
        measured = parts(notice)
    return outcomes, page(outcomes, measured, command, f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC")


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(report)
