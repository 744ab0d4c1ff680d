"""The durable file of an ensemble: sums of finished realisations, in SQLite.

Every finished block is one transaction, so that a run may be killed at any moment. Blocks whose
sums nobody will need apart are merged in the same transaction: the file stays small. A file is
trusted only after all of it was checked, and one that is not this scene's is never written to.
"""

import hashlib
import json
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from time import sleep
from typing import Annotated, Any

from pydantic import Field, JsonValue, TypeAdapter

from ..arithmetic.errors import ForceDiffusionError, NotReachedError, printable
from .measure import Measurement
from .scene_key import differences
from .sums import Block, from_bytes

APPLICATION, SCHEMA = 0x46444546, 1  # "FDEF", and the layout
# Looks at a store that is being written to, and seconds between them.
LOOKS, PAUSE = 20, 0.05
_MAGIC = b"SQLite format 3\x00"
_TABLES = (
    "CREATE TABLE about (name TEXT PRIMARY KEY, content TEXT NOT NULL, checksum TEXT NOT NULL)",
    "CREATE TABLE sums (first INTEGER PRIMARY KEY, stop INTEGER NOT NULL, content BLOB NOT NULL, "
    "checksum TEXT NOT NULL)",
)
_SETTINGS = "locking_mode = EXCLUSIVE", "synchronous = FULL", "trusted_schema = 0"
# Bytes of what a store says of itself, and of a block: of a million contacts it has 60 MB.
LARGEST_TEXT, LARGEST_BLOCK = 1_000_000, 500_000_000
_Number = Annotated[int, Field(ge=0, le=10**12)]  # of a realisation
_KEY = TypeAdapter(dict[str, dict[str, JsonValue] | None])
_ENDS = TypeAdapter(tuple[_Number, ...])


class StoreError(ForceDiffusionError, ValueError):
    """A file can't serve as the store of an ensemble: the message says why, and what to do."""


class StoreInUseError(StoreError):
    """Another run works on the file of an ensemble."""


class StoreFailedError(NotReachedError):
    """The file of an ensemble can't be written to: the message says why, and what it holds."""


