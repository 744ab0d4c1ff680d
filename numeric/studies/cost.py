"""What accuracy costs: every way to answer a scene's question, its error beside its time.

Errors are relative to the largest |change| of the answer, and are distances from a reference. For
one packing the reference is certified: balls enclose it, and their radius is added to every error.
For an ensemble (see ``of_profile``) it is estimated. Times and memory are measurements.
"""

from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from typing import Any

import flint

from ..arithmetic.systems import FLOAT64, Array, NumberSystem, largest_of
from ..mechanics.problem import Route
from ..planning import planner
from ..planning.plan import Plan, Skipped
from ..quantities.base import Table, first_order_std
from ..scene.scene import Scene, refuse
from ..scene.sections import SceneError
from .distances import FAILURES, answer, changes
from .of_profile import study_ensemble
from .reference import BEYOND, certified
from .rows import Reference, Way, marked
from .table import CostStudy
from .ways import Notice, measured, systems, with_geometry

EXACT, LINE_SUMS = "exact", "first-order line sums"


def cost(scene: Scene, notice: Notice = lambda _: None) -> CostStudy:
    """Measure what accuracy costs: every way that answers a scene, its error beside its time.

    ``notice`` is told the name of each way before it is measured. Raises ``SceneError`` where
    nothing changes or the study is too large, ``TableError``,
    ``ToleranceError`` where no reference is found, and what the sweeps raise.

    >>> import force_diffusion as fd
    >>> scene = fd.Scene(
    ...     packing=fd.Packing(height=3, width=6),
    ...     disorder=fd.Disorder(kind="uniform", relative_std=1e-6, seed=1),
    ...     ask=fd.Ask(quantity="contact_forces"),
    ... )
    >>> found = fd.cost(scene)
    >>> way, error = found.arrays["way"], found.arrays["error"]
    >>> bool(error[way == "first-order line sums"].min() > 1e-8 > 1e-100 > error.min())
    True
    """
    if not isinstance(scene, Scene):
        raise TypeError(
            f"cost takes a scene, not {type(scene).__name__}: Scene(…) or read_scene(path)"
        )
    refuse("cost", scene)
    plan = planner.plan(scene, Fraction(1, 10))
    if plan.problem.route == Route.ORDERED:
        why = "every change is exactly zero here: there is nothing that errors could be relative to"
        raise SceneError("ask.quantity", scene.ask.quantity, why)
    upright = scene.ask.quantity == "profile" and not plan.problem.load.angle_deg
    if upright and first_order_std(plan.problem) is not None:
        return study_ensemble(scene, notice)
    return _study_one(scene, notice)


def _study_one(scene: Scene, notice: Notice) -> CostStudy:
    """Measure the ways to the answer of one packing, the scene's first realisation."""
    one = scene.model_copy(update={"ask": scene.ask.model_copy(update={"realisations": 1})})
    plan = planner.plan(one, BEYOND)
    notice("reference")
    true = certified(one)
    rows: list[Way] = []
    skipped = list(_never(scene))

    def measure(
        way: str, system: NumberSystem, of: Plan, meant: Array | None = None, **how: bool
    ) -> None:
        def judged(table: Table) -> dict[str, Any]:
            found = changes(table)
            radii = [value.rad() for value in found if isinstance(value, flint.arb)]
            bound = true.relative(largest_of(radii)) if radii else None
            return true.errors(found, meant) | {"certified_bound": bound}

        notice(f"{way}, {system.name}")
        try:
            rows.append(measured(way, system, partial(answer, of, system, [0], **how), judged))
        except FAILURES as failed:
            skipped.append(Skipped(f"{way}, {system.name}", str(failed)))

    own = EXACT
    if plan.problem.route != Route.EXACT:
        own = LINE_SUMS
        skipped.append(Skipped(EXACT, "the scene asks for the first-order theory"))
    else:
        first = with_geometry(one, "first-order")
        measure(LINE_SUMS, FLOAT64, planner.plan(first, BEYOND), certified(first).best)
    for system in systems():
        measure(own, system, plan)
    what = "the first realisation" if scene.ask.realisations > 1 else "the packing"
    reference = Reference("certified", what, true.system.name, true.relative(true.radius))
    return CostStudy(scene.ask.quantity, reference, marked(rows), tuple(skipped))


def _never(scene: Scene) -> Iterator[Skipped]:
    """List what answers for ensembles only."""
    if scene.ask.quantity == "profile":
        why = (
            "formulas are compared for drawn radii, W > M and an upright surface or "
            "bulk load only; the profile of one packing is studied"
        )
    else:
        why = f"'{scene.ask.quantity}' is studied for one packing, and this is about an ensemble"
    for way in ("printed asymptotic formula", "exact finite-M formula", "Monte Carlo"):
        yield Skipped(way, why)
