"""The command that checks packings which another program, or another run, found."""

import json
from pathlib import Path
from typing import Annotated

import typer
from force_diffusion.numeric.arithmetic.errors import NOT_REACHED

import force_diffusion as fd

STATUSES = (
    "Exit status: 0 all proved, 2 no file of packings, 3 something is not proved, 130 interrupted."
)


def check_packings(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="A packings.json of 'run --out'.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    """Prove that packings touch where they say, without tension or overlap."""
    verdicts = fd.check_packings(file)
    if as_json:
        print(json.dumps([verdict.data() for verdict in verdicts], indent=2))
    else:
        for number, verdict in enumerate(verdicts):
            print(f"packing {number}: {verdict}")
    if not all(verdict.proved for verdict in verdicts):
        raise typer.Exit(NOT_REACHED)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command("check-packings", epilog=STATUSES)(check_packings)