def _identity(path: Path) -> tuple[int, int] | None:
    """Say which file a name stands for now."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


@dataclass(frozen=True)
class About:
    """What a store says of itself: ``key`` describes the ensemble, ``ends`` are sizes asked for."""

    key: dict[str, Any]
    ends: tuple[int, ...]


class Store:
    """An open store, locked for every other process until it is closed."""

    def __init__(self, path: Path, database: sqlite3.Connection, about: About) -> None:
        """Take an open database that was checked."""
        self.path, self.about = path, about
        self._database = database
        self._file = _identity(path)

    def blocks(self, m: Measurement) -> list[Block]:
        """Read and check all sums, in the order of their realisations. Raises ``StoreError``."""
        found = list[Block]()
        for first, stop, content in self._rows():
            try:
                block = Block(first, stop, from_bytes(content, m))
                if block.sums.tried != stop - first:
                    raise ValueError("it holds more or fewer realisations than it says")
            except ValueError as error:
                raise _damaged(self.path, str(error)) from None
            found.append(block)
        return found

    def ranges(self) -> list[tuple[int, int]]:
        """Give (first, stop) of all blocks, checked. Raises ``StoreError``."""
        return [(first, stop) for first, stop, _ in self._rows()]

    def _rows(self) -> Iterator[tuple[int, int, bytes]]:
        before = 0
        with _reading(self.path):
            rows = self._database.execute(
                "SELECT first, stop, content, checksum FROM sums ORDER BY first"
            )
            for first, stop, content, checksum in rows:
                whole = isinstance(stop, int) and isinstance(content, bytes)
                if not whole or checksum != _checksum(self.about.key, first, stop, content):
                    raise _damaged(self.path, "a checksum is wrong")
                if not before <= first < stop:
                    raise _damaged(self.path, "its realisations don't follow each other")
                before = stop
                yield first, stop, content

    def begin(self, end: int) -> None:
        """Remember a size that was asked for: blocks on its two sides are never joined."""
        if end not in self.about.ends:
            self.about = About(self.about.key, tuple(sorted({*self.about.ends, end})))
            self._commit(lambda: _write_about(self._database, self.about))

    def put(self, block: Block) -> None:
        """Write a block in one transaction, in place of its parts."""
        content = block.sums.to_bytes()
        own = block.first, block.stop
        row = (*own, content, _checksum(self.about.key, *own, content))

        def write() -> None:
            self._database.execute("DELETE FROM sums WHERE first >= ? AND first < ?", own)
            self._database.execute("INSERT INTO sums VALUES (?, ?, ?, ?)", row)

        self._commit(write)

    def _commit(self, write: Callable[[], None]) -> None:
        """Write in one transaction: all of it, or none, also when interrupted."""
        self.check_it_is_there()
        try:
            with self._database:
                self._database.execute("BEGIN IMMEDIATE")
                write()
        except sqlite3.Error as error:
            raise OSError(None, f"{error}", str(self.path)) from None

    def check_it_is_there(self) -> None:
        """Raise ``OSError`` where the file was deleted or replaced since it was opened."""
        if _identity(self.path) != self._file:
            raise OSError(None, "it was deleted or replaced meanwhile", str(self.path))

    def close(self) -> None:
        """Close the file, and let others have it."""
        self._database.close()


def open_store(path: Path, key: dict[str, Any] | None, *, peek: bool = False) -> Store:
    """Open a store, or make one; without a ``key`` whatever ensemble it holds, and no new one.

    ``peek``: one that another run has locked, to read it as it is. Raises ``StoreError`` for a file
    that is damaged, of another kind, scene or version, or in use.
    """
    if str(path) == ":memory:":
        raise StoreError(f"{path} would be kept nowhere: give the name of a file")
    _look_at(path, may_be_new=key is not None)
    # from the root, since SQLite obeys other names, such as file:x?mode=memory
    name = f"{path.absolute().as_uri()}?immutable=1" if peek else path.absolute()
    with _reading(path):
        database = sqlite3.connect(name, uri=peek, timeout=0, isolation_level=None)
    try:
        with _reading(path):
            if not peek:
                for setting in _SETTINGS:
                    database.execute(f"PRAGMA {setting}")
                database.execute("BEGIN EXCLUSIVE")  # takes the lock, or fails at once
                (tables,) = database.execute("SELECT count(*) FROM sqlite_master").fetchone()
                if key is not None and not tables:  # a new file, or one that was never finished
                    _create(database, key)
                database.execute("COMMIT")
        return Store(path, database, _checked(path, database, key))
    except BaseException:
        database.close()
        raise


@dataclass(frozen=True)
class StoreContent:
    """What the store of an ensemble holds; every block of it has been checked.

    Attributes:
        realisations: packings in all, those that could not be built included.
        ranges: of the packings' numbers, (first, stop).
        sizes_asked_for: numbers of realisations that have been asked for.
        ensemble: the scene's sections that set the ensemble, as a scene file has them.
        in_use: whether a run works on it now; then this is what it held a moment ago.
    """

    realisations: int
    ranges: tuple[tuple[int, int], ...]
    sizes_asked_for: tuple[int, ...]
    ensemble: dict[str, Any]
    in_use: bool = False

    def data(self) -> dict[str, Any]:
        """What JSON can hold."""
        return {**asdict(self), "ranges": [list(one) for one in self.ranges]}

    def __str__(self) -> str:
        lines = [
            f"{self.realisations} realisations{', and a run works on it' if self.in_use else ''}",
            f"sizes asked for: {', '.join(map(str, self.sizes_asked_for))}",
        ]
        for section, keys in self.ensemble.items():
            given = [f"{k} = {v}" for k, v in (keys or {}).items() if v is not None]
            lines.append(f"{section}: {', '.join(given)}")
        return printable("\n".join(lines))

    __repr__ = __str__


def read_store(path: str | Path) -> StoreContent:
    """What the store of an ensemble holds, checked; nothing in it is changed.

    >>> import force_diffusion as fd
    >>> fd.read_store("nowhere.sqlite")  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    force_diffusion...StoreError: nowhere.sqlite: there is no such store

    Raises:
        StoreError: there is no such file, or it is damaged, or of another kind or version.
    """
    try:
        return _content(open_store(Path(path), None), in_use=False)
    except StoreInUseError:
        pass
    for _ in range(LOOKS):  # between two transactions the file is whole
        with suppress(StoreError):
            return _content(open_store(Path(path), None, peek=True), in_use=True)
        sleep(PAUSE)
    return _content(open_store(Path(path), None, peek=True), in_use=True)


def _content(opened: Store, *, in_use: bool) -> StoreContent:
    with closing(opened):
        ranges = tuple(opened.ranges())
    total = sum(stop - first for first, stop in ranges)
    return StoreContent(total, ranges, tuple(opened.about.ends), opened.about.key, in_use)


def _look_at(path: Path, *, may_be_new: bool) -> None:
    """Refuse what is plainly no store of ours."""
    try:
        if path.is_dir() or (path.exists() and not path.is_file()):
            raise StoreError(f"{path} is no ordinary file: give another name")
        if not path.exists() or not path.stat().st_size:
            if not may_be_new:
                raise StoreError(f"{path}: there is no such store")
            return
        with path.open("rb") as file:
            head = file.read(100)
    except OSError as error:
        raise StoreError(f"{path} can't be read: {error.strerror}") from None
    ours = head[:16] == _MAGIC and int.from_bytes(head[68:72], "big") == APPLICATION
    if not ours:
        raise StoreError(
            f"{path} is not the store of an ensemble, and is left as it is: give another name"
        )


@contextmanager
def _reading(path: Path) -> Iterator[None]:
    """Turn the database's errors into messages."""
    try:
        yield
    except UnicodeDecodeError:  # in what the database would say of it
        raise _damaged(path, "a text in it is none") from None
    except sqlite3.Error as error:
        code = (getattr(error, "sqlite_errorcode", None) or 0) & 0xFF
        if code in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
            raise StoreInUseError(
                f"{path} is in use: another run works on it. Wait for its end, or give another name"
            ) from None
        if code in (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM):
            raise StoreError(
                f"{path} can't be written to ({error}): give a place that can"
            ) from None
        if code in (sqlite3.SQLITE_FULL, sqlite3.SQLITE_IOERR):
            raise OSError(None, f"{error}", str(path)) from None
        raise _damaged(path, str(error)) from None


