"""Answers that are judged by other answers: of balls, of threads, of files.

Each gives the exit status that its question has, and what was wrong with the answer, or nothing.
"""

import csv
import io
import json
import math
import sys
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import commands
import numpy as np
import questions
from force_diffusion.numeric.accuracy import ToleranceError
from force_diffusion.numeric.arithmetic.decimals import short
from force_diffusion.numeric.arithmetic.errors import WRONG_INPUT
from force_diffusion.numeric.arithmetic.systems import as_ball, midpoint
from force_diffusion.numeric.tables import strings
from pyarrow import parquet

import force_diffusion as fd

Judged = tuple[int, str]
THREADS = 4
# Of the error that is stated: what comparing it with balls of 1e-25 may add.
SLACK = Fraction(1001, 1000)


def _scene(random: Random, folder: Path) -> fd.Scene:
    path = folder / "scene.toml"
    path.write_text(questions.mild(random), encoding="utf-8")
    return fd.read_scene(path)


def _refused(error: fd.ForceDiffusionError) -> Judged:
    """Take a refusal, which has to say something."""
    return error.exit_status, "" if str(error).strip() else f"{error!r} says nothing"


def of_balls(random: Random, folder: Path) -> Judged:
    """Compare an answer, to a tolerance or without, with that of balls of 1e-25 or 1e-40."""
    tolerance = random.choice([None, None, None, "1e-6", "1e-14", "1e-20"])
    try:
        scene = _scene(random, folder)
        if scene.effects.contacts == "unilateral":  # in balls, whatever is asked
            return WRONG_INPUT, ""
        rough = scene.run(tolerance)
    except fd.ForceDiffusionError as error:
        return _refused(error)
    try:
        sharp = scene.run("1e-40" if tolerance == "1e-20" else "1e-25", certified=True)
    except ToleranceError:  # what is exactly zero has no sign
        return 0, ""
    except fd.ForceDiffusionError as error:
        return 0, f"with 1e-25 it was refused, and without it was not: {error}"
    return 0, differs(rough, sharp)


def of_radii(random: Random, folder: Path) -> Judged:
    """Solve an array of a Python user's, odd or not."""
    usual = [(4, 6), (3, 9), (2, 2), (2, 3, 5), (3, 4, 4), (2, 3, 3, 3), (2, 2, 2, 2)]
    shape = random.choice([*usual * 3, (6, 4), (5, 1), (1, 5), (4,), ()])
    scatter = random.choice([1e-3, 1e-3, 0.02, 0.1, 1e-12, 0])
    values = 1 + scatter * np.random.default_rng(random.randrange(10**6)).uniform(-1, 1, shape)
    if random.random() < 0.2 and values.size:
        odd = [np.nan, np.inf, 1.7e308, 1e-320, -1.0, 0.0, 1e200, 3.0]
        values.flat[random.randrange(values.size)] = random.choice(odd)
    scale = random.choice([1.0] * 12 + [1.7e308, 1e-300, 1e150, -1.0])
    forms = ["f8"] * 6 + [">f4", "O", "f2"]
    with np.errstate(all="ignore"):
        given: Any = (values * scale).astype(random.choice(forms))
    given = random.choice([given, given, np.asarray(given).tolist()])
    loads: list[Any] = [None, fd.BulkLoad(), fd.SurfaceLoad(angle_deg=7), fd.Load()]
    more: dict[str, Any] = {
        "spacing": random.choice([None] * 15 + [3 * abs(scale), "3", 2.0, np.float64(3), 2.2]),
        "dimension": random.choice([len(shape)] * 15 + [None, 2, 3, 4, "2", True]),
        "tolerance": random.choice([None] * 15 + [1e-20, "1e-9", 0, 2, "x", np.nan]),
        "load": random.choice([*loads * 3, "down"]),
        "allow_images": random.random() < 0.8,
    }
    if random.random() < 0.2:
        more["arithmetic"] = random.choice(["pairs", "longdouble", "mpmath 30", "balls 30", "x"])
    try:
        found = fd.solve(given, **more)
    except fd.ForceDiffusionError as error:
        return _refused(error)
    try:
        sharp = fd.solve(
            given, **{**more, "tolerance": "1e-25", "certified": True, "arithmetic": None}
        )
    except ToleranceError:
        return 0, ""
    except fd.ForceDiffusionError as error:
        return 0, f"with 1e-25 it was refused, and without it was not: {error}"
    what = differs(found.forces, sharp.forces)
    try:
        return 0, what or differs(found.positions, sharp.positions)
    except fd.ForceDiffusionError as error:  # positions have limits of their own
        return _refused(error)


