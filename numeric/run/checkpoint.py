"""The file that a long run of one packing goes on from: a zip of arrays, which checks itself.

Its first entry says what run it is of. The others are arrays as NumPy writes them, with the zip's
checksums; the zip's comment is the SHA-256 of all that stands before it, so that a file of which
any byte was changed, moved or cut off is refused. It is written whole, beside its place, and then
put there: a run that is killed at any moment leaves the last one or the next one. What such a run
left beside it is gone with the next. Against whoever computes the sum anew it is no safeguard.
"""

import json
import os
import time
from collections.abc import Mapping
from contextlib import suppress
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO
from zipfile import ZIP_STORED, BadZipFile, ZipFile, ZipInfo

import numpy as np

from ..arithmetic.errors import ForceDiffusionError, NotReachedError
from ..arithmetic.systems import Array
from ..mechanics.kept import Kept

FIRST, FORMAT = "force-diffusion checkpoint.json", 3
_OLD = b'{"is": "force-diffusion checkpoint'
_AT = 30  # where the name of a zip's first entry stands
_SUM = 64  # letters of a SHA-256
# Writing takes at most one part in so many of the time.
OFTEN = 20


class CheckpointError(ForceDiffusionError, ValueError):
    """A file can't serve as a checkpoint: the message says why, and what to do."""


