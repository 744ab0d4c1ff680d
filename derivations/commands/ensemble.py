"""The commands for ensembles: a thin layer over ``numeric.ensemble``."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from force_diffusion.derivations.commands.ensemble_running import Where, executor_for, run_shown
from force_diffusion.derivations.commands.guard import about
from force_diffusion.derivations.commands.output import Overwrite, out_option, output
from force_diffusion.derivations.export.tables import csv_text
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError, NotReachedError

if TYPE_CHECKING:
    from force_diffusion.numeric.ensemble.measure import Measurement

MOST = 10**9
STATUSES = (
    "Exit status: 0 answered, 2 something wrong in the scene, the options or the store, 3 the "
    "asked confidence is not reached, or workers or the disk failed, 130 interrupted."
)


def ensemble(
    scene: Annotated[Path, typer.Argument(metavar="SCENE", help="A scene file, in TOML.")],
    realisations: Annotated[
        int | None,
        typer.Option(metavar="N", help="Packings to solve, at most; by default as the scene says."),
    ] = None,
    store: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Keep what is done in this file, and go on from there."),
    ] = None,
    until: Annotated[
        float | None,
        typer.Option(metavar="R", help="Stop when every σ_f is known to this share of itself."),
    ] = None,
    confidence: Annotated[
        float, typer.Option(metavar="C", help="With which confidence all are known.")
    ] = 0.95,
    workers: Annotated[
        int | None,
        typer.Option(metavar="K", help="Processes; by default as many as there are cores."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Let the Dask cluster there work: tcp://host:8786."),
    ] = None,
    cluster: Annotated[
        Where | None, typer.Option(help="Make a Dask cluster on this machine.")
    ] = None,
    covariance: Annotated[
        bool, typer.Option("--covariance", help="Also give covariances between rows.")
    ] = False,
    reach: Annotated[
        float | None,
        typer.Option(metavar="X", help="Outer edge of a histogram's bins, in units of force."),
    ] = None,
    out: Annotated[Path | None, out_option("the result as JSON and CSV")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
    overwrite: Overwrite = False,
) -> None:
    """Statistics over many packings, on many cores, kept in a file as they come."""
    from force_diffusion.numeric.ensemble.result import result_data

    m, size = _measured(scene, realisations, covariance, reach)
    _check_numbers(until, confidence, workers)
    executor = executor_for(m, size, workers, scheduler, cluster)
    names = ["result.json", f"{m.quantity}.csv", *(["covariance.csv"] if covariance else [])]
    with output(out, f"ensemble {scene}", names, overwrite) as folder:
        found = run_shown(scene.name, m, size, executor, store, until, confidence)
        data = result_data(found)
        if folder:
            files = {
                "result.json": json.dumps(data, indent=2) + "\n",
                f"{m.quantity}.csv": csv_text(data["results"][m.quantity]),
            }
            if "covariance" in data:
                files["covariance.csv"] = _matrix_text(data["covariance"])
            folder.write(files)
    print(json.dumps(data, indent=2) if as_json else "\n".join(_lines(data, m.quantity)))
    if found.reached is False:
        assert until is not None
        N, width = found.estimates.realisations, found.half_width
        more = f"about {N * (width / until) ** 2:.2g} realisations may do" if width < MOST else ""
        raise NotReachedError(
            f"the asked confidence is not reached: σ_f is known to {width:.2g}, not {until:g}; "
            f"{more or 'more realisations are needed'}"
        )


def _measured(
    scene: Path, realisations: int | None, covariance: bool, reach: float | None
) -> tuple["Measurement", int]:
    """Read the scene and say what is measured, over how many packings."""
    from force_diffusion.numeric.ensemble.asked import measurement
    from force_diffusion.numeric.run import read_scene

    try:
        with about(scene.name):
            read = read_scene(scene)
        size = read.ask.realisations if realisations is None else realisations
        if not 2 <= size <= MOST:
            given = f"--realisations = {size}" if realisations is not None else (
                f"{scene.name}: ask.realisations = {size}"
            )  # fmt: skip
            raise ForceDiffusionError(
                f"{given}: an ensemble has from 2 to {MOST} packings; say how many with "
                "--realisations N or in the scene"
            )
        with about(scene.name):
            return measurement(read, covariance=covariance, reach=reach), size
    except MemoryError:
        raise ForceDiffusionError(
            f"{scene.name}: the memory is full; ask for a smaller packing"
        ) from None


def _check_numbers(until: float | None, confidence: float, workers: int | None) -> None:
    if until is not None and not 0 < until < 1:
        raise ForceDiffusionError(f"--until = {until:g}: must lie between 0 and 1, such as 0.01")
    if not 0 < confidence < 1:
        raise ForceDiffusionError(
            f"--confidence = {confidence:g}: must lie between 0 and 1, such as 0.95"
        )
    if workers is not None and not 1 <= workers <= 1024:
        raise ForceDiffusionError(f"--workers = {workers}: must lie between 1 and 1024")


def _matrix_text(covariance: dict[str, Any]) -> str:
    """The matrix as CSV: a column a row of the result, under that row's label."""
    labels = [":".join(map(str, one)) for one in zip(*covariance["labels"].values(), strict=True)]
    rows = [dict(zip(labels, map(repr, row), strict=True)) for row in covariance["matrix"]]
    return csv_text(rows)


def _lines(data: dict[str, Any], quantity: str) -> list[str]:
    rows, about, sure = data["results"][quantity], data["ensemble"], data["confidence"]
    lines = [csv_text(rows).rstrip("\n"), f"# {quantity}: {len(rows)} rows"]
    lines.append(f"# {about['realisations']} packings, {about['arithmetic']}")
    width = sure["largest_relative_half_width"]
    if width is not None:
        looks = f", looked at {sure['looks']} times" if sure["looks"] else ""
        lines.append(
            f"# every std together within {width:.2g} of itself, with confidence "
            f"{sure['level']:g}{looks}"
        )
    lines += [f"# left out: {s['effect']}: {s['reason']}" for s in data["skipped"]]
    return lines


def ensemble_status(
    store: Annotated[Path, typer.Argument(metavar="FILE", help="The store of an ensemble.")],
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
) -> None:
    """Say what the store of an ensemble holds, and check it."""
    from force_diffusion.numeric.ensemble.store import open_store

    opened = open_store(store, None)
    try:
        ranges = opened.ranges()
    finally:
        opened.close()
    data = {
        "realisations": sum(stop - first for first, stop in ranges),
        "ranges": [list(one) for one in ranges],
        "sizes_asked_for": list(opened.about.ends),
        "ensemble": opened.about.key,
    }
    if as_json:
        print(json.dumps(data, indent=2))
        return
    print(f"{store}: sound, {data['realisations']} realisations")
    asked = ", ".join(map(str, opened.about.ends))
    print(f"sizes asked for: {asked}")
    for section, keys in opened.about.key.items():
        shown = keys or {}
        print(f"{section}: " + ", ".join(f"{k} = {v}" for k, v in shown.items() if v is not None))


def register(app: typer.Typer) -> None:
    """Add the commands to the command line."""
    app.command(epilog=STATUSES)(ensemble)
    app.command("ensemble-status", epilog=STATUSES)(ensemble_status)
