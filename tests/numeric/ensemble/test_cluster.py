"""The same ensemble on a real local Dask scheduler, one of whose two workers is killed."""

import os
import signal
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.derivations.commands import ensemble as command
from force_diffusion.numeric.ensemble import ensemble as module
from force_diffusion.numeric.ensemble import sums
from force_diffusion.numeric.ensemble.ensemble import WorkersError

import force_diffusion as fd
from tests.numeric.ensemble.cases import PROFILE, bytes_of_first, case
from tests.numeric.scenes import scene, toml

# a second to load, which collecting tests should not take
pytestmark = [
    pytest.mark.skipif(find_spec("distributed") is None, reason="without Dask"),
    pytest.mark.long,
]

M = case("profile")


@pytest.fixture(scope="module")
def local() -> Iterator[Any]:
    import distributed

    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0"
    ) as made:
        yield made


@pytest.fixture
def client(local: Any) -> Iterator[Any]:
    import distributed

    with distributed.Client(local.scheduler_address) as client:
        yield client


def test_a_worker_is_killed_in_the_middle(client, monkeypatch):
    monkeypatch.setattr(sums, "BEADS", 4 * M.problem.region.beads)
    pids = list(client.run(os.getpid).values())
    assert len(set(pids) - {os.getpid()}) == 2
    done: list[int] = []

    def kill_one(realisations: int, width: float | None) -> None:
        done.append(realisations)
        if realisations > 100 and pids:
            os.kill(pids.pop(), signal.SIGKILL)
            pids.clear()

    executor = client.get_executor(pure=False)
    ensemble = fd.ensemble(scene(PROFILE), 300, executor=executor, progress=kill_one)
    assert not pids
    assert done[-1] == 300
    assert ensemble.realisations == ensemble.solved == 300  # none twice
    assert ensemble.sums.to_bytes() == bytes_of_first(M, 300)


def test_another_version_on_a_worker_is_refused(client, monkeypatch):
    monkeypatch.setattr(module, "__version__", "9.9")
    with pytest.raises(WorkersError, match="install the same version"):
        fd.ensemble(scene(PROFILE), 40, executor=client.get_executor(pure=False))


@pytest.fixture
def forty(tmp_path: Path) -> list[Any]:
    """The words of the command."""
    path = tmp_path / "scene.toml"
    path.write_text(toml(PROFILE))
    return ["ensemble", path, "--realisations", 40, "--json"]


def test_the_command_gives_the_same(local, forty, call):
    assert call(*forty, "--scheduler", local.scheduler_address)[:2] == call(*forty)[:2]


def test_a_scheduler_that_is_missing_or_has_no_workers(forty, monkeypatch, refused):
    import distributed

    monkeypatch.setattr(command, "PATIENCE", 1)
    with distributed.LocalCluster(n_workers=0, processes=True, dashboard_address=":0") as empty:
        for address, says in (
            ("tcp://127.0.0.1:9", "no Dask scheduler answers"),
            ("nonsense://x", "no Dask scheduler answers"),
            (empty.scheduler_address, "give the cluster workers"),
        ):
            assert says in refused(*forty, "--scheduler", address, status=3)
