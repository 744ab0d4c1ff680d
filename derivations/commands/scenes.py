"""The commands for scenes: a thin layer over ``numeric``."""

import json
import sys
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack, nullcontext
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any

import typer
from force_diffusion.derivations.commands.publishing import (
    NOT_REACHED,
    WRONG_INPUT,
    csv_text,
    drawn,
    fail,
    noticing,
    out_option,
    published,
)

if TYPE_CHECKING:
    from force_diffusion.numeric.planning.plan import Plan
    from force_diffusion.numeric.studies.cost.rows import Study

# Seconds from which on progress is shown.
MOMENT = 1.0
STATUSES = (
    "Exit status: 0 answered, 2 something wrong in the scene or its files, 3 the asked tolerance "
    "can't be reached or the disk failed, 130 interrupted."
)


_Scene = Annotated[Path, typer.Argument(metavar="SCENE", help="A scene file, in TOML.")]
_Json = Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")]
_Tolerance = Annotated[
    str | None,
    typer.Option(
        metavar="T",
        help="Relative error allowed, such as 1e-30; the cheapest way that meets it is taken.",
    ),
]
_Certified = Annotated[
    bool, typer.Option("--certified", help="With a tolerance: only a rigorous bound will do.")
]


def _planned(scene: Path, tolerance: str | None, certified: bool) -> "Plan":
    """Read and plan a scene, or leave with a message."""
    from force_diffusion.derivations.commands.calibrate import model_for
    from force_diffusion.numeric.arithmetic.decimals import parse
    from force_diffusion.numeric.planning.budget import memory_limit
    from force_diffusion.numeric.planning.planner import plan
    from force_diffusion.numeric.scene.sections import SceneError, read_scene
    from force_diffusion.numeric.scene.tables import TableError

    asked = None
    if tolerance is not None:
        try:
            asked = parse(tolerance)
        except ValueError as error:
            fail(f"--tolerance: {error}", WRONG_INPUT)
        if not 0 < asked < 1:
            fail(f"--tolerance = {tolerance}: must lie between 0 and 1", WRONG_INPUT)
    try:
        found = read_scene(scene)
        wanted = asked or found.ask.tolerance
        if certified and wanted is None:
            fail("--certified needs a tolerance: give --tolerance T, such as 1e-30", WRONG_INPUT)
        return plan(found, asked, certified=certified, model=model_for(wanted is not None))
    except (SceneError, TableError) as error:
        fail(f"{scene.name}: {error}", WRONG_INPUT)
    except MemoryError:
        free = memory_limit() / 1e6
        fail(
            f"{scene.name}: reading and planning it takes more than the free memory, "
            f"{free:.3g} MB: ask for a smaller packing or give smaller files",
            WRONG_INPUT,
        )


def explain(
    scene: _Scene,
    tolerance: _Tolerance = None,
    certified: _Certified = False,
    as_json: _Json = False,
) -> None:
    """Say what 'run' would do, and why."""
    from force_diffusion.numeric.result import plan_data

    planned = _planned(scene, tolerance, certified)
    data = plan_data(planned)
    print(json.dumps(data, indent=2) if as_json else "\n".join(_plan_lines(data)))


def run(
    scene: _Scene,
    out: Annotated[Path | None, out_option("the answer as JSON and CSV")] = None,
    as_json: _Json = False,
    tolerance: _Tolerance = None,
    certified: _Certified = False,
) -> None:
    """Answer a scene's question."""
    planned = _planned(scene, tolerance, certified)
    quantity = planned.scene.ask.quantity

    def answer() -> tuple[dict[str, Any], dict[str, str | bytes]]:
        data = _solved(planned, scene)
        return data, {
            "result.json": json.dumps(data, indent=2) + "\n",
            f"{quantity}.csv": csv_text(data["results"][quantity]),
        }

    _show(published(out, answer), as_json)


