"""The command ``report``: everything that the package finds, as one page."""

from pathlib import Path
from typing import Annotated

import typer
from force_diffusion.derivations.commands.cli import shell_line
from force_diffusion.derivations.commands.guard import say
from force_diffusion.derivations.commands.output import Overwrite, out_option, output
from force_diffusion.derivations.commands.progress import display
from force_diffusion.derivations.commands.shared import noticing
from force_diffusion.derivations.framework.catalogue import modules

import force_diffusion as fd

PAGE = "report.html"
STATUSES = (
    "Exit status: 0 all proved, 1 something refuted or undecided, or the checker at fault, "
    "2 wrong usage or input, "
    "3 the disk or a pipe failed or a package is missing, 130 interrupted."
)


def report(
    out: Annotated[Path, out_option("the page")] = Path("report"),
    overwrite: Overwrite = False,
) -> None:
    """Write all results as one HTML page: derivations, checks, figures, costs, stability."""
    from force_diffusion.derivations.api.report import find_libraries
    from force_diffusion.derivations.commands.deriving import watched

    find_libraries()
    command = shell_line(["force-diffusion", "report", "--out", str(out)])
    with output(out, "report", [PAGE], overwrite) as folder:
        derived = watched(modules(), display(len(modules()), as_json=False))
        with noticing() as notice:
            made = fd.report(derived, notice=notice, command=command)
        if folder:
            folder.write({PAGE: made.html})
    size = len(made.html.encode()) / 1e6
    say(f"{derived.counts()}. Written to {out / PAGE}, {size:.2f} MB.")
    raise typer.Exit(0 if derived.proved else 1)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(report)
