"""What accuracy costs: every way to answer a scene's question, its error beside its time.

Errors are relative to the largest |change| of the answer, and are distances from a reference. For
one packing the reference is certified: balls enclose it, and their radius is added to every error.
For an ensemble (``numeric.cost.ensemble``) it is estimated. Times and memory are measurements.
"""

import math
import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from fractions import Fraction
from functools import partial
from statistics import median
from time import perf_counter
from typing import TypeVar

from numeric import planner
from numeric.answers import Profile, Table
from numeric.cost.truth import BEYOND, DIGITS, IncomparableError, Truth
from numeric.cost.ways import answer, solve_plainly, why_not_plain
from numeric.forces import NotStandingError
from numeric.packing import UnbuildableError, UndecidedError
from numeric.plans import Skipped
from numeric.radii import RadiusError
from numeric.scene import Scene, SceneError
from numeric.systems import FLOAT64, LONGDOUBLE, Balls, BigFloat, NumberSystem

LEAST_RUNS, MOST_RUNS, ENOUGH_SECONDS = 3, 15, 0.2
# After so many seconds no further run is timed: slow rows scatter little, and a study stays short.
LONG_SECONDS = 2.0
_FAILURES = (UnbuildableError, UndecidedError, NotStandingError, RadiusError, IncomparableError)
T = TypeVar("T")
Notice = Callable[[str], None]
"""Called with the name of each way before it is measured."""


@dataclass(frozen=True)
class Row:
    """One way to the answer. Errors are relative to the largest |change|; None: does not apply.

    ``error`` is measured against the reference, the radius of a certified one added. Of its parts
    ``model_error`` is that of what is computed, ``rounding_error`` that of the arithmetic,
    ``sampling_error`` that of a finite ensemble. ``certified_bound`` is what the way itself
    certifies of its error (balls only). ``seconds`` is the median of ``runs`` runs, a warm-up not
    counted. ``peak_bytes``: what Python and NumPy allocate, by tracemalloc, in a run of its own;
    where ``peak_is_bound``, it is a lower bound: the limbs of big numbers, which flint and GMP
    allocate, are not in it. ``pareto``: no other row has a smaller measured error and median time.
    """

    way: str
    arithmetic: str
    realisations: int | None
    error: Decimal
    model_error: Decimal | None
    rounding_error: Decimal | None
    sampling_error: Decimal | None
    certified_bound: Decimal | None
    seconds: float
    seconds_min: float
    seconds_max: float
    runs: int
    peak_bytes: int
    peak_is_bound: bool
    pareto: bool = False


@dataclass(frozen=True)
class Reference:
    """What errors are measured against; ``radius`` is its own error, relative as theirs.

    ``kind`` is "certified" (then the radius is a bound) or "estimated" (a standard error).
    """

    kind: str
    what: str
    arithmetic: str
    radius: Decimal


@dataclass(frozen=True)
class Study:
    """All ways to one answer; ``sampling_floor`` is the standard error of the scene's ensemble."""

    quantity: str
    reference: Reference
    rows: tuple[Row, ...]
    skipped: tuple[Skipped, ...]
    sampling_floor: Decimal | None = None


def study(scene: Scene, notice: Notice = lambda _: None) -> Study:
    """Measure every way that applies to a scene's question.

    Raises ``SceneError`` where nothing changes or the study is too large, ``TableError``,
    ``ToleranceError`` where no reference is found, and what the sweeps raise.
    """
    plan = planner.plan(scene, Fraction(1, 10))
    if plan.route == "ordered":
        why = "every change is exactly zero here: there is nothing that errors could be relative to"
        raise SceneError("ask.quantity", scene.ask.quantity, why)
    if scene.ask.quantity == "profile" and Profile(plan, FLOAT64).theory_applies():
        from numeric.cost.ensemble import study_ensemble

        return study_ensemble(scene, notice)
    return _study_one(scene, notice)


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


