"""The memory that a scene takes, and the limit above which it is refused."""

from collections.abc import Sequence

from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..lattice.layers import Region, Rows
from ..mechanics.engine import chunk_size
from ..mechanics.problem import Problem, Route
from ..quantities.base import Quantity
from ..scene.scene import CheckedScene
from ..scene.sections import SceneError

# Bytes of a bead of balls, a packing whose rows are listed, and a line of a file; measured, rounded
# up. The rest is the interpreter with its libraries.
BALL_BEAD, LISTED, FILE_LINE = 2200, 2700, 600
# Bytes of a layer: in the plan, and while it is solved in memory.
PLAN_LAYER, SOLVED_LAYER = 150, 750
# What a row of the answer takes: its names, a number, and that as text.
NAMES, FLOAT_NUMBER, TEXT, BALL_ROW = 100, 60, 190, 1300
INTERPRETER = 84_000_000
# The library that loads compiled loops. Compiling them, once on a machine, takes 150 MB more.
COMPILED = 60_000_000


def float_bead(dimension: int) -> int:
    """Give the bytes of a bead while it is solved in float64; measured up to d = 3, rounded up.

    δr, c and δn are 1 + d + d² numbers, with their errors; forces, loads and gaps a few times d.
    """
    return 16 * (1 + dimension + dimension**2) + 99 * dimension


class TooLargeError(SceneError):
    """A scene needs more memory than there is."""


def memory(
    quantities: Sequence[Quantity], problem: Problem, system: NumberSystem, *, text: bool
) -> int:
    """Estimate the bytes at the peak; the rows of the answer become ``text`` or not."""
    n, region = problem.realisations, problem.region
    together = min(n, chunk_size(problem, system))
    at_once = region.beads * together
    if problem.route == Route.LINE_SUMS:  # one realisation after the other
        at_once = problem.line_beads * 2 // 3  # they are summed, which takes less
    elif problem.route == Route.ORDERED and problem.dimension == 2:
        at_once = 0
    at_once += sum(quantity.gathered(region, together) for quantity in quantities)
    loops = COMPILED * (problem.route == Route.EXACT)
    return _bytes(quantities, region, at_once, n, system, text=text) + loops


def refuse_beads(quantities: Sequence[Quantity], beads: int, room: int, *, text: bool) -> None:
    """Refuse what takes more than ``room``: so many ``beads``, and the plan itself."""
    scene = quantities[0].scene
    layers = 0 if quantities[0].single and not beads else scene.packing.height + 1
    nothing = Region(scene.packing.width, Rows())
    needed = _bytes(quantities, nothing, beads, 1, FLOAT64, text=text)
    refuse_memory(scene, needed + layers * PLAN_LAYER, room)


def _bytes(
    quantities: Sequence[Quantity],
    region: Region,
    beads: int,
    realisations: int,
    system: NumberSystem,
    *,
    text: bool,
) -> int:
    """Estimate the bytes of so many ``beads`` solved at once, and of the rows of the answer."""
    scene = quantities[0].scene
    each = float_bead(scene.packing.dimension)
    if isinstance(system, Balls):
        each = BALL_BEAD * max(64 + system.bits, 128) // 128
    if scene.disorder is not None and scene.disorder.file is not None:
        each += FILE_LINE
    needed = beads * each + len(region.rows) * (PLAN_LAYER + SOLVED_LAYER) + INTERPRETER
    for quantity in quantities:
        row = NAMES + quantity.numbers * (FLOAT_NUMBER + TEXT * text)
        row = BALL_ROW if isinstance(system, Balls) else row
        listed = 0 if quantity.merged or realisations == 1 else realisations
        needed += quantity.answer_rows(region, realisations) * row + listed * LISTED
        needed += quantity.kept(region, realisations)
    return needed


def refuse_memory(scene: CheckedScene, needed: int, room: int) -> None:
    """Raise ``TooLargeError`` where a scene needs more than ``room``, the bytes that may be used.

    Of the height, the width and the realisations the largest is named.
    """
    if needed > room:
        packing = scene.packing
        sizes = {
            "packing.height": packing.height,
            "packing.width": packing.width or 0,
            "ask.realisations": scene.ask.realisations,
        }
        key = max(sizes, key=sizes.__getitem__)
        needs = f"this scene would need about {size(needed)} of memory"
        less = "a smaller packing needs less"
        if key == "ask.realisations":
            less = "the command ensemble needs less, since it keeps sums alone"
        raise TooLargeError(key, sizes[key], f"{needs} and {size(room)} may be used; {less}")


def size(number: int) -> str:
    """Write bytes as a person would.

    >>> size(123), size(45_600_000), size(10**40)
    ('123 B', '45.6 MB', '1e+25 PB')
    """
    units = ("B", "kB", "MB", "GB", "TB", "PB")
    power = min((len(str(number)) - 1) // 3, len(units) - 1)
    return f"{number / 1000**power:.3g} {units[power]}"
