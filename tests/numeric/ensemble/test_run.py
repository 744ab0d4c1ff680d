"""An ensemble is the same to the bit for any workers, blocks, order and interruption."""

import random
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path
from threading import current_thread
from typing import Any

import pytest
from force_diffusion.numeric.disorder.radii import RadiusError
from force_diffusion.numeric.ensemble import run, workers
from force_diffusion.numeric.ensemble.measure import Measurement
from force_diffusion.numeric.ensemble.result import Ensemble
from force_diffusion.numeric.ensemble.run import Executor
from force_diffusion.numeric.ensemble.scene_key import ensemble_key
from force_diffusion.numeric.ensemble.store import Block, Store, StoreError, open_store
from force_diffusion.numeric.ensemble.sums import Sums, measured
from force_diffusion.numeric.ensemble.workers import InProcess, Pool, RealisationError, WorkersError
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.sweep import NotStandingError, UnbuildableError
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.statistics.confidence import Rule
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.numeric.ensemble.cases import CASES, case

ROOT = Path(__file__).parents[3]
M = case("profile", covariance=True)
WHOLE = measured(M, range(150)).to_bytes()


class Shuffled:
    """Workers that take several blocks, finish them in any order, and may fail."""

    def __init__(self, seed: int, failing: bool = False) -> None:
        self.random, self.failing = random.Random(seed), failing

    def results(
        self, m: Measurement, tasks: Iterator[tuple[int, int]]
    ) -> Iterator[tuple[int, int, Sums]]:
        pending: list[tuple[int, int]] = []
        while True:
            while len(pending) < 6 and (task := next(tasks, None)):
                pending.append(task)
            if not pending:
                return
            if self.failing and self.random.random() < 0.2:
                raise WorkersError("they are gone")
            first, stop = pending.pop(self.random.randrange(len(pending)))
            yield first, stop, measured(m, range(first, stop))


def size_of_blocks(monkeypatch: pytest.MonkeyPatch, size: int) -> None:
    monkeypatch.setattr(run, "BLOCK", size * M.plan.problem.region.beads)


def on_file(path: Path, m: Measurement, size: int, executor: Executor, **more: Any) -> Ensemble:
    store = open_store(path, ensemble_key(m))
    try:
        return run.run(m, size, executor, store=store, **more)
    finally:
        store.close()


def bytes_of(result: Ensemble) -> bytes:
    return result.estimates.sums.to_bytes()


@settings(max_examples=10)
@given(st.integers(0, 10**6), st.integers(5, 200))
def test_any_order_and_any_blocks(seed: int, size: int) -> None:
    with pytest.MonkeyPatch.context() as monkeypatch:
        size_of_blocks(monkeypatch, size)
        assert bytes_of(run.run(M, 150, Shuffled(seed))) == WHOLE


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
                found = on_file(path, M, 150, Shuffled(seed, failing=True))
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

    assert bytes_of(run.run(M, 150, Pool(2), progress=kill_one)) == WHOLE
    assert killed


@pytest.mark.long
def test_workers_that_always_die_are_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "PATIENCE", 2)
    monkeypatch.setattr(workers, "_start", _die)
    with pytest.raises(WorkersError, match="died 2 times"):
        run.run(M, 40, Pool(1))


@pytest.mark.long(sample=2)
@pytest.mark.parametrize(
    "trouble", [BrokenProcessPool("gone"), RuntimeError("can't start new thread"), OSError("fork")]
)
def test_a_process_that_can_not_be_started_loses_nothing(
    trouble: Exception, monkeypatch: pytest.MonkeyPatch
) -> None:
    size_of_blocks(monkeypatch, 10)
    submit, calls = workers.ProcessPoolExecutor.submit, []

    def seldom(self: Any, *arguments: Any) -> Any:
        calls.append(arguments)
        if len(calls) in (1, 4):
            raise trouble
        return submit(self, *arguments)

    monkeypatch.setattr(workers.ProcessPoolExecutor, "submit", seldom)
    assert bytes_of(run.run(M, 150, Pool(2))) == WHOLE
    assert len(calls) > 4
    monkeypatch.setattr(workers.ProcessPoolExecutor, "submit", lambda *_: seldom(calls.clear()))
    with pytest.raises(WorkersError, match="died 3 times"):
        run.run(M, 150, Pool(2))


