"""What all commands that write results share: exit statuses, messages, files written whole."""

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NoReturn, TypeVar

import typer

WRONG_INPUT = 2
NOT_REACHED = 3


def _folder(word: str) -> Path:
    if not word:  # a path would take it for the current folder
        raise typer.BadParameter("'' names no folder. Give one; '.' is the current folder.")
    return Path(word)


def out_option(what: str) -> Any:
    """The option ``--out DIR``, which says what is written there."""
    return typer.Option(metavar="DIR", help=f"Write {what} into this folder.", parser=_folder)


def fail(message: str, status: int) -> NoReturn:
    """Leave with a message on standard error."""
    print(f"force-diffusion: {message}", file=sys.stderr)
    raise typer.Exit(status)


@contextmanager
def noticing() -> Iterator[Callable[[str], None]]:
    """Give a function that tells a terminal what is being measured, on one line of its own."""
    terminal = sys.stderr.isatty()

    def notice(words: str) -> None:
        if terminal:
            print(f"\r\x1b[K{words}", end="", file=sys.stderr, flush=True)

    try:
        yield notice
    finally:
        notice("")


def drawn(module: str, *arguments: Any) -> Mapping[str, str | bytes]:
    """Call ``plots`` of a module that needs matplotlib, or say what is missing and draw nothing."""
    from importlib import import_module

    try:
        plots = import_module(module).plots
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "matplotlib":
            raise
        missing = "no plot: matplotlib is missing; pip install 'force-diffusion[plots]'"
        print(f"force-diffusion: {missing}", file=sys.stderr)
        return {}
    found: Mapping[str, str | bytes] = plots(*arguments)
    return found


T = TypeVar("T")


def published(
    out: Path | None,
    answer: Callable[[], tuple[T, Mapping[str, str | bytes]]],
) -> T:
    """Answer, and write the files into the folder, which is looked at before anything is solved."""
    if out is None:
        return answer()[0]
    from force_diffusion.derivations.commands.folder import (
        NotOurFolderError,
        foreign_files,
        output_folder,
        owned_files,
    )

    refusal = f"--out {out}: give a new folder, an empty one, or one that an earlier run wrote"
    if out.exists() and not out.is_dir():
        fail(f"{refusal}; this is a file", WRONG_INPUT)
    if out.exists() and (foreign_files(out) or "equations.tex" in owned_files(out)):
        fail(f"{refusal}; this one holds other files", WRONG_INPUT)
    try:
        with output_folder(out) as folder:
            data, files = answer()
            names = sorted([*files, "manifest.json"])
            manifest = {"program": "force-diffusion", "files": names}
            folder.publish({**files, "manifest.json": json.dumps(manifest, indent=2) + "\n"})
    except NotOurFolderError as foreign:
        fail(f"{refusal}; this one holds {foreign}", WRONG_INPUT)
    return data


def csv_text(rows: list[dict[str, Any]]) -> str:
    """Write rows as CSV, under the keys of the first."""
    import csv
    import io

    text = io.StringIO()
    if rows:
        writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return text.getvalue()
