"""Who solves an ensemble, what the user sees meanwhile, and what is said where it fails."""

import sys
from collections.abc import Callable
from contextlib import ExitStack
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING

from force_diffusion.derivations.commands.guard import in_range, tell
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError, NotReachedError

if TYPE_CHECKING:
    from force_diffusion.numeric.ensemble.measure import Measurement
    from force_diffusion.numeric.ensemble.run import Executor, Result
    from force_diffusion.numeric.ensemble.store import Store

# Bytes of a batch of small packings, on top of those of one.
BATCH = 100_000_000
# Seconds of work from which on starting more processes repays.
WORTH_WORKERS = 5


class Where(StrEnum):
    """Where a cluster is made."""

    LOCAL = "local"


def executor_for(
    m: "Measurement",
    size: int,
    workers: int | None,
    scheduler: str | None,
    cluster: Where | None,
) -> "Executor":
    """Choose who solves."""
    from force_diffusion.numeric.arithmetic.machine import cores, memory_limit
    from force_diffusion.numeric.ensemble.workers import InProcess, Pool

    if scheduler is not None and (cluster is not None or workers is not None):
        other = "--workers" if cluster is None else "--cluster"
        raise ForceDiffusionError(f"--scheduler and {other} exclude each other: leave one out")
    room = max(1, memory_limit() // (m.plan.memory + BATCH))
    if scheduler is None:
        if workers is not None and workers > room:
            raise ForceDiffusionError(
                f"--workers = {workers}: the free memory is enough for {room}"
            )
        if workers is None:
            short = cluster is None and size * m.plan.estimated_seconds < WORTH_WORKERS
            workers = 1 if short else min(cores(), room)
        if cluster is None:
            return InProcess() if workers == 1 else Pool(workers)
    try:
        from force_diffusion.numeric.ensemble.cluster import Cluster
    except ImportError:
        raise ForceDiffusionError(
            "a cluster needs Dask, which is missing: pip install 'force-diffusion[cluster]'"
        ) from None
    return Cluster(scheduler, workers or 1)


def run_shown(
    name: str,
    m: "Measurement",
    size: int,
    executor: "Executor",
    path: Path | None,
    until: float | None,
    confidence: float,
) -> "Result":
    """Run under a progress bar; an error says what the store holds."""
    from force_diffusion.numeric.ensemble.run import run
    from force_diffusion.numeric.ensemble.scene_key import ensemble_key
    from force_diffusion.numeric.ensemble.store import StoreError, open_store
    from force_diffusion.numeric.ensemble.workers import WorkersError
    from force_diffusion.numeric.statistics.confidence import Rule

    rule = None if until is None else Rule(until, confidence)
    store = None
    try:
        if path is not None:
            store = open_store(path, ensemble_key(m))
        with ExitStack() as stack:
            progress = _progress(stack, size, until)
            with in_range():
                return run(
                    m, size, executor,
                    store=store, rule=rule, confidence=confidence, progress=progress,
                )  # fmt: skip
    except StoreError as error:
        raise StoreError(f"--store {error}") from None
    except WorkersError as error:
        raise WorkersError(f"{error}.{_kept(store)}") from None
    except ForceDiffusionError as error:
        error.add_note(name)
        raise
    except OSError as error:
        if path is None or error.filename != str(path):
            raise
        raise NotReachedError(
            f"--store {path} can't be written to ({error.strerror}): make room, or move it to "
            f"another place.{_kept(store)}"
        ) from None
    except MemoryError:
        raise NotReachedError(
            f"{name}: the memory is full; use fewer workers.{_kept(store)}"
        ) from None
    except KeyboardInterrupt:
        kept = _kept(store)
        if path is None:
            kept = " nothing was kept; with --store FILE it would have been."
        if kept:
            tell(kept.strip())
        raise
    finally:
        if store is not None:
            store.close()


def _kept(store: "Store | None") -> str:
    if store is None:
        return ""
    done = sum(stop - first for first, stop in store.ranges())
    return f" {store.path} holds {done} realisations; the same command goes on from there."


def _progress(
    stack: ExitStack, size: int, until: float | None
) -> Callable[[int, float | None], None]:
    """A bar with the time left, on a terminal."""
    if not sys.stderr.isatty():
        return lambda done, width: None
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
    from rich.progress import TimeElapsedColumn as Elapsed
    from rich.progress import TimeRemainingColumn as Left

    columns = (
        TextColumn("realisations"), BarColumn(), MofNCompleteColumn(),
        Elapsed(), TextColumn("left"), Left(), TextColumn("{task.description}"),
    )  # fmt: skip
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    task = None

    def progress(done: int, width: float | None) -> None:
        nonlocal task
        if task is None:  # what a store held took no time now
            task = bar.add_task("", total=size, completed=done)
            stack.enter_context(bar)
        bar.update(task, completed=done)
        if width is not None and until is not None:
            bar.update(task, description=f"σ_f to {width:.2g}, until {until:g}")

    return progress