def test_a_worker_that_has_too_little_memory_ends_at_once() -> None:
    program = (
        "from force_diffusion.numeric.ensemble import workers\n"
        "from tests.numeric.ensemble.cases import case\n"
        "m = case('profile')\n"
        "workers.memory_limit = lambda: m.plan.memory - 1\n"
        "workers._start(m, 1)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stderr) == (1, "")


def _die(m: Measurement) -> None:
    import os

    os._exit(1)


def test_a_file_grows_with_looks_and_not_with_blocks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    size_of_blocks(monkeypatch, 1)
    path = tmp_path / "ensemble.fd"
    for size in (100, 150, 100, 150):
        on_file(path, M, size, Shuffled(size))
    store = open_store(path, None)
    assert store.ranges() == [
        (0, 32),
        (32, 48),
        (48, 64),
        (64, 96),
        (96, 100),
        (100, 128),
        (128, 150),
    ]
    assert store.about.ends == (100, 150)
    store.close()
    assert bytes_of(on_file(path, M, 100, Nobody())) == measured(M, range(100)).to_bytes()
    with pytest.raises(StoreError, match="ask for 128 or 150"):
        on_file(path, M, 140, Nobody())
    assert bytes_of(on_file(path, M, 150, Nobody())) == WHOLE


class Nobody:
    """Nothing may be left to do."""

    def results(
        self, m: Measurement, tasks: Iterator[tuple[int, int]]
    ) -> Iterator[tuple[int, int, Sums]]:
        assert next(tasks, None) is None
        return iter(())


@settings(max_examples=5)
@given(st.integers(0, 10**6), st.integers(10, 64))
def test_where_it_stops_depends_on_nothing_but_the_sums(seed: int, size: int) -> None:
    rule = Rule(0.12, 0.9)
    with pytest.MonkeyPatch.context() as monkeypatch:
        usual = run.run(M, 300, InProcess(), rule=rule)
        size_of_blocks(monkeypatch, size)
        found = run.run(M, 300, Shuffled(seed), rule=rule)
    assert usual.reached
    assert 32 < usual.estimates.realisations < 300
    assert usual.half_width <= 0.12
    assert bytes_of(found) == bytes_of(usual)
    assert (found.looks, found.half_width) == (usual.looks, usual.half_width)


def test_a_file_with_more_does_not_change_where_it_stops(tmp_path: Path) -> None:
    rule = Rule(0.12, 0.9)
    path = tmp_path / "ensemble.fd"
    usual = run.run(M, 300, InProcess(), rule=rule)
    on_file(path, M, 300, InProcess())
    found = on_file(path, M, 300, Nobody(), rule=rule)
    assert bytes_of(found) == bytes_of(usual)
    assert found.looks == usual.looks


def test_a_rule_that_is_not_met() -> None:
    found = run.run(M, 40, InProcess(), rule=Rule(1e-6, 0.9))
    assert found.reached is False
    assert found.looks == 2  # at 32, and at the end
    assert found.estimates.realisations == 40
    fixed = run.run(M, 40, InProcess(), confidence=0.9)
    assert fixed.reached is None
    assert fixed.looks == 0
    assert fixed.half_width < found.half_width


def test_packings_that_can_not_be_built_are_left_out_and_counted() -> None:
    wild = case("profile", kind="normal", relative_std="=0.16")
    bad = []
    for k in range(60):
        try:
            measured(wild, [k])
        except (UnbuildableError, RadiusError, NotStandingError):
            bad.append(k)
    assert 5 < len(bad) < 55
    good = [k for k in range(60) if k not in bad]
    for executor in (InProcess(), Pool(1)):
        sums = run.run(wild, 60, executor).estimates.sums
        assert (sums.realisations, sums.unbuildable, sums.tried) == (len(good), len(bad), 60)
        assert sums.first_unbuildable == bad[0]
        assert replace(sums, unbuildable=0, first_unbuildable=-1).to_bytes() == (
            measured(wild, good).to_bytes()
        )


@pytest.mark.parametrize(
    ("std", "missing"), [("=1e-4", "nothing"), ("=0.16", "nothing"), ("=1e-4", "threadpoolctl")]
)
def test_threads_that_sweep_compiled_give_the_same_bytes(
    std: str, missing: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of rough packings, too, of which some can't be built: blocks come in any order."""
    pytest.importorskip("numba")
    monkeypatch.setitem(sys.modules, missing, None)
    m = case("profile", kind="normal", relative_std=std, covariance=True)
    alone = run.run(m, 300, InProcess()).estimates.sums.to_bytes()
    names = set()

    def noted(*arguments: Any) -> Any:
        names.add(current_thread().name)
        return measured(*arguments)

    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(workers, "cores", lambda: 3)
    monkeypatch.setattr(workers, "measured", noted)
    assert m.compiled
    assert run.run(m, 300, InProcess()).estimates.sums.to_bytes() == alone
    assert "MainThread" not in names


def test_who_stops_waiting_stops_the_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("numba")
    done = []

    def noted(m: Measurement, realisations: Any, work: Work) -> Any:
        found = measured(m, realisations, work)
        done.append(realisations)
        return found

    monkeypatch.setattr(engine, "COMPILED_FROM", 1)
    monkeypatch.setattr(workers, "cores", lambda: 2)
    monkeypatch.setattr(workers, "measured", noted)
    results = InProcess().results(M, ((k, k + 1) for k in range(10_000)))
    next(results)
    results.close()
    assert 1 <= len(done) < 100


def test_where_hardly_a_packing_can_be_built_one_is_named() -> None:
    wild = case("profile", kind="normal", relative_std="=0.4")
    with pytest.raises(RealisationError, match=r"60 of 60 .* realisation 0: bead \("):
        run.run(wild, 60, InProcess())


def test_a_store_remembers_what_could_not_be_built(tmp_path: Path) -> None:
    wild = case("profile", kind="normal", relative_std="=0.16")
    whole = run.run(wild, 60, InProcess()).estimates.sums
    path = tmp_path / "ensemble.fd"
    for size in (20, 60):
        found = on_file(path, wild, size, InProcess())
    assert found.solved == 40
    assert found.estimates.sums.to_bytes() == whole.to_bytes()


@pytest.mark.parametrize("name", CASES)
def test_every_quantity_can_be_kept(name: str, tmp_path: Path) -> None:
    m = case(name, covariance=True)
    path = tmp_path / "ensemble.fd"
    on_file(path, m, 5, InProcess())
    assert bytes_of(on_file(path, m, 9, InProcess())) == measured(m, range(9)).to_bytes()


def test_a_block_is_written_once() -> None:
    class Counted(Store):
        def __init__(self) -> None:
            self.first: list[int] = []

        def put(self, block: Block, merged: Any = ()) -> None:
            self.first.append(block.first)

    one = run._Run(M, 150, None, None, 0.9, lambda done, width: None)
    counted = Counted()
    one.store = counted
    one.finish(InProcess())
    assert counted.first == [0, 32, 48, 64, 96, 128]
