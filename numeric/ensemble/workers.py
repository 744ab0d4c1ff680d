"""Who solves the blocks: this process, or a pool of processes on this machine."""

import os
from collections.abc import Iterator
from concurrent.futures import (
    FIRST_COMPLETED,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    wait,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from functools import reduce
from itertools import islice
from multiprocessing import active_children, get_context
from operator import add
from threading import Event
from typing import Any, cast

from ..arithmetic.errors import NOT_REACHED, ForceDiffusionError, UndecidedError
from ..arithmetic.machine import cores, memory_limit, share_cores, take_one_core
from ..arithmetic.processes import end_with_parent, without_interrupts
from ..disorder.radii import RadiusError
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..mechanics.work import Progress, Work
from ..unilateral.network import UnfinishedError
from .measure import Measurement
from .sums import AnySums, from_bytes, left_out, measured

# Pools in a row that may die without finishing anything.
PATIENCE = 3
# Seconds between looks at whether any process is left.
LOOK = 10
_TROUBLE = (UnbuildableError, NotStandingError, RadiusError, UnfinishedError, UndecidedError)


class NotStartedError(Exception):
    """The system gives no process, or no thread to look after it."""


class RealisationError(ForceDiffusionError, ValueError):
    """Hardly a realisation can be built; the message says which can't, and why."""


class UnsettledError(RealisationError):
    """Hardly a packing comes to rest, or is proved to, within what was asked."""

    exit_status = NOT_REACHED


class WorkersError(ForceDiffusionError, RuntimeError):
    """Those who should solve are missing or die; the message says what to do."""

    exit_status = NOT_REACHED


def solve_block(m: Measurement, first: int, stop: int) -> bytes:
    """Sum up realisations first … stop − 1; those that can't be built are left out and counted."""
    return _without_unbuildable(m, first, stop).to_bytes()


def _without_unbuildable(
    m: Measurement, first: int, stop: int, progress: Progress | None = None
) -> AnySums:
    """Find them by halving: sums merge exactly, however they were cut."""
    try:
        return measured(m, range(first, stop), Work(progress=progress))
    except _TROUBLE:
        if stop - first == 1:
            return left_out(m, first)
    middle = (first + stop) // 2
    parts = (first, middle), (middle, stop)
    return reduce(add, (_without_unbuildable(m, *part, progress) for part in parts))


def refuse_unbuildable(m: Measurement, sums: AnySums) -> None:
    """Raise ``RealisationError`` where no two packings are left, and say why one can't be built."""
    if sums.realisations >= 2:
        return
    first, why, kind = sums.first_unbuildable, "", RealisationError
    try:
        measured(m, [first])
    except _TROUBLE as error:
        why = str(error)
        kind = UnsettledError if isinstance(error, UnfinishedError | UndecidedError) else kind
    raise kind(
        f"{sums.unbuildable} of {sums.tried} packings are left out, and statistics need two: "
        f"realisation {first}: {why}"
    )


class _StoppedError(Exception):
    """Nobody waits for a thread's block any more."""


class InProcess:
    """Solve blocks here: compiled ones on all cores, a block a core, others one after the other."""

    def results(
        self, m: Measurement, tasks: Iterator[tuple[int, int]]
    ) -> Iterator[tuple[int, int, AnySums]]:
        """Give (first, stop, sums) of every task, as they come."""
        room = memory_limit() // max(m.plan.memory, 1)
        threads = min(cores(), max(room, 1)) if m.compiled else 1
        if threads == 1:
            for first, stop in tasks:
                yield first, stop, _without_unbuildable(m, first, stop)
            return
        stopped = Event()

        def go_on(kind: str, beads: int) -> None:
            if stopped.is_set():
                raise _StoppedError

        def block(first: int, stop: int) -> tuple[int, int, AnySums]:
            return first, stop, _without_unbuildable(m, first, stop, go_on)

        pool = ThreadPoolExecutor(threads, initializer=take_one_core)
        with _one_core_for_matrices():
            try:
                pending: set[Future[tuple[int, int, AnySums]]] = set()
                while True:
                    more = islice(tasks, threads + 1 - len(pending))
                    pending |= {pool.submit(block, *task) for task in more}
                    if not pending:
                        return
                    done, pending = wait(pending, return_when=FIRST_COMPLETED)
                    for future in done:
                        yield future.result()
            finally:
                stopped.set()
                pool.shutdown(cancel_futures=True)


def _one_core_for_matrices() -> AbstractContextManager[Any]:
    """Let each thread multiply matrices on its own core; BLAS takes all cores for each."""
    try:
        from threadpoolctl import threadpool_limits
    except ImportError:  # numba alone, without the rest of the extra "fast": slower, no more
        return nullcontext()
    return cast(AbstractContextManager[Any], threadpool_limits(1, user_api="blas"))


_here: list[Measurement] = []  # what this process measures, if it is a worker


def _start(m: Measurement, workers: int) -> None:
    if memory_limit() < m.plan.memory:
        os._exit(1)  # as if killed for it: a library that gets none may wait for ever
    _here.append(m)
    share_cores(workers)
    end_with_parent()


def _block(first: int, stop: int) -> bytes:
    return solve_block(_here[0], first, stop)


def _submitted(pool: ProcessPoolExecutor, task: tuple[int, int]) -> Future[bytes]:
    """Hand a block in; the first ones start the processes."""
    try:
        with without_interrupts():
            return pool.submit(_block, *task)
    except BrokenProcessPool:
        raise
    except (OSError, RuntimeError) as error:
        raise NotStartedError(str(error)) from None


@dataclass(frozen=True)
class Pool:
    """Solve blocks in processes of this machine; one that dies is replaced, its work done again."""

    workers: int

    def results(
        self, m: Measurement, tasks: Iterator[tuple[int, int]]
    ) -> Iterator[tuple[int, int, AnySums]]:
        """Give (first, stop, sums) of every task, as they come. Raises ``WorkersError``."""
        again: list[tuple[int, int]] = []
        deaths = 0
        while True:
            others = active_children()
            with without_interrupts():
                pool = ProcessPoolExecutor(
                    self.workers,
                    get_context("spawn"),
                    initializer=_start,
                    initargs=(m, self.workers),
                )
            pending: dict[tuple[int, int], Future[bytes]] = {}
            try:
                while True:
                    while len(pending) < 2 * self.workers:
                        task = again[-1] if again else next(tasks, None)
                        if task is None:
                            break
                        if not again:
                            again.append(task)  # it must not be lost where no process starts
                        pending[task] = _submitted(pool, task)
                        again.pop()
                    if not pending:
                        return
                    done, _ = wait(pending.values(), LOOK, return_when=FIRST_COMPLETED)
                    if not done and not set(active_children()).difference(others):
                        raise BrokenProcessPool  # it died with those who would have said so
                    for task in [t for t, future in pending.items() if future.done()]:
                        content = pending[task].result()
                        del pending[task]
                        deaths = 0
                        yield *task, from_bytes(content, m)
            except (BrokenProcessPool, NotStartedError):
                deaths += 1
                if deaths == PATIENCE:
                    raise WorkersError(
                        f"worker processes died {PATIENCE} times in a row, perhaps for want of "
                        "memory: use fewer workers"
                    ) from None
                again += pending
            finally:
                pool.shutdown(wait=False, cancel_futures=True)
                for child in set(active_children()).difference(others):
                    child.terminate()  # nobody waits for what it is still at
