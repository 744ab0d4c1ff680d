"""The command ``stability``: a thin layer over ``fd.stability``."""

import json
from pathlib import Path
from typing import Annotated

import typer

import force_diffusion as fd

from ..export.tables import csv_text
from .cli import shell_line
from .output import Overwrite, out_option, output
from .shared import drawn, images, noticing

STATUSES = (
    "Takes about 40 s. Exit status: 0 measured, 2 wrong usage, 3 the disk or a pipe failed, "
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

    names = ["stability.json", *study.FILES.values(), *images("stability")]
    with output(out, "stability", names, overwrite) as folder:
        with noticing() as notice:
            found = fd.stability(notice)
        data = {"command": command, **found.data()}
        if folder:
            tables = study.csv_rows(data, command)
            folder.write(
                {
                    "stability.json": json.dumps(data, indent=2) + "\n",
                    **{name: csv_text(rows) for name, rows in tables.items()},
                    **drawn(found.plot, "stability", "The cost of stability", command),
                }
            )
    print(json.dumps(data, indent=2) if as_json else found)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(stability)
