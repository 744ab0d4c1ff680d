"""Packings that the memory does not hold: which are swept by segments, and by how many layers."""

import math
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec

from ..arithmetic.systems import FLOAT64, NumberSystem
from ..lattice.layers import Region
from ..mechanics.physicality import PHYSICAL
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..scene.scene import Scene
from . import budget
from .plan import Method, Step
from .times import predicted

# Quantities whose answer comes from one segment after the other; of a response some layers do.
KNOWN = ("profile", "contact", "base_reactions", "histogram")
# Columns of a packing as high whose error, so many times, stands for that of a profile of whole
# layers: means over more contacts err less. In 1,100 packings it was up to 1.05 times.
COLUMNS, STAND_IN = 16, 2
# Bytes of a bead of a segment (δr, positions, δn, forces), and of one that is kept on the way up;
# by NumPy, in a longer arithmetic, so many times as much.
_BEAD, _KEPT = 96, 16
_LONGER = 3
# Layers that are solved beside those of a segment.
_BESIDE = 5
# Seconds of a bead, all steps together, in whole layers and in others.
_SECONDS, _SECONDS_OF_CONE = 8e-8, 1.6e-7


def suits(scene: Scene, tolerance: Fraction | None) -> bool:
    """Say whether a scene's packing could be swept by segments, as far as is plain at once.

    With a tolerance it is not: another arithmetic might have to take over.
    """
    ask, disorder = scene.ask, scene.disorder
    return (
        (ask.quantity in KNOWN or ask.layers is not None)
        and scene.packing.dimension == 2
        and ask.realisations == 1
        and tolerance is None
        and disorder is not None
        and disorder.kind not in {"file", "given"}
        and scene.load.kind != "file"
        and scene.effects.geometry == "exact"
        and not scene.effects.stop_at_tension
        and find_spec("numba") is not None
    )


def layers(widest: int, height: int) -> int:
    """Give the layers of a segment, an even number, that take the least memory together."""
    best = math.sqrt(_KEPT / _BEAD * (height + 1))
    return max(2, 2 * round(best / 2))


def beads_bytes(widest: int, height: int) -> int:
    """Bound the bytes of a segment and of what is kept, for rows of so many beads, in float64."""
    k = layers(widest, height)
    return widest * (_BEAD * (k + _BESIDE) + _KEPT * (height // k + 1))


def cut(
    problem: Problem, method: Method, scene: Scene, tolerance: Fraction | None
) -> Problem | None:
    """Give the problem swept by segments, if it can be."""
    if not suits(scene, tolerance) or method.system is not FLOAT64 or problem.route != Route.EXACT:
        return None
    widest = max(row.count for row in problem.region.rows)
    return replace(problem, segment=layers(widest, problem.region.top))


def memory(problem: Problem, quantity: Quantity, longer: NumberSystem) -> int:
    """Estimate the bytes at the peak; ``longer`` is the arithmetic that estimates the error."""
    widest = max(row.count for row in problem.region.rows)
    counted = quantity.name == "histogram"  # one segment after the other
    region = Region(problem.width, ()) if counted else problem.region
    rows = quantity.answer_rows(region, 1)
    swept = beads_bytes(widest, problem.region.top)
    if stands_in(quantity.scene):
        swept += 2 * budget.FLOAT_BEAD * COLUMNS * len(problem.region.rows)
    else:
        swept += swept * (budget.BALL_BEAD // _BEAD if longer.dtype is object else _LONGER)
    return (
        swept
        + rows * budget.FLOAT_ROW
        + len(problem.region.rows) * budget.PLAN_LAYER
        + budget.INTERPRETER
        + budget.COMPILER
    )


def seconds(problem: Problem, quantity: Quantity, longer: NumberSystem) -> float:
    """Predict how long it takes; ``longer`` is the arithmetic that estimates the error."""
    each = _SECONDS if problem.region.is_whole else _SECONDS_OF_CONE
    own = problem.region.beads * each
    spent = own * (5 / 3 if quantity.name == "histogram" else 1)
    if stands_in(quantity.scene):
        return spent
    return spent + own + 2 * predicted(quantity, problem, Method(longer), 1)


def steps(
    found: tuple[Step, ...], problem: Problem, quantity: Quantity, needed: int, limit: int
) -> tuple[Step, ...]:
    """Say in the steps of a plan what is done twice, and why."""
    k, all_layers = problem.segment, problem.region.top + 1
    sizes = f"{budget.size(needed)} of memory would be needed and {budget.size(limit)} may be used"
    counts = quantity.name == "histogram"
    often, last = ("three times", ", and a third time to count") if counts else ("twice", "")
    why = (
        f"{often}, {k} of {all_layers} layers at a time, because {sizes}: on the way up every "
        f"{k}-th layer is kept, and those between are deposited again on the way down{last}"
    )
    again = "the packing once more, beside one with a longer significand, segment by segment"
    visited = sum(
        s.beads * (1 + (s.step != "balance forces")) for s in found[:-1] if s.step != PHYSICAL
    )
    if stands_in(quantity.scene):
        again = (
            f"of another packing, {COLUMNS} columns of as many layers, once and with a longer "
            "significand"
        )
        visited = found[-1].beads * COLUMNS * all_layers // max(problem.region.beads, 1)
    changed = []
    for step in found:
        if step.step in {"draw radii", "deposit"}:
            reason = why if step.step == "deposit" else f"{often}, on the way up and down"
            changed.append(replace(step, reason=reason, beads=(2 + counts) * step.beads))
        elif step.step == "balance forces" and counts:
            reason = "twice: the bins lie between the smallest and the largest change"
            changed.append(replace(step, reason=reason, beads=2 * step.beads))
        elif step is found[-1]:
            changed.append(replace(step, reason=again, beads=2 * visited))
        else:
            changed.append(step)
    return tuple(changed)


def stands_in(scene: Scene) -> bool:
    """Say whether the error is that of a narrow packing; all else is repeated itself."""
    return scene.ask.quantity == "profile" and scene.load.kind in {"surface", "bulk"}


def narrow(scene: Scene) -> Scene:
    """Give the scene of a packing as high and so narrow that it is solved quickly."""
    width = min(scene.packing.width or COLUMNS, COLUMNS)
    packing = scene.packing.model_copy(update={"width": width, "allow_images": True})
    return scene.model_copy(update={"packing": packing})
