"""From a scene to a plan: which beads, what is left out, and in which numbers.

One planner serves both explaining and running: ``run`` takes its problem and its numbers from here.

A tolerance chooses the arithmetic: float64 where that should do, and else balls with as many bits
as it needs. What is promised is measured afterwards; where the estimate of float64 misses the
tolerance, balls answer (see ``run``), whose bits are raised until their bound fits. What a scene
names is never replaced: both answer the same question about the same packings.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from math import isqrt

from ..arithmetic.carried import PRINTED, UNIT
from ..arithmetic.decimals import short
from ..arithmetic.machine import memory_limit
from ..arithmetic.systems import FLOAT64, Balls, NumberSystem
from ..disorder.radii import DrawnRadii, Radii
from ..lattice.layers import Region, Rows
from ..mechanics.problem import Problem, Route
from ..quantities import quantities_of
from ..quantities.base import Quantity
from ..scene.scene import CheckedScene
from ..scene.sections import SceneError
from ..theory.expected import critical_height
from .memory import memory, refuse_beads, refuse_memory
from .plan import Plan
from .sources import beyond_floats, load_of, radii_of

# To which packings are enclosed whose contacts open, relative to the largest force.
TOUCHING = Fraction(1, 10**17)
# Nearer to M* than this, disorder itself grows with the height, and rounding errors with it.
SOUND = 0.5


def plan(
    scene: CheckedScene,
    tolerance: Fraction | None = None,
    *,
    certified: bool = False,
    text: bool = True,
) -> Plan:
    """Plan a scene; ``tolerance`` and ``certified`` override the scene's own.

    With a tolerance balls are chosen where float64 should not meet it; ``certified`` keeps the
    choice to balls. Room is left for rows as ``text``, as files and screens have them. Reads the
    scene's files. Raises ``SceneError`` for a scene that is too large for what is free of the
    memory, and ``TableError``.
    """
    tolerance = tolerance or scene.ask.tolerance
    certified = certified or scene.ask.certified
    if certified and tolerance is None:
        raise SceneError("ask.certified", True, "needs a tolerance, such as tolerance = 1e-30")
    quantities, room = quantities_of(scene), memory_limit()
    problem, skipped = _problem(scene, quantities, room, text=text)
    error = expected(FLOAT64, quantities, problem)
    made = Plan(scene, quantities, problem, tolerance, FLOAT64, "", error, 0, room, skipped)
    reason = why_balls(made, certified=certified)
    if reason:
        return in_balls(made, reason, text=text)
    needed = memory(quantities, problem, FLOAT64, text=text)
    refuse_memory(scene, needed, room)
    return replace(made, memory=needed)


def in_balls(made: Plan, reason: str, *, text: bool = True) -> Plan:
    """Plan the same in balls. Raises ``TooLargeError`` where they take too much memory."""
    tolerance, height = made.tolerance or UNIT, made.problem.height
    if made.problem.route == Route.UNILATERAL:
        tolerance, height = made.tolerance or TOUCHING, 1
    system = Balls(initial_bits(tolerance, height))
    needed = memory(made.quantities, made.problem, system, text=text)
    refuse_memory(made.scene, needed, made.room)
    error = expected(system, made.quantities, made.problem)
    return replace(made, system=system, reason=reason, error=error, memory=needed)


def _problem(
    scene: CheckedScene, quantities: Sequence[Quantity], room: int, *, text: bool
) -> tuple[Problem, dict[str, str]]:
    """Say which beads are solved, by which theory, and what that leaves out.

    Raises ``SceneError`` for a scene that is too large, before any radii are read, and
    ``TableError``.
    """
    skipped: dict[str, str] = {}
    effects, realisations = scene.effects, scene.ask.realisations
    ordered, unilateral = _why_ordered(scene), effects.contacts == "unilateral"
    single = quantities[0].single and bool(ordered or effects.geometry == "first-order")
    beads = 3 * scene.packing.height  # as much as those of five diagonals, which are summed
    if not single:
        beads = max(quantity.fewest_beads for quantity in quantities)
    swept = not ordered or scene.packing.dimension > 2
    refuse_beads(quantities, beads * swept, room, text=text)

    load = load_of(scene)
    needs_forces = any(quantity.needs_forces for quantity in quantities)
    if not needs_forces and "load" in scene.model_fields_set:
        skipped["load"] = "positions follow from the radii alone"
    rows, region = Rows(), Region(load.width, Rows())
    if not single:  # of two questions one needs all beads that the other does
        needed = [quantity.beads(load) for quantity in quantities]
        rows = max((rows for rows, _ in needed), key=len)
        region = max((region for _, region in needed), key=lambda region: region.beads)
        beads = int(region.rows.counts.sum(dtype=float))  # whole numbers could overflow
        refuse_beads(quantities, beads * swept, room, text=text)
    alike = DrawnRadii("uniform", Fraction(0), 0, load.width)
    radii: Radii = alike
    if not ordered:
        radii = radii_of(scene, region.rows)
        if not single and not unilateral:
            if not radii.relative_std:
                ordered = "every delta_r is 0"
            elif not region.rows or (needs_forces and load.loaded == []):
                ordered = "no load reaches what is asked for: the forces are exactly zero"
    if ordered:
        route, radii = Route.ORDERED, alike
        if scene.disorder is not None:
            skipped["disorder"] = ordered
        if realisations > 1:
            skipped["realisations"] = (
                "without disorder all realisations are the same: one is solved"
            )
            realisations = 1
    elif effects.geometry == "first-order":
        route = Route.LINE_SUMS if single else Route.FIRST_ORDER
        skipped["nonlinear geometry"] = 'geometry = "first-order" sums the radii along diagonals'
    else:
        route = Route.UNILATERAL if unilateral else Route.EXACT
    if not ordered and not region.is_whole:
        skipped["other beads"] = "only those that the answer depends on are solved"
    problem = Problem(
        scene.packing.n_x,
        radii,
        load,
        route,
        region,
        rows,
        needs_forces,
        scene.contact,
        scene.site,
        realisations,
        effects.most_programs,
        effects.most_seconds,
    )
    return problem, skipped


def _why_ordered(scene: CheckedScene) -> str:
    """Say why nothing is disordered, where that is plain without reading any file; else nothing."""
    disorder = scene.disorder
    if scene.effects.contacts == "unilateral":
        return ""
    if disorder is None:
        return "all radii are equal"
    if scene.effects.geometry == "ordered":
        return 'geometry = "ordered" looks at the ordered packing only'
    drawn = disorder.kind not in ("file", "given")
    return "its relative_std is 0" if drawn and not disorder.relative_std else ""


def why_balls(made: Plan, *, certified: bool) -> str:
    """Say why float64 won't do for a plan in float64; nothing where it should."""
    problem, tolerance, error = made.problem, made.tolerance, made.error
    if problem.route == Route.ORDERED:
        return "exactly known, whatever is asked"
    if problem.route == Route.UNILATERAL:
        return "found in float64, and proved in balls"
    if certified:
        return "only balls certify"
    if beyond_floats(made.scene, problem.radii, problem.load):
        return "float64 can't hold numbers so small or so large"
    if tolerance is None:
        return ""
    if error is None:
        half = critical_height(problem.radii.relative_std) * SOUND
        return f"the height is above M*/2 = {half:.3g}, where rounding errors grow with it"
    return f"float64 is expected to err by {short(error)}" if error > tolerance else ""


