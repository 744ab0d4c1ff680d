"""The file of an ensemble: sums over blocks of realisations, in SQLite.

Every block is one transaction, so that a run may be killed at any moment. Checksums are checked
when a file is opened, and a file that is not this scene's is never written to.
"""

import hashlib
import json
import sqlite3
import textwrap
from collections.abc import Iterable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict, dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

from force_diffusion import __version__

from ..arithmetic.decimals import short
from ..arithmetic.errors import (
    ForceDiffusionError,
    NotReachedError,
    WrongTypeError,
    printable,
    quoted,
)
from ..scene.scene import PROGRAM, source_of
from .sums import Block, Measurement, Sums, from_bytes

APPLICATION = 0x46444546  # "FDEF"
# Seconds until another run has written its block.
PATIENCE = 60
_TABLES = (
    "CREATE TABLE ensemble (description TEXT NOT NULL)",
    "CREATE TABLE blocks (first INTEGER NOT NULL, stop INTEGER NOT NULL, content BLOB NOT NULL, "
    "checksum TEXT NOT NULL, PRIMARY KEY (first, stop))",
)
# Keys of a question that say how much is asked, not what.
_HOW_MUCH = ("realisations", "tolerance", "bins")


class StoreError(ForceDiffusionError, ValueError):
    """A file can't be the store of this ensemble; the message says why, and what to do."""


class StoreFailedError(NotReachedError):
    """The store of an ensemble can't be written to; the message says why, and what it holds."""


def description(m: Measurement) -> dict[str, Any]:
    """Describe an ensemble: all that decides its numbers; numbers are exact, as strings."""
    scene = m.plan.scene
    sections: dict[str, Any] = source_of(scene, {})["scene"]
    for key in _HOW_MUCH:
        sections["ask"].pop(key, None)
    if scene.load.file is not None:  # its content counts, not its name
        loads = m.problem.load.single.items()
        forces = sorted((list(site), list(map(str, force))) for site, force in loads)
        digest = hashlib.sha256(json.dumps(forces).encode()).hexdigest()
        sections["load"]["file"] = f"sha256 {digest}"
    edges = [edge.hex() for edge in m.edges]
    return sections | {"measured": {"edges": edges}, "version": {PROGRAM: __version__}}


class Store:
    """An open store; ``held`` are its blocks, all of which have been checked."""

    def __init__(self, path: Path, ensemble: dict[str, Any] | None = None) -> None:
        """Open a store; without an ``ensemble`` one that exists, whatever it holds.

        A new one is made with its first block. Raises ``StoreError`` for a file that is damaged, of
        another kind, scene or version.
        """
        self.path, self.ensemble, self.held = path, ensemble or {}, set[Block]()
        if path.exists() and not path.is_file():
            raise StoreError(f"{path} must be a regular file: give another name")
        if ensemble is None and not path.exists():
            raise StoreError(f"{path}: there is no such store")
        with _reading(path):
            self._database = sqlite3.connect(
                path.absolute(), timeout=PATIENCE, isolation_level=None
            )
        try:
            with _reading(path):
                self._read()
            if ensemble not in (None, self.ensemble):
                raise StoreError(
                    f"{path} holds another ensemble: {_difference(self.ensemble, ensemble or {})}. "
                    "Give another name for this one"
                )
        except BaseException:
            self._database.close()
            raise

    def _read(self) -> None:
        """Look what it holds, if it is not new, and check it."""
        if not self._database.execute("SELECT * FROM sqlite_master").fetchone():
            return
        if self._database.execute("PRAGMA application_id").fetchone() != (APPLICATION,):
            raise _not_ours(self.path)
        if self._database.execute("PRAGMA integrity_check(1)").fetchone() != ("ok",):
            raise ValueError("the database is not in order")
        (text,) = self._database.execute("SELECT description FROM ensemble").fetchone() or ("[]",)
        self.ensemble = json.loads(text)
        if not isinstance(self.ensemble, dict):
            raise ValueError("it does not say what it holds")
        rows = self._database.execute("SELECT first, stop, content, checksum FROM blocks")
        for first, stop, content, checksum in rows:
            if not isinstance(content, bytes) or checksum != self._checksum((first, stop), content):
                raise ValueError("a checksum is wrong")
            self.held.add((first, stop))

    def _checksum(self, block: Block, content: bytes) -> str:
        head = f"{_text(self.ensemble)} {block}".encode()
        return hashlib.sha256(head + content).hexdigest()

    @property
    def realisations(self) -> int:
        """How many there are."""
        return sum(stop - first for first, stop in together(self.held))

    def read(self, block: Block, m: Measurement) -> Sums:
        """Read the sums of a block that is held."""
        query = "SELECT content FROM blocks WHERE first = ? AND stop = ?"
        with _reading(self.path):
            (content,) = self._database.execute(query, block).fetchone() or (b"",)
            return from_bytes(content, m)

    def put(self, block: Block, sums: Sums) -> None:
        """Write a block. Raises ``StoreFailedError``, or ``StoreError`` as opening it does."""
        content = sums.to_bytes()
        row = (*block, content, self._checksum(block, content))
        with _reading(self.path), self._database as database:
            database.execute("BEGIN IMMEDIATE")
            if not database.execute("SELECT * FROM sqlite_master").fetchone():
                for table in _TABLES:
                    database.execute(table)
                database.execute(f"PRAGMA application_id = {APPLICATION}")
                database.execute("INSERT INTO ensemble VALUES (?)", (_text(self.ensemble),))
            database.execute("INSERT OR REPLACE INTO blocks VALUES (?, ?, ?, ?)", row)
        self.held.add(block)

    def close(self) -> None:
        """Close the file."""
        self._database.close()


