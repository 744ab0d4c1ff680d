"""Figure 3: σ_f/⟨f⟩ under a surface load, theory against exact simulation, over heights M.

Simulated are exact, nonlinear packings of W = 2M beads a layer, wide enough that no force sees an
image of itself. The theory is Eq. 13 as printed, and its exact form at finite M. Far below
M* = (σ/r)^(-2/3) the exact form has to lie within the band. Nearer to M* forces need not be linear
in δr: the ratio of nonlinear to first-order σ_f is estimated on realisations of its own, each
solved both ways, so that most of the sampling error cancels.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..planning.plan import Plan
from ..statistics.bands import Estimate, averaged, log_relative_std, simultaneous
from ..theory.expected import critical_height
from . import specification as spec
from .names import LEAST_REALISATIONS
from .packings import (
    LEVEL,
    PAPER,
    Medium,
    Notice,
    Options,
    band_of_spread,
    by_layer,
    moments,
    planned,
)
from .q_model import weight_variance

NOTEWORTHY = 0.01
"""Nonlinear corrections from here on are drawn and told of."""
NEAR = 0.5
"""… and from this part of M* on they are told of, whatever they are."""
MARKED = 16
"""About so many layers get a marker."""


@dataclass(frozen=True)
class Height:
    """One height of packings; ``alone``: the exact finite-M curve; ``printed``: shape (M,).

    ``correction`` estimates ln(σ nonlinear / σ first-order), from other realisations.
    """

    height: int
    alone: spec.Comparison
    printed: Array
    correction: Estimate

    @property
    def z(self) -> Array:
        """j/M."""
        return np.arange(self.height) / self.height

    @property
    def factor(self) -> Array:
        """The nonlinear correction."""
        return np.exp(self.correction.log)

    @cached_property  # it is written and told
    def corrected_deviation(self) -> float:
        """That of the curve times its correction, whose own error widens the band."""
        band = self.alone.band
        both = simultaneous(band.estimate - self.correction, band.level)
        return both.deviation(self.alone.theory)

    @property
    def largest(self) -> float:
        """The largest correction."""
        return float(np.abs(np.expm1(self.correction.log)).max())

    def facts(self, realisations: int) -> dict[str, Any]:
        """Verdicts."""
        alone, corrected = self.alone.deviation(), self.corrected_deviation
        return {
            "height": self.height,
            "realisations": realisations,
            "exact_finite_M_inside": alone <= 1,
            "largest_deviation_in_half_widths": alone,
            "corrected_inside": corrected <= 1,
            "corrected_deviation_in_half_widths": corrected,
            "largest_correction": self.largest,
            "band_in_standard_errors": self.alone.band.critical,
        }

    def says(self, critical: float) -> str:
        """Say whether theory holds."""
        words, near = self.alone.verdict(), self.height / critical
        if near > NEAR:
            words += f"; M = {near:.2g} M*"
        if self.alone.deviation() > 1 or self.largest > NOTEWORTHY or near > NEAR:
            words += (
                f"; with the nonlinear correction (up to {self.largest:.2%}) "
                f"{self.alone.band.verdict(self.corrected_deviation)}"
            )
        return words

    def columns(self, realisations: int) -> spec.Table:
        """Columns of the CSV file: σ/⟨f⟩ plain; times M^(-3/2) it is what is drawn."""
        return {
            "height": np.full(self.height, self.height),
            "realisations": np.full(self.height, realisations),
            "j": np.arange(self.height),
            "z": self.z,
            **self.alone.columns(),
            "printed": self.printed,
            "nonlinear_correction": self.factor,
            "correction_standard_error": self.correction.error * self.factor,
            "corrected": self.alone.theory * self.factor,
        }

    def marked(self, number: int) -> slice:
        """Choose the layers that get a marker, other ones for each height."""
        step = -(-self.height // MARKED)
        return slice(number * step // 3, None, step)

    def over_height(self, c: int, unit: float) -> list[spec.Element]:
        """Simulation, exact curve and, if it matters, the corrected one, over M^(3/2)."""
        unit, exact, some = unit * self.height**1.5, self.alone.theory, self.marked(c)
        low, high = self.alone.band.limits
        simulated = self.alone.band.value[some] / unit
        found: list[spec.Element] = [
            spec.Line(self.z, exact / unit, c),
            spec.Area(self.z, low / unit, high / unit, c),
            spec.Points(self.z[some], simulated, c, f"simulated, $M={self.height}$"),
        ]
        if self.largest > NOTEWORTHY:
            found.append(spec.Line(self.z, exact * self.factor / unit, c, ":"))
        return found

    def over_theory(self, c: int) -> list[spec.Element]:
        """Simulation over the exact curve, less 1, in %: all of a band has to hold zero."""
        some, exact = self.marked(c), self.alone.theory
        low, high = (100 * (edge / exact - 1) for edge in self.alone.band.limits)
        off = 100 * (self.alone.band.value / exact - 1)
        return [
            spec.Area(self.z, low, high, c, alpha=0.18, edges=0.5),
            spec.Points(self.z[some], off[some], c, size=2.6),
        ]


def averages(
    M: int, realisations: range, seed: int, geometry: str, notice: Notice, medium: Medium = PAPER
) -> tuple[Array, Array]:
    """Average g = f/F − 1 and g² over the contacts of each layer; shapes (realisations, M)."""
    ensemble = _ensemble(M, len(realisations), seed, geometry, medium)
    what = f"figure 3, M = {M}" + ("" if geometry == "exact" else ", first order")
    return moments(ensemble, notice, what, by_layer, realisations.start)


def _ensemble(M: int, realisations: int, seed: int, geometry: str, medium: Medium) -> Plan:
    """Plan packings of W = 2M: then no exact force sees an image."""
    return planned(
        "profile", height=M, seed=seed, geometry=geometry,
        realisations=realisations, std=medium.std, spacing=medium.spacing,
    )  # fmt: skip


def curves(M: int, medium: Medium = PAPER) -> tuple[Array, Array]:
    """Give σ_f/⟨f⟩ of layers 0 … M − 1 by Eq. 13: exact to first order at finite M, and printed."""
    phi, std = float(medium.phi), medium.std
    exact = [closed_forms.surface_variance(M, j, phi, std, 1.0) for j in range(M)]
    printed = [closed_forms.surface_diffusion(M, j / M, phi, std, 1.0) for j in range(M)]
    return np.sqrt(exact), np.sqrt(printed)


def simulated(M: int, o: Options) -> Height:
    """Simulate one height."""
    start, n, medium = M << 32, o.realisations, o.medium()  # heights share no radii
    found = averages(M, range(start, start + n), o.seed, "exact", o.notice, medium)
    exact, printed = curves(M, medium)
    alone = spec.Comparison(f"M = {M}: exact finite-M curve", band_of_spread(*found, o.seed), exact)
    apart = range(start + n, start + n + max(n // 8, LEAST_REALISATIONS // 2))
    (log, influence), (first, first_influence) = (
        log_relative_std(*averages(M, apart, o.seed, geometry, o.notice, medium))
        for geometry in ("exact", "first-order")
    )
    return Height(M, alone, printed, averaged(log - first, influence - first_influence))


def figure(o: Options) -> spec.Figure:
    """Simulation, exact finite-M curves and the printed curve; below, their ratio.

    Raises ``SceneError`` and what the sweeps raise near M*.
    """
    medium = o.medium()
    for M in o.heights:  # one that is too large is refused before any is solved
        _ensemble(M, o.realisations, o.seed, "exact", medium)
    found = [simulated(M, o) for M in o.heights]
    critical, q_model = critical_height(Fraction(medium.std)), "q-model" in o.models
    columns = spec.stacked([one.columns(o.realisations) for one in found])
    loads = [(M, *row) for M in o.heights for row in enumerate(weight_variance(M).tolist())]
    panels = [_theory_and_simulation(found, medium), _ratio(found)]
    return spec.Figure(
        spec.Picture(
            [*panels, _shapes(found)], 3.5, page=True, mosaic="ac;bc", share="x", rows=(2.6, 1)
        )
        if q_model
        else spec.Picture(panels, 3.5, mosaic="a;b", share="x", rows=(2.6, 1)),
        tables={"figure3": columns}
        | (
            {"figure3_q_model": spec.table("height depth weight_variance", loads)}
            if q_model
            else {}
        ),
        facts={
            "simultaneous_level": LEVEL,
            "spacing_over_r": float(medium.spacing),
            "relative_std": medium.std,
            "critical_height": critical,
            "heights": [one.facts(o.realisations) for one in found],
        },
        words=[one.says(critical) for one in found],
        comparisons=[one.alone for one in found],
    )


def _theory_and_simulation(found: Sequence[Height], medium: Medium) -> spec.Panel:
    power = -math.floor(math.log10(medium.std))
    z, unit = np.linspace(0, 1, 201), 10.0**-power
    form, phi = closed_forms.surface_diffusion, float(medium.phi)
    printed = np.sqrt([form(1, v, phi, medium.std, 1.0) for v in z]) / unit
    return spec.Panel(
        [
            spec.Line(z, printed, "black", "--", "Eq. (13), printed", 1.0),
            spec.Line(name="exact at finite $M$"),
            *(one.over_height(c, unit) for c, one in enumerate(found)),
            spec.Area(name=f"{LEVEL:.0%} band"),
        ],
        spec.Axis(low=0, high=1),
        spec.Axis(rf"$10^{{{power}}}\,M^{{-3/2}}\,\sigma_f/\langle f\rangle$", 0),
        legend="lower left",
    )


def _ratio(found: Sequence[Height]) -> spec.Panel:
    edges = [edge / one.alone.theory - 1 for one in found for edge in one.alone.band.limits]
    widest = 115 * max(float(np.abs(edge).max()) for edge in edges)
    return spec.Panel(
        [spec.Rule("y", 0), *(one.over_theory(c) for c, one in enumerate(found))],
        spec.RELATIVE_HEIGHT,
        spec.Axis("deviation (%)", -widest, widest),
    )


def _shapes(found: Sequence[Height]) -> spec.Panel:
    z = np.linspace(0, 1, 201)
    elements: list[spec.Element] = []
    for c, one in enumerate(found):
        std, depth = np.sqrt(weight_variance(one.height)), np.arange(one.height + 1)
        here, shape = 1 - depth / one.height, std / std[-1]
        some = slice(None, None, max(1, one.height // MARKED))
        elements += [
            spec.Line(here, shape, c),
            spec.Points(here[some], shape[some], c, f"$q$-model, $M={one.height}$"),
        ]
    return spec.Panel(
        [
            spec.Line(z, np.sqrt((1 - z) ** 2 * (2 * z + 1)), "black", name="Eq. (13), printed"),
            spec.Line(z, np.sqrt(1 - z), "0.45", ":", r"Brownian, $\sqrt{1-z}$"),
            *elements,
        ],
        spec.RELATIVE_HEIGHT,
        spec.Axis(r"$\sigma(z)\,/\,\sigma(0)$", 0, 1.04),
        legend="lower left",
    )
