"""Answers that are judged by those of balls.

Each gives the exit status that its question has, and what was wrong with the answer, or nothing.
"""

import math
from collections.abc import Callable
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import questions
from force_diffusion.numeric.accuracy import ToleranceError
from force_diffusion.numeric.arithmetic.decimals import short
from force_diffusion.numeric.arithmetic.errors import WRONG_INPUT
from force_diffusion.numeric.arithmetic.systems import as_ball, midpoint

import force_diffusion as fd

Judged = tuple[int, str]
# Of the error that is stated: what comparing it with balls of 1e-25 may add.
SLACK = Fraction(1001, 1000)


def compared(
    rough: Callable[[], Any], sharp: Callable[[], Any], answers: Callable[[Any], list[fd.Outcome]]
) -> Judged:
    """Compare what an answer gives with the same in balls, if it is not refused, in words."""
    try:
        found = answers(rough())
    except fd.ForceDiffusionError as error:
        return refused(error)
    try:
        true = answers(sharp())
    except ToleranceError:  # what is exactly zero has no sign
        return 0, ""
    except fd.ForceDiffusionError as error:
        return 0, f"in balls it was refused, and without them was not: {error}"
    return 0, "; ".join(filter(None, map(differs, found, true)))


def refused(error: fd.ForceDiffusionError) -> Judged:
    """Take a refusal, which has to say something."""
    return error.exit_status, "" if str(error).strip() else f"{error!r} says nothing"


def of_balls(random: Random, folder: Path) -> Judged:
    """Compare an answer, to a tolerance or without, with that of balls of 1e-25 or 1e-40."""
    tolerance = random.choice([None, None, None, "1e-6", "1e-14", "1e-20"])
    path = folder / "scene.toml"
    path.write_text(questions.mild(random), encoding="utf-8")
    try:
        scene = fd.read_scene(path)
    except fd.ForceDiffusionError as error:
        return refused(error)
    if scene.effects.contacts == "unilateral":  # in balls, whatever is asked
        return WRONG_INPUT, ""
    return compared(
        lambda: scene.run(tolerance),
        lambda: scene.run("1e-40" if tolerance == "1e-20" else "1e-25", certified=True),
        lambda outcome: [outcome],
    )


def of_radii(random: Random, _folder: Path) -> Judged:
    """Solve an array of a Python user's, odd or not."""
    usual = [(4, 6), (3, 9), (2, 2), (2, 3, 5), (3, 4, 4), (2, 3, 3)]
    shape = random.choice([*usual * 3, (6, 4), (5, 1), (1, 5), (2, 2, 2, 2), (4,), ()])
    scatter = random.choice([1e-3, 1e-3, 0.02, 0.1, 1e-12, 0])
    values = 1 + scatter * np.random.default_rng(random.randrange(10**6)).uniform(-1, 1, shape)
    if random.random() < 0.2 and values.size:
        odd = [np.nan, np.inf, 1.7e308, 1e-320, -1.0, 0.0, 1e200, 3.0]
        values.flat[random.randrange(values.size)] = random.choice(odd)
    scale = random.choice([1.0] * 12 + [1.7e308, 1e-300, 1e150, -1.0])
    with np.errstate(all="ignore"):
        given: Any = (values * scale).astype(random.choice(["f8"] * 6 + [">f4", "O", "f2"]))
    given = random.choice([given, given, np.asarray(given).tolist()])
    loads: list[Any] = [None, fd.BulkLoad(), fd.SurfaceLoad(angle_deg=7), fd.Load()]
    more: dict[str, Any] = {
        "spacing": random.choice([None] * 15 + [3 * abs(scale), "3", 2.0, np.float64(3), 2.2]),
        "dimension": random.choice([len(shape)] * 15 + [None, 2, 3, 4, "2", True]),
        "tolerance": random.choice([None] * 15 + [1e-20, "1e-9", 0, 2, "x", np.nan]),
        "load": random.choice([*loads * 3, "down"]),
        "allow_images": random.random() < 0.8,
    }
    return compared(
        lambda: fd.solve(given, **more),
        lambda: fd.solve(given, **{**more, "tolerance": "1e-25", "certified": True}),
        lambda solution: [solution.forces, solution.positions],
    )


def differs(rough: fd.Outcome, sharp: fd.Outcome) -> str:
    """Say where an answer is not within its stated error of a certified one, or nothing."""
    stated = rough.accuracy.error_bound
    if math.isinf(stated):  # and that is said
        return "" if rough.accuracy.note else "it tells no error, and not why"
    names = rough.table.small
    mine, true = balls(rough, names), balls(sharp, names)
    if [len(one) for one in mine] != [len(one) for one in true]:
        return f"{[len(one) for one in mine]} rows, in balls {[len(one) for one in true]}"
    largest = max((abs(midpoint(x)) for column in mine for x in column), default=Fraction(0))
    error = Fraction(stated) * largest * SLACK + largest / 10**24
    if "relative to σ/r" in rough.accuracy.note:  # as every change is zero
        scene = rough.plan.scene
        unit = scene.load.magnitude if rough.plan.quantity.needs_forces else scene.packing.radius
        error = Fraction(stated) * rough.plan.problem.radii.relative_std * unit
    for name, a, b in zip(names, mine, true, strict=True):
        wide = max((midpoint(y.rad()) for y in b), default=Fraction(0))
        apart = (abs(midpoint(x) - midpoint(y)) for x, y in zip(a, b, strict=True))
        if (worst := max(apart, default=Fraction(0))) > error + wide:
            return f"{name} is off by {short(worst)}, and {short(error)} is stated"
    return ""


def balls(outcome: fd.Outcome, names: tuple[str, ...]) -> list[list[Any]]:
    """Give the numbers of some columns."""
    return [[as_ball(x) for x in outcome.table.numbers[name]] for name in names]
