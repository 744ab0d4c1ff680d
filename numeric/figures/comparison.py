"""Figure 3: σ_f/⟨f⟩ under a surface load, theory against exact simulation, over heights M.

Simulated are exact, nonlinear packings of W = 2M beads a layer, wide enough that no force sees an
image of itself. The theory is Eq. 13 as printed, and its exact form at finite M. Far below
M* = (σ/r)^(-2/3) the exact form has to lie within the band. Nearer to M* forces need not be linear
in δr: the ratio of nonlinear to first-order σ_f is estimated on realisations of its own, each
solved both ways, so that most of the sampling error cancels.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..planning.plan import Plan
from ..statistics.bands import (
    Band,
    Estimate,
    averaged,
    log_relative_std,
    simultaneous,
)
from ..theory.critical_height import critical_height
from .models.q_model import weight_variance
from .packings import (
    PAPER,
    Medium,
    Notice,
    Row,
    changes,
    planned,
)

LEVEL = 0.99
# Fewer realisations than this make no covariance worth the name.
LEAST = 16


@dataclass(frozen=True)
class Height:
    """One height of packings; arrays have shape (M,), over layers j = 0 … M − 1.

    ``correction`` estimates ln(σ nonlinear / σ first-order), from other realisations than ``band``.
    """

    height: int
    realisations: int
    band: Band
    exact: Array
    printed: Array
    correction: Estimate

    @property
    def z(self) -> Array:
        """j/M."""
        return np.arange(self.height) / self.height

    @property
    def corrected(self) -> Array:
        """The exact finite-M curve times the estimated nonlinear correction."""
        return np.asarray(self.exact * np.exp(self.correction.log))

    def deviation(self) -> float:
        """Largest deviation of the exact finite-M curve, in half-widths of the band."""
        return self.band.deviation(self.exact)

    @cached_property  # it is drawn, written and told
    def corrected_deviation(self) -> float:
        """The same for the corrected curve; its own error widens the band."""
        both = simultaneous(self.band.estimate - self.correction, self.band.level)
        return both.deviation(self.exact)


@dataclass(frozen=True)
class Comparison:
    """What figure 3 shows; ``q_model`` says whether the q-model stands beside it."""

    heights: tuple[Height, ...]
    q_model: bool
    medium: Medium

    def tables(self) -> dict[str, list[Row]]:
        """CSV files: σ/⟨f⟩ plain; multiply by M^(-3/2) to get what is drawn."""
        rows = []
        for one in self.heights:
            low, high = one.band.limits
            columns = {
                "z": one.z,
                "simulated": np.exp(one.band.estimate.log),
                "band_low": low,
                "band_high": high,
                "exact_first_order": one.exact,
                "printed": one.printed,
                "nonlinear_correction": np.exp(one.correction.log),
                "correction_standard_error": one.correction.error * np.exp(one.correction.log),
                "corrected": one.corrected,
            }
            for j in range(one.height):
                row: Row = {"height": one.height, "realisations": one.realisations, "j": j}
                rows.append(row | {name: float(values[j]) for name, values in columns.items()})
        tables = {"figure3": rows}
        if self.q_model:
            tables["figure3_q_model"] = [
                {"height": one.height, "depth": depth, "weight_variance": variance}
                for one in self.heights
                for depth, variance in enumerate(weight_variance(one.height))
            ]
        return tables

    def facts(self) -> dict[str, Any]:
        """Verdicts for each height."""
        found = []
        for one in self.heights:
            alone, corrected = one.deviation(), one.corrected_deviation
            found.append(
                {
                    "height": one.height,
                    "realisations": one.realisations,
                    "exact_finite_M_inside": alone <= 1,
                    "largest_deviation_in_half_widths": alone,
                    "corrected_inside": corrected <= 1,
                    "corrected_deviation_in_half_widths": corrected,
                    "largest_correction": float(np.abs(np.expm1(one.correction.log)).max()),
                    "band_in_standard_errors": one.band.critical,
                }
            )
        return {
            "simultaneous_level": LEVEL,
            "spacing_over_r": float(self.medium.spacing),
            "relative_std": self.medium.std,
            "critical_height": critical_height(Fraction(self.medium.std)),
            "heights": found,
        }

    def lines(self) -> list[str]:
        """Say for each height whether theory holds."""
        said = []
        facts = self.facts()
        for one, fact in zip(self.heights, facts["heights"], strict=True):
            alone = fact["largest_deviation_in_half_widths"]
            words = f"M = {one.height}: exact finite-M curve {one.band.verdict(alone)}"
            near = one.height / facts["critical_height"]
            if near > NEAR:
                words += f"; M = {near:.2g} M*"
            if alone > 1 or fact["largest_correction"] > NOTEWORTHY or near > NEAR:
                words += (
                    f"; with the nonlinear correction (up to {fact['largest_correction']:.2%}) "
                    f"{one.band.verdict(fact['corrected_deviation_in_half_widths'])}"
                )
            said.append(words)
        return said


# Nonlinear corrections from here on are drawn and told of.
NOTEWORTHY = 0.01
# … and these parts of M* are told of, whatever the correction is.
NEAR = 0.5


def compare(
    heights: Sequence[int],
    realisations: int,
    seed: int,
    notice: Notice,
    *,
    q_model: bool = False,
    medium: Medium = PAPER,
) -> Comparison:
    """Simulate and compare. Raises ``SceneError`` and what the sweeps raise near M*."""
    for M in heights:  # one that is too large is refused before any is solved
        _ensemble(M, realisations, seed, "exact", medium)
    found = tuple(_height(M, realisations, seed, medium, notice) for M in heights)
    return Comparison(found, q_model, medium)


def _height(M: int, n: int, seed: int, medium: Medium, notice: Notice) -> Height:
    start = M << 32  # heights share no radii
    moments = averages(M, range(start, start + n), seed, "exact", notice, medium)
    band = simultaneous(averaged(*log_relative_std(*moments)), LEVEL, seed)
    apart = range(start + n, start + n + max(n // 8, LEAST // 2))
    log, influence = log_relative_std(*averages(M, apart, seed, "exact", notice, medium))
    first, first_influence = log_relative_std(
        *averages(M, apart, seed, "first-order", notice, medium)
    )
    exact, printed = curves(M, medium)
    correction = averaged(log - first, influence - first_influence)
    return Height(M, n, band, exact, printed, correction)


def curves(M: int, medium: Medium = PAPER) -> tuple[Array, Array]:
    """Give σ_f/⟨f⟩ of layers 0 … M − 1 by Eq. 13: exact to first order at finite M, and printed."""
    phi, std = float(medium.phi), medium.std
    exact = [closed_forms.surface_variance(M, j, phi, std, 1.0) for j in range(M)]
    printed = [closed_forms.surface_diffusion(M, j / M, phi, std, 1.0) for j in range(M)]
    return np.sqrt(exact), np.sqrt(printed)


def _ensemble(M: int, realisations: int, seed: int, geometry: str, medium: Medium) -> Plan:
    """Plan packings of W = 2M: then no exact force sees an image."""
    return planned(
        "profile", height=M, width=2 * M, seed=seed, geometry=geometry,
        realisations=realisations, std=medium.std, spacing=medium.spacing,
    )  # fmt: skip


def averages(
    M: int,
    realisations: range,
    seed: int,
    geometry: str,
    notice: Notice,
    medium: Medium = PAPER,
) -> tuple[Array, Array]:
    """Average g = f/F − 1 and g² over the contacts of each layer; shapes (realisations, M)."""
    ensemble = _ensemble(M, len(realisations), seed, geometry, medium)
    what = f"figure 3, M = {M}" + ("" if geometry == "exact" else ", first order")
    means: list[Array] = []
    squares: list[Array] = []
    for F, g in changes(ensemble, realisations, notice, what):
        relative = g / F[:, None]  # (layer and branch, realisation, contact)
        for found, values in ((means, relative), (squares, relative**2)):
            found.append(values.mean(axis=2).reshape(M, 2, -1).mean(axis=1).T)
    return np.concatenate(means), np.concatenate(squares)
