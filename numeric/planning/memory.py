"""The memory that a scene takes: what is swept by segments, and what is refused as too much."""

import math
from dataclasses import replace
from fractions import Fraction
from importlib.util import find_spec
from typing import NamedTuple

from ..arithmetic.carried import Pairs
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..lattice.layers import Region, Rows
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..scene.scene import Scene
from ..scene.sections import SceneError

# Bytes of a bead of balls, a packing whose rows are listed, and a line of a file; measured, rounded
# up. The rest is the interpreter with its libraries.
BALL_BEAD, LISTED, FILE_LINE = 2200, 3500, 600
# Bytes of a layer: in the plan, and while it is solved in memory.
PLAN_LAYER, SOLVED_LAYER = 150, 750
# What a row of the answer takes: its names, a number, and that as text.
NAMES, FLOAT_NUMBER, TEXT, BALL_ROW = 100, 60, 150, 1300
INTERPRETER = 85_000_000
# The compiler that the extra ``fast`` brings, and what it leaves behind.
COMPILED = 150_000_000
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


def float_bead(dimension: int) -> int:
    """Give the bytes of a bead while it is solved in float64; measured up to d = 3, rounded up.

    δr, c and δn are 1 + d + d² numbers, with their errors; forces, loads and gaps a few times d.
    """
    return 16 * (1 + dimension + dimension**2) + 99 * dimension


class TooLargeError(SceneError):
    """A scene needs more memory than there is."""


def memory(
    quantity: Quantity,
    region: Region,
    beads: int,
    realisations: int,
    system: NumberSystem,
    *,
    text: bool,
) -> int:
    """Estimate the bytes at the peak.

    ``beads`` are those solved at once, ``region`` is that of the plan; the rows of the answer
    become ``text`` or not.
    """
    scene, big = quantity.scene, system.dtype is object
    each = float_bead(scene.packing.dimension) * (1 if system is FLOAT64 else 3)
    if big and not isinstance(system, Pairs):
        each = BALL_BEAD * max(64 + system.bits, 128) // 128
    if scene.disorder is not None and scene.disorder.file is not None:
        each += FILE_LINE
    row = BALL_ROW if big else NAMES + quantity.numbers * (FLOAT_NUMBER + TEXT * text)
    listed = 0 if quantity.merged or realisations == 1 else realisations
    return (
        beads * each
        + quantity.answer_rows(region, realisations) * row
        + listed * LISTED
        + quantity.kept(region, realisations)
        + len(region.rows) * (PLAN_LAYER + SOLVED_LAYER)
        + INTERPRETER
    )


def has_segments(scene: Scene, tolerance: Fraction | None) -> bool:
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


def by_segments(
    problem: Problem,
    system: NumberSystem,
    scene: Scene,
    tolerance: Fraction | None,
    limit: int = _MANY,
) -> tuple[Problem, Division] | None:
    """Give the problem swept by segments, in so many bytes if that can be; None if it can't."""
    exact = problem.route == Route.EXACT and system is FLOAT64
    if not (exact and has_segments(scene, tolerance)):
        return None
    found = division(problem.region.widest, problem.region.top, problem.dimension, limit)
    return replace(problem, segment=found.layers, every=found.every), found


def divided(
    quantity: Quantity,
    problem: Problem,
    system: NumberSystem,
    tolerance: Fraction | None,
    needed: int,
    limit: int,
    *,
    text: bool,
) -> tuple[Problem, int, str]:
    """Sweep by segments what needs more than ``limit`` bytes otherwise, or more time.

    Gives the problem, the bytes at the peak, and why there are segments, if there are.
    """
    cut = None
    if needed > limit or problem.region.beads > QUICKER:
        cut = by_segments(problem, system, quantity.scene, tolerance, limit)
    if cut is None:
        return problem, needed, ""
    why = f"{size(needed)} of memory that was not used before take longer"
    if needed > limit:
        why = f"{size(needed)} of memory would be needed and {size(limit)} may be used"
    problem, found = cut
    counted = quantity.name == "histogram"  # one segment after the other
    region = Region(problem.width, Rows()) if counted else problem.region
    row = quantity.numbers * (_NUMBER + text * TEXT) + text * NAMES
    rows = quantity.answer_rows(region, 1) * row + len(problem.region.rows) * PLAN_LAYER
    return problem, found.bytes + rows + INTERPRETER + COMPILED, why


def refuse_beads(
    quantity: Quantity, beads: int, tolerance: Fraction | None, limit: int, *, text: bool
) -> None:
    """Refuse what surely takes too much memory before a single row of ``beads`` is made."""
    scene, packing = quantity.scene, quantity.scene.packing
    layers = 0 if quantity.single and not beads else packing.height + 1
    nothing, rows = Region(packing.width, Rows()), layers * PLAN_LAYER
    needed = memory(quantity, nothing, beads, 1, FLOAT64, text=text)
    if needed + rows > limit and has_segments(scene, tolerance):
        height = packing.height
        widest = min(packing.width or 2 * height + 2, -(-2 * beads // (height + 1)))
        needed = min(needed, division(widest, height, packing.dimension, 0).bytes)
    refuse_memory(scene, needed + rows, limit)


def refuse_memory(scene: Scene, needed: int, limit: int) -> None:
    """Raise ``TooLargeError`` with the size where a scene needs more than ``limit`` bytes.

    Of the height, the width and the realisations the largest is named.
    """
    if needed <= limit:
        return
    less = "less, or for a smaller packing"
    if scene.ask.quantity == "response" and scene.ask.layers is None:
        less = "some layers of the response, as with ask.layers = [0], or for a smaller packing"
    packing, realisations = scene.packing, scene.ask.realisations
    sizes = [("packing.height", packing.height), ("packing.width", packing.width or 0)]
    key, value = max([*sizes, ("ask.realisations", realisations)], key=lambda one: one[1])
    raise TooLargeError(
        key,
        value,
        f"this scene would need about {size(needed)} of memory and {size(limit)} may be used: ask "
        f"for {less}",
    )


def size(number: int) -> str:
    """Write bytes as a person would.

    >>> size(123), size(45_600_000), size(10**40)
    ('123 B', '45.6 MB', '1e+25 PB')
    """
    units = ("B", "kB", "MB", "GB", "TB", "PB")
    power = min((len(str(number)) - 1) // 3, len(units) - 1)
    return f"{number / 1000**power:.3g} {units[power]}"
