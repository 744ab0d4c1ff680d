"""What a scene will cost, estimated before it starts, and what is refused as too much."""

import os
from fractions import Fraction

from force_diffusion.numeric.arithmetic.systems import FLOAT64, NumberSystem
from force_diffusion.numeric.lattice import regions
from force_diffusion.numeric.lattice.layers import Region
from force_diffusion.numeric.scene.sections import Scene, SceneError

# Bytes that a bead takes while it is solved, a row of the answer, a line of a file and a layer of
# the plan; measured, rounded up. The rest is the interpreter with its libraries.
FLOAT_BEAD, BALL_BEAD, ANSWER_ROW, FILE_LINE, PLAN_LAYER = 450, 2200, 1700, 600, 900
INTERPRETER = 100_000_000
DEFAULT_BINS = 20
# No arithmetic of more bits is tried.
MOST_BITS = 8192
LONGEST = 24 * 3600.0
# Realisations that are solved twice to estimate the error: four of packings that are small.
FEW, SMALL = 4, 20_000


def one_contact(scene: Scene) -> bool:
    """Say whether one contact is asked for, and not the whole packing."""
    ask = scene.ask
    return ask.quantity == "contact" or (ask.quantity == "histogram" and ask.at is not None)


def initial_bits(tolerance: Fraction, height: int) -> int:
    """Choose a first precision for balls: the digits asked for, the loss up and down, a margin."""
    digits = max(tolerance.denominator.bit_length() - tolerance.numerator.bit_length(), 0)
    return digits + 4 * height.bit_length() + 48


def chunk_size(region: Region, system: NumberSystem, scene: Scene) -> int:
    """Say how many realisations are swept together: as many as keep the arrays small."""
    if system.dtype is object or scene.effects.stop_at_tension:
        return 1
    return max(1, 200_000 // max(region.beads, 1))


def repeated(region: Region, realisations: int) -> int:
    """Say how many realisations are solved again to estimate the error."""
    return min(realisations, FEW if region.beads < SMALL else 1)


def cores() -> int:
    """Give the number of cores that may be used."""
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        return os.cpu_count() or 1


def memory_limit() -> int:
    """Give the bytes that may be used: most of the free memory, 1 GB where that is unknown."""
    try:
        return int(0.8 * os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (ValueError, OSError, AttributeError):
        return 10**9


def bound_of_beads(scene: Scene, *, closed: bool) -> int:
    """Bound the beads to be solved, before a single row of them is made.

    ``closed`` says that closed forms or line sums answer the question.
    """
    M, W = scene.packing.height, scene.packing.width
    contact = one_contact(scene)
    if closed and (contact or (scene.ask.quantity == "positions" and scene.ask.at)):
        return 5 * M
    if scene.ask.quantity == "positions" and scene.ask.at is not None:
        layers = scene.site[1] + 1
        beads = regions.triangle_beads(scene.site[1])
    elif scene.load.at is not None and scene.ask.quantity != "positions":
        layers = scene.load.at[1] + 1
        beads = regions.triangle_beads(scene.load.at[1])
    elif contact:
        layers = M + 1
        beads = regions.contact_beads(scene.contact[1], M)
    else:
        layers = M + 1
        beads = layers * (W or layers)
    return beads if W is None else min(beads, W * layers)


def answer_rows(scene: Scene, region: Region, realisations: int) -> int:
    """Bound the number of rows of the answer (a histogram's changes count for a little)."""
    quantity, width = scene.ask.quantity, scene.packing.width
    if quantity == "histogram":
        changes = 1 if one_contact(scene) else region.beads // 50
        return (scene.ask.bins or 1) + realisations * changes
    if quantity == "contact_forces" and width is not None:
        return 2 * width * scene.packing.height * realisations
    one = {
        "contact": 1,
        "positions": 1 if scene.ask.at is not None else region.beads,
        "contact_forces": 2 * region.beads,
        "response": 2 * region.beads,
        "base_reactions": region.rows[0].count if region.rows else 1,
        "profile": 2 * scene.packing.height,
    }[quantity]
    return one * (1 if quantity in {"profile", "response"} else realisations)


def memory(
    scene: Scene,
    region: Region,
    *,
    beads: int,
    layers: int,
    realisations: int,
    system: NumberSystem,
) -> int:
    """Estimate the bytes at the peak; ``beads`` are those solved at once, in ``layers`` rows."""
    each = FLOAT_BEAD if system is FLOAT64 else 2 * FLOAT_BEAD
    if system.dtype is object:
        each = BALL_BEAD * max(64 + system.bits, 128) // 128
    file = scene.disorder is not None and scene.disorder.file is not None
    return (
        beads * (each + (FILE_LINE if file else 0))
        + answer_rows(scene, region, realisations) * ANSWER_ROW
        + layers * PLAN_LAYER
        + INTERPRETER
    )


def refuse_memory(scene: Scene, needed: int, limit: int) -> None:
    """Raise ``SceneError`` with the size where a scene needs more than ``limit`` bytes."""
    if needed > limit:
        raise SceneError(
            "packing.height",
            scene.packing.height,
            f"this scene would need about {_size(needed)} of memory and {_size(limit)} may be "
            "used: ask for less, or for a smaller packing",
        )


def refuse_seconds(scene: Scene, realisations: int, seconds: float) -> None:
    """Raise ``SceneError`` where a scene would take more than a day."""
    if seconds > LONGEST:
        key, value = ("packing.height", scene.packing.height)
        if realisations > 1:
            key, value = ("ask.realisations", realisations)
        raise SceneError(
            key,
            value,
            f"this scene would take about {seconds / 86400:.3g} days, and one is allowed: "
            "ask for fewer realisations or a smaller packing",
        )


def _size(size: int) -> str:
    """Write bytes as a person would.

    >>> _size(123), _size(45_600_000), _size(10**40)
    ('123 B', '45.6 MB', '1e+25 PB')
    """
    units = ("B", "kB", "MB", "GB", "TB", "PB")
    power = min((len(str(size)) - 1) // 3, len(units) - 1)
    return f"{size / 1000**power:.3g} {units[power]}"
