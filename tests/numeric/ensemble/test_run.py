"""An ensemble is the same to the bit for any executor, order and interruption."""

import os
import random
import signal
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import suppress
from multiprocessing import active_children
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.ensemble import ensemble as module
from force_diffusion.numeric.ensemble import sums
from force_diffusion.numeric.ensemble.ensemble import WorkersError
from force_diffusion.numeric.ensemble.result import Ensemble
from force_diffusion.numeric.ensemble.store import read_store
from force_diffusion.numeric.ensemble.sums import solve_block, why_left_out
from hypothesis import given, settings
from hypothesis import strategies as st

import force_diffusion as fd
from tests.numeric.ensemble.cases import PROFILE, bytes_of_first, case
from tests.numeric.scenes import scene

SCENE = scene(PROFILE)
M = case("profile")
WILD = {**PROFILE, "disorder": {"kind": "normal", "relative_std": "=0.16", "seed": 5}}
BEADS = M.problem.region.beads


class Shuffled(ThreadPoolExecutor):
    """Threads that finish blocks in any order, and may fail."""

    def __init__(self, seed: int, *, failing: bool = False) -> None:
        super().__init__(4)
        self.drawn, self.failing = random.Random(seed), failing

    def submit(self, function: Callable[..., Any], /, *given: Any, **more: Any) -> Future[Any]:
        return super().submit(self.run, function, *given, **more)

    def run(self, function: Callable[..., Any], *given: Any, **more: Any) -> Any:
        time.sleep(self.drawn.random() / 300)
        if self.failing and self.drawn.random() < 0.2:
            raise WorkersError("they are gone")
        return function(*given, **more)


class Nobody(Executor):
    """An executor that must not get any work."""

    def submit(self, function: Any, /, *given: Any, **more: Any) -> Future[Any]:
        raise AssertionError(given)


def bytes_of(result: Ensemble) -> bytes:
    return result.sums.to_bytes()


@pytest.fixture
def small_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut blocks of four packings."""
    monkeypatch.setattr(sums, "BEADS", 4 * BEADS)


@settings(max_examples=settings.default.max_examples // 6)
@given(st.integers(0, 10**6), st.integers(2, 150))
def test_a_failed_run_continues_from_its_file(tmp_path_factory, seed, before):
    path = tmp_path_factory.mktemp("store") / "ensemble.fd"
    counts = []
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setattr(sums, "BEADS", 4 * BEADS)
        fd.ensemble(SCENE, before, store=path)
        while True:
            seed += 1
            counts.append(read_store(path).realisations)
            with suppress(WorkersError), Shuffled(seed, failing=True) as executor:
                ensemble = fd.ensemble(SCENE, 150, store=path, executor=executor)
                break
        again = fd.ensemble(SCENE, 150, store=path, executor=Nobody())
        assert bytes_of(again) == bytes_of(ensemble) == bytes_of_first(M, 150)
        first_part = fd.ensemble(SCENE, before, store=path, executor=Nobody())
        assert bytes_of(first_part) == bytes_of_first(M, before)
    assert counts == sorted(counts)  # nothing finished was lost


@pytest.mark.long
@pytest.mark.usefixtures("small_blocks")
def test_a_killed_process_loses_no_stored_realisation(tmp_path, monkeypatch):
    monkeypatch.setattr(module.engine, "compiles", lambda *_, **__: False)
    others, store = active_children(), tmp_path / "ensemble.fd"

    def kill_one(done: int, width: float | None) -> None:
        if done:
            for victim in set(active_children()).difference(others):
                assert victim.pid is not None
                with suppress(ProcessLookupError):  # its pool has seen the other one die
                    os.kill(victim.pid, signal.SIGKILL)

    with pytest.raises(WorkersError, match=r"a worker died.* holds [1-9]"):
        fd.ensemble(SCENE, 4000, workers=2, store=store, progress=kill_one)
    count = read_store(store).realisations
    with module._executor(M, 150, 2) as executor:
        assert isinstance(executor, ProcessPoolExecutor)
    ensemble = fd.ensemble(SCENE, 150, workers=2, store=store)
    assert ensemble.solved == 150 - min(count, 150)
    assert bytes_of(ensemble) == bytes_of_first(M, 150)


@settings(max_examples=settings.default.max_examples // 6)
@given(st.integers(0, 10**6))
def test_where_it_stops_depends_on_nothing_but_the_sums(seed):
    with pytest.MonkeyPatch.context() as monkeypatch:
        monkeypatch.setattr(sums, "BEADS", 4 * BEADS)
        usual = fd.ensemble(SCENE, 300, until=0.12, confidence=0.9)
        with Shuffled(seed) as executor:
            ensemble = fd.ensemble(SCENE, 300, until=0.12, confidence=0.9, executor=executor)
        assert bytes_of(usual) == bytes_of_first(M, usual.realisations)
    assert usual.reached
    assert 32 < usual.realisations < 300
    assert usual.half_width <= 0.12
    assert bytes_of(ensemble) == bytes_of(usual)
    assert (ensemble.looks, ensemble.half_width) == (usual.looks, usual.half_width)


def test_a_rule_that_is_not_met():
    ensemble = fd.ensemble(SCENE, 40, until=1e-6, confidence=0.9)
    assert ensemble.reached is False
    assert ensemble.looks == 2  # at 32, and at the end
    assert ensemble.realisations == 40
    fixed = fd.ensemble(SCENE, 40, confidence=0.9)
    assert (fixed.reached, fixed.looks) == (None, 0)
    assert fixed.half_width < ensemble.half_width


def test_packings_that_can_not_be_built_are_left_out_and_counted(tmp_path):
    wild = case("profile", kind="normal", relative_std="=0.16")
    bad = [k for k in range(60) if why_left_out(wild, k)]
    assert 5 < len(bad) < 55
    store = tmp_path / "ensemble.fd"
    assert fd.ensemble(scene(WILD), 20, store=store).unbuildable == sum(k < 20 for k in bad)
    result = fd.ensemble(scene(WILD), 60, store=store)
    assert (result.realisations, result.unbuildable) == (60 - len(bad), len(bad))
    assert result.sums.first_left_out == result.data()["ensemble"]["first_unbuildable"] == bad[0]
    # single packings are solved one by one, and what is left out is not there
    good = [solve_block(wild, k, k + 1).means for k in range(60) if k not in bad]
    assert result.sums.means == pytest.approx(np.mean(good, axis=0), rel=1e-12)
    assert bytes_of(result) == bytes_of_first(wild, 60)


def test_a_pool_is_given_few_blocks_at_a_time_and_they_are_withdrawn():
    done = []

    class Counting(ThreadPoolExecutor):
        def submit(self, *given: Any, **more: Any) -> Future[Any]:
            done.append(given)
            return super().submit(*given, **more)

    with Counting(2) as executor:
        blocks = module.solved_blocks(M, ((k, k + 1) for k in range(10_000)), executor)
        next(blocks)
        blocks.close()
    assert len(done) <= 2 * module.AHEAD
