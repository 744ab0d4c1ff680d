"""The folder that a command writes its results into.

    with output(out, "run scene.toml", ["result.json", "profile.csv"], overwrite) as folder:
        answer = solve()  # a folder that can't be used has been refused before
        if folder:  # None without --out
            folder.write({"result.json": ..., "profile.csv": ...})

A command replaces the files that it has written before, adds others beside whatever is there, and
deletes nothing. It refuses to replace a file that this program did not write, one that was changed
since, and the answer to another question, unless ``--overwrite`` is given. ``manifest.json`` of the
folder knows which is which. Each file is written aside and renamed, the manifest last, so that none
is ever half-written. A command that is killed between two renames leaves that manifest aside: what
it lists was written by this program, too, so that the command can be given again. The next one that
succeeds in the folder takes away what such a one has left.

Commands that run at once may share a folder. Each locks the names that it will write until it
ends, and the manifest while it reads or adds to it: one that would write what another one is about
to write is refused before it solves anything. A lock is that of an open file, and dies with its
process, however that ends. Where the system or the disk has no such locks, there are none.
"""

import errno
import hashlib
import os
import re
import secrets
import stat
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager, suppress
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryFile
from typing import Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError, printable

from ..export.manifest import (
    LARGEST,
    MANIFEST,
    PROGRAM,
    FoundEquation,
    Made,
    Manifest,
    read_manifest,
)
from .cli import command_line
from .interrupts import waiting

# Files are written aside under a dot, their name, eight random digits, and this.
PART = ".fd-part"
# Locks are on files beside those that are written: a dot, the name, and this.
LOCK = ".fd-lock"
NO_LOCKS = {errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP}
_LEFT = re.compile(rf"\..+\.[0-9a-f]{{8}}{re.escape(PART)}")
# How often a folder is made that others take away at once.
ATTEMPTS = 100


class OutputError(ForceDiffusionError):
    """Files can't go there; the message names what is in the way."""


def folder_of(word: str) -> Path:
    """Read the name of a folder."""
    if not word:  # a path would take it for the current folder
        raise typer.BadParameter("'' names no folder. Give one; '.' is the current folder.")
    return Path(word)


def out_option(what: str) -> Any:
    """The option ``--out DIR``, which says what is written there."""
    return typer.Option(metavar="DIR", help=f"Write {what} into this folder.", parser=folder_of)


Overwrite = Annotated[
    bool,
    typer.Option("--overwrite", help="Replace files of the same name there, whoever wrote them."),
]


_IS_FOLDER = "is a folder"


def _in_the_way(path: Path, reason: str) -> OutputError:
    remedy = "." if reason == _IS_FOLDER else ", or --overwrite to replace it."
    return OutputError(f"'{path}' {reason}. Give another folder{remedy}")


