"""What accuracy costs where an ensemble is asked for: σ_f layer by layer.

The reference is the exact first-order σ_f (Eqs. 13 and 14 at finite M) times an estimated nonlinear
correction √(Σ s²_exact / Σ s²_first-order): both theories on the same realisations, which no Monte
Carlo row uses. It is estimated and never certified; its radius is the standard error of the
correction. A scene that asks for the first-order theory needs no correction.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import (
    FLOAT64,
    Array,
    Balls,
    NumberSystem,
    array,
)
from ..planning import planner
from ..planning.plan import Plan, Skipped
from ..quantities.base import Table
from ..scene.scene import Scene
from .distances import Enclosed, answer, exactly
from .rows import Reference, Way, marked
from .table import CostStudy
from .ways import Notice, measured, systems, with_geometry

# Realisations that the correction and the scatter are estimated from: at least, at most.
LEAST, MOST = 8, 64
# Precision of the closed forms that others are compared with: beyond that of every row.
EXACT = Balls(1200)


def study_ensemble(scene: Scene, notice: Notice) -> CostStudy:
    """Measure every way to σ_f. Raises ``SceneError`` and what the sweeps raise."""
    plans = _plans(scene)
    linear = plans["first-order"]
    notice("reference")
    means, true, reference, sampled = _estimated(scene, plans)
    rows: list[Way] = []
    for way, printed in (("printed asymptotic formula", True), ("exact finite-M formula", False)):
        meant = formula(linear, True, EXACT) if printed else means["first-order"]
        for system in systems():
            notice(f"{way}, {system.name}")
            work = partial(formula, linear, printed, system)
            rows.append(measured(way, system, work, partial(true.errors, meant=meant)))
    for name, plan in plans.items():
        rounding, mean = _rounding(plan, true), means[name]

        def judged(
            table: Table, rounding: Decimal = rounding, mean: Array = mean
        ) -> dict[str, Any]:
            std = _both_branches(table, "std")
            own = {"rounding_error": rounding, "sampling_error": true.off(std, mean)}
            return true.errors(std, mean) | own

        for size in sizes(scene.ask.realisations):
            notice(f"Monte Carlo, {name}, {size} realisations")
            sampled_by = partial(answer, plan, FLOAT64, range(size))
            rows.append(measured(f"Monte Carlo, {name}", FLOAT64, sampled_by, judged, size))
    return CostStudy("profile", reference, marked(rows), tuple(_skipped(scene)), sampled)


def _estimated(
    scene: Scene, plans: Mapping[str, Plan]
) -> tuple[dict[str, Array], Enclosed, Reference, Decimal]:
    """Estimate σ_f, from packings that no row uses, in units of the load.

    Gives what each Monte Carlo converges to, shape (M,), and what the scene asks for; what is said
    of that; and the standard error of the scene's own ensemble, relative to the largest σ_f.
    """
    geometry, n = scene.effects.geometry, scene.ask.realisations
    first = formula(plans["first-order"], False, EXACT)
    apart = range(n, n + min(max(n, LEAST), MOST))
    scale = float(Enclosed(first, EXACT).largest)
    scatter = {name: _scatter(plan, apart, scale) for name, plan in plans.items()}
    means, residual = {"first-order": first}, np.zeros(len(first))
    if geometry == "exact":
        squares, firsts = scatter["exact"], scatter["first-order"]
        ratio = squares.mean(axis=0) / firsts.mean(axis=0)
        with EXACT.active():
            factors = [EXACT.from_float(float(root)) for root in np.sqrt(ratio)]
            means["exact"] = first * np.array(factors, object)
        residual = _standard_error(squares - ratio * firsts) / squares.mean(axis=0)
    true = Enclosed(means[geometry], EXACT)
    share = np.array([float(v) for v in true.best]) / float(true.largest)
    spread = scatter[geometry]
    floor = _standard_error(spread) / spread.mean(axis=0) * math.sqrt(len(apart) / n)
    what = "exact first-order σ_f"
    if geometry == "exact":
        off = true.off(first)
        what += f", nonlinear correction up to {off:.1E} from {len(apart)} realisations"
    # Of the root of a mean square, relative to σ_f, the standard error is half of the square's.
    radius, sampled = (Decimal(f"{(share * one / 2).max():.4E}") for one in (residual, floor))
    return means, true, Reference("estimated", what, EXACT.name, radius), sampled


def _plans(scene: Scene) -> dict[str, Plan]:
    """Plan the theories that are compared, without a tolerance."""
    free = {"tolerance": None, "certified": False}
    asked = scene.model_copy(update={"ask": scene.ask.model_copy(update=free)})
    names = ("first-order", "exact") if scene.effects.geometry == "exact" else ("first-order",)
    return {name: planner.plan(with_geometry(asked, name)) for name in names}


def sizes(realisations: int) -> list[int]:
    """Give ensembles of a quarter each, the scene's own last.

    >>> sizes(20), sizes(1)
    ([1, 5, 20], [1])
    """
    found = [realisations]
    while found[0] >= 4:
        found.insert(0, found[0] // 4)
    return found


def _skipped(scene: Scene) -> Iterator[Skipped]:
    sampled = "sampling errors lie far above what float64 rounds: see the rounding errors"
    if scene.effects.geometry != "exact":
        yield Skipped("Monte Carlo, exact", "the scene asks for the first-order theory")
    yield Skipped("first-order line sums", "one packing has no σ_f: Monte Carlo averages over them")
    yield Skipped("exact", "one packing has no σ_f: Monte Carlo averages over them")
    yield Skipped("Monte Carlo in mpmath, balls", sampled)


def formula(plan: Plan, printed: bool, system: NumberSystem) -> Array:
    """Give σ_f of layers j = 0 … M − 1 by a closed form, in units of the load; shape (M,).

    ``printed`` is the asymptotic form of the paper, the other is exact to first order at finite M.
    """
    bulk = plan.problem.load.kind == "bulk"
    asymptotic = closed_forms.bulk_diffusion if bulk else closed_forms.surface_diffusion
    exact = closed_forms.bulk_variance if bulk else closed_forms.surface_variance
    M = plan.problem.height
    with system.active():
        one, phi = system.number(Fraction(1)), system.number(1 - 2 * plan.problem.n_x**2)
        strength = plan.problem.load.strength(plan.problem.n_x, system)
        forces, squares = (array(system, [Fraction(0)] * M) for _ in range(2))
        for j in range(M):
            forces[j] = plan.problem.load.ordered_force((j % 2, j, "+"), strength, system)
            if printed:
                squares[j] = asymptotic(M, system.number(Fraction(j, M)), phi, one, one)
            else:
                squares[j] = exact(M, j, phi, one, one)
        unit = plan.problem.radii.relative_std() * plan.scene.load.magnitude
        scaled = system.sqrt(squares) * forces * system.scalar(unit)
        return np.asarray(scaled)


def _both_branches(table: Table, name: str) -> Array:
    """Give a column of a profile by layer, the mean square over its two branches; shape (M,)."""
    plus, minus = np.asarray(table.numbers[name]).reshape(-1, 2).T
    return np.asarray(np.hypot(plus, minus) / math.sqrt(2))  # squares may be below all floats


def _scatter(plan: Plan, realisations: Sequence[int], scale: float) -> Array:
    """Give the mean square of the change over ``scale``, by realisation and layer; shape (n, M)."""
    squares = []
    for k in realisations:
        table = answer(plan, FLOAT64, [k])
        std, mean = _both_branches(table, "std"), _both_branches(table, "mean_change")
        squares.append(np.hypot(std / scale, mean / scale) ** 2)
    return np.stack(squares)


def _standard_error(values: Array) -> Array:
    """Give the standard error of the mean over the first axis."""
    return np.asarray(values.std(axis=0, ddof=1) / math.sqrt(len(values)))


def _rounding(plan: Plan, true: Enclosed) -> Decimal:
    """Estimate the rounding error of σ_f, from one realisation in balls."""
    near, far = (answer(plan, system, [0]).numbers["std"] for system in (FLOAT64, Balls(160)))
    return true.off(near, np.array([exactly(value) for value in far]))