def _study_one(scene: Scene, notice: Notice) -> Study:
    """Measure the ways to the answer of one packing, the scene's first realisation."""
    one = scene.model_copy(update={"ask": scene.ask.model_copy(update={"realisations": 1})})
    plan = planner.plan(one, BEYOND)
    notice("reference")
    true = Truth(plan)
    nothing = Decimal(0)
    rows: list[Row] = []
    skipped = list(_never(scene))

    def measure(
        way: str, system: NumberSystem, work: Callable[[], Table], model: Truth | None
    ) -> None:
        notice(f"{way}, {system.name}")
        try:
            table, seconds, peak = measured(work)
            error, bound = true.error(table), true.bound(table)
            rounding = error if model is None else model.error(table, true.largest)
        except _FAILURES as failed:
            skipped.append(Skipped(f"{way}, {system.name}", str(failed)))
            return
        wrong = nothing if model is None else true.error(model.table)
        rows.append(row(way, system.name, seconds, peak, error, (wrong, rounding, None), bound))

    if plan.route == "exact":
        if scene.effects.stop_at_tension:
            skipped.append(Skipped("first-order line sums", "they do not stop at tension"))
        else:
            linear = planner.plan(with_geometry(one, "first-order"), BEYOND)
            model = Truth(linear)
            name = "first-order line sums"
            measure(name, FLOAT64, partial(answer, linear, FLOAT64, [0]), model)
    else:
        reason = "the scene asks for the first-order theory"
        skipped.append(Skipped("exact, deviation form", reason))
    own = "exact, deviation form" if plan.route == "exact" else "first-order line sums"
    why = why_not_plain(plan)
    if why is not None:
        skipped.append(Skipped("exact, plain form", why))
    for system in systems():
        measure(own, system, partial(answer, plan, system, [0]), None)
        if why is None:
            work = partial(answer, plan, system, [0], solve_plainly)
            measure("exact, plain form", system, work, None)
    what = "the first realisation" if scene.ask.realisations > 1 else "the packing"
    reference = Reference("certified", what, true.system.name, true.radius)
    return Study(scene.ask.quantity, reference, marked(rows), tuple(skipped))


def _never(scene: Scene) -> Iterator[Skipped]:
    """List what answers for ensembles only."""
    if scene.ask.quantity == "profile":
        why = (
            "an exact first-order σ_f is known for drawn radii, W > M and an upright surface or "
            "bulk load only; the profile of one packing is studied"
        )
    else:
        why = f"'{scene.ask.quantity}' is studied for one packing, and this is about an ensemble"
    for way in ("printed asymptotic formula", "exact finite-M formula", "Monte Carlo"):
        yield Skipped(way, why)
    if LONGDOUBLE.bits <= FLOAT64.bits:
        yield Skipped("longdouble", "on this machine it is no longer than float64")


def measured(work: Callable[[], T]) -> tuple[T, list[float], int]:
    """Run once, tracing memory, as a warm-up; then several times by the clock.

    Gives the result, the seconds of each timed run and the peak of traced memory in bytes.
    """
    tracemalloc.start()
    try:
        result = work()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    seconds: list[float] = []
    while math.fsum(seconds) < LONG_SECONDS and (
        len(seconds) < LEAST_RUNS
        or (len(seconds) < MOST_RUNS and math.fsum(seconds) < ENOUGH_SECONDS)
    ):
        start = perf_counter()
        work()
        seconds.append(perf_counter() - start)
    return result, seconds, peak


def row(
    way: str,
    arithmetic: str,
    seconds: Sequence[float],
    peak: int,
    error: Decimal,
    parts: tuple[Decimal | None, Decimal | None, Decimal | None],
    bound: Decimal | None = None,
    realisations: int | None = None,
) -> Row:
    """Make a row; ``parts`` are model, rounding and sampling error."""
    return Row(
        way, arithmetic, realisations, error, *parts, bound,
        median(seconds), min(seconds), max(seconds), len(seconds), peak,
        arithmetic not in {FLOAT64.name, LONGDOUBLE.name},
    )  # fmt: skip


def marked(rows: Sequence[Row]) -> tuple[Row, ...]:
    """Mark the rows on the Pareto front, and sort all by error, the largest first."""
    front = pareto([(r.seconds, r.error) for r in rows])
    done = [replace(r, pareto=best) for r, best in zip(rows, front, strict=True)]
    return tuple(sorted(done, key=lambda r: -r.error))


def pareto(points: Sequence[tuple[float, Decimal]]) -> list[bool]:
    """Tell which (seconds, error) no other point beats in one without losing in the other.

    >>> pareto([(1, Decimal(3)), (2, Decimal(1)), (2, Decimal(2)), (3, Decimal(1))])
    [True, True, False, False]
    """
    return [
        not any(s <= seconds and e <= error and (s, e) != (seconds, error) for s, e in points)
        for seconds, error in points
    ]