def _create(database: sqlite3.Connection, key: dict[str, Any]) -> None:
    for table in _TABLES:
        database.execute(table)
    database.execute(f"PRAGMA application_id = {APPLICATION}")
    database.execute(f"PRAGMA user_version = {SCHEMA}")
    _write_about(database, About(key, ()))


def _write_about(database: sqlite3.Connection, about: About) -> None:
    for name, value in (("ensemble", about.key), ("ends", list(about.ends))):
        content = json.dumps(value, sort_keys=True)
        database.execute(
            "INSERT OR REPLACE INTO about VALUES (?, ?, ?)", (name, content, _hash(name, content))
        )


def _checked(path: Path, database: sqlite3.Connection, key: dict[str, Any] | None) -> About:
    """Look at the tables first: what another one computes, even a CHECK, must never be run."""
    with _reading(path):
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_TEXT)
        (schema,) = database.execute("PRAGMA user_version").fetchone()
        if schema != SCHEMA:
            raise StoreError(
                f"{path} has the layout {schema} of another version of force-diffusion, and this "
                f"one reads layout {SCHEMA}: finish it with that version, or give another name"
            )
        written = database.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL")
        if set(written.fetchmany(len(_TABLES) + 1)) != {(table,) for table in _TABLES}:
            raise _damaged(path, "its tables are not those of an ensemble")
        rows = database.execute("SELECT name, content, checksum FROM about LIMIT 3").fetchall()
        database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_BLOCK)
        if database.execute("PRAGMA integrity_check(1)").fetchall() != [("ok",)]:
            raise _damaged(path, "the database is not in order")
    found = {name: content for name, content, _ in rows}
    if any(checksum != _hash(str(name), str(content)) for name, content, checksum in rows):
        raise _damaged(path, "a checksum is wrong")
    if set(found) != {"ensemble", "ends"}:
        raise _damaged(path, "it does not say what it holds")
    try:
        about = About(
            _KEY.validate_json(found["ensemble"], strict=True),
            _ENDS.validate_json(found["ends"], strict=True),
        )
    except ValueError:
        raise _damaged(path, "what it says of itself is not understood") from None
    if key is not None and about.key != key:
        if not database.execute("SELECT count(*) FROM sums").fetchone()[0]:
            about = About(key, ())  # of a run that failed before it had anything to keep
            with database:
                _write_about(database, about)
            return about
        raise StoreError(
            f"{path} holds another ensemble: {differences(about.key, key)}. "
            "Give another name for this one"
        )
    return about


def _damaged(path: Path, why: str) -> StoreError:
    return StoreError(
        f"{path} is damaged ({why}) and is left as it is: give another name, and the realisations "
        "are solved again"
    )


def _hash(*parts: str) -> str:
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def _checksum(key: dict[str, Any], first: int, stop: int, content: bytes) -> str:
    head = _hash(json.dumps(key, sort_keys=True), str(first), str(stop))
    return hashlib.sha256(head.encode() + content).hexdigest()
