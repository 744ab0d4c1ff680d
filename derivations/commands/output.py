"""The folder for a command's results: it is either complete or absent.

    folder = Output(out, ["result.json", "profile.csv"], overwrite)
    answer = solve()  # a folder that can't be used has been refused before
    folder.write({"result.json": ..., "profile.csv": ...})

Files are written into a temporary folder next to it, which is renamed at the end. An existing
folder is replaced only with ``--overwrite``, and only if all files in it have these names: it is
renamed first, and deleted last. A command killed in between leaves both, and the next one says so.
"""

import os
import shutil
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError

from .guard import tell


class OutputError(ForceDiffusionError):
    """Files can't go there; the message names what is in the way."""


def folder_of(word: str) -> Path:
    """Read the name of a folder."""
    path = Path(word)
    if path.name in {"", ".."}:  # such as '.', or nothing, which a path would take for it
        raise typer.BadParameter(f"'{word}' can't name a new folder. Give another name.")
    return path


def out_option(what: str) -> Any:
    """The option ``--out DIR``, which says what is written there."""
    return typer.Option(metavar="DIR", help=f"Write {what} into this new folder.", parser=folder_of)


Overwrite = Annotated[
    bool,
    typer.Option("--overwrite", help="Replace the folder, if it contains only files of this kind."),
]


class Output:
    """A folder to be written; ``names`` are the files that may be in it.

    Raises ``OutputError`` where it is in the way, and ``OSError`` where nothing can be written.
    """

    def __init__(self, path: Path, names: Iterable[str], overwrite: bool) -> None:
        self.path, self.names, self.overwrite = path, frozenset(names), overwrite
        self._old = path.with_name(f"{path.name}.old")
        self._check()
        above = next(parent for parent in path.parents if os.path.lexists(parent))
        if not above.is_dir():
            raise _no_folder(above)
        self._new = above / f"{path.name}.new-{os.urandom(4).hex()}"
        self._new.mkdir()
        self._new.rmdir()

    def _check(self) -> None:
        """Refuse what is not to be replaced."""
        path = self.path
        if os.path.lexists(self._old):
            raise OutputError(
                f"'{self._old}' exists: a command was stopped while it replaced '{path}', and this "
                "is the old content. Rename it, or delete it."
            )
        if not os.path.lexists(path):
            return
        if path.is_symlink() or not path.is_dir():
            raise _no_folder(path)
        if not self.overwrite:
            raise OutputError(f"'{path}' exists already. Give another folder, or --overwrite.")
        try:
            there = list(path.iterdir())
        except FileNotFoundError:  # another command replaces it just now
            return
        own = {file for file in there if file.name in self.names and not file.is_symlink()}
        others = [file.name for file in there if file not in own or not file.is_file()]
        if others:
            raise OutputError(
                f"'{path}' contains files that this command doesn't write, such as "
                f"'{min(others)}'. Give another folder."
            )

    def write(self, files: Mapping[str, str | bytes]) -> None:
        """Write all files into a new folder, and rename it.

        Raises ``OSError`` that names the file which can't be written, and ``OutputError`` where the
        folder can't be renamed any more; it says where the files are.
        """
        new = self._new
        try:
            new.mkdir(parents=True)
            for name, content in files.items():
                _write(new / name, content, self.path / name)
        except BaseException:
            shutil.rmtree(new, ignore_errors=True)
            raise
        there = self.overwrite and self.path.is_dir()
        try:
            self._check()
            self.path.parent.mkdir(parents=True, exist_ok=True)
            if there:
                os.rename(self.path, self._old)
            os.rename(new, self.path)
        except (OutputError, OSError) as failure:
            if there and not self.path.exists():
                os.rename(self._old, self.path)
            why = failure if isinstance(failure, OutputError) else f"{failure.strerror}."
            raise OutputError(f"{why} The results are in '{new}'.") from None
        if there:
            with suppress(OSError):
                for name in self.names:
                    (self._old / name).unlink(missing_ok=True)
                self._old.rmdir()
            if self._old.is_dir():  # as where something came into it meanwhile
                tell(f"'{self._old}' can't be deleted. It has the old content of '{self.path}'.")


def _no_folder(path: Path) -> OutputError:
    return OutputError(f"'{path}' is a file or a link. Give a folder that doesn't exist yet.")


def _write(path: Path, content: str | bytes, named: Path) -> None:
    try:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    except OSError as failure:  # one that fails half-way has no name
        failure.filename = str(named)
        raise
