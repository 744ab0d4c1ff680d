"""The command ``stability``: a thin layer over ``fd.stability``."""

from pathlib import Path
from typing import Annotated

import typer

import force_diffusion as fd

from .cli import shell_line
from .output import Overwrite, out_option, output
from .shared import images, noticing, write_study

STATUSES = (
    "Takes about a minute. Exit status: 0 measured, 2 wrong usage, 3 the disk or a pipe failed, "
    "130 interrupted."
)


def stability(
    out: Annotated[Path | None, out_option("the tables as JSON and CSV, and a plot")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
    overwrite: Overwrite = False,
) -> None:
    """Measure what stability costs: errors, lost bits and times with and without it."""
    from force_diffusion.numeric.studies.stability import stability as study

    where = [] if out is None else ["--out", str(out)]
    command = shell_line(["force-diffusion", "stability", *where])

    names = [
        "stability.json",
        *(table.file for table in study.TABLES.values()),
        *images("stability"),
    ]
    with output(out, "stability", names, overwrite) as folder:
        with noticing() as notice:
            found = fd.stability(notice)
        title = "The cost of stability"
        data = write_study(folder, found, title, {"command": command})
    print(data if as_json else found)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(stability)
