"""The command ``report``: everything that the package finds, as one page."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from force_diffusion.derivations.commands.publishing import (
    NOT_REACHED,
    fail,
    noticing,
    out_option,
    published,
)

if TYPE_CHECKING:
    from force_diffusion.derivations.framework.record import Outcome

PAGE = "report.html"
STATUSES = (
    "Exit status: 0 all proved, 1 something refuted or undecided, 2 wrong usage or input, "
    "3 the disk or a pipe failed or a package is missing, 130 interrupted."
)


def report(
    out: Annotated[Path, out_option("the page")] = Path("report"),
) -> None:
    """Write all results as one HTML page: derivations, checks, figures, costs, stability."""
    import shlex

    try:
        import jinja2  # noqa: F401
        import matplotlib  # noqa: F401
        import scipy  # noqa: F401
    except ImportError as missing:
        fail(f"{missing.name} is missing; pip install 'force-diffusion[report]'", NOT_REACHED)
    from force_diffusion.derivations.commands.deriving import status_of, verdict_counts

    command = shlex.join(["force-diffusion", "report", "--out", str(out)])
    outcomes, size = published(out, lambda: _made(command))
    print(f"{verdict_counts(outcomes)}. Written to {out / PAGE}, {size / 1e6:.2f} MB.", flush=True)
    raise typer.Exit(status_of(outcomes))


def _made(command: str) -> "tuple[tuple[list[Outcome], int], Mapping[str, str | bytes]]":
    """Derive, measure, draw, and put the page together."""
    from datetime import UTC, datetime

    from force_diffusion.derivations.commands.deriving import everything, outcomes_of
    from force_diffusion.derivations.commands.progress import display
    from force_diffusion.derivations.export.page.making import page
    from force_diffusion.derivations.export.page.measured import parts

    derivations = everything()
    outcomes = outcomes_of(derivations, display(len(derivations), as_json=False))
    with noticing() as notice:
        measured = parts(notice)
    text = page(outcomes, measured, command, f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC")
    return (outcomes, len(text.encode())), {PAGE: text}


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(report)
