"""What accuracy costs: every way to answer a scene's question, its error beside its time.

Errors are relative to the largest |change| of the answer, and are distances from a reference. For
one packing the reference is certified: balls enclose it, and their radius is added to every error.
For an ensemble (see ``ensemble``) it is estimated. Times and memory are measurements.
"""

from collections.abc import Callable, Iterator
from decimal import Decimal
from fractions import Fraction
from functools import partial

from ...arithmetic.errors import UndecidedError
from ...arithmetic.systems import FLOAT64, LONGDOUBLE, NumberSystem
from ...disorder.radii import RadiusError
from ...mechanics.problem import Route
from ...mechanics.sweep import NotStandingError, UnbuildableError
from ...planning import planner
from ...planning.plan import Skipped
from ...quantities.base import Table, first_order_std
from ...scene.checks import refuse
from ...scene.scene import Scene
from ...scene.sections import SceneError
from .of_profile import study_ensemble
from .reference import BEYOND, CertifiedReference, IncomparableError
from .rows import Reference, Way, marked
from .table import CostStudy
from .ways import Notice, answer, measured, systems, why_not_plain, with_geometry

_FAILURES = (UnbuildableError, UndecidedError, NotStandingError, RadiusError, IncomparableError)


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
    true = CertifiedReference(plan)
    nothing = Decimal(0)
    rows: list[Way] = []
    skipped = list(_never(scene))
    exact = plan.problem.route == Route.EXACT

    def measure(
        way: str, system: NumberSystem, work: Callable[[], Table], model: CertifiedReference | None
    ) -> None:
        notice(f"{way}, {system.name}")
        try:
            table, costs = measured(work, system)
            error, bound = true.error(table), true.bound(table)
            rounding = error if model is None else model.error(table, true.largest)
        except _FAILURES as failed:
            skipped.append(Skipped(f"{way}, {system.name}", str(failed)))
            return
        wrong = nothing if model is None else true.error(model.table)
        rows.append(Way(way, system.name, None, error, wrong, rounding, None, bound, **costs))

    if exact:
        if scene.effects.stop_at_tension:
            skipped.append(Skipped("first-order line sums", "they do not stop at tension"))
        else:
            linear = planner.plan(with_geometry(one, "first-order"), BEYOND)
            model = CertifiedReference(linear)
            name = "first-order line sums"
            measure(name, FLOAT64, partial(answer, linear, FLOAT64, [0]), model)
    else:
        reason = "the scene asks for the first-order theory"
        skipped.append(Skipped("exact, deviation form", reason))
    own = "exact, deviation form" if exact else "first-order line sums"
    why = why_not_plain(plan)
    if why is not None:
        skipped.append(Skipped("exact, plain form", why))
    for system in systems():
        measure(own, system, partial(answer, plan, system, [0]), None)
        if why is None:
            work = partial(answer, plan, system, [0], plainly=True)
            measure("exact, plain form", system, work, None)
    what = "the first realisation" if scene.ask.realisations > 1 else "the packing"
    reference = Reference("certified", what, true.system.name, true.radius)
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
    if LONGDOUBLE.bits <= FLOAT64.bits:
        yield Skipped("longdouble", "on this machine it is no longer than float64")
