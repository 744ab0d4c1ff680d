"""What several commands share: options, the printing of answers, and a progress line."""

import os
import shlex
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.errors import printable

from ..export import answers
from ..export.answers import Format
from .guard import tell

if TYPE_CHECKING:
    from force_diffusion.numeric.tables import Answered

PROVED = (
    "Exit status: 0 all proved; 1 something refuted or undecided; 2 wrong usage or input; "
    "3 the disk or a pipe failed; 130 interrupted."
)
ANSWERED = (
    "Exit status: 0 answered; 2 wrong usage or input; 3 the goal can't be reached, or something "
    "outside the program, such as the disk, failed; 130 interrupted."
)
# Rows that are printed beside words.
FEW = 10
Json = Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")]
Quiet = Annotated[
    bool,
    typer.Option("--quiet", "-q", help="Print all rows and nothing else; with --out, nothing."),
]
Written = Annotated[
    Format, typer.Option("--format", help="Format of the rows; npz and parquet are for many rows.")
]

GIVEN: ContextVar[list[str]] = ContextVar("given")
"""The arguments of the command that runs."""


def command_line() -> str:
    """The command as one line for a shell; characters that no line may hold are spelled out."""
    return printable(shlex.join(["force-diffusion", *GIVEN.get()])).replace("\n", r"\n")


def warn(scene: Path, notes: Iterable[str]) -> None:
    """Tell what should be known of a scene before its answer is used."""
    for note in notes:
        tell(f"{scene.name}: {note}")


def sourced(source: dict[str, Any], scene: Path, command: str | None) -> dict[str, Any]:
    """Say also which scene file it was, and the command that answered it."""
    from force_diffusion.numeric.scene.scene import sha256

    data = {**source, "file": scene.name, "sha256": {"scene": sha256(scene), **source["sha256"]}}
    return data if command is None else {"command": command, **data}


def show(
    results: "Sequence[Answered]",
    about: dict[str, Any],
    lines: Iterable[str],
    *,
    as_json: bool,
    quiet: bool,
    written: bool,
) -> None:
    """Print JSON; or the first rows, all if ``quiet``, unless they are ``written``, and words."""
    from force_diffusion.numeric.tables import csv_bytes

    if as_json:
        _print(answers.json_bytes(results, about))
        return
    for answer in results if not written else ():
        if len(results) > 1:
            print(f"# {answer.quantity}")
        count = answer.number_of_rows
        rows = count if quiet else FEW
        _print(csv_bytes({name: text[:rows] for name, text in answer.text.items()}))
        if count > rows:
            print(f"# {count - rows} more rows: --quiet prints all, --out DIR writes them")
    if not quiet:
        mark = "" if written else "# "
        print("\n".join(f"{mark}{line}" for line in lines))


def _print(content: bytes) -> None:
    for at in range(0, len(content), 1_000_000):
        print(content[at : at + 1_000_000].decode(), end="")


@contextmanager
def noticing() -> Iterator[Callable[[str], None]]:
    """Give a function that tells a terminal what is being measured, on one line of its own."""
    terminal = sys.stderr.isatty() and os.environ.get("TERM") != "dumb"

    def notice(words: str) -> None:
        if terminal:
            print(f"\r\x1b[K{words}", end="", file=sys.stderr, flush=True)

    try:
        yield notice
    finally:
        notice("")