def initial_bits(tolerance: Fraction, height: int) -> int:
    """Choose a first precision for balls: the digits asked for, the loss up and down, a margin."""
    digits = max(tolerance.denominator.bit_length() - tolerance.numerator.bit_length(), 0)
    return digits + 4 * height.bit_length() + 48


def gathering(quantity: Quantity, problem: Problem) -> int:
    """Estimate what gathering a number rounds, in ``UNIT`` of the largest change.

    Of a product with a magnitude two more. Rounding errors have random signs: of sums over a layer,
    which are added up by halves, and of statistics that are merged realisation by realisation. That
    is three times what was measured, of 3 × 5 to 40 × 90 beads and up to 300 realisations.
    """
    units = quantity.roundings
    if quantity.of_forces and quantity.scene.load.magnitude != 1:
        units += 2
    if quantity.merged:
        units += problem.region.widest.bit_length() // 2 + isqrt(problem.realisations)
    return units


def expected(
    system: NumberSystem, quantities: Sequence[Quantity], problem: Problem
) -> Fraction | None:
    """Give the error that an answer is expected to be printed with, relative to its largest change.

    For balls, what they should certify: they lose some bits for the depth of the packing. Numbers
    of float64 are corrected by the errors that their sweep carries; None above M*/2, where these
    grow, too.
    """
    if isinstance(system, Balls):
        exact = problem.route == Route.ORDERED
        return Fraction(0 if exact else max(problem.height, 4) ** 2 * 2**12, 2**system.bits)
    highest = critical_height(problem.radii.relative_std)
    if problem.route == Route.EXACT and problem.height > highest * SOUND:
        return None
    return PRINTED * (1 + max(gathering(quantity, problem) for quantity in quantities)) * UNIT
