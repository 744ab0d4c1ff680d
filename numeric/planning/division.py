"""Large packings: which are swept by segments, and by how many layers."""

import math
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from typing import NamedTuple

from ..arithmetic.systems import FLOAT64
from ..lattice.layers import Region, Rows
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..scene.scene import Scene
from .memory import COMPILED, INTERPRETER, NAMES, PLAN_LAYER, TEXT, size
from .plan import Method

# Bytes of a number of the answer.
_NUMBER = 20
# Bytes from which on fewer layers are kept, and found once more on the way down; the fewest layers
# of a segment then.
_MANY, _FEWEST = 600_000_000, 16
# Beads from which on segments take less time than fresh memory for all of them, which the system
# has to hand out: 0.25 µs a bead instead of 0.4, and of 10⁷ instead of 1 (on a busy machine).
QUICKER = 5_000_000
# Layers that are solved beside those of a segment.
_BESIDE = 5


def suits(scene: Scene, tolerance: Fraction | None) -> bool:
    """Say whether a scene's packing could be swept by segments, as far as is plain at once.

    With a tolerance it is not: segments are swept in float64 alone.
    """
    return (
        scene.ask.realisations == 1
        and tolerance is None
        and scene.disorder is not None
        and scene.effects.geometry == "exact"
        and not scene.effects.stop_at_tension
        and find_spec("numba") is not None
    )


class Division(NamedTuple):
    """The layers of a segment, an even number; below every how manyth a layer is kept; bytes."""

    layers: int
    every: int
    bytes: int


def division(widest: int, height: int, dimension: int, limit: int) -> Division:
    """Give what takes the least memory, of layers of so many beads at most.

    That is with a layer kept below every segment, if it takes no more than ``limit``.
    """
    # of a bead of a segment: δr, c, δn with their errors, forces, and what is gathered; of one that
    # is kept on the way up: c
    bead, kept = 16 * (1 + dimension + dimension**2) + 74 * dimension, 16 * dimension
    k = max(2, 2 * round(math.sqrt(kept / bead * (height + 1)) / 2))
    usual = widest * (bead * (k + _BESIDE) + kept * (height // k + 1))
    if usual <= min(limit, _MANY):
        return Division(k, 1, usual)
    k = max(_FEWEST, 2 * round((kept / bead * math.sqrt(height + 1)) ** (2 / 3) / 2))
    every = max(1, math.isqrt(height // k))
    less = widest * (bead * (k + _BESIDE) + kept * (height // (k * every) + every + 1))
    return min(Division(k, every, less), Division(k, 1, usual), key=lambda one: one.bytes)


def _divided(problem: Problem, limit: int) -> Division:
    return division(problem.region.widest, problem.region.top, problem.dimension, limit)


def cut(
    problem: Problem,
    method: Method,
    scene: Scene,
    tolerance: Fraction | None,
    limit: int = _MANY,
) -> Problem | None:
    """Give the problem swept by segments, in so many bytes if that can be; None if it can't."""
    if not suits(scene, tolerance) or method.system is not FLOAT64 or problem.route != Route.EXACT:
        return None
    found = _divided(problem, limit)
    return replace(problem, segment=found.layers, every=found.every)


def memory(problem: Problem, quantity: Quantity, *, text: bool) -> int:
    """Estimate the bytes at the peak."""
    counted = quantity.name == "histogram"  # one segment after the other
    region = Region(problem.width, Rows()) if counted else problem.region
    rows = quantity.answer_rows(region, 1)
    found = _divided(problem, _MANY if problem.every == 1 else 0)
    return (
        found.bytes
        + rows * (quantity.numbers * (_NUMBER + text * TEXT) + text * NAMES)
        + len(problem.region.rows) * PLAN_LAYER
        + INTERPRETER
        + COMPILED
    )


def why(needed: int, limit: int) -> str:
    """Say why a packing of so many bytes is swept by segments."""
    if needed <= limit:
        return f"{size(needed)} of memory that was not used before take longer"
    return f"{size(needed)} of memory would be needed and {size(limit)} may be used"
