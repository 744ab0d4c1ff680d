"""A scene becomes an ensemble: blocks that are missing are solved, kept, and joined in order."""

import math
import os
import signal
import threading
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent import futures
from concurrent.futures import Executor
from contextlib import AbstractContextManager, closing, contextmanager, nullcontext
from dataclasses import replace
from itertools import islice
from multiprocessing import connection, get_context, parent_process
from numbers import Real
from pathlib import Path

from force_diffusion import __version__

from ..arithmetic.errors import (
    ArgumentError,
    ForceDiffusionError,
    NotReachedError,
    WrongTypeError,
    check_progress,
    checked,
    is_whole,
    quoted,
)
from ..arithmetic.machine import cores, memory_limit
from ..arithmetic.systems import FLOAT64
from ..mechanics import engine
from ..mechanics.work import bar
from ..scene.reading import read_scene
from ..scene.scene import CheckedScene
from ..scene.sections import MOST_REALISATIONS, SceneError
from ..statistics.confidence import looks
from .result import Ensemble
from .store import Store, StoreFailedError, description
from .sums import Block, Measurement, Sums, measurement, solve_block, summed, why_left_out

MOST_WORKERS = 1024
# Blocks that an executor is given at a time.
AHEAD = 256
# Bytes of a block of small packings, on top of those of one packing.
BATCH = 200_000_000
# Visits to beads from which on starting processes repays (some seconds), where each packing takes
# as long as so many visits by itself.
WORTH_PROCESSES, OF_PACKING = 20_000_000, 1000

Progress = Callable[[int, float | None], None]
"""Takes how many packings are done, and the half-width at the last look."""


class RealisationError(ForceDiffusionError, ValueError):
    """Hardly any packing can be built; the message names one that can't, and says why."""


class WorkersError(NotReachedError, RuntimeError):
    """Workers are missing or have died; the message says what to do."""


@checked
def ensemble(
    scene: CheckedScene | str | Path,
    realisations: int | None = None,
    *,
    until: float | None = None,
    store: str | Path | None = None,
    confidence: float = 0.95,
    workers: int | None = 1,
    executor: Executor | None = None,
    reach: float | None = None,
    progress: bool | Progress = False,
) -> Ensemble:
    """Solve many packings of a scene, given itself or by its path, and gather statistics.

    The scene asks for a ``profile``, ``contact``, ``contact_forces``, ``response`` or
    ``histogram``, and its radii are drawn. ``realisations`` is the number of packings, by default
    that of the scene; with ``until``, the run stops earlier if every σ_f is known to this relative
    error, all together with confidence ``confidence``. ``store`` is a file in which finished blocks
    are saved, and from which a run continues. Results don't depend on ``workers``: threads
    if loops are compiled (the extra ``fast``), otherwise processes, for which a script needs its
    ``if __name__ == "__main__"``; None chooses their number. Any ``executor`` of
    ``concurrent.futures`` may be used instead, such as that of a Dask cluster,
    ``distributed.Client(address).get_executor()``. ``reach`` is the outer edge of a histogram's
    bins, in units of force; by default six times the largest σ_f of theory. ``progress=True`` shows
    a bar; a function is called with the number of packings done and the half-width at the last
    look.

    Raises ``WrongTypeError`` for what is not a scene, ``ArgumentError``, ``SceneError``,
    ``StoreError`` for a file that is not the store of this ensemble, ``StoreFailedError`` if it
    can't be written, ``RealisationError`` if hardly any packing can be built, and ``WorkersError``.
    Blocks in the store stay valid.

    >>> import force_diffusion as fd
    >>> scene = fd.Scene(
    ...     packing=fd.Packing(height=4, width=8),
    ...     disorder=fd.Disorder(kind="uniform", relative_std=1e-4, seed=1),
    ...     ask=fd.Ask(quantity="profile"),
    ... )
    >>> found = fd.ensemble(scene, 200, until=0.1)
    >>> found.std.shape, found.realisations, found.reached
    ((8,), 192, True)
    >>> bool((abs(found.std / found.first_order_std - 1) < found.half_width).all())
    True
    """
    check_progress(progress)
    if isinstance(scene, str | Path):
        scene = read_scene(Path(scene), CheckedScene)
    if not isinstance(scene, CheckedScene):
        raise WrongTypeError(f"ensemble takes a scene or its path, not {type(scene).__name__}")
    if not isinstance(executor, Executor | None):
        raise WrongTypeError(f"executor = {quoted(executor)}: must be one of concurrent.futures")
    until = None if until is None else _number("until", until)
    confidence = _number("confidence", confidence)
    if store is not None and not isinstance(store, str | Path):
        raise ArgumentError(f"store = {quoted(store)}: must be the name of a file")
    m = measurement(scene, reach=None if reach is None else _number("reach", reach, 1e300))
    size = _size(scene, realisations)
    solving: AbstractContextManager[Executor] = (
        _executor(m, size, workers) if executor is None else nullcontext(executor)
    )
    opened = None if store is None else Store(Path(store), description(m))
    followed = _bar(size, until) if progress is True else nullcontext(progress or (lambda *_: None))
    try:
        with closing(opened) if opened else nullcontext(), solving as solver, followed as follow:
            return _joined(m, size, solver, opened, until, confidence, follow)
    except (futures.BrokenExecutor, futures.CancelledError, MemoryError) as error:
        raise WorkersError(
            f"a worker died, perhaps because memory ran out ({error}): use fewer.{_kept(opened)}"
        ) from None
    except (WorkersError, StoreFailedError) as error:
        raise type(error)(f"{error}.{_kept(opened)}") from None
    except KeyboardInterrupt as interrupt:
        if opened is not None:
            interrupt.add_note(_kept(opened).strip())
        raise


