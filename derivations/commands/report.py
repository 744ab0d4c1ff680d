"""The command ``report``: everything that the package finds, as one page."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..framework.catalogue import modules
from .cli import shell_line
from .guard import say
from .output import Overwrite, out_option, output
from .progress import display
from .shared import noticing

if TYPE_CHECKING:
    from force_diffusion.numeric.arithmetic.processes import Start

    from ..api.derived import Derived

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
    from force_diffusion.numeric.arithmetic.processes import beside

    from ..api.report import find_libraries, made
    from .deriving import watched

    find_libraries()
    command = shell_line(["force-diffusion", "report", "--out", str(out)])

    def deriving(start: "Start") -> "Derived":
        return watched(modules(), display(len(modules()), as_json=False), start)

    with output(out, "report", [PAGE], overwrite) as folder:
        with beside() as start, noticing() as notice:
            found = made(deriving, notice, command, start)
        if folder:
            folder.write({PAGE: found.html})
    size = len(found.html.encode()) / 1e6
    say(f"{found.derived.counts()}. Written to {out / PAGE}, {size:.2f} MB.")
    raise typer.Exit(0 if found.derived.proved else 1)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(report)