def differs(rough: fd.Outcome, sharp: fd.Outcome) -> str:
    """Say where an answer is not within its stated error of a certified one, or nothing."""
    stated = rough.accuracy.error_bound
    if math.isinf(stated):  # and that is said
        return "" if rough.accuracy.note else "it tells no error, and not why"
    names = rough.answer.table.small
    mine, true = _columns(rough, names), _columns(sharp, names)
    wide = [max((midpoint(x.rad()) for x in column), default=0) for column in _balls(sharp, names)]
    if [len(one) for one in mine] != [len(one) for one in true]:
        return f"{[len(one) for one in mine]} rows, in balls {[len(one) for one in true]}"
    largest = max((abs(x) for column in mine for x in column), default=Fraction(0))
    error = Fraction(stated) * largest * SLACK + largest / 10**24
    if "relative to σ/r" in rough.accuracy.note:  # as every change is zero
        scene = rough.plan.scene
        unit = scene.load.magnitude if rough.plan.quantity.needs_forces else scene.packing.radius
        error = Fraction(stated) * rough.plan.problem.radii.relative_std() * unit
    for name, a, b, radius in zip(names, mine, true, wide, strict=True):
        worst = max((abs(x - y) for x, y in zip(a, b, strict=True)), default=Fraction(0))
        if worst > error + radius:
            return f"{name} is off by {short(worst)}, and {short(error)} is stated"
    return _miscounted(rough, true[0], error) if rough.answer.bins else ""


def _columns(outcome: fd.Outcome, names: tuple[str, ...]) -> list[list[Fraction]]:
    """Give the numbers of some columns, of balls their midpoints."""
    return [[midpoint(x) for x in column] for column in _balls(outcome, names)]


def _balls(outcome: fd.Outcome, names: tuple[str, ...]) -> list[list[Any]]:
    return [[as_ball(x) for x in outcome.answer.table.numbers[name]] for name in names]


def _miscounted(rough: fd.Outcome, changes: list[Fraction], error: Fraction) -> str:
    plan = rough.plan
    alike = plan.scene.ask.realisations // plan.problem.realisations
    for low, high, count in rough.answer.bins or ():
        off = error + max(abs(low), abs(high)) / 2**50
        inside = alike * sum(low + off <= x < high - off for x in changes)
        near = alike * sum(low - off <= x < high + off for x in changes)
        if not inside <= count <= near:
            return f"counted {count} from {float(low)} to {float(high)}; {inside} to {near} are"
    return ""


def of_threads(random: Random, folder: Path) -> Judged:
    """Ask the same question in several threads, and alone."""
    path = folder / "scene.toml"
    path.write_text(questions.mild(random), encoding="utf-8")
    tolerance = random.choice([None, None, "1e-20", "1e-40"])

    def answer(_: int) -> tuple[int, Any]:
        try:
            found = fd.read_scene(path).run(tolerance)
        except fd.ForceDiffusionError as error:
            return error.exit_status, type(error).__name__
        return 0, (found.decimals(), found.accuracy)

    alone = answer(0)
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        with ThreadPoolExecutor(THREADS) as pool:
            several = list(pool.map(answer, range(THREADS)))
    finally:
        sys.setswitchinterval(before)
    differ = [one for one in several if one != alone]
    return alone[0], f"alone {alone}\nand in threads {differ[0]}"[:2500] if differ else ""


def of_files(random: Random, folder: Path) -> Judged:
    """Read back what ``run --out`` writes, and compare it with the answer."""
    kind = random.choice(["parquet", "parquet", "npz", "csv"])
    (folder / "scene.toml").write_text(questions.mild(random), encoding="utf-8")
    command = ["run", "scene.toml", "--out", "out", "--format", kind]
    found = commands.said(command)
    if (what := commands.wrong(command, found)) or found.status:
        return found.status, what
    answer = fd.read_scene(folder / "scene.toml").run()
    content = (folder / "out" / f"{answer.quantity}.{kind}").read_bytes()
    columns, about = _read(kind, content)
    if about["accuracy"] != answer.data(rows=False)["accuracy"]:
        return 0, f"what {kind} says of the answer is not what it says itself"
    if list(columns) != list(answer.text):
        return 0, f"{kind} has the columns {list(columns)}, and not {list(answer.text)}"
    for name, column in answer.arrays.items():
        exact = kind != "csv" and (column.dtype == np.float64 or column.dtype.kind in "iU")
        expected = column.tolist() if exact else strings(answer.text[name])
        if repr(columns[name]) != repr(expected):  # NaN is like NaN
            return 0, f"{kind} has {name} = {columns[name]}, and not {expected}"[:2000]
    return 0, ""


def _read(kind: str, content: bytes) -> tuple[dict[str, list[Any]], dict[str, Any]]:
    """Give the columns of a file, and what is said about them."""
    if kind == "npz":
        with np.load(io.BytesIO(content)) as file:
            found = {name: file[name].tolist() for name in file.files}
        return found, json.loads(found.pop("about"))
    if kind == "parquet":
        table = parquet.read_table(io.BytesIO(content))
        return table.to_pydict(), json.loads(table.schema.metadata[b"force-diffusion"])
    header, *rows = csv.reader(io.StringIO(content.decode()))
    columns = {name: [row[k] for row in rows] for k, name in enumerate(header)}
    return columns, json.loads(Path("out/result.json").read_text(encoding="utf-8"))
