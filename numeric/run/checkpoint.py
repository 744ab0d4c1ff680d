"""The file that a long run of one packing goes on from: arrays by name, one after the other.

Its first line says what run it is of. A record is a header (its name, its shape and the SHA-256 of
its array, as JSON filled up with spaces), the SHA-256 of the mark before and this header, which is
its own mark, and the array. So a mark covers all that stands before it, names and order included:
what was changed, moved, repeated or put in is noticed, and refused. Nothing is ever changed, so
that a run may be killed at any moment: a file that ends early is gone on from. Against whoever
computes marks anew it is no safeguard.
"""

import json
from collections.abc import Collection, Mapping
from contextlib import suppress
from hashlib import sha256
from math import prod
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.errors import ForceDiffusionError, NotReachedError
from ..arithmetic.systems import Array

_MAGIC, _FORMAT = "force-diffusion checkpoint", 2
LONGEST_LINE = 10_000
HEADER, MARK = 160, 32
"""Bytes of a record before its array."""


class CheckpointError(ForceDiffusionError, ValueError):
    """A file can't serve as a checkpoint: the message says why, and what to do."""


class _Kept(NamedTuple):
    """Where an array begins, its shape and its SHA-256."""

    at: int
    shape: tuple[int, ...]
    digest: str


class Checkpoint:
    """An open file of arrays, for a run that ``key`` describes; a context manager closes it.

    ``names`` are those that arrays of this run may have. Raises ``CheckpointError`` for a file of
    something else, of another run, damaged, or in use.
    """

    def __init__(self, path: Path, key: Mapping[str, Any], names: Collection[str]) -> None:
        """Open or make it."""
        self.path = path
        self._names = names
        self._places: dict[str, _Kept] = {}
        run = sha256(json.dumps(key).encode()).hexdigest()
        own = json.dumps({"is": _MAGIC, "format": _FORMAT, "key": run}).encode() + b"\n"
        if path.exists() and not path.is_file():  # a device or a pipe may have no end
            raise CheckpointError(f"{path} is no ordinary file: give another name")
        try:
            self._file = path.open("r+b" if path.exists() else "x+b")
        except OSError as error:
            raise CheckpointError(f"{path} can't be opened ({error.strerror})") from None
        try:
            _lock(self._file, path)
            self._read(own)
        except BaseException:
            self._file.close()
            raise

    def _read(self, own: bytes) -> None:
        """Find what is there; begin anew behind the last array that is whole."""
        self._file.seek(0)
        self._mark = sha256(own).digest()
        first = self._file.readline(LONGEST_LINE)
        if first != own and own.startswith(first):  # empty, or killed at its first line
            self._file.seek(0)
            self._file.truncate()
            self._write(own)
            return
        if first != own:
            if not first.startswith(f'{{"is": "{_MAGIC}'.encode()):
                raise CheckpointError(f"{self.path} is no checkpoint: give another name")
            raise CheckpointError(
                f"{self.path} is the checkpoint of another scene, or of another version of the "
                "program: give another name, or delete it"
            )
        end = self._file.tell()
        while len(header := self._file.read(HEADER)) == HEADER:
            mark = self._file.read(MARK)
            if len(mark) < MARK:
                break
            if mark != sha256(self._mark + header).digest():
                raise self._damaged(end)
            record = json.loads(header)
            name, kept = record["name"], _Kept(self._file.tell(), record["shape"], record["sha256"])
            if name in self._places or name not in self._names:
                raise self._damaged(end)
            content = self._content(kept)
            if content is None:
                break
            self._places[name], self._mark = kept, mark
            end = self._file.tell()
        self._file.seek(end)
        self._file.truncate()

    def _content(self, kept: _Kept) -> bytes | None:
        """Read the bytes of an array; None where the file ends before they do."""
        self._file.seek(kept.at)
        size = 8 * prod(kept.shape)
        content: bytes = self._file.read(size)
        if len(content) < size:
            return None
        if sha256(content).hexdigest() != kept.digest:
            raise self._damaged(kept.at)
        return content

    def _damaged(self, at: int) -> CheckpointError:
        return CheckpointError(
            f"{self.path} is damaged: what stands from byte {at} on is not what was written; "
            "delete it, and the same command begins anew"
        )

    def get(self, name: str) -> Array | None:
        """Give what was kept under a name, or None; raise ``CheckpointError`` if it was changed."""
        if name not in self._places:
            return None
        kept = self._places[name]
        content = self._content(kept)
        if content is None:
            raise self._damaged(kept.at)
        return np.frombuffer(content, "<f8").reshape(kept.shape)

    def put(self, name: str, values: Array) -> None:
        """Keep an array of float64. Raises ``NotReachedError`` where the disk is full.

        What is there under that name stays: it is the same.
        """
        if name in self._places:
            return
        assert name in self._names
        content = np.ascontiguousarray(values, dtype="<f8").tobytes()
        digest = sha256(content).hexdigest()
        record = {"name": name, "shape": list(values.shape), "sha256": digest}
        header = json.dumps(record).encode().ljust(HEADER)
        assert len(header) == HEADER
        mark = sha256(self._mark + header).digest()
        self._file.seek(0, 2)
        at = self._write(header + mark)
        self._write(content)
        self._places[name], self._mark = _Kept(at, values.shape, digest), mark

    def drop(self, name: str) -> None:
        """Nothing is ever forgotten: another run may need it."""

    def _write(self, content: bytes) -> int:
        try:
            self._file.write(content)
            self._file.flush()
        except OSError as error:
            raise NotReachedError(
                f"{self.path} can't be written to ({error.strerror}): make room, or move it; the "
                "same command goes on from there"
            ) from None
        return self._file.tell()

    def __enter__(self) -> "Checkpoint":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Close it; who interrupts is told that nothing is lost."""
        with suppress(OSError):  # what a full disk did not take was said before
            self._file.close()
        if isinstance(error, KeyboardInterrupt):
            error.add_note(f"{self.path} holds what is done; the same command goes on from there.")


def _lock(file: Any, path: Path) -> None:
    try:
        import fcntl
    except ImportError:  # not on this system
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise CheckpointError(f"another run works on {path}: wait, or give another name") from None
