"""A scene becomes an ensemble: what is measured, who solves it, and where it is kept."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from numbers import Real
from operator import index
from pathlib import Path
from typing import SupportsIndex

from ..arithmetic.errors import ForceDiffusionError, NotReachedError
from ..arithmetic.machine import cores, memory_limit
from ..scene.scene import Scene
from ..scene.sections import SceneError
from ..statistics.confidence import Rule
from .measure import ArgumentError, Measurement, measurement
from .result import Ensemble
from .run import run
from .scene_key import ensemble_key
from .store import Store, StoreFailedError, open_store
from .workers import Workers, WorkersError, cluster, here, processes, threads

MOST, MOST_WORKERS = 10**9, 1024
# Bytes of a batch of small packings, on top of those of one.
BATCH = 200_000_000
# Visits to beads from which on starting more processes repays (some seconds), where each packing
# takes as long as so many visits by itself.
WORTH_WORKERS, OF_PACKING = 20_000_000, 1000
LOCAL = "local"


def ensemble(
    scene: Scene,
    realisations: int | None = None,
    *,
    until: float | None = None,
    store: str | Path | None = None,
    confidence: float = 0.95,
    workers: int | None = 1,
    scheduler: str | None = None,
    reach: float | None = None,
    progress: Callable[[int, float | None], None] = lambda done, width: None,
) -> Ensemble:
    """Solve many packings of a scene, and give their statistics; the same for any workers.

    The scene asks for a ``profile``, ``contact``, ``contact_forces``, ``response`` or
    ``histogram``, of drawn radii. There are ``realisations`` packings, by default as many as the
    scene says; with ``until`` fewer, if every σ_f is known to that share of itself, all together
    with confidence ``confidence``, already before. ``store`` is a file that keeps what is done, and
    goes on from there. ``workers`` are processes, None for as many as are good here (compiled
    sweeps take all cores in one); above 1 they start the program anew, so that a script needs its
    ``if __name__ == "__main__"``. ``scheduler`` is the address of a Dask scheduler, or "local" for
    a cluster made here. ``reach`` is the outer edge of a histogram's bins, in units of force; by
    default six times the largest σ_f of theory. ``progress`` is told how many packings are done,
    and the half-width at the last look.

    Raises ``TypeError`` for what is no scene, ``ArgumentError``, ``SceneError``, ``StoreError`` for
    a file that can't serve, ``StoreFailedError`` where it can't be written, ``RealisationError``
    where hardly one can be built, and ``WorkersError``. What a store holds by then stays good.

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
    if not isinstance(scene, Scene):
        raise TypeError(
            f"ensemble takes a scene, not {type(scene).__name__}: Scene(…) or read_scene(path)"
        )
    size = _size(scene, realisations)
    until = None if until is None else _share("until", until, "0.01")
    confidence = _share("confidence", confidence, "0.95")
    reach = None if reach is None else _number("reach", reach)
    if scheduler is not None and not isinstance(scheduler, str):
        raise ArgumentError("scheduler", scheduler, 'must be an address, or "local"')
    if store is not None and not isinstance(store, str | Path):
        raise ArgumentError("store", store, "must be the name of a file")
    # Loaded before the memory is shared out: in a full one its library waits for ever.
    import_module("scipy.special")
    m = replace(measurement(scene, reach=reach), expected=size)
    solvers = _workers(m, size, workers, scheduler)
    rule = None if until is None else Rule(until, confidence)
    path = None if store is None else Path(store)
    opened: Store | None = None
    try:
        if path is not None:
            opened = open_store(path, ensemble_key(m))
        found = run(
            m, size, solvers, store=opened, rule=rule, confidence=confidence, progress=progress
        )
        if opened is not None:
            opened.check_it_is_there()
        return found
    except WorkersError as error:
        raise WorkersError(f"{error}.{_kept(opened)}") from None
    except OSError as error:
        if path is None or error.filename != str(path):
            raise
        if not path.exists():  # with all that was done
            raise StoreFailedError(f"{path}: {error.strerror}: what it held is lost") from None
        raise StoreFailedError(
            f"{path} can't be written to ({error.strerror}): make room, or move it to another "
            f"place.{_kept(opened)}"
        ) from None
    except MemoryError:
        raise NotReachedError(f"the memory is full; use fewer workers.{_kept(opened)}") from None
    except KeyboardInterrupt as interrupt:
        if opened is not None:
            interrupt.add_note(_kept(opened).strip())
        raise
    finally:
        if opened is not None:
            opened.close()


def _size(scene: Scene, realisations: int | None) -> int:
    allowed = f"an ensemble has from 2 to {MOST} packings"
    if realisations is None:
        if not 2 <= scene.ask.realisations <= MOST:
            more = f"{allowed}; say how many here or with realisations (--realisations N)"
            raise SceneError("ask.realisations", scene.ask.realisations, more)
        return scene.ask.realisations
    if not isinstance(realisations, SupportsIndex) or not 2 <= index(realisations) <= MOST:
        raise ArgumentError("realisations", realisations, allowed)
    return index(realisations)


def _number(name: str, value: object) -> float:
    if not isinstance(value, Real):
        raise ArgumentError(name, value, "must be a number")
    try:
        return float(value)
    except OverflowError:
        raise ArgumentError(name, "a number", "must be one that float64 holds") from None


def _share(name: str, value: object, such_as: str) -> float:
    number = _number(name, value)
    if not 0 < number < 1:
        raise ArgumentError(name, f"{number:g}", f"must lie between 0 and 1, such as {such_as}")
    return number


def _workers(m: Measurement, size: int, workers: int | None, scheduler: str | None) -> Workers:
    """Choose who solves: this process, others on this machine, or a cluster."""
    whole = workers is None or isinstance(workers, SupportsIndex)
    if not whole or (workers is not None and not 1 <= workers <= MOST_WORKERS):
        allowed = f"must be a whole number between 1 and {MOST_WORKERS}"
        raise ArgumentError("workers", workers, allowed)
    if scheduler in {None, LOCAL}:
        room = max(1, memory_limit() // (m.plan.memory + BATCH))
        if workers is not None and workers > room:
            raise ArgumentError("workers", workers, f"the free memory is enough for {room}")
        if workers is None:
            short = size * (m.plan.problem.region.beads + OF_PACKING) < WORTH_WORKERS
            alone = scheduler is None and (short or m.compiled)  # that takes all cores by itself
            workers = 1 if alone else min(cores(), room)
        if scheduler is None and workers > 1:
            return partial(processes, workers, m.plan.memory)
    if scheduler is None:
        room = memory_limit() // max(m.plan.memory, 1)
        each = min(cores(), max(room, 1)) if m.compiled else 1
        return here if each == 1 else partial(threads, each)
    if find_spec("distributed") is None:
        raise ForceDiffusionError(
            "a cluster needs Dask, which is missing: pip install 'force-diffusion[cluster]'"
        )
    return partial(cluster, None if scheduler == LOCAL else scheduler, workers or 1)


def _kept(store: Store | None) -> str:
    if store is None:
        return ""
    done = sum(stop - first for first, stop in store.ranges())
    return f" {store.path} holds {done} realisations; the same command goes on from there."
