"""The file: what is damaged, foreign or in use is refused with a message, and never written to."""

import sqlite3
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.ensemble import store, sums
from force_diffusion.numeric.ensemble.ensemble import RealisationError
from force_diffusion.numeric.ensemble.result import Ensemble
from force_diffusion.numeric.ensemble.sums import measurement, solve_block
from hypothesis import given
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.ensemble.cases import PROFILE, bytes_of_first, case
from tests.numeric.scenes import scene

M = case("profile")
KEY = store.description(M)
SIZE = 40


def on_file(path: Path, size: int) -> Ensemble:
    return fd.ensemble(scene(PROFILE), size, store=path)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    path = tmp_path_factory.mktemp("sound") / "ensemble.fd"
    on_file(path, SIZE)
    return path.read_bytes()


def refused(path: Path, says: str) -> None:
    before = path.read_bytes()
    with pytest.raises(store.StoreError, match=says):
        on_file(path, SIZE)
    assert path.read_bytes() == before
    assert [p.name for p in path.parent.iterdir()] == [path.name]


@given(st.data())
def test_flipped_and_missing_bytes_are_refused_or_do_no_harm(sound, tmp_path_factory, data):
    path = tmp_path_factory.mktemp("flipped") / "ensemble.fd"
    wrong = bytearray(sound)
    for _ in range(data.draw(st.integers(1, 3))):
        wrong[data.draw(st.integers(0, len(wrong) - 1))] ^= data.draw(st.integers(1, 255))
    del wrong[data.draw(st.just(len(wrong)) | st.integers(1, len(wrong))) :]
    path.write_bytes(wrong)
    try:
        ensemble = on_file(path, SIZE)
    except store.StoreError:
        assert path.read_bytes() == bytes(wrong)
    else:  # in a part of the file that holds nothing
        assert ensemble.sums.to_bytes() == bytes_of_first(M, SIZE)


def test_files_of_another_kind_are_refused(tmp_path):
    path = tmp_path / "thesis.tex"
    path.write_text("\\documentclass{article}")
    refused(path, "not the store of an ensemble")
    path.write_bytes(b"SQLite format 3\x00" + bytes(20))
    refused(path, "not the store of an ensemble")
    path.unlink()
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("CREATE TABLE sums (first INTEGER)")
    refused(path, "not the store of an ensemble")
    with pytest.raises(store.StoreError, match="must be a regular file"):
        store.Store(tmp_path, KEY)
    with pytest.raises(store.StoreError, match="can't be written to"):
        store.Store(tmp_path / "no folder" / "ensemble.fd", KEY)
    with pytest.raises(store.StoreError, match="no such store"):
        store.Store(tmp_path / "none.fd", None)


@pytest.mark.parametrize(
    ("statement", "says"),
    [
        ("DELETE FROM ensemble", "does not say"),
        ("UPDATE ensemble SET description = '['", "damaged"),
        ("UPDATE ensemble SET description = '{}'", "checksum"),
        ("UPDATE blocks SET stop = 31 WHERE first = 0", "checksum"),
        ("UPDATE blocks SET content = 'text'", "checksum"),
        ("DROP TABLE blocks", "no such table"),
    ],
)
def test_a_file_that_was_tampered_with(statement, says, sound, tmp_path):
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    with closing(sqlite3.connect(path)) as database, database:
        database.execute(statement)
    refused(path, says)


def test_a_file_of_another_ensemble_or_version(sound, tmp_path, monkeypatch):
    path = tmp_path / "ensemble.fd"
    path.write_bytes(sound)
    for other, says in (
        (case("profile", seed=6), "there disorder.seed is 5, here 6"),
        (case("profile", relative_std="=1e-5"), "relative_std is 0.0001, here 1e-05"),
        (case("profile of a bulk load"), "load.kind"),
    ):
        with pytest.raises(store.StoreError, match=says):
            store.Store(path, store.description(other))
    monkeypatch.setattr("force_diffusion.numeric.ensemble.store.__version__", "9.9")
    with pytest.raises(store.StoreError, match=r"version.force-diffusion is .*, here 9.9"):
        store.Store(path, store.description(M))
    assert path.read_bytes() == sound


