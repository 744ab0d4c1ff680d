"""The same blocks on a Dask cluster: one that runs somewhere, or one made on this machine."""

import logging
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass
from typing import Any

import distributed as untyped

from ..arithmetic.machine import share_cores
from ..arithmetic.processes import without_interrupts
from ..scene.source import program_version
from .measure import Measurement
from .sums import AnySums, from_bytes
from .workers import WorkersError, solve_block

distributed: Any = untyped  # it has no types
# Seconds until a scheduler has to answer, and until a worker has to be there.
TO_ANSWER, PATIENCE = 10, 30


def _block(m: Measurement, first: int, stop: int) -> tuple[str, bytes]:
    share_cores(sys.maxsize)  # a thread of a worker is one core
    return program_version(), solve_block(m, first, stop)


@dataclass(frozen=True)
class Cluster:
    """Solve blocks on the workers of the scheduler at ``address``; None makes ``workers`` here.

    The scheduler gives the work of a worker that died to another one; a block counts once, when it
    comes back whole.
    """

    address: str | None
    workers: int = 1

    def results(
        self, m: Measurement, tasks: Iterator[tuple[int, int]]
    ) -> Iterator[tuple[int, int, AnySums]]:
        """Give (first, stop, sums) of every task, as they come. Raises ``WorkersError``."""
        with ExitStack() as open_things:
            client = self._client(open_things)
            pending: dict[Any, tuple[int, int]] = {}
            completed = distributed.as_completed()
            while True:
                room = 2 * max(sum(client.nthreads().values()), 1) - len(pending)
                for _ in range(room):
                    task = next(tasks, None)
                    if task is None:
                        break
                    future = client.submit(_block, m, *task, pure=False)
                    pending[future] = task
                    completed.add(future)
                if not pending:
                    return
                future = next(completed)
                try:
                    version, content = future.result()
                except distributed.KilledWorker:
                    raise WorkersError(
                        "several workers of the cluster died at the same block, perhaps for want "
                        "of memory: give them more"
                    ) from None
                except distributed.client.FutureCancelledError as error:
                    raise WorkersError(f"the cluster gave the work up: {error}") from None
                if version != program_version():
                    raise WorkersError(
                        f"a worker has force-diffusion {version}, and this is {program_version()}: "
                        "numbers could differ; install the same version everywhere"
                    )
                first, stop = pending.pop(future)
                yield first, stop, from_bytes(content, m)

    def _client(self, open_things: ExitStack) -> Any:
        if self.address is None:
            with without_interrupts():  # its threads start the workers
                made = distributed.LocalCluster(
                    n_workers=self.workers,
                    threads_per_worker=1,
                    dashboard_address=":0",
                    silence_logs=logging.ERROR,
                )
            cluster = open_things.enter_context(made)
            return open_things.enter_context(distributed.Client(cluster))
        try:
            client = open_things.enter_context(distributed.Client(self.address, timeout=TO_ANSWER))
        except (OSError, ValueError) as error:
            raise WorkersError(
                f"no scheduler answers at {self.address} ({error}): give the address that "
                "'dask scheduler' prints, such as tcp://127.0.0.1:8786"
            ) from None
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
        except TimeoutError:
            raise WorkersError(
                f"the scheduler at {self.address} has no workers: start some with "
                f"'dask worker {self.address}'"
            ) from None
        return client