def cost(
    scene: _Scene,
    out: Annotated[Path | None, out_option("the study as CSV, JSON and a plot")] = None,
    as_json: _Json = False,
) -> None:
    """Measure what accuracy costs: every way to answer a scene, its error beside its time."""
    import shlex

    from force_diffusion.numeric.studies.cost.data import csv_rows, lines, study_data

    command = shlex.join(["force-diffusion", "cost", str(scene), "--out", str(out or "DIR")])

    def answer() -> tuple[dict[str, Any], dict[str, str | bytes]]:
        found = _studied(scene)
        data = study_data(found, command)
        files: dict[str, str | bytes] = {
            "cost.json": json.dumps(data, indent=2) + "\n",
            "cost.csv": csv_text(csv_rows(data)),
        }
        if out is not None:
            files |= drawn("force_diffusion.numeric.studies.cost.plot", found, command, scene.stem)
        return data, files

    data = published(out, answer)
    print(json.dumps(data, indent=2) if as_json else "\n".join(lines(data)))


def _studied(scene: Path) -> "Study":
    """Study a scene, telling a terminal what is measured, or leave with a message."""
    from force_diffusion.numeric.disorder.radii import RadiusError
    from force_diffusion.numeric.mechanics.forces import NotStandingError
    from force_diffusion.numeric.mechanics.packing import UnbuildableError, UndecidedError
    from force_diffusion.numeric.run import ToleranceError
    from force_diffusion.numeric.scene.sections import SceneError, read_scene
    from force_diffusion.numeric.scene.tables import TableError
    from force_diffusion.numeric.studies.cost.study import study

    try:
        with noticing() as notice:
            return study(read_scene(scene), notice)
    except (SceneError, TableError, UnbuildableError, NotStandingError, RadiusError) as error:
        fail(f"{scene.name}: {error}", WRONG_INPUT)
    except (ToleranceError, UndecidedError) as error:
        fail(f"{scene.name}: {error}", NOT_REACHED)
    except MemoryError:
        fail(f"{scene.name}: the memory is full; ask for less", NOT_REACHED)


def _solved(planned: "Plan", scene: Path) -> dict[str, Any]:
    """Run a plan under a progress bar, or leave with a message."""
    from force_diffusion.numeric.disorder.radii import RadiusError
    from force_diffusion.numeric.mechanics.forces import NotStandingError
    from force_diffusion.numeric.mechanics.packing import UnbuildableError
    from force_diffusion.numeric.result import outcome_data
    from force_diffusion.numeric.run import ToleranceError
    from force_diffusion.numeric.run import run as solve

    bar, progress = _progress(planned)
    try:
        with bar:
            outcome = solve(planned, progress=progress)
    except (UnbuildableError, NotStandingError, RadiusError) as error:
        fail(f"{scene.name}: {error}", WRONG_INPUT)
    except ToleranceError as error:
        fail(f"{scene.name}: {error}", NOT_REACHED)
    except ArithmeticError as error:
        fail(f"{scene.name}: a number left the range of the arithmetic ({error})", NOT_REACHED)
    except MemoryError:
        fail(f"{scene.name}: the memory is full; ask for less", NOT_REACHED)
    return outcome_data(outcome)


def _progress(
    planned: "Plan",
) -> tuple[AbstractContextManager[object], Callable[[str, int], None] | None]:
    """A bar on a terminal, for work that takes longer than a moment, whatever was estimated."""
    if not sys.stderr.isatty():
        return nullcontext(), None
    from rich.console import Console
    from rich.progress import Progress

    bar = Progress(console=Console(stderr=True), transient=True)
    total = sum(step.beads for step in planned.steps)
    task = bar.add_task("solving", total=total)
    done, shown = 0, perf_counter() + MOMENT
    stack = ExitStack()

    def progress(kind: str, beads: int) -> None:
        nonlocal done, shown
        done += beads
        if perf_counter() < shown:  # single beads may come a million a second
            return
        if not bar.live.is_started:
            stack.enter_context(bar)
        bar.update(task, completed=done, description=kind)
        shown = perf_counter() + MOMENT / 10

    return stack, progress


