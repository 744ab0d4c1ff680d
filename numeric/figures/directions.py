"""Figure B2: how much contact forces fluctuate as a surface load leaves the vertical.

Simulated are exact, nonlinear packings of W = 2M beads a layer; the curves are Eq. B2, exact to
first order at finite M. Both are root mean squares over all layers.
"""

from dataclasses import dataclass
from fractions import Fraction
from math import asin, degrees, radians, sqrt, tan
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..scene.sections import SurfaceLoad
from ..statistics.bands import Band, averaged, log_relative_std, simultaneous
from .packings import N_X, PAPER_STD, PHI, Notice, Row, changes, planned

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 24
ANGLES = (-40, -30, -20, -10, 0, 10, 20, 30, 40)
"""Degrees from the vertical; the contacts are at ±48.6° for s = 3 r."""
LIMIT = degrees(asin(N_X))
LEVEL = 0.99


def ratio(angle: float) -> float:
    """L⁻/L⁺ of a load at an angle in degrees from straight down, positive towards +i."""
    slope = tan(radians(angle)) * sqrt(1 - N_X**2) / float(N_X)
    return (1 + slope) / (1 - slope)


def theory(angle: float) -> tuple[float, float]:
    """Root mean square over the layers of σ_f/⟨f⟩ of f⁺ and of f⁻ (Eq. B2)."""
    share = ratio(angle)
    plus, minus = (
        sum(
            closed_forms.surface_variance_at_angle(HEIGHT, j, t, float(PHI), PAPER_STD, 1.0)
            for j in range(HEIGHT)
        )
        for t in (share, 1 / share)
    )
    return sqrt(plus / HEIGHT), sqrt(minus / HEIGHT)


@dataclass(frozen=True)
class Directions:
    """The band holds f⁺ at all angles, then f⁻; ``exact``, shape (2, angles), likewise."""

    realisations: int
    band: Band
    exact: Array

    def deviation(self) -> float:
        """Largest deviation of theory, in half-widths of the band: inside is ≤ 1."""
        return self.band.deviation(self.exact.ravel())

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row an angle and branch."""
        found = np.exp(self.band.estimate.log).reshape(2, -1)
        low, high = (edge.reshape(2, -1) for edge in self.band.limits)
        return {
            "figureB2": [
                {
                    "angle_deg": angle,
                    "branch": branch,
                    "t": ratio(angle),
                    "simulated": float(found[b, a]),
                    "band_low": float(low[b, a]),
                    "band_high": float(high[b, a]),
                    "exact_first_order": float(self.exact[b, a]),
                }
                for b, branch in enumerate("+-")
                for a, angle in enumerate(ANGLES)
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdict and parameters."""
        return {
            "height": HEIGHT,
            "realisations": self.realisations,
            "relative_std": PAPER_STD,
            "simultaneous_level": LEVEL,
            "largest_deviation_in_half_widths": self.deviation(),
        }

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        verdict = self.band.verdict(self.deviation())
        return [f"M = {HEIGHT}, {len(ANGLES)} angles, both branches: Eq. B2 {verdict}"]


def sweep(realisations: int, seed: int, notice: Notice) -> Directions:
    """Simulate all angles, each on radii of its own."""
    means: list[Array] = []
    squares: list[Array] = []
    for place, angle in enumerate(ANGLES):
        ensemble = planned(
            "profile", height=HEIGHT, width=2 * HEIGHT, seed=seed, realisations=realisations,
            load=SurfaceLoad(angle_deg=Fraction(angle)),
        )  # fmt: skip
        start = place << 32
        what = f"figure B2, {angle} degrees"
        found = [
            [(g / F[:, None]) ** power for power in (1, 2)]
            for F, g in changes(ensemble, range(start, start + realisations), notice, what)
        ]
        for power, kept in enumerate((means, squares)):
            # (layer and branch, realisation, contact), to (realisation, branch)
            each = [one[power].mean(axis=2).reshape(HEIGHT, 2, -1).mean(axis=0).T for one in found]
            kept.append(np.concatenate(each))
    stacked = (np.stack(kept, axis=2).reshape(realisations, -1) for kept in (means, squares))
    band = simultaneous(averaged(*log_relative_std(*stacked)), LEVEL, seed)
    return Directions(realisations, band, np.array([theory(angle) for angle in ANGLES]).T)


def draw(data: Directions) -> "Figure":
    """Draw σ_f/⟨f⟩ of both branches over the angle of the load, up to that of the contacts."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    fine = np.linspace(-0.93 * LIMIT, 0.93 * LIMIT, 161)
    curves = np.array([theory(angle) for angle in fine]).T
    found = np.exp(data.band.estimate.log).reshape(2, -1)
    low, high = (edge.reshape(2, -1) for edge in data.band.limits)
    for b, name in enumerate(("+", "-")):
        look, error = style.series(b), (found[b] - low[b], high[b] - found[b])
        axes.plot(fine, curves[b], color=look[0], label=f"$f^{name}$, Eq. (B2)")
        style.points(axes, ANGLES, found[b], error, look, f"$f^{name}$, simulated")
    for edge in (-LIMIT, LIMIT):
        axes.axvline(edge, color="0.6", ls=":", lw=0.8)
    axes.set_yscale("log")
    axes.set_xlim(-52, 52)
    axes.set_xlabel("angle of the load from the vertical (degrees)")
    axes.set_ylabel(r"$\sigma_f/\langle f\rangle$, r.m.s. over layers")
    axes.legend(loc="upper center", ncols=2, columnspacing=1.0)
    axes.set_ylim(None, 6 * float(curves.max()))
    return figure