@dataclass(frozen=True)
class StoreContent:
    """What the store of an ensemble holds, with every block checked.

    Attributes:
        realisations: packings in all, including those that could not be built.
        ranges: of the packings' numbers, (first, stop).
        ensemble: the scene's sections that set the ensemble, as a scene file has them.
    """

    realisations: int
    ranges: tuple[Block, ...]
    ensemble: dict[str, Any]

    def data(self) -> dict[str, Any]:
        """Data for JSON."""
        return {**asdict(self), "ranges": [list(block) for block in self.ranges]}

    def __str__(self) -> str:
        lines = [f"{self.realisations} realisations"]
        for section, keys in self.ensemble.items():
            if given := [f"{k} = {v}" for k, v in (keys or {}).items() if v not in (None, [])]:
                lines.append(f"{section}: {', '.join(given)}")
        return printable("\n".join(lines))

    __repr__ = __str__


def read_store(path: str | Path) -> StoreContent:
    """Check the store of an ensemble and say what it holds, without changing it.

    >>> import force_diffusion as fd
    >>> fd.read_store("nowhere.sqlite")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    force_diffusion...StoreError: nowhere.sqlite: there is no such store

    Raises:
        StoreError: there is no such file, it is damaged, or it is of another kind.
    """
    if not isinstance(path, str | Path):
        raise WrongTypeError(f"read_store takes the path of a file, not {quoted(path)}")
    with closing(Store(Path(path))) as store:
        return StoreContent(store.realisations, tuple(together(store.held)), store.ensemble)


def together(blocks: Iterable[Block]) -> list[Block]:
    """Join blocks that follow each other, or overlap.

    >>> together([(32, 40), (0, 32), (32, 48), (64, 96)])
    [(0, 48), (64, 96)]
    """
    joined: list[Block] = []
    for first, stop in sorted(blocks):
        if joined and first <= joined[-1][1]:
            joined[-1] = joined[-1][0], max(stop, joined[-1][1])
        else:
            joined.append((first, stop))
    return joined


def _not_ours(path: Path) -> StoreError:
    return StoreError(
        f"{path} is not the store of an ensemble, and is left as it is: give another name"
    )


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    """Turn errors of the database, and of what it holds, into messages."""
    try:
        yield
    except StoreError:
        raise
    except (sqlite3.Error, ValueError, RecursionError) as error:
        code = (getattr(error, "sqlite_errorcode", None) or 0) & 0xFF
        if code == sqlite3.SQLITE_NOTADB:
            raise _not_ours(path) from None
        if code in (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM):
            raise StoreError(
                f"{path} can't be written to ({error}): choose a folder that can be"
            ) from None
        if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR):
            raise StoreFailedError(
                f"{path} can't be used ({error}): make room, or move it to another place"
            ) from None
        raise StoreError(
            f"{path} is damaged ({error}) and is left as it is: give another name, and the "
            "realisations are solved again"
        ) from None


def _text(ensemble: dict[str, Any]) -> str:
    return json.dumps(ensemble, sort_keys=True)


def _difference(old: dict[str, Any], new: dict[str, Any]) -> str:
    """Name the first few keys in which two ensembles differ."""
    differences = []
    for section in {**old, **new}:
        a, b = old.get(section) or {}, new.get(section) or {}
        differences += [
            f"there {section}.{key} is {_shown(a.get(key))}, here {_shown(b.get(key))}"
            for key in {**a, **b}
            if a.get(key) != b.get(key)
        ]
    return "; ".join(differences[:3])


def _shown(value: Any) -> str:
    if isinstance(value, str):
        with suppress(ValueError):
            return short(Fraction(value))
    return "not given" if value is None else textwrap.shorten(json.dumps(value), 50)
