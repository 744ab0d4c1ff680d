"""The file that a long run of one packing goes on from: arrays by name, one after the other.

Each is a line of JSON and its bytes, with a checksum; whatever was cut off at the end is forgotten.
Nothing is ever changed, so that a run may be killed at any moment.
"""

import json
import zlib
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from ..arithmetic.errors import ForceDiffusionError, NotReachedError
from ..arithmetic.systems import Array

_MAGIC = "force-diffusion checkpoint 1"
LONGEST_LINE = 10_000


class CheckpointError(ForceDiffusionError, ValueError):
    """A file can't serve as a checkpoint: the message says why, and what to do."""


class Checkpoint:
    """An open file of arrays, for a run that ``key`` describes; a context manager closes it.

    Raises ``CheckpointError`` for a file of something else, of another run, or in use.
    """

    def __init__(self, path: Path, key: Mapping[str, Any]) -> None:
        """Open or make it."""
        self.path = path
        self._places: dict[str, tuple[int, tuple[int, ...]]] = {}
        about = {"is": _MAGIC, "key": sha256(json.dumps(key).encode()).hexdigest()}
        if path.exists() and not path.is_file():  # a device or a pipe may have no end
            raise CheckpointError(f"{path} is no ordinary file: give another name")
        try:
            self._file = path.open("r+b" if path.exists() else "x+b")
        except OSError as error:
            raise CheckpointError(f"{path} can't be opened ({error.strerror})") from None
        try:
            _lock(self._file, path)
            self._read(about)
        except BaseException:
            self._file.close()
            raise

    def _read(self, about: dict[str, str]) -> None:
        """Find what is there; begin anew behind the last array that is whole."""
        self._file.seek(0)
        own = json.dumps(about).encode() + b"\n"
        first = self._file.readline(LONGEST_LINE)
        if first != own and own.startswith(first):  # empty, or killed at its first line
            self._file.seek(0)
            self._file.truncate()
            self._write(own)
            return
        found = _record(first)
        if found.get("is") != _MAGIC:
            raise CheckpointError(f"{self.path} is no checkpoint: give another name")
        if found != about:
            raise CheckpointError(
                f"{self.path} is the checkpoint of another scene, or of another version of the "
                "program: give another name, or delete it"
            )
        end = self._file.tell()
        while record := _record(self._file.readline()):
            at, shape = self._file.tell(), tuple(record["shape"])
            content = self._file.read(8 * int(np.prod(shape)))
            if zlib.crc32(content) != record["crc"]:
                break
            self._places[record["name"]] = at, shape
            end = self._file.tell()
        self._file.seek(end)
        self._file.truncate()

    def get(self, name: str) -> Array | None:
        """Give what was kept under a name, or None."""
        if name not in self._places:
            return None
        at, shape = self._places[name]
        self._file.seek(at)
        return np.frombuffer(self._file.read(8 * int(np.prod(shape))), "<f8").reshape(shape)

    def put(self, name: str, values: Array) -> None:
        """Keep an array of float64. Raises ``NotReachedError`` where the disk is full.

        What is there under that name stays: it is the same.
        """
        if name in self._places:
            return
        content = np.ascontiguousarray(values, dtype="<f8").tobytes()
        record = {"name": name, "shape": list(values.shape), "crc": zlib.crc32(content)}
        self._file.seek(0, 2)
        at = self._write(json.dumps(record).encode() + b"\n")
        self._write(content)
        self._places[name] = at, values.shape

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
        self._file.close()
        if isinstance(error, KeyboardInterrupt):
            error.add_note(f"{self.path} holds what is done; the same command goes on from there.")


def _record(line: bytes) -> dict[str, Any]:
    """Read a line of JSON; an empty one where it is cut off, or nothing of the kind."""
    try:
        found = json.loads(line) if line.endswith(b"\n") else {}
    except ValueError:
        return {}
    return found if isinstance(found, dict) else {}


def _lock(file: Any, path: Path) -> None:
    try:
        import fcntl
    except ImportError:  # not on this system
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        raise CheckpointError(f"another run works on {path}: wait, or give another name") from None
