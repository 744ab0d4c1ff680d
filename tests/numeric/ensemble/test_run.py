"""An ensemble is the same to the bit for any workers, blocks, order and interruption."""

import math
import random
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from threading import current_thread
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.ensemble import run, workers
from force_diffusion.numeric.ensemble.measure import Measurement
from force_diffusion.numeric.ensemble.result import Ensemble
from force_diffusion.numeric.ensemble.run import RealisationError
from force_diffusion.numeric.ensemble.scene_key import ensemble_key
from force_diffusion.numeric.ensemble.store import About, Store, StoreError, open_store
from force_diffusion.numeric.ensemble.sums import Block, measured, why_left_out
from force_diffusion.numeric.ensemble.workers import (
    Pool,
    Workers,
    WorkersError,
    here,
    processes,
    solve_block,
    threads,
)
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.statistics.confidence import Rule
from hypothesis import given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.ensemble.cases import CASES, bytes_of_first, case
from tests.numeric.scenes import scene

ROOT = Path(__file__).parents[3]
M = case("profile")
WHOLE = bytes_of_first(M, 150)


@contextmanager
def shuffled(seed: int, *, failing: bool = False) -> Iterator[Pool]:
    """Give threads that take several blocks, finish them in any order, and may fail."""
    drawn = random.Random(seed)

    def solve(m: Measurement, first: int, stop: int) -> tuple[str, bytes]:
        time.sleep(drawn.random() / 300)
        if failing and drawn.random() < 0.2:
            raise WorkersError("they are gone")
        return solve_block(m, first, stop)

    with ThreadPoolExecutor(4) as pool:
        yield Pool(pool, lambda: 6, solve=solve)


@contextmanager
def nobody() -> Iterator[Pool]:
    """Nothing may be left to do."""

    def solve(m: Measurement, first: int, stop: int) -> tuple[str, bytes]:
        raise AssertionError((first, stop))

    with here() as pool:
        yield Pool(pool.executor, pool.ahead, solve=solve)


def size_of_blocks(monkeypatch: pytest.MonkeyPatch, size: int) -> None:
    monkeypatch.setattr(run, "BLOCK", size * M.plan.problem.region.beads)


def on_file(path: Path, m: Measurement, size: int, solvers: Workers, **more: Any) -> Ensemble:
    store = open_store(path, ensemble_key(m))
    try:
        return run.run(m, size, solvers, store=store, **more)
    finally:
        store.close()


def bytes_of(result: Ensemble) -> bytes:
    return result.sums.to_bytes()


@settings(max_examples=10)
@given(st.integers(0, 10**6), st.integers(5, 200))
def test_any_order_and_any_blocks(seed: int, size: int) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        size_of_blocks(monkeypatch, size)
        assert bytes_of(run.run(M, 150, partial(shuffled, seed))) == WHOLE


@settings(max_examples=6)
@given(st.integers(0, 10**6), st.integers(8, 40))
def test_what_fails_goes_on_from_the_file(
    tmp_path_factory: pytest.TempPathFactory, seed: int, size: int
) -> None:
    path = tmp_path_factory.mktemp("store") / "ensemble.fd"
    seen = []
    with pytest.MonkeyPatch.context() as monkeypatch:
        while True:
            size_of_blocks(monkeypatch, size)
            try:
                found = on_file(path, M, 150, partial(shuffled, seed, failing=True))
                break
            except WorkersError:
                seed, size = seed + 1, size % 40 + 8
                store = open_store(path, None)
                seen.append(sum(stop - first for first, stop in store.ranges()))
                store.close()
    assert bytes_of(found) == WHOLE
    assert seen == sorted(seen)  # nothing finished was lost


@pytest.mark.long
def test_a_pool_of_processes_one_of_which_is_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    import os
    import signal
    from multiprocessing import active_children

    size_of_blocks(monkeypatch, 10)
    others = active_children()
    killed = []

    def kill_one(done: int, width: float | None) -> None:
        if done and not killed:
            victim = next(c for c in active_children() if c not in others)
            assert victim.pid is not None
            killed.append(victim.pid)
            os.kill(victim.pid, signal.SIGKILL)

    assert (
        bytes_of(run.run(M, 150, partial(processes, 2, M.plan.memory), progress=kill_one)) == WHOLE
    )
    assert killed


