"""What accuracy costs where an ensemble is asked for: σ_f layer by layer.

The reference is the exact first-order σ_f (Eqs. 13 and 14 at finite M) times an estimated nonlinear
correction √(Σ s²_exact / Σ s²_first-order): both theories on the same realisations, which no Monte
Carlo row uses. It is estimated and never certified; its radius is the standard error of the
correction. A scene that asks for the first-order theory needs no correction.
"""

import math
from collections.abc import Iterator, Sequence
from decimal import Decimal
from fractions import Fraction
from functools import partial

import numpy as np

from ... import closed_forms
from ...arithmetic.systems import (
    FLOAT64,
    LONGDOUBLE,
    Array,
    Balls,
    BigFloat,
    NumberSystem,
    array,
    largest_of,
)
from ...planning import planner
from ...planning.plan import Plan, Skipped
from ...quantities.base import Table
from ...scene.scene import Scene
from .reference import decimal, exactly
from .rows import Reference, Way, marked
from .table import CostStudy
from .ways import Notice, answer, measured, systems, with_geometry

# Realisations that the correction and the scatter are estimated from: at least, at most.
LEAST, MOST = 8, 64
# Precision of the closed forms that others are compared with: beyond that of every row.
EXACT = Balls(1200)


def study_ensemble(scene: Scene, notice: Notice) -> CostStudy:
    """Measure every way to σ_f. Raises ``SceneError`` and what the sweeps raise."""
    reference = _EstimatedReference(scene, notice)
    linear = reference.plans["first-order"]
    rows: list[Way] = []
    for way, printed in (("printed asymptotic formula", True), ("exact finite-M formula", False)):
        meant = formula(linear, printed, EXACT)
        model = reference.off(meant, reference.best)
        for system in systems():
            notice(f"{way}, {system.name}")
            found, costs = measured(partial(formula, linear, printed, system), system)
            error, rounding = reference.off(found, reference.best), reference.off(found, meant)
            rows.append(Way(way, system.name, None, error, model, rounding, None, None, **costs))
    for name in reference.plans if scene.effects.geometry == "exact" else ["first-order"]:
        rounding = reference.rounding(name)
        mean = reference.mean[name]
        model = reference.off(mean, reference.best)
        for n in sizes(scene.ask.realisations):
            way = f"Monte Carlo, {name}"
            notice(f"{way}, {n} realisations")
            plan = reference.plans[name]
            table, costs = measured(partial(answer, plan, FLOAT64, range(n)), FLOAT64)
            std = _both_branches(table, "std")
            error, sampling = reference.off(std, reference.best), reference.off(std, mean)
            parts = model, rounding, sampling
            rows.append(Way(way, FLOAT64.name, n, error, *parts, None, **costs))
    skipped = tuple(_skipped(scene))
    return CostStudy("profile", reference.reference, marked(rows), skipped, reference.floor)


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
    yield Skipped("exact, deviation form", "one packing has no σ_f: Monte Carlo averages over them")
    yield Skipped("exact, plain form", "it would sample the same packings and round more")
    yield Skipped("Monte Carlo in longdouble, mpmath, balls", sampled)


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
    squares = np.asarray(table.numbers[name]) ** 2
    return np.asarray(np.sqrt(squares.reshape(-1, 2).mean(axis=1)))


class _EstimatedReference:
    """The estimated reference; arrays have shape (M,), in units of the load.

    ``mean`` holds what each Monte Carlo converges to, ``best`` what the scene asks for, ``floor``
    the standard error of the scene's own ensemble, relative to the largest σ_f.
    """

    def __init__(self, scene: Scene, notice: Notice) -> None:
        asked = scene.model_copy(
            update={"ask": scene.ask.model_copy(update={"tolerance": None, "certified": False})}
        )
        self.plans = {
            name: planner.plan(with_geometry(asked, name)) for name in ("first-order", "exact")
        }
        notice("reference")
        first = formula(self.plans["first-order"], False, EXACT)
        n = scene.ask.realisations
        apart = range(n, n + min(max(n, LEAST), MOST))
        linear = self._scatter("first-order", apart)
        exact = self._scatter("exact", apart) if scene.effects.geometry == "exact" else linear
        ratio = exact.mean(axis=0) / linear.mean(axis=0)
        with EXACT.active():
            factors = [EXACT.from_float(float(root)) for root in np.sqrt(ratio)]
            self.mean = {"first-order": first, "exact": first * np.array(factors, object)}
            self.best = self.mean[scene.effects.geometry]
            self.largest = largest_of(exactly(v) for v in self.best)
        share = np.array([float(v) for v in self.best]) / float(self.largest)
        root = math.sqrt(len(apart))
        # Standard errors of √ratio and of the root of a mean square, each relative to σ_f.
        residual = (exact - ratio * linear).std(axis=0, ddof=1) / linear.mean(axis=0) / ratio
        radius = float((share * residual / 2).max()) / root
        scatter = exact.std(axis=0, ddof=1) / exact.mean(axis=0)
        self.floor = Decimal(f"{float((share * scatter / 2).max()) / math.sqrt(n):.4E}")
        what = "exact first-order σ_f"
        if scene.effects.geometry == "exact":
            change = self.off(first, self.best)
            what += f", nonlinear correction up to {change:.1E} from {len(apart)} realisations"
        self.reference = Reference("estimated", what, EXACT.name, Decimal(f"{radius:.4E}"))

    def _scatter(self, name: str, realisations: Sequence[int]) -> Array:
        """Give the mean square of the change, by realisation and layer; shape (n, M)."""
        squares = []
        for k in realisations:
            table = answer(self.plans[name], FLOAT64, [k])
            std, mean = _both_branches(table, "std"), _both_branches(table, "mean_change")
            squares.append(std**2 + mean**2)
        return np.stack(squares)

    def off(self, found: Array, meant: Array) -> Decimal:
        """Give the largest |difference| over layers, relative to the largest σ_f."""
        with EXACT.active():
            pairs = zip(found, meant, strict=True)
            apart = largest_of(abs(exactly(a) - exactly(b)) for a, b in pairs)
            return decimal((apart / self.largest).upper())

    def rounding(self, name: str) -> Decimal:
        """Estimate the rounding error of σ_f, from one realisation with a longer significand."""
        longer: NumberSystem = LONGDOUBLE if LONGDOUBLE.bits > FLOAT64.bits else BigFloat(35)
        return self.off(
            *(answer(self.plans[name], s, [0]).numbers["std"] for s in (FLOAT64, longer))
        )
