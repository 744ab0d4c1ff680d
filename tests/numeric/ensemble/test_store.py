"""The file: what is damaged, foreign or in use is refused with a message, and never written to."""

import gc
import hashlib
import os
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing, contextmanager, suppress
from pathlib import Path
from types import FrameType

import pytest
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.numeric.ensemble.run import RealisationError, run
from force_diffusion.numeric.ensemble.scene_key import ensemble_key
from force_diffusion.numeric.ensemble.store import (
    APPLICATION,
    StoreError,
    StoreFailedError,
    open_store,
    read_store,
)
from force_diffusion.numeric.ensemble.sums import Block
from force_diffusion.numeric.ensemble.workers import Pool, WorkersError, here
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.ensemble.cases import PROFILE, bytes_of_first, case
from tests.numeric.ensemble.test_run import on_file
from tests.numeric.scenes import scene

ROOT = Path(__file__).parents[3]
M = case("profile")
KEY = ensemble_key(M)
SIZE = 40
WHOLE = bytes_of_first(M, SIZE)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("sound") / "ensemble.fd"
    on_file(path, M, SIZE, here)
    return path.read_bytes()


def refused(path: Path, says: str) -> None:
    before = path.read_bytes()
    with pytest.raises(StoreError, match=says):
        on_file(path, M, SIZE, here)
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == [path.name]


