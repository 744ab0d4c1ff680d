"""The commands for ensembles: a thin layer over ``fd.ensemble`` and ``fd.read_store``."""

import json
import sys
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from force_diffusion.numeric.scene.combinations import answered

import force_diffusion as fd

from ..export.answers import check, files_of, names_of
from .guard import about, in_range, say, tell
from .output import Output, Overwrite, out_option
from .scenes import scene_argument
from .shared import Json, Quiet, Written, show, sourced, warn

# Seconds until a scheduler has to answer, and a worker of it has to be there.
PATIENCE = 10


def ensemble(
    scene: Annotated[Path, scene_argument("ensemble")],
    realisations: Annotated[
        int | None,
        typer.Option(metavar="N", help="Largest number of packings; by default that of the scene."),
    ] = None,
    store: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="Save finished packings in this file, and continue from it."
        ),
    ] = None,
    until: Annotated[
        float | None,
        typer.Option(metavar="R", help="Stop when every σ_f is known to this relative error."),
    ] = None,
    confidence: Annotated[
        float, typer.Option(metavar="C", help="Confidence of --until, for all σ_f together.")
    ] = 0.95,
    workers: Annotated[
        int | None,
        typer.Option(
            metavar="K",
            help="Threads, or processes if loops are not compiled; by default one per core.",
        ),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(
            metavar="ADDRESS", help="Use the Dask cluster at this address, such as tcp://host:8786."
        ),
    ] = None,
    reach: Annotated[
        float | None,
        typer.Option(metavar="X", help="Outer edge of a histogram's bins, in units of force."),
    ] = None,
    out: Annotated[Path | None, out_option("the result as JSON and a table")] = None,
    written: Written = "csv",
    as_json: Json = False,
    quiet: Quiet = False,
    overwrite: Overwrite = False,
) -> None:
    """Gather statistics over many packings, on all cores, and save them in a file."""
    if scheduler is not None and workers is not None:
        raise fd.ForceDiffusionError("--scheduler and --workers exclude each other: leave one out")
    with about(scene.name):
        read = fd.read_scene(scene)
    check(written, out)
    folder = Output(out, names_of(answered("ensemble")), overwrite) if out else None
    with about(scene.name):
        result = _solved(
            read, store, scheduler, realisations=realisations, until=until,
            confidence=confidence, workers=workers, reach=reach,
            progress=not quiet and sys.stderr.isatty(),
        )  # fmt: skip
    warn(scene, result.measurement.plan.notes)
    data = result.data(rows=False)
    data["source"] = sourced(data["source"], scene, None)  # the same, whoever solved it
    if folder:
        folder.write(files_of([result], data, written))
    lines = str(result).splitlines()
    show([result], data, lines, as_json=as_json, quiet=quiet, written=folder is not None)
    if result.reached is False:
        more = result.half_width / (until or 1)
        remedy = (
            f"about {more**2 * result.realisations:.2g} realisations may be enough"
            if more < 1e6
            else "that needs more realisations than an ensemble may have"
        )
        raise fd.NotReachedError(
            f"the confidence is not reached: σ_f is known to {result.half_width:.2g}, not {until}; "
            f"{remedy}"
        )


def _solved(
    scene: "fd.Scene", store: Path | None, scheduler: str | None, **more: Any
) -> "fd.Ensemble":
    """Solve under a progress bar; errors name options as they are written here."""
    try:
        with ExitStack() as stack, in_range():
            if scheduler is not None:
                more["executor"] = stack.enter_context(_cluster(scheduler))
            return fd.ensemble(scene, store=store, **more)
    except fd.ArgumentError as error:
        raise fd.ForceDiffusionError(f"--{error}") from None
    except KeyboardInterrupt as interrupt:
        nothing = "nothing was saved; with --store FILE it would have been."
        for note in getattr(interrupt, "__notes__", [] if store else [nothing]):
            tell(note)
        raise


@contextmanager
def _cluster(address: str) -> Iterator[Executor]:
    """Give the executor of the Dask cluster at an address."""
    try:
        import distributed as untyped
    except ImportError:
        raise fd.ForceDiffusionError(
            "a cluster needs Dask, which is missing: pip install 'force-diffusion[cluster]'"
        ) from None
    distributed: Any = untyped  # it has no types
    try:
        client = distributed.Client(address, timeout=PATIENCE)
    except (OSError, ValueError) as error:
        raise fd.WorkersError(f"no Dask scheduler answers at {address} ({error})") from None
    with client:
        try:
            client.wait_for_workers(1, timeout=PATIENCE)
            yield client.get_executor(pure=False)
        except (TimeoutError, distributed.KilledWorker) as error:
            raise fd.WorkersError(f"{error}: give the cluster workers, or more memory") from None


def ensemble_status(
    store: Annotated[Path, typer.Argument(metavar="FILE", help="The store of an ensemble.")],
    as_json: Json = False,
) -> None:
    """Check the store of an ensemble, and say what it holds."""
    saved = fd.read_store(store)
    if as_json:
        print(json.dumps(saved.data(), indent=2))
        return
    say(f"{store}: sound, {saved}")
