"""The command ``cascade``: a thin layer over ``fd.cascade``."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

import force_diffusion as fd

from .cli import command_line
from .output import Overwrite, out_option, output
from .shared import images, noticing, write_study

STATUSES = (
    "Takes a minute by default, and 16 times as long for twice the height. Exit status: "
    "0 measured, 2 wrong usage, 3 beads that do not come to rest, or the disk failed, "
    "130 interrupted."
)


class Protocol(StrEnum):
    """How beads come to rest."""

    LINEAR_PROGRAMS = "linear-programs"
    EVENT_DRIVEN = "event-driven"


def cascade(
    height: Annotated[
        list[int] | None, typer.Option(help="A height M; give it more than once. [8, 12, 16]")
    ] = None,
    packings: Annotated[int, typer.Option(help="Packings of each height and load.")] = 16,
    protocol: Annotated[
        Protocol, typer.Option(help="How beads come to rest.")
    ] = Protocol.LINEAR_PROGRAMS,
    out: Annotated[Path | None, out_option("the study as JSON and CSV, and a plot")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
    overwrite: Overwrite = False,
) -> None:
    """Open one contact that barely pulls, and count what changes."""
    command = command_line()
    names = ["cascade.json", "cascade.csv", *images("cascade")]
    with output(out, "cascade", names, overwrite) as folder:
        with noticing() as notice:
            found = fd.cascade(
                notice,
                heights=height or (8, 12, 16),
                packings=packings,
                protocol=protocol.value,
            )
        data = write_study(folder, found, "Cascades", {"command": command})
    print(data if as_json else found)


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(cascade)