@given(st.data())
def test_flipped_bytes_are_refused_or_do_no_harm(
    sound: bytes, tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    path = tmp_path_factory.mktemp("flipped") / "ensemble.fd"
    wrong = bytearray(sound)
    for _ in range(data.draw(st.integers(1, 3))):
        wrong[data.draw(st.integers(0, len(wrong) - 1))] ^= data.draw(st.integers(1, 255))
    path.write_bytes(wrong)
    try:
        found = on_file(path, M, SIZE, here)
    except StoreError:
        assert path.read_bytes() == bytes(wrong)
    else:  # in a part of the file that holds nothing
        assert found.sums.to_bytes() == WHOLE


def test_flipped_sums_are_refused(sound: bytes, tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    content = bytes_of_first(M, 32)
    at = sound.index(content[8:200])
    for offset in (0, 7, 100, 190):
        wrong = bytearray(sound)
        wrong[at + offset] ^= 1
        path.write_bytes(wrong)
        refused(path, "damaged")


@pytest.mark.parametrize("bit", range(8))
def test_a_flipped_bit_where_the_tables_are_described(
    bit: int, sound: bytes, tmp_path: Path
) -> None:
    """SQLite's own words then hold what is no text."""
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    unharmed = read_store(path)
    start, stop = sound.index(b"tablesums") - 30, sound.index(b"checksum TEXT NOT NULL)") + 30
    for at in range(start, stop):
        wrong = bytearray(sound)
        wrong[at] ^= 1 << bit
        path.write_bytes(wrong)
        try:
            assert read_store(path) == unharmed  # nothing reads this bit
        except StoreError:
            assert path.read_bytes() == bytes(wrong)


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_a_truncated_file_is_refused(share: float, sound: bytes, tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound[: int(len(sound) * share)])
    refused(path, "damaged")


def test_files_of_another_kind_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "thesis.tex"
    path.write_text("\\documentclass{article}")
    refused(path, "not the store of an ensemble")
    path.write_bytes(b"SQLite format 3\x00" + bytes(20))
    refused(path, "not the store of an ensemble")
    path.unlink()
    with sqlite3.connect(path) as database:
        database.execute("CREATE TABLE sums (first INTEGER)")
    database.close()
    refused(path, "not the store of an ensemble")
    with pytest.raises(StoreError, match="no ordinary file"):
        open_store(tmp_path, KEY)
    with pytest.raises(StoreError, match="can't be written to"):
        open_store(tmp_path / "no folder" / "ensemble.fd", KEY)
    with pytest.raises(StoreError, match="no such store"):
        open_store(tmp_path / "none.fd", None)


def changed(path: Path, *statements: str) -> None:
    database = sqlite3.connect(path)
    for statement in statements:
        database.execute(statement)
    database.commit()
    database.close()


@pytest.mark.parametrize(
    ("statement", "says"),
    [
        ("PRAGMA user_version = 2", "layout 2 of another version"),
        ("DELETE FROM about WHERE name = 'ends'", "does not say"),
        ("UPDATE about SET content = '[7]' WHERE name = 'ends'", "checksum"),
        ("UPDATE sums SET stop = 31 WHERE first = 0", "checksum"),
        ("UPDATE sums SET first = 33 WHERE first = 32", "checksum"),
        ("UPDATE sums SET content = 'text'", "checksum"),
        ("CREATE TRIGGER t AFTER INSERT ON sums BEGIN DELETE FROM sums; END", "tables"),
        ("CREATE VIEW v AS SELECT * FROM sums", "tables"),
    ],
)
def test_a_file_that_was_tampered_with(
    statement: str, says: str, sound: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    changed(path, statement)
    refused(path, says)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("ends", "["),
        ("ends", "null"),
        ("ends", '["40"]'),
        ("ends", "[1.5]"),
        ("ends", "[true]"),
        ("ends", "[-1]"),
        ("ends", f"[{'9' * 5000}]"),
        ("ends", "[" * 100_000),
        ("ends", f"[{'1, ' * 400_000}1]"),
        ("ensemble", "[]"),
        ("ensemble", "null"),
        ("ensemble", '{"packing": 3}'),
        ("ensemble", f'{{"packing": {{"height": {"[" * 3000}{"]" * 3000}}}}}'),
        ("ensemble", '{"packing": "\\ud800"}'),
    ],
)
def test_forged_words_of_a_store_are_refused(
    name: str, content: str, sound: bytes, tmp_path: Path
) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    checksum = hashlib.sha256(f"{name}\n{content}".encode()).hexdigest()
    forged = f"UPDATE about SET content = '{content}', checksum = '{checksum}'"
    changed(path, f"{forged} WHERE name = '{name}'")
    refused(path, "damaged")
    with pytest.raises(StoreError, match="damaged"):
        read_store(path)


def test_a_store_never_computes_what_its_tables_say(sound: bytes, tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    endless = (
        "(WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c) SELECT max(x) FROM c)"
    )
    for computed in ("CHECK (randomblob(900000000) IS NULL)", f"DEFAULT {endless}"):
        changed(
            path,
            "PRAGMA writable_schema = ON",
            f"UPDATE sqlite_master SET sql = replace(sql, 'TEXT NOT NULL', 'TEXT {computed}')",
        )
        program = (
            "import sys; from force_diffusion.numeric.ensemble.store import read_store\n"
            "read_store(sys.argv[1])"
        )
        done = subprocess.run(
            [sys.executable, "-c", program, str(path)],
            cwd=ROOT, capture_output=True, text=True, check=False, timeout=600,
        )  # fmt: skip
        assert "its tables are not those of an ensemble" in done.stderr


def test_names_in_a_forged_store_do_not_command_a_terminal(sound: bytes, tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    content = '{"packing": {"height": "\\u001b[2J"}}'
    checksum = hashlib.sha256(f"ensemble\n{content}".encode()).hexdigest()
    changed(
        path,
        f"UPDATE about SET content = '{content}', checksum = '{checksum}' WHERE name = 'ensemble'",
        "DELETE FROM sums",
    )
    assert r"height = \x1b[2J" in str(read_store(path))


def test_a_file_of_another_ensemble(sound: bytes, tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    for other, says in (
        (case("profile", seed=6), "there disorder.seed is 5, here 6"),
        (
            case("profile", relative_std="=1e-5"),
            "there disorder.relative_std is 0.0001, here 1e-05",
        ),
        (case("profile of a bulk load"), "load.kind"),
        (case("response"), "ask.quantity"),
    ):
        with pytest.raises(StoreError, match=says):
            open_store(path, ensemble_key(other))
    assert path.read_bytes() == sound


def test_a_file_of_another_version(
    sound: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    monkeypatch.setattr("force_diffusion.numeric.ensemble.scene_key.program_version", lambda: "9.9")
    with pytest.raises(StoreError, match=r"version.force-diffusion is .*, here 9.9"):
        open_store(path, ensemble_key(M))


def test_the_same_scene_in_other_words_is_the_same_ensemble() -> None:
    from force_diffusion.numeric.ensemble.measure import measurement

    from tests.numeric.ensemble.cases import PROFILE
    from tests.numeric.scenes import scene

    other = {**PROFILE, "packing": {"height": 4, "width": 6, "radius": "=1.0", "spacing": "=3.00"}}
    other["ask"] = {"quantity": "profile", "realisations": 77}
    assert ensemble_key(measurement(scene(other))) == KEY


def test_a_second_process_is_refused_while_one_works(tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    mine = open_store(path, KEY)
    run(M, 5, here, store=mine)
    program = (
        "import sys; from pathlib import Path\n"
        "from force_diffusion.numeric.ensemble.store import open_store\n"
        "open_store(Path(sys.argv[1]), None)"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, str(path)],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert "StoreInUseError" in done.stderr
    assert "in use" in done.stderr
    mine.close()
    open_store(path, KEY).close()


def test_a_full_disk_is_told_and_leaves_the_file_good(tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    store = open_store(path, KEY)
    pages = store._database.execute("PRAGMA page_count").fetchone()[0]
    store._database.execute(f"PRAGMA max_page_count = {pages + 1}")
    with pytest.raises(OSError, match="full") as failure:
        run(M, 400, here, store=store)
    assert failure.value.filename == str(path)
    held = sum(stop - first for first, stop in store.ranges())
    store.close()
    assert held
    assert on_file(path, M, held, here).solved == 0


def test_an_empty_file_is_a_new_one(tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    path.touch()
    assert on_file(path, M, 5, here).solved == 5


def test_a_file_that_was_never_finished_is_a_new_one(tmp_path: Path) -> None:
    """As a kill leaves it while the tables are being made."""
    path = tmp_path / "ensemble.fd"
    changed(path, f"PRAGMA application_id = {APPLICATION}")
    assert path.stat().st_size
    assert on_file(path, M, 5, here).solved == 5


KILLED = """
import os, signal, sys
from pathlib import Path
from force_diffusion.numeric.ensemble import run, store
from force_diffusion.numeric.ensemble.workers import here
from force_diffusion.numeric.ensemble.scene_key import ensemble_key
from tests.numeric.ensemble.cases import case

path, word, count = Path(sys.argv[1]), sys.argv[2], int(sys.argv[3])
seen = 0

def watch(statement):
    global seen
    seen += statement.startswith(word)
    if seen == count:
        os.kill(os.getpid(), signal.SIGKILL)

class Watched(store.sqlite3.Connection):
    def __init__(self, *a, **k):
        super().__init__(*a, **k)
        self.set_trace_callback(watch)

connect = store.sqlite3.connect
store.sqlite3.connect = lambda *a, **k: connect(*a, factory=Watched, **k)
m = case("profile")
run.BLOCK = 5 * m.plan.problem.region.beads
opened = store.open_store(path, ensemble_key(m))
run.run(m, 40, here, store=opened)
"""


@pytest.mark.long
def test_killed_at_every_kind_of_moment(tmp_path: Path) -> None:
    """SIGKILL just before a statement runs; the last run has nothing to stop it."""
    path = tmp_path / "ensemble.fd"
    moments = ["CREATE 2", "COMMIT 1", "DELETE 1", "INSERT 3", "COMMIT 4"]
    held = []
    for moment in moments:
        done = subprocess.run(
            [sys.executable, "-c", KILLED, str(path), *moment.split()],
            cwd=ROOT, env={**os.environ, "PYTHONPATH": str(ROOT)}, check=False,
        )  # fmt: skip
        assert done.returncode == -signal.SIGKILL, moment
        if path.stat().st_size:
            held.append(held_by(path))
    assert 0 < held[-1] < 40
    assert held == sorted(held)
    found = on_file(path, M, SIZE, here)
    assert found.sums.to_bytes() == WHOLE
    assert found.solved == SIZE - held[-1]
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def held_by(path: Path) -> int:
    """How many realisations a file holds, as SQLite recovers a copy of it."""
    copy, journal = path.with_suffix(".copy"), Path(f"{path}-journal")
    copy.write_bytes(path.read_bytes())
    if journal.exists():
        Path(f"{copy}-journal").write_bytes(journal.read_bytes())
    opened = open_store(copy, KEY)
    ranges = opened.ranges()
    opened.close()
    copy.unlink()
    Path(f"{copy}-journal").unlink(missing_ok=True)
    return sum(stop - first for first, stop in ranges)


@contextmanager
def failing() -> Iterator[Pool]:
    raise WorkersError("they are gone")
    yield


def test_a_store_that_holds_nothing_serves_the_next_scene(tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    wild = case("profile", kind="normal", relative_std="=0.9")
    with pytest.raises(ForceDiffusionError):
        on_file(path, wild, SIZE, failing)
    assert on_file(path, M, SIZE, here).sums.to_bytes() == WHOLE
    assert read_store(path).ensemble == KEY


def test_a_running_store_can_be_looked_at(tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    on_file(path, M, SIZE, here)
    running = open_store(path, KEY)
    try:
        found = read_store(path)
        assert (found.in_use, found.realisations) == (True, SIZE)
        assert "a run works on it" in str(found)
        with pytest.raises(StoreError, match="in use"):
            open_store(path, KEY)
    finally:
        running.close()
    assert not read_store(path).in_use


@pytest.mark.parametrize("how", ["deleted", "replaced"])
def test_a_store_that_vanishes_is_told(how: str, tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    done = []

    def vanish(count: int, width: float | None) -> None:
        done.append(count)
        if count == 300:  # after the last block
            path.unlink()
            if how == "replaced":
                path.write_bytes(b"")

    with pytest.raises(StoreFailedError, match="deleted or replaced"):
        fd.ensemble(scene(PROFILE), 300, store=path, progress=vanish)
    assert done[-1] == 300


def test_a_store_in_memory_is_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(StoreError, match="name of a file"):
        fd.ensemble(scene(PROFILE), 30, store=":memory:")
    for name in ("file:here?mode=memory", "file::memory:"):  # names that SQLite could obey
        fd.ensemble(scene(PROFILE), 30, store=name)
        assert (tmp_path / name).is_file()
        assert fd.read_store(name).realisations == 30


def test_an_ensemble_that_can_not_be_built_blocks_no_corrected_scene(tmp_path: Path) -> None:
    path = tmp_path / "ensemble.fd"
    wrong = PROFILE | {"disorder": PROFILE["disorder"] | {"kind": "normal", "relative_std": "=5"}}
    with pytest.raises(RealisationError, match="30 of 30 packings are left out"):
        fd.ensemble(scene(wrong), 30, store=path)
    assert fd.read_store(path).realisations == 0
    fd.ensemble(scene(PROFILE), 30, store=path)
    assert fd.read_store(path).realisations == 30


class _Interrupt:
    """Raise ``KeyboardInterrupt`` before the ``at``-th instruction of the store, as Ctrl-C may."""

    def __init__(self, at: int) -> None:
        self.left = at

    def __call__(self, frame: FrameType, event: str, _: object) -> "_Interrupt | None":
        if Path(frame.f_code.co_filename).name not in {"store.py", "contextlib.py"}:
            return None
        frame.f_trace_opcodes = True
        if event == "opcode":
            self.left -= 1
            if not self.left:
                sys.settrace(None)
                raise KeyboardInterrupt
        return self


def test_interrupted_at_every_instruction(
    sound: bytes, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A block is there or not, and nothing touches the file once it is closed."""
    complaints: list[object] = []
    monkeypatch.setattr(sys, "unraisablehook", complaints.append)
    path, before = tmp_path / "ensemble.fd", sys.gettrace()
    path.write_bytes(sound)
    with closing(open_store(path, KEY)) as store:
        first = store.blocks(M)[0]
    added = Block(SIZE, SIZE + first.stop - first.first, first.sums)
    held, ended = set[int](), False
    for at in range(1, 10_000):
        path.write_bytes(sound)
        with suppress(KeyboardInterrupt), closing(open_store(path, KEY)) as store:
            try:
                sys.settrace(_Interrupt(at))
                store.put(added)
                ended = True
            finally:
                sys.settrace(before)
        gc.collect(0)
        assert not complaints, at
        held.add(read_store(path).realisations)
        if ended:
            break
    assert ended
    assert held == {SIZE, added.stop}
