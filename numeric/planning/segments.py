"""Large packings: which are swept by segments, and by how many layers."""

import math
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec

from ..arithmetic.systems import FLOAT64
from ..lattice.layers import Region
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..scene.scene import Scene
from . import budget
from .plan import Method, Step

# Bytes of a bead of a segment (δr, positions, δn, forces, with their errors, and forces rounded),
# and of one that is kept on the way up.
_BEAD, _KEPT = 240, 32
# Beads from which on segments take less time than fresh memory for all of them, which the system
# has to hand out: 0.25 µs a bead instead of 0.4, and of 10⁷ instead of 1 (on a busy machine).
QUICKER = 5_000_000
# Layers that are solved beside those of a segment.
_BESIDE = 5
# Seconds of a bead, all steps together, in whole layers and in others.
_SECONDS, _SECONDS_OF_CONE = 2.5e-7, 5e-7


def suits(scene: Scene, tolerance: Fraction | None) -> bool:
    """Say whether a scene's packing could be swept by segments, as far as is plain at once.

    With a tolerance it is not: the error is that of a few columns, not of the answer.
    """
    return (
        scene.ask.realisations == 1
        and tolerance is None
        and scene.disorder is not None
        and scene.effects.geometry == "exact"
        and not scene.effects.stop_at_tension
        and find_spec("numba") is not None
    )


def layers(widest: int, height: int) -> int:
    """Give the layers of a segment, an even number, that take the least memory together."""
    best = math.sqrt(_KEPT / _BEAD * (height + 1))
    return max(2, 2 * round(best / 2))


def beads_bytes(widest: int, height: int) -> int:
    """Bound the bytes of a segment and of what is kept, for layers of so many beads at most."""
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


def memory(problem: Problem, quantity: Quantity) -> int:
    """Estimate the bytes at the peak."""
    widest = max(row.count for row in problem.region.rows)
    counted = quantity.name == "histogram"  # one segment after the other
    region = Region(problem.width, ()) if counted else problem.region
    rows = quantity.answer_rows(region, 1)
    return (
        beads_bytes(widest, problem.region.top)
        + rows * budget.FLOAT_ROW
        + len(problem.region.rows) * budget.PLAN_LAYER
        + budget.INTERPRETER
        + budget.COMPILER
    )


def seconds(problem: Problem, quantity: Quantity) -> float:
    """Predict how long it takes."""
    each = _SECONDS if problem.region.is_whole else _SECONDS_OF_CONE
    return problem.region.beads * each * (5 / 3 if quantity.name == "histogram" else 1)


def steps(
    found: tuple[Step, ...], problem: Problem, quantity: Quantity, needed: int, limit: int
) -> tuple[Step, ...]:
    """Say in the steps of a plan what is done twice, and why."""
    k, all_layers = problem.segment, problem.region.top + 1
    sizes = f"{budget.size(needed)} of memory would be needed and {budget.size(limit)} may be used"
    if needed <= limit:
        sizes = f"{budget.size(needed)} of memory that was not used before take longer"
    counts = quantity.name == "histogram"
    often, last = ("three times", ", and a third time to count") if counts else ("twice", "")
    why = (
        f"{often}, {k} of {all_layers} layers at a time, because {sizes}: on the way up every "
        f"{k}-th layer is kept, and those between are deposited again on the way down{last}"
    )
    changed = []
    for step in found:
        if step.step in {"draw radii", "deposit"}:
            reason = why if step.step == "deposit" else f"{often}, on the way up and down"
            changed.append(replace(step, reason=reason, beads=(2 + counts) * step.beads))
        elif step.step == "balance forces" and counts:
            reason = "twice: the bins lie between the smallest and the largest change"
            changed.append(replace(step, reason=reason, beads=2 * step.beads))
        else:
            changed.append(step)
    return tuple(changed)