@contextmanager
def _bar(size: int, until: float | None) -> Iterator[Progress]:
    """Show a bar of the realisations that are done, and how well σ_f is known by then."""
    with bar("realisations", size) as update:

        def progress(done: int, width: float | None) -> None:
            known = width is not None and until is not None
            words = f", σ_f to {width:.2g}, until {until:g}" if known else ""
            update(completed=done, description=f"{done} of {size} realisations{words}")

        yield progress


def _joined(
    m: Measurement,
    size: int,
    executor: Executor,
    store: Store | None,
    until: float | None,
    confidence: float,
    progress: Progress,
) -> Ensemble:
    """Sum up realisations 0 … size − 1, or up to a look at which all is known well enough."""
    blocks, held = list(m.blocks(size)), set() if store is None else store.held.copy()
    at_looks = set() if until is None else {*looks(size), size}
    statistics, width = Ensemble(m, summed(m, []), confidence, until), None
    missing = (block for block in blocks if block not in held)
    with closing(solved_blocks(m, missing, executor)) as arriving:
        for first, stop in blocks:
            if store is not None and (first, stop) in held:
                own = store.read((first, stop), m)
            else:
                own = next(arriving)
                if store is not None and own.packings:  # of a wrong scene nothing is kept
                    store.put((first, stop), own)
                statistics = replace(statistics, solved=statistics.solved + stop - first)
                progress(stop, width)
            statistics = replace(statistics, sums=statistics.sums + own)
            if stop in at_looks:
                statistics = replace(statistics, looks=statistics.looks + 1)
                width = statistics.half_width
                progress(stop, width)
                if statistics.reached:
                    break
    if statistics.realisations < 2:
        number = statistics.sums.first_left_out
        raise RealisationError(
            f"{statistics.unbuildable} of {size} packings are left out, and statistics need two: "
            f"realisation {number}: {why_left_out(m, number)}; choose a smaller scatter"
        )
    return statistics


def solved_blocks(
    m: Measurement, blocks: Iterable[Block], executor: Executor
) -> Generator[Sums, None, None]:
    """Give the sums of blocks in their order; some are solved ahead."""
    todo, pending = iter(blocks), deque[futures.Future[Sums]]()
    try:
        while True:
            for block in islice(todo, AHEAD - len(pending)):
                with without_interrupts():  # the first ones may start processes
                    pending.append(executor.submit(_solve, __version__, m, *block))
            if not pending:
                return
            yield pending.popleft().result()
    finally:
        for future in pending:
            future.cancel()


def _solve(version: str, m: Measurement, first: int, stop: int) -> Sums:
    if version != __version__:
        raise WorkersError(
            f"a worker has force-diffusion {__version__}, and this is {version}: numbers "
            "could differ; install the same version everywhere"
        )
    return solve_block(m, first, stop)


def _executor(m: Measurement, size: int, workers: int | None) -> Executor:
    """Give threads where loops are compiled, and else processes."""
    if workers is not None and not is_whole(workers, 1, MOST_WORKERS):
        allowed = f"must be a whole number between 1 and {MOST_WORKERS}"
        raise ArgumentError(f"workers = {quoted(workers)}: {allowed}")
    room = max(1, memory_limit() // (m.plan.memory + BATCH))
    compiled = engine.compiles(replace(m.problem, realisations=size), FLOAT64)
    if workers is None:
        short = size * (m.problem.region.beads + OF_PACKING) < WORTH_PROCESSES
        workers = 1 if short and not compiled else min(cores(), room)
    elif workers > room:
        raise ArgumentError(f"workers = {quoted(workers)}: the free memory is enough for {room}")
    if compiled or workers == 1:
        return futures.ThreadPoolExecutor(workers)
    return futures.ProcessPoolExecutor(workers, get_context("spawn"), end_with_parent)


@contextmanager
def without_interrupts() -> Iterator[None]:
    """Let signals of a terminal wait; they come to us afterwards.

    None of these signals reaches processes that are started meanwhile: those that load their
    modules could only end with a traceback, and the one that keeps account of all others must see
    their end.
    """
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGHUP})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def end_with_parent() -> None:
    """Leave interrupts to the parent, and end with it, however it ends; a pool does not see it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # held back until now
    threading.Thread(target=_follow_parent, daemon=True).start()


def _follow_parent() -> None:
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


def _size(scene: CheckedScene, realisations: object) -> int:
    size = scene.ask.realisations if realisations is None else realisations
    if is_whole(size, 2, MOST_REALISATIONS):
        return int(size)
    allowed = f"must be a whole number from 2 to {MOST_REALISATIONS} for an ensemble"
    if realisations is None:
        raise SceneError("ask.realisations", size, allowed)
    raise ArgumentError(f"realisations = {quoted(size)}: {allowed}")


def _number(name: str, value: object, below: float = 1) -> float:
    try:
        number = float(value) if isinstance(value, Real) else math.nan
    except OverflowError:
        number = math.inf
    if not 0 < number < below:
        allowed = f"must be greater than 0 and less than {below:g}"
        raise ArgumentError(f"{name} = {quoted(value)}: {allowed}")
    return number


def _kept(store: Store | None) -> str:
    if store is None:
        return ""
    held = f"{store.path} holds {store.realisations} realisations"
    return f" {held}; the same command goes on from there."