class Checkpoint(Kept):
    """Arrays by name, kept in a file, for a run that ``key`` describes.

    A context manager keeps what is there at its end, whatever ends it. Raises ``CheckpointError``
    for a file of something else, of another run, damaged, or in use.
    """

    def __init__(self, path: Path, key: Mapping[str, Any]) -> None:
        """Open it, or make it."""
        super().__init__()
        self.path, self._place = path, path.resolve()
        self._part = self._place.with_name(f"{self._place.name}.part")
        self._run = sha256(json.dumps(key).encode()).hexdigest()
        self._saved, self._cost, self._changed = 0.0, 0.0, True
        self._file = opened(path)
        try:
            if self._file is None:
                self.save()
            else:
                _lock(self._file, path)
                self._read(self._file)
                self._clear()
        except BaseException:
            self._close()
            raise

    def _read(self, file: BinaryIO) -> None:
        """Take in what is there."""
        size = file.seek(0, os.SEEK_END)
        damaged = CheckpointError(
            f"{self.path} is damaged, it is not what was written: delete it, and the same command "
            "begins anew"
        )
        if size < _SUM or _sum(file, size) != (file.seek(size - _SUM), file.read())[1]:
            raise damaged
        try:
            with ZipFile(file) as kept:
                said = json.loads(kept.read(FIRST))
                if said != self._said:
                    raise CheckpointError(
                        f"{self.path} is the checkpoint of another scene, or of another version of "
                        "the program: give another name, or delete it"
                    )
                for entry in kept.infolist()[1:]:
                    with kept.open(entry) as content:
                        values = np.lib.format.read_array(content, allow_pickle=False)
                        self._kept[entry.filename.removesuffix(".npy")] = values
        except (BadZipFile, ValueError, KeyError, EOFError, NotImplementedError) as error:
            raise error if isinstance(error, CheckpointError) else damaged from None
        self._changed = False

    @property
    def _said(self) -> dict[str, Any]:
        return {"format": FORMAT, "run": self._run}

    def put(self, name: str, values: Array) -> None:
        """Keep an array."""
        super().put(name, values)
        self._changed = True

    def save(self, *, now: bool = True) -> None:
        """Write the file; if it is not to be ``now``, only where that takes little of the time.

        Raises ``NotReachedError`` where the disk is full.
        """
        start = time.monotonic()
        if not self._changed or (not now and start - self._saved < OFTEN * self._cost):
            return
        try:
            self._write()
        except OSError as error:
            if self._file is None:
                why = f"{self.path} can't be opened ({error.strerror})"
                raise CheckpointError(why) from None
            raise NotReachedError(
                f"{self.path} can't be written to ({error.strerror}): make room, or move it; the "
                "same command goes on from there"
            ) from None
        self._saved, self._changed = time.monotonic(), False
        self._cost = self._saved - start

    def _write(self) -> None:
        if self._part.exists():
            self._see_part()
        file = os.fdopen(os.open(self._part, os.O_RDWR | os.O_CREAT | _BINARY, 0o666), "r+b")
        try:
            _lock(file, self.path)
            file.truncate(0)
            with ZipFile(file, "w", ZIP_STORED) as kept:
                kept.writestr(ZipInfo(FIRST), json.dumps(self._said))
                for name, values in self._kept.items():
                    with kept.open(ZipInfo(f"{name}.npy"), "w", force_zip64=True) as content:
                        np.lib.format.write_array(content, values, allow_pickle=False)
                kept.comment = b"0" * _SUM
            size = file.seek(0, os.SEEK_END)
            total = _sum(file, size)
            file.seek(size - _SUM)
            file.write(total)
            file.flush()
            os.fsync(file.fileno())
            if self._file is None and self._place.exists():  # made since by another run
                raise _in_use(self.path)
            if not _LOCKS:  # and no open file can be renamed
                file.close()
            os.replace(self._part, self._place)
        except BaseException as error:
            with suppress(OSError):  # what a full disk did not take
                file.close()
            if not isinstance(error, CheckpointError):
                self._part.unlink(missing_ok=True)
            raise
        self._close()
        self._file = file

    def _clear(self) -> None:
        """Remove what a killed run left beside."""
        with suppress(OSError, CheckpointError):
            if self._part.exists():
                self._see_part()
                self._part.unlink()

    def _see_part(self) -> None:
        """Raise ``CheckpointError`` for a file beside it that no run of this program has left."""
        begun = b"?"
        if self._part.is_file():
            with self._part.open("rb") as file:
                begun = file.read(_AT + len(FIRST))[_AT:]
        if not FIRST.encode().startswith(begun):
            raise CheckpointError(
                f"{self._part} is in the way, and is no part of a checkpoint: move it, or give "
                "another name"
            )

    def _close(self) -> None:
        if self._file is not None:
            with suppress(OSError):
                self._file.close()

    def __enter__(self) -> "Checkpoint":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Save and close it; who interrupts is told that nothing is lost."""
        try:
            with suppress(*((NotReachedError,) if error else ())):  # that was said before
                self.save()
        finally:
            self._close()
        if isinstance(error, KeyboardInterrupt):
            error.add_note(f"{self.path} holds what is done; the same command goes on from there.")


def opened(path: Path) -> BinaryIO | None:
    """Open a checkpoint; None where there is no file. Raise ``CheckpointError`` for all else."""
    if path.exists() and not path.is_file():  # a device or a pipe may have no end
        raise CheckpointError(f"{path} is no ordinary file: give another name")
    try:
        file = path.open("rb")
    except FileNotFoundError:
        return None
    except OSError as error:
        raise CheckpointError(f"{path} can't be opened ({error.strerror})") from None
    head = file.read(_AT + len(FIRST))
    if head[_AT:] == FIRST.encode():
        return file
    file.close()
    if head.startswith(_OLD):
        raise CheckpointError(
            f"{path} is the checkpoint of an older version of the program: finish it with that, or "
            "delete it"
        )
    raise CheckpointError(
        f"{path} is no checkpoint, or damaged: give another name, or delete it if it was one"
    )


def _sum(file: BinaryIO, size: int) -> bytes:
    """Give the SHA-256 of all but the last bytes, in letters."""
    file.seek(0)
    found, left = sha256(), size - _SUM
    while left > 0 and (piece := file.read(min(left, 2**20))):
        found.update(piece)
        left -= len(piece)
    return found.hexdigest().encode()


try:
    import fcntl
except ImportError:  # not on this system
    _LOCKS = False
else:
    _LOCKS = True
_BINARY = getattr(os, "O_BINARY", 0)


def _lock(file: BinaryIO, path: Path) -> None:
    if not _LOCKS:
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise _in_use(path) from None


def _in_use(path: Path) -> CheckpointError:
    return CheckpointError(f"another run works on {path}: wait, or give another name")