@pytest.mark.long
def test_workers_that_always_die_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "PATIENCE", 2)
    monkeypatch.setattr(workers, "_start", _die)
    with pytest.raises(WorkersError, match="died 2 times"):
        run.run(M, 40, partial(processes, 1, M.plan.memory))


@pytest.mark.long(sample=2)
@pytest.mark.parametrize(
    "trouble", [BrokenProcessPool("gone"), RuntimeError("can't start new thread"), OSError("fork")]
)
def test_a_process_that_can_not_be_started_loses_nothing(
    trouble: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    size_of_blocks(monkeypatch, 10)
    submit, calls = ProcessPoolExecutor.submit, []

    def seldom(self: Any, *arguments: Any) -> Any:
        calls.append(arguments)
        if len(calls) in (1, 4):
            raise trouble
        return submit(self, *arguments)

    monkeypatch.setattr(ProcessPoolExecutor, "submit", seldom)
    assert bytes_of(run.run(M, 150, partial(processes, 2, M.plan.memory))) == WHOLE
    assert len(calls) > 4
    monkeypatch.setattr(ProcessPoolExecutor, "submit", lambda *_: seldom(calls.clear()))
    with pytest.raises(WorkersError, match="died 3 times"):
        run.run(M, 150, partial(processes, 2, M.plan.memory))


def test_a_worker_that_has_too_little_memory_ends_at_once() -> None:
    program = (
        "from force_diffusion.numeric.ensemble import workers\n"
        "from tests.numeric.ensemble.cases import case\n"
        "m = case('profile')\n"
        "workers.memory_limit = lambda: m.plan.memory - 1\n"
        "workers._start(1, m.plan.memory)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (1, "")


def _die(count: int, memory: int) -> None:
    import os

    os._exit(1)


def test_a_file_grows_with_looks_and_not_with_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    size_of_blocks(monkeypatch, 1)
    path = tmp_path / "ensemble.fd"
    for size in (100, 150, 100, 150):
        on_file(path, M, size, partial(shuffled, size))
    store = open_store(path, None)
    assert store.ranges() == [
        (0, 32),
        (32, 48),
        (48, 64),
        (64, 96),
        (96, 100),
        (100, 104),
        (104, 112),
        (112, 128),
        (128, 144),
        (144, 148),
        (148, 150),
    ]
    assert store.about.ends == (100, 150)
    store.close()
    assert bytes_of(on_file(path, M, 100, nobody)) == bytes_of_first(M, 100)
    with pytest.raises(StoreError, match="ask for 128 or 144"):
        on_file(path, M, 140, nobody)
    assert bytes_of(on_file(path, M, 150, nobody)) == WHOLE


@settings(max_examples=5)
@given(st.integers(0, 10**6), st.integers(10, 64))
def test_where_it_stops_depends_on_nothing_but_the_sums(seed: int, size: int) -> None:
    rule = Rule(0.12, 0.9)
    with pytest.MonkeyPatch.context() as monkeypatch:
        usual = run.run(M, 300, here, rule=rule)
        size_of_blocks(monkeypatch, size)
        found = run.run(M, 300, partial(shuffled, seed), rule=rule)
    assert usual.reached
    assert 32 < usual.realisations < 300
    assert usual.half_width <= 0.12
    assert bytes_of(found) == bytes_of(usual)
    assert (found.looks, found.half_width) == (usual.looks, usual.half_width)


def test_a_file_with_more_does_not_change_where_it_stops(tmp_path: Path) -> None:
    rule = Rule(0.12, 0.9)
    path = tmp_path / "ensemble.fd"
    usual = run.run(M, 300, here, rule=rule)
    on_file(path, M, 300, here)
    found = on_file(path, M, 300, nobody, rule=rule)
    assert bytes_of(found) == bytes_of(usual)
    assert found.looks == usual.looks


def test_a_rule_that_is_not_met() -> None:
    found = run.run(M, 40, here, rule=Rule(1e-6, 0.9))
    assert found.reached is False
    assert found.looks == 2  # at 32, and at the end
    assert found.realisations == 40
    fixed = run.run(M, 40, here, confidence=0.9)
    assert fixed.reached is None
    assert fixed.looks == 0
    assert fixed.half_width < found.half_width


def test_packings_that_can_not_be_built_are_left_out_and_counted() -> None:
    wild = case("profile", kind="normal", relative_std="=0.16")
    bad = [k for k in range(60) if why_left_out(wild, k)]
    assert 5 < len(bad) < 55
    usual = run.run(wild, 60, here)
    sums = usual.sums
    assert (sums.realisations, sums.unbuildable, sums.tried) == (60 - len(bad), len(bad), 60)
    assert sums.first_unbuildable == bad[0]
    # single packings are solved one by one, and what is left out is not there
    good = [
        block.sums.means for k in range(60) if k not in bad for block in measured(wild, k, k + 1)
    ]
    assert sums.means == pytest.approx(np.mean(good, axis=0), rel=1e-12)
    assert bytes_of(run.run(wild, 60, partial(processes, 1, M.plan.memory))) == sums.to_bytes()


@pytest.mark.parametrize("std", ["=1e-4", "=0.16"])
def test_threads_that_sweep_compiled_give_the_same_bytes(
    std: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of rough packings, too, of which some can't be built: blocks come in any order."""
    pytest.importorskip("numba")
    m = case("profile", kind="normal", relative_std=std)
    alone = run.run(m, 300, here).sums.to_bytes()
    names = set()

    def noted(*arguments: Any) -> Any:
        names.add(current_thread().name)
        return measured(*arguments)

    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(workers, "measured", noted)
    assert m.compiled
    assert run.run(m, 300, partial(threads, 3)).sums.to_bytes() == alone
    assert "MainThread" not in names


def test_who_stops_waiting_stops_the_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    done = []

    def noted(*arguments: Any) -> Any:
        done.append(arguments)
        return measured(*arguments)

    monkeypatch.setattr(workers, "measured", noted)
    found = workers.solved(M, ((k, k + 1) for k in range(10_000)), partial(threads, 2))
    next(found)
    found.close()
    assert 1 <= len(done) < 100


def test_where_hardly_a_packing_can_be_built_one_is_named() -> None:
    wild = case("profile", kind="normal", relative_std="=0.4")
    with pytest.raises(RealisationError, match=r"60 of 60 .* realisation 0: bead \("):
        run.run(wild, 60, here)


def test_a_store_remembers_what_could_not_be_built(tmp_path: Path) -> None:
    wild = case("profile", kind="normal", relative_std="=0.16")
    whole = run.run(wild, 60, here).sums
    path = tmp_path / "ensemble.fd"
    for size in (20, 60):
        found = on_file(path, wild, size, here)
    assert found.solved == 40
    assert found.sums.to_bytes() == whole.to_bytes()


@pytest.mark.parametrize("name", CASES)
def test_every_quantity_can_be_kept(name: str, tmp_path: Path) -> None:
    m = case(name)
    path = tmp_path / "ensemble.fd"
    on_file(path, m, 5, here)
    assert bytes_of(on_file(path, m, 9, here)) == bytes_of_first(m, 9)


def test_a_block_is_written_once() -> None:
    class Counted(Store):
        def __init__(self) -> None:
            self.first, self.about = list[int](), About({}, ())

        def blocks(self, m: Measurement) -> list[Block]:
            return []

        def begin(self, end: int) -> None:
            pass

        def put(self, block: Block) -> None:
            self.first.append(block.first)

    counted = Counted()
    run.run(M, 150, here, store=counted)
    assert counted.first == [0, 32, 48, 64, 96, 128, 144, 148]


@pytest.mark.parametrize("seed", range(6))
def test_two_packings_tell_not_how_well_the_scatter_of_a_contact_is_known(seed: int) -> None:
    asked = scene(
        {
            "packing": {"height": 2, "width": 6},
            "disorder": {"kind": "normal", "relative_std": 1e-3, "seed": seed},
            "load": {"kind": "surface"},
            "ask": {"quantity": "contact", "at": [2, 0, "+"]},
        }
    )
    found = fd.ensemble(asked, 2, until=0.01)
    assert math.isnan(found.std_error[0])
    assert (found.half_width, found.reached) == (math.inf, False)
