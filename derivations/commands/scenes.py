"""The commands for scenes: a thin layer over ``numeric``."""

import json
import sys
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.errors import printable
from force_diffusion.numeric.figures.names import KINDS as PICTURES
from force_diffusion.numeric.scene.combinations import KINDS, answered, either

import force_diffusion as fd

from ..export.answers import Format, check, files_of, names_of
from .guard import about as named
from .guard import in_range, say, tell
from .output import Output, Overwrite, folder_of, out_option
from .shared import Json, Quiet, Written, command_line, show, sourced, warn
from .sweep import Settings, name_of, variants

if TYPE_CHECKING:
    from force_diffusion.numeric.planning.plan import Plan

COPIED = "Exit status: 0 copied; 2 the folder exists; 3 the disk failed; 130 interrupted."


def scene_argument(command: str) -> Any:
    """The argument of a command that is a scene's file, and what that may ask for."""
    words = f"A scene file, in TOML, that asks for {either(answered(command))}"
    kinds = [name for name, own in KINDS.items() if not answered(command, **own)]
    none = f"; not for {' or '.join(kinds).replace('`', '')}" if kinds else ""
    return typer.Argument(metavar="SCENE", help=f"{words}{none}.")


_Scene = Annotated[Path, scene_argument("run")]
_Tolerance = Annotated[
    str | None, typer.Option(metavar="T", help="Largest relative error allowed, such as 1e-30.")
]
_Certified = Annotated[
    bool, typer.Option("--certified", help="With a tolerance: accept only a rigorous bound.")
]


def _planned(
    scene: Path, tolerance: str | None, certified: bool, changes: dict[str, str] | None = None
) -> "Plan":
    """Read and plan a scene."""
    from force_diffusion.numeric.run.running import read_tolerance

    try:
        asked = None if tolerance is None else read_tolerance(tolerance)
    except fd.SceneError as error:
        raise fd.ForceDiffusionError(f"--{error}") from None
    with named(scene.name):
        read = fd.read_scene(scene, changes)
        if certified and asked is None and read.ask.tolerance is None:
            raise fd.ForceDiffusionError(
                "--certified needs a tolerance: give --tolerance T, such as 1e-30"
            )
        return read.explain(asked, certified=certified)


def explain(
    scene: _Scene,
    tolerance: _Tolerance = None,
    certified: _Certified = False,
    as_json: Json = False,
) -> None:
    """Say what 'run' would do, and why."""
    from force_diffusion.numeric.planning.plan import plan_lines

    planned = _planned(scene, tolerance, certified)
    warn(scene, planned.notes)
    data = planned.data()
    print(json.dumps(data, indent=2) if as_json else "\n".join(plan_lines(data)))


def run(
    scene: _Scene,
    out: Annotated[Path | None, out_option("the answer as JSON and a table")] = None,
    written: Written = "csv",
    as_json: Json = False,
    quiet: Quiet = False,
    tolerance: _Tolerance = None,
    certified: _Certified = False,
    settings: Settings = None,
    overwrite: Overwrite = False,
) -> None:
    """Solve the packing of a scene and answer its question."""
    check(written, out)
    asked = variants(settings)
    # all scenes and folders are checked first
    plans = [_planned(scene, tolerance, certified, changes) for changes in asked]
    varying = [key for key in asked[0] if len({changes[key] for changes in asked}) > 1]
    varied = [{key: changes[key] for key in varying} for changes in asked]
    names = names_of(answered("run"))
    folders = [
        Output(out / name_of(own) if own else out, names, overwrite) if out else None
        for own in varied
    ]
    several = len(asked) > 1
    for place, (planned, own, folder) in enumerate(zip(plans, varied, folders, strict=True)):
        if several and as_json:
            print("," if place else "[")
        elif several and not quiet:
            say(f"# {', '.join(f'{key} = {value}' for key, value in own.items())}")
        _answer(planned, scene, folder, written, as_json, quiet)
    if several and as_json:
        print("]")


def _answer(
    planned: "Plan", scene: Path, folder: Output | None, written: Format, as_json: bool, quiet: bool
) -> None:
    """Answer one scene, and print or write the answer."""
    from force_diffusion.numeric.run.outcome import outcome_lines
    from force_diffusion.numeric.tables import counted

    warn(scene, planned.notes)
    with named(scene.name), in_range():
        # the progress of a single packing is not known
        many = planned.problem.realisations > 1
        outcome = fd.run(planned, many and not quiet and sys.stderr.isatty())
    answers = list(outcome.results.values())
    about = outcome.data(rows=False)
    about["source"] = sourced(about["source"], scene, command_line())
    if folder:
        folder.write(files_of(answers, about, written))
    counts = ((answer.quantity, counted(answer.number_of_rows, "row")) for answer in answers)
    rows = ", ".join(f"{quantity}: {count}" for quantity, count in counts)
    lines = [rows, *outcome_lines(about)]
    show(answers, about, lines, as_json=as_json, quiet=quiet, written=folder is not None)


def cost(
    scene: Annotated[Path, scene_argument("cost")],
    seconds: Annotated[
        float, typer.Option(help="Time for the whole command; longer runs are extrapolated.")
    ] = 20,
    out: Annotated[Path | None, out_option("the study as CSV, JSON and a plot")] = None,
    as_json: Json = False,
    overwrite: Overwrite = False,
) -> None:
    """Measure what accuracy costs: the error and time of one packing in each arithmetic."""
    from force_diffusion.numeric.run.cost import HEAD
    from force_diffusion.numeric.scene.scene import source_of
    from force_diffusion.numeric.tables import csv_bytes

    command = command_line()
    names = [f"cost.{kind}" for kind in ("json", "csv", *PICTURES)]
    folder = Output(out, names, overwrite) if out else None
    head = iter([HEAD])

    def say_row(way: object) -> None:
        if not as_json:
            say("\n".join([*head, str(way)]))

    with named(scene.name):
        read = fd.read_scene(scene)
        study = fd.cost(read, seconds, say_row)
    data = {"command": command, "source": sourced(source_of(read), scene, None), **study.data()}
    if folder:
        title = f"Cost of accuracy: {printable(scene.stem)}"
        plots: dict[str, bytes] = {}
        try:
            from force_diffusion.numeric.figures import style

            plots = style.images(study.plot(title), "cost", title, command, PICTURES)
        except fd.MissingLibraryError as error:
            tell(f"no plot: {error}")
        text = json.dumps(data, indent=2) + "\n"
        columns = {name: [str(row[name]) for row in study.rows()] for name in study.rows()[0]}
        folder.write({"cost.json": text, "cost.csv": csv_bytes(columns), **plots})
    if as_json:
        print(json.dumps(data, indent=2))
    for name, why in study.skipped.items():
        tell(f"{name}: {why}")


def examples(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Where to copy them.", parser=folder_of)
    ],
    overwrite: Overwrite = False,
) -> None:
    """Copy the example scenes into a new folder."""
    scenes = {
        file.name: file.read_bytes()
        for file in files("force_diffusion.scenes").iterdir()
        if file.is_file() and not file.name.endswith(".py")
    }
    Output(folder, scenes, overwrite).write(scenes)
    for name in sorted(scenes):
        say(str(folder / name))
