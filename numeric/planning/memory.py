"""The memory that a scene takes, and what is refused as too much."""

from ..arithmetic.carried import Pairs
from ..arithmetic.systems import FLOAT64, NumberSystem
from ..lattice.layers import Region
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
COMPILED = 120_000_000


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
        + len(region.rows) * (PLAN_LAYER + SOLVED_LAYER)
        + INTERPRETER
    )


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
