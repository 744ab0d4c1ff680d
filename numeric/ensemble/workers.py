"""Who solves blocks: this thread, threads or processes of this machine, or a Dask cluster."""

import logging
import os
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from contextlib import AbstractContextManager, ExitStack, contextmanager
from dataclasses import dataclass
from itertools import islice
from multiprocessing import active_children, get_context
from typing import Any

from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError
from ..arithmetic.machine import memory_limit, share_cores, take_one_core
from ..arithmetic.processes import end_with_parent, without_interrupts
from ..scene.scene import program_version
from .measure import Measurement
from .sums import Block, from_bytes, measured

# Pools in a row that may die without finishing anything.
PATIENCE = 3
# Seconds between looks at whether any process is left.
LOOK = 10
# Seconds until a scheduler has to answer, and until a worker of it has to be there.
TO_ANSWER, TO_BE_THERE = 10, 30


class WorkersError(ForceDiffusionError, RuntimeError):
    """Those who should solve are missing or die; the message says what to do."""

    exit_status = NOT_REACHED


def solve_block(m: Measurement, first: int, stop: int) -> tuple[str, bytes]:
    """Sum up a block; say which version of the program did."""
    (block,) = measured(m, first, stop)
    return program_version(), block.sums.to_bytes()


def _on_one_core(m: Measurement, first: int, stop: int) -> tuple[str, bytes]:
    share_cores(sys.maxsize)  # a thread of a worker is one
    return solve_block(m, first, stop)


@dataclass(frozen=True)
class Pool:
    """An executor, how many blocks it is given at a time, and whether any of its workers lives."""

    executor: Executor
    ahead: Callable[[], int]
    alive: Callable[[], bool] = lambda: True
    solve: Callable[[Measurement, int, int], tuple[str, bytes]] = solve_block


Workers = Callable[[], AbstractContextManager[Pool]]
"""Opens a pool; anew, where the last one died."""


def solved(m: Measurement, tasks: Iterator[tuple[int, int]], workers: Workers) -> Iterator[Block]:
    """Give the block of every task, as they come. Raises ``WorkersError``.

    What workers were at that died is done again.
    """
    again: list[tuple[int, int]] = []
    deaths = 0
    while deaths < PATIENCE:
        pending: dict[Future[tuple[str, bytes]], tuple[int, int]] = {}
        try:
            with workers() as pool:
                while True:
                    while len(pending) < pool.ahead() and (
                        again := again or list(islice(tasks, 1))
                    ):
                        pending[pool.executor.submit(pool.solve, m, *again[-1])] = again[-1]
                        again.pop()  # only now: it must not be lost where no process starts
                    if not pending:
                        return
                    done, _ = wait(pending, LOOK, return_when=FIRST_COMPLETED)
                    if not done and not pool.alive():
                        raise BrokenExecutor  # they died with those who would have said so
                    for future in done:
                        version, content = future.result()
                        if version != program_version():
                            raise WorkersError(
                                f"a worker has force-diffusion {version}, and this is "
                                f"{program_version()}: numbers could differ; install the same "
                                "version everywhere"
                            )
                        deaths = 0
                        yield Block(*pending.pop(future), from_bytes(content, m))
        except BrokenExecutor:
            deaths += 1
            again += pending.values()
    raise WorkersError(
        f"worker processes died {PATIENCE} times in a row, perhaps for want of memory: use fewer "
        "workers"
    )


class _Here(Executor):
    def submit(self, function: Callable[..., Any], /, *given: Any, **more: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(function(*given, **more))
        return future


@contextmanager
def here() -> Iterator[Pool]:
    """Solve in this thread, one block after the other."""
    yield Pool(_Here(), lambda: 1)


@contextmanager
def threads(count: int) -> Iterator[Pool]:
    """Solve by compiled loops, a thread a core."""
    with ThreadPoolExecutor(count, initializer=take_one_core) as pool:
        try:
            yield Pool(pool, lambda: count + 1)
        finally:
            pool.shutdown(cancel_futures=True)


class _Processes(ProcessPoolExecutor):
    def submit(self, function: Callable[..., Any], /, *given: Any, **more: Any) -> Future[Any]:
        try:
            with without_interrupts():  # the first ones start the processes
                return super().submit(function, *given, **more)
        except (OSError, RuntimeError) as error:  # no process, or no thread to look after it
            raise BrokenExecutor(str(error)) from None


def _start(count: int, memory: int) -> None:
    if memory_limit() < memory:
        os._exit(1)  # as if killed for it: a library that gets none may wait for ever
    share_cores(count)
    end_with_parent()


@contextmanager
def processes(count: int, memory: int) -> Iterator[Pool]:
    """Solve in processes of this machine, each of which needs so many bytes."""
    others = active_children()
    with without_interrupts():
        pool = _Processes(count, get_context("spawn"), _start, (count, memory))
    try:
        yield Pool(pool, lambda: 2 * count, lambda: set(active_children()) > set(others))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for child in set(active_children()).difference(others):
            child.terminate()  # nobody waits for what it is still at


@contextmanager
def cluster(address: str | None, count: int) -> Iterator[Pool]:
    """Solve on the workers of the Dask scheduler at ``address``; None makes ``count`` here.

    The scheduler gives the work of a worker that died to another one.
    """
    import distributed as untyped

    distributed: Any = untyped  # it has no types
    with ExitStack() as open_things:
        client = open_things.enter_context(_client(distributed, address, count, open_things))

        def ahead() -> int:
            return int(2 * max(sum(client.nthreads().values()), 1))

        try:
            yield Pool(client.get_executor(pure=False), ahead, solve=_on_one_core)
        except distributed.KilledWorker:
            raise WorkersError(
                "several workers of the cluster died at the same block, perhaps for want of "
                "memory: give them more"
            ) from None
        except CancelledError as error:
            raise WorkersError(f"the cluster gave the work up: {error}") from None


def _client(distributed: Any, address: str | None, count: int, open_things: ExitStack) -> Any:
    if address is None:
        with without_interrupts():  # its threads start the workers
            made = distributed.LocalCluster(
                n_workers=count,
                threads_per_worker=1,
                dashboard_address=":0",
                silence_logs=logging.ERROR,
            )
        return distributed.Client(open_things.enter_context(made))
    try:
        client = distributed.Client(address, timeout=TO_ANSWER)
    except (OSError, ValueError) as error:
        raise WorkersError(
            f"no scheduler answers at {address} ({error}): give the address that "
            "'dask scheduler' prints, such as tcp://127.0.0.1:8786"
        ) from None
    try:
        client.wait_for_workers(1, timeout=TO_BE_THERE)
    except TimeoutError:
        client.close()
        raise WorkersError(
            f"the scheduler at {address} has no workers: start some with 'dask worker {address}'"
        ) from None
    return client
