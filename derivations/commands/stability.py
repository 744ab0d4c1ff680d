"""The command ``stability``: a thin layer over ``numeric.studies.stability``."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer
from force_diffusion.derivations.commands.output import Overwrite, out_option, output
from force_diffusion.derivations.commands.shared import drawn, images, noticing
from force_diffusion.derivations.export.tables import csv_text

STATUSES = (
    "Takes about 40 s. Exit status: 0 measured, 2 wrong usage, 3 the disk or a pipe failed, "
    "130 interrupted."
)


def stability(
    out: Annotated[Path | None, out_option("the tables as JSON and CSV, and a plot")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
    overwrite: Overwrite = False,
) -> None:
    """Measure what stability costs: errors and lost bits of both forms, time beside them."""
    import shlex

    from force_diffusion.numeric.studies.stability.data import FILES, csv_rows, stability_data

    where = [] if out is None else ["--out", str(out)]
    command = shlex.join(["force-diffusion", "stability", *where])

    names = ["stability.json", *FILES.values(), *images("stability")]
    with output(out, "stability", names, overwrite) as folder:
        data = stability_data(_measured(quiet=as_json), command)
        if folder:
            files: dict[str, str | bytes] = {"stability.json": json.dumps(data, indent=2) + "\n"}
            files |= {name: csv_text(rows) for name, rows in csv_rows(data).items()}
            files |= drawn("force_diffusion.numeric.studies.stability.plot", data)
            folder.write(files)
    if as_json:
        print(json.dumps(data, indent=2))


def _measured(*, quiet: bool) -> list[Any]:
    """Measure all tables, printing each row as it comes, or telling a terminal how far it is."""
    from dataclasses import asdict

    from force_diffusion.numeric.studies.stability.data import (
        CLOSED_FORMS,
        HEADS,
        closed_form_lines,
        line,
        measurements,
    )

    found: list[Any] = []
    with noticing() as notice:
        for name, row in measurements():
            if not quiet:
                if not found or found[-1][0] != name:
                    print(("\n" if found else "") + HEADS[name], flush=True)
                if name != CLOSED_FORMS:
                    print(line(name, asdict(row)), flush=True)
            elif name != CLOSED_FORMS:
                notice(f"{name}: row {len(found) + 1}")
            found.append((name, row))
    if not quiet:
        rows = [asdict(row) for name, row in found if name == CLOSED_FORMS]
        print("\n".join(closed_form_lines(rows)))
    return found


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(stability)
