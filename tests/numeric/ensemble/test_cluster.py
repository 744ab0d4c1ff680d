"""The same ensemble on a real local Dask scheduler, one of whose two workers is killed."""

import os
import signal
from collections.abc import Iterator
from functools import partial
from typing import Any

import pytest
from force_diffusion.numeric.ensemble import run, workers
from force_diffusion.numeric.ensemble.run import RealisationError
from force_diffusion.numeric.ensemble.workers import WorkersError, cluster

from tests.numeric.ensemble.cases import bytes_of_first, case

distributed = pytest.importorskip("distributed")

M = case("profile")
WHOLE = bytes_of_first(M, 300)


@pytest.fixture(scope="module")
def local() -> Iterator[Any]:
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as made:
        yield made


def test_a_worker_is_killed_in_the_middle(local: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run, "BLOCK", 5 * M.plan.problem.region.beads)
    address = local.scheduler_address
    with distributed.Client(address) as client:
        pids = list(client.run(os.getpid).values())
    assert len(set(pids) - {os.getpid()}) == 2
    done: list[int] = []

    def kill_one(realisations: int, width: float | None) -> None:
        done.append(realisations)
        if realisations > 100 and pids:
            os.kill(pids.pop(), signal.SIGKILL)
            pids.clear()

    found = run.run(M, 300, partial(cluster, address, 1), progress=kill_one)
    assert not pids
    assert done[-1] == 300
    assert found.realisations == found.solved == 300  # none twice
    assert found.sums.to_bytes() == WHOLE


def test_what_a_worker_finds_wrong_is_told(local: Any) -> None:
    wild = case("profile", kind="normal", relative_std="=0.4")
    with pytest.raises(RealisationError, match=r"realisation \d+: bead \("):
        run.run(wild, 60, partial(cluster, local.scheduler_address, 1))


def test_another_version_on_a_worker_is_refused(
    local: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(workers, "program_version", lambda: "9.9")
    with pytest.raises(WorkersError, match="install the same version"):
        run.run(M, 40, partial(cluster, local.scheduler_address, 1))


def test_a_scheduler_that_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "TO_ANSWER", 1)
    for address in ("tcp://127.0.0.1:9", "nonsense://x"):
        with pytest.raises(WorkersError, match="no scheduler answers"):
            run.run(M, 40, partial(cluster, address, 1))


@pytest.mark.long
def test_a_scheduler_without_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "TO_BE_THERE", 1)
    with (
        distributed.LocalCluster(n_workers=0, processes=True, dashboard_address=":0") as empty,
        pytest.raises(WorkersError, match="no workers"),
    ):
        run.run(M, 40, partial(cluster, empty.scheduler_address, 1))