def test_the_same_scene_in_other_words_is_the_same_ensemble():
    other = {**PROFILE, "packing": {"height": 4, "width": 6, "radius": "=1.0", "spacing": "=3.00"}}
    other["ask"] = {"quantity": "profile", "realisations": 77}
    assert store.description(measurement(scene(other))) == KEY


def test_two_runs_may_share_a_file(tmp_path):
    path = tmp_path / "ensemble.fd"
    with closing(store.Store(path, KEY)) as first, closing(store.Store(path, KEY)) as second:
        for k, block in enumerate(M.blocks(SIZE)):
            (first, second)[k % 2].put(block, solve_block(M, *block))
            first.put(block, solve_block(M, *block))
    ensemble = fd.ensemble(scene(PROFILE), SIZE, store=path)
    assert (ensemble.solved, ensemble.sums.to_bytes()) == (0, bytes_of_first(M, SIZE))


def test_a_full_disk_is_reported_and_the_file_stays_sound(tmp_path, monkeypatch):
    path = tmp_path / "ensemble.fd"
    monkeypatch.setattr(sums, "BEADS", 4 * M.problem.region.beads)
    connect = sqlite3.connect

    def small(*given: Any, **more: Any) -> sqlite3.Connection:
        database = connect(*given, **more)
        database.execute("PRAGMA max_page_count = 6")
        return database

    monkeypatch.setattr(sqlite3, "connect", small)
    with pytest.raises(store.StoreFailedError, match=r"full.* holds [1-9]\d* realisations"):
        fd.ensemble(scene(PROFILE), 400, store=path)
    monkeypatch.setattr(sqlite3, "connect", connect)
    count = store.read_store(path).realisations
    assert fd.ensemble(scene(PROFILE), 400, store=path).solved == 400 - count


@pytest.mark.parametrize("moment", ["CREATE 2", "INSERT 1", "INSERT 2", "INSERT 3", "INSERT 5"])
def test_a_run_stopped_before_any_statement_continues(moment, tmp_path, monkeypatch):
    word, count = moment.split()
    statements = []

    class Stopped(sqlite3.Connection):
        def execute(self, statement: str, *given: Any) -> sqlite3.Cursor:
            statements.append(statement.split(maxsplit=1)[0])
            if statements[-1] == word and statements.count(word) == int(count):
                raise KeyboardInterrupt
            return super().execute(statement, *given)

    path, connect = tmp_path / "ensemble.fd", sqlite3.connect
    monkeypatch.setattr(sums, "BEADS", 4 * M.problem.region.beads)
    monkeypatch.setattr(sqlite3, "connect", partial(connect, factory=Stopped))
    with pytest.raises(KeyboardInterrupt):
        on_file(path, SIZE)
    monkeypatch.setattr(sqlite3, "connect", connect)
    # the first block is written by the second INSERT
    written = 4 * max(statements.count("INSERT") - 2, 0)
    assert (store.read_store(path).realisations if written else path.stat().st_size) == written
    ensemble = on_file(path, SIZE)
    assert ensemble.solved == SIZE - written
    assert ensemble.sums.to_bytes() == bytes_of_first(M, SIZE)


def test_special_names_of_sqlite_are_plain_files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    # names that SQLite could obey
    for name in (":memory:", "file:here?mode=memory", "file::memory:"):
        fd.ensemble(scene(PROFILE), 30, store=name)
        assert (tmp_path / name).is_file()
        assert fd.read_store(name).realisations == 30


def test_an_ensemble_that_can_not_be_built_blocks_no_corrected_scene(tmp_path):
    path = tmp_path / "ensemble.fd"
    wrong = PROFILE | {"disorder": PROFILE["disorder"] | {"kind": "normal", "relative_std": "=5"}}
    with pytest.raises(RealisationError, match="30 of 30 packings are left out"):
        fd.ensemble(scene(wrong), 30, store=path)
    assert not path.stat().st_size
    fd.ensemble(scene(PROFILE), 30, store=path)
    assert fd.read_store(path).realisations == 30