class Folder:
    """A folder that can be written to; ``manifest`` is what it held before, if it is ours."""

    def __init__(self, path: Path, result_of: str, overwrite: bool) -> None:
        self.path = path
        self._read()
        self._result_of = printable(result_of)
        self._overwrite = overwrite

    def _read(self) -> None:
        """Read the manifest, and those of commands that were killed before they could rename it."""
        self.manifest = read_manifest(self.path)
        parts = sorted(self.path.glob(f".{MANIFEST}.*{PART}"))
        begun = (read_manifest(self.path, part.name) for part in parts)
        self._begun = [one for one in begun if one is not None]

    def check(self, names: Iterable[str]) -> None:
        """Raise ``OutputError`` if a file of these names must not be replaced, and name it."""
        for name in (*names, MANIFEST):
            reason = self._reason_to_keep(name)
            if reason:
                raise _in_the_way(self.path / name, reason)

    def _reason_to_keep(self, name: str) -> str:
        path = self.path / name
        try:
            mode = path.lstat().st_mode
        except FileNotFoundError:
            return ""
        if stat.S_ISDIR(mode):
            return _IS_FOLDER
        if self._overwrite:
            return ""
        if name == MANIFEST:
            return "" if self.manifest else "was not written by this program"
        manifests = [one for one in (self.manifest, *self._begun) if one is not None]
        made = [one.files[name] for one in manifests if name in one.files]
        if not made or not stat.S_ISREG(mode):
            return f"is there, and no {MANIFEST} says that this program wrote it"
        own = {one.sha256 for one in made if one.result_of == self._result_of}
        if own and self._digest(name) in own:
            return ""
        others = [one for one in made if one.result_of != self._result_of]
        if others and (not own or self._digest(name) in {one.sha256 for one in others}):
            return f"is the result of '{others[0].result_of}'"
        return "was changed after this program wrote it"

    def _digest(self, name: str) -> str:
        with (self.path / name).open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()

    def holds(self, name: str) -> bool:
        """Say whether a file that this program wrote before is still there."""
        listed = self.manifest is not None and name in self.manifest.files
        return listed and (self.path / name).is_file()

    def write(
        self,
        files: Mapping[str, str | bytes],
        equations: Sequence[FoundEquation] | None = None,
        *,
        seed: int | None = None,
        inputs: Mapping[str, str] | None = None,
    ) -> None:
        """Write all files aside, then rename them into place, the manifest last.

        ``equations`` take the place of those in the manifest; ``seed`` and ``inputs`` are noted
        there. Raises ``OutputError`` as ``check`` does, and ``OSError`` that names
        the file where one can't be written.
        """
        contents = {
            name: content if isinstance(content, bytes) else content.encode()
            for name, content in files.items()
        }
        with _locked(self.path / MANIFEST, wait=True) as locked:
            self._write(contents, equations, seed, inputs or {})
            if locked:  # else another may still write
                _clear(self.path)

    def _write(
        self,
        contents: dict[str, bytes],
        equations: Sequence[FoundEquation] | None,
        seed: int | None,
        inputs: Mapping[str, str],
    ) -> None:
        """Write files and the manifest, while no other command reads it to write it anew."""
        self._read()  # another command may have written meanwhile
        self.check(contents)
        before = self.manifest or Manifest(program=PROGRAM, files={})
        kept = {name: made for name, made in before.files.items() if self.holds(name)}
        for begun in self._begun:
            kept |= {
                name: one
                for name, one in begun.files.items()
                if (self.path / name).is_file() and self._digest(name) == one.sha256
            }
        made = {n: self._made(content, seed, inputs) for n, content in contents.items()}
        contents[MANIFEST] = (
            Manifest(
                program=PROGRAM,
                files=dict(sorted((kept | made).items())),
                equations=before.equations if equations is None else tuple(equations),
            )
            .text()
            .encode()
        )
        if len(contents[MANIFEST]) > LARGEST:
            raise OutputError(
                f"'{self.path}' holds too many results: its {MANIFEST} would grow beyond "
                f"{LARGEST} bytes. Give another folder."
            )
        write_whole(self.path, contents)

    def _made(self, content: bytes, seed: int | None, inputs: Mapping[str, str]) -> Made:
        return Made(
            result_of=self._result_of,
            command=command_line(),
            version=version(PROGRAM),
            sha256=hashlib.sha256(content).hexdigest(),
            seed=seed,
            inputs={printable(name): digest for name, digest in inputs.items()},
        )


