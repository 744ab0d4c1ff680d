"""Ways to answer a scene: any plan in any number system, also in the plain form, as one table."""

import math
from collections.abc import Iterator, Sequence

from ...arithmetic.systems import (
    FLOAT64,
    LONGDOUBLE,
    Balls,
    BigFloat,
    NumberSystem,
)
from ...mechanics.engine import packings
from ...mechanics.problem import Route
from ...planning.plan import Plan
from ...quantities.base import Table
from ...scene.scene import Scene

DIGITS = (20, 30, 50, 100, 300)


def systems() -> Iterator[NumberSystem]:
    """All arithmetics: float64, long double where it is longer, mpmath and balls by digits."""
    yield FLOAT64
    if LONGDOUBLE.bits > FLOAT64.bits:
        yield LONGDOUBLE
    yield from (BigFloat(digits) for digits in DIGITS)
    yield from (Balls(math.ceil(digits * math.log2(10))) for digits in DIGITS)


def with_geometry(scene: Scene, geometry: str) -> Scene:
    """Give the scene with another ``effects.geometry``."""
    effects = scene.effects.model_copy(update={"geometry": geometry})
    return scene.model_copy(update={"effects": effects})


def answer(
    plan: Plan, system: NumberSystem, realisations: Sequence[int], *, plainly: bool = False
) -> Table:
    """Answer a plan's question for some realisations; units as in the scene's own answer.

    Raises what the sweeps raise for a packing that can't be built, or not be decided.
    """
    with system.active():
        gatherer = plan.quantity.gatherer(plan.problem, system)
        for solved, chunk in packings(plan.problem, realisations, system, plainly=plainly):
            gatherer.add(solved, chunk, plan.quantity.all_layers)
        return gatherer.table().sorted()


def why_not_plain(plan: Plan) -> str | None:
    """Say why the plain form can't answer a plan; None where it can."""
    if plan.problem.route != Route.EXACT:
        return "it solves the exact packing, and the scene asks for less"
    if plan.problem.width is None:
        return "it is written for periodic packings; the scene's is an infinite slab"
    if plan.problem.stop_at_tension:
        return "it does not stop at tension"
    if not plan.quantity.plain:
        name = plan.quantity.name
        return f"it gives forces and positions, from which '{name}' is not gathered"
    return None