def _plan_lines(data: dict[str, Any]) -> list[str]:
    lines = ["What is done"]
    for step in data["plan"]:
        spent = "" if step["seconds"] is None else f", {step['seconds']:.3g} s"
        cost = f"{step['beads']} beads, {step['arithmetic']}{spent}"
        lines.append(f"  {step['step']}: {step['reason']} ({cost})")
    lines.append("What is left out")
    lines += [f"  {s['effect']}: {s['reason']}" for s in data["skipped"]] or ["  nothing"]
    lines += _choice_lines(data["choice"]) if data["choice"] else []
    lines.append(f"About {data['estimated_seconds']:.2g} s and {data['memory_bytes'] / 1e6:.3g} MB")
    if data["sees_images"]:
        lines.append("The answer sees periodic images: it is that of the strip, not of the slab")
    return lines


def _choice_lines(choice: dict[str, Any]) -> list[str]:
    """Say what was chosen, from what, and what a digit costs."""
    chosen = choice["chosen"]
    lines = [
        f"How, for a tolerance of {choice['tolerance']}: {_way(chosen)}",
        f"  {choice['reason']} (cost model: {choice['coefficients']})",
        f"  {'':2}{'way':<31}{'arithmetic':<22}{'repeated':>8} {'error':>9} {'seconds':>9}",
    ]
    for way in choice["candidates"]:
        mark = "*" if way == chosen else ""
        error, spent = way["expected_error"], way["seconds"]
        seconds = "" if spent is None else f"{spent:.2g}"
        lines.append(
            f"  {mark:2}{way['algorithm']:<31}{way['arithmetic']:<22}{way['repeated'] or '':>8} "
            f"{error:>9} {seconds:>9}  {way['out']}".rstrip()
        )
    for name, words in (("digit_more", "One digit more"), ("digit_less", "One digit fewer")):
        way = choice[name]
        if way is None:
            lines.append(f"{words}: there is no way to it")
        else:
            lines.append(f"{words}, {way['tolerance']}: {_way(way)}, about {way['seconds']:.2g} s")
    for missed in choice.get("missed", []):
        lines.append(
            f"Tried before: {missed['algorithm']}, {missed['arithmetic']}: {missed['why']}"
        )
    if "measured_seconds" in choice:
        lines.append(
            f"Predicted {chosen['seconds']:.2g} s, took {choice['measured_seconds']:.2g} s"
        )
    return lines


def _way(way: dict[str, Any]) -> str:
    kind = "certified" if way["certified"] else "estimated"
    return f"{way['algorithm']}, {way['arithmetic']}, {kind}"


def _show(data: dict[str, Any], as_json: bool) -> None:
    if as_json:
        print(json.dumps(data, indent=2))
        return
    quantity, rows = next(iter(data["results"].items()))
    print(csv_text(rows), end="")
    print(f"# {quantity}: {len(rows)} rows")
    accuracy = data["accuracy"]
    bound = accuracy["error_bound"]
    kind = "certified" if accuracy["certified"] else "estimated"
    shown = f"{bound:.2g}" if isinstance(bound, float) else bound or "unknown"
    print(
        f"# error {shown}, {kind}, in {accuracy['arithmetic']}; bits lost {accuracy['bits_lost']}"
    )
    if "physical" in data:
        p = data["physical"]
        words = "physical" if p["physical"] else "NOT physical"
        gap = "none" if p["smallest_gap"] is None else f"{p['smallest_gap']:.6g} r"
        print(
            f"# {words}: smallest gap {gap}, {p['overlaps']} overlaps, "
            f"{p['tensile_contacts']} tensile contacts; "
            f"M = {p['height']}, M* = {p['critical_height']}"
        )
    if "stopped_at_tension" in data:
        print(f"# stopped at the tensile contact {data['stopped_at_tension']}")
    print("\n".join(f"# {line}" for line in _plan_lines(data)))


def register(app: typer.Typer) -> None:
    """Add the commands to the command line."""
    app.command(epilog=STATUSES)(run)
    app.command(epilog=STATUSES)(explain)
    app.command(epilog=STATUSES)(cost)