def write_whole(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write files aside in their folder; when all are there, rename them, in their order.

    Interrupts wait until all are renamed. Raises ``OSError`` that names the file which can't be
    written; nothing is left aside then but a manifest of what was renamed.
    """
    suffix = f".{secrets.token_hex(4)}{PART}"
    aside = {name: folder / f".{name}{suffix}" for name in contents}
    try:
        for name, content in contents.items():
            try:
                with aside[name].open("xb") as file:
                    file.write(content)
            except OSError as failure:  # a write that fails half-way names no file
                failure.filename = str(folder / name)
                raise
        with waiting():
            for name in list(aside):
                os.replace(aside[name], folder / name)
                del aside[name]
    finally:
        if len(aside) < len(contents):
            aside.pop(MANIFEST, None)
        for path in aside.values():
            path.unlink(missing_ok=True)


def _clear(folder: Path) -> None:
    """Take away what killed commands have left in a folder in which no other one writes now."""
    for path in folder.iterdir():
        if _LEFT.fullmatch(path.name):
            path.unlink(missing_ok=True)
        elif path.name.startswith(".") and path.name.endswith(LOCK):
            own = folder / path.name[1 : -len(LOCK)]
            # not so where its command still runs
            with suppress(OutputError, OSError), _locked(own, wait=False):
                pass


@contextmanager
def output(
    out: Path | None, result_of: str, names: Iterable[str], overwrite: bool = False
) -> Iterator[Folder | None]:
    """Give the folder to write into, or None without ``--out``; it is made if it is not there.

    ``names`` are the files that will be written, as far as they are known: whether they may be is
    found out now, and until the end no other command may. ``result_of`` is the question that they
    answer, such as "run scene.toml". Raises ``OutputError`` where ``out`` can't be used, and
    ``OSError`` where it can't be written to.
    """
    if out is None:
        yield None
        return
    names = list(dict.fromkeys(names))
    with _standing(out, names):
        with _locked(out / MANIFEST, wait=True):
            folder = Folder(out, result_of, overwrite)
            folder.check(names)
        yield folder


def copied(contents: Mapping[str, bytes], folder: Path, overwrite: bool) -> list[str]:
    """Write files that are no results; return the names of those that were not there already.

    Raises ``OutputError`` where another file of that name is there, before anything is written.
    """
    with _standing(folder):
        new = {}
        for name, content in sorted(contents.items()):
            path = folder / name
            if path.is_dir():
                raise _in_the_way(path, _IS_FOLDER)
            size = path.stat().st_size if path.is_file() else None
            if size == len(content) and path.read_bytes() == content:
                continue
            if os.path.lexists(path) and not overwrite:
                raise _in_the_way(path, "is there, and differs from the one to be written")
            new[name] = content
        with _locked(folder / MANIFEST, wait=True):
            write_whole(folder, new)
    return list(new)


@contextmanager
def _standing(folder: Path, names: Sequence[str] = ()) -> Iterator[None]:
    """See to it that a folder is there and can be written to, and lock names in it.

    One that stays empty goes again.
    """
    missing = []
    for one in (folder, *folder.parents):
        mode = _mode(one)
        if mode is not None and stat.S_ISDIR(mode):
            break
        if mode is not None:
            raise OutputError(f"'{one}' is a file. Give a folder.")
        if one.is_symlink():
            raise OutputError(
                f"'{one}' is a link to '{os.readlink(one)}', which is not there. Give a folder."
            )
        missing.append(one)
    try:
        with ExitStack() as locks:
            for left in reversed(range(ATTEMPTS)):
                try:
                    folder.mkdir(parents=True, exist_ok=True)
                    with TemporaryFile(dir=folder):  # whether it can be written to
                        pass
                    for name in names:
                        locks.enter_context(_locked(folder / name, wait=False))
                    break
                except (FileNotFoundError, FileExistsError):  # others make it, and take it away
                    locks.close()
                    if not left:
                        raise
            yield
    finally:
        for one in missing:
            with suppress(OSError):  # not empty, or never made
                one.rmdir()


def _mode(path: Path) -> int | None:
    """Give what a path leads to, looked at once; None where that is nothing."""
    try:
        return path.stat().st_mode
    except OSError as failure:
        if failure.errno not in {errno.ENOENT, errno.ENOTDIR, errno.ELOOP}:
            raise
        return None


@contextmanager
def _locked(path: Path, *, wait: bool) -> Iterator[bool]:
    """Keep other commands from writing a file; raise ``OutputError`` where one does, or wait.

    Says whether the system and the disk have locks. The lock is on a hidden file beside it, which
    goes when the lock does.
    """
    try:
        import fcntl
    except ImportError:  # not on this system
        yield False
        return
    beside = path.with_name(f".{path.name}{LOCK}")
    while True:
        number = _opened(beside, path)
        locked = True
        try:
            try:
                fcntl.flock(number, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
            except BlockingIOError:
                raise OutputError(
                    f"'{path}' is about to be written by another command, which still runs. Wait "
                    "for it, or give another folder."
                ) from None
            except OSError as failure:
                if failure.errno not in NO_LOCKS:
                    raise
                locked = False
            if not _is_at(number, beside):  # who had the lock took it away with the file
                continue
            try:
                yield locked
            finally:
                beside.unlink(missing_ok=True)
            return
        finally:
            os.close(number)


def _opened(beside: Path, path: Path) -> int:
    """Open the file that locks another; raise ``OSError`` that names the other."""
    try:
        return os.open(beside, os.O_RDWR | os.O_CREAT | os.O_NOFOLLOW | os.O_NONBLOCK, 0o666)
    except OSError as failure:
        failure.filename = str(path)
        raise


def _is_at(number: int, path: Path) -> bool:
    """Say whether an open file still has its name."""
    try:
        return os.path.samestat(os.fstat(number), path.lstat())
    except FileNotFoundError:
        return False
