"""Figure 3: σ_f/⟨f⟩ under a surface load, theory against exact simulation, over heights M.

Simulated are exact, nonlinear packings of W = 2M beads a layer, wide enough that no force sees an
image of itself. The theory is Eq. 13 as printed, and its exact form at finite M. Far below
M* = (σ/r)^(-2/3) the exact form has to lie within the band. Nearer to M* forces need not be linear
in δr.
"""

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from matplotlib.axes import Axes

from ..arithmetic.systems import Array
from ..theory.expected import critical_height, leading_stds, stds_by_layer
from . import packings
from .packings import LEVEL, PAPER, Comparison, Made, Medium, Options
from .q_model import weight_variance
from .style import COLUMN, GREY, PAGE, RELATIVE_HEIGHT, marked, panels, points


def curves(M: int, medium: Medium = PAPER) -> tuple[Array, Array]:
    """Give σ_f/⟨f⟩ of layers 0 … M − 1 by Eq. 13: exact to first order at finite M, and printed."""
    phi, std, z = float(medium.phi), medium.std, [j / M for j in range(M)]
    return stds_by_layer("surface", M, phi) * std, leading_stds("surface", M, z, phi) * std


def simulated(M: int, o: Options) -> Comparison:
    """Simulate one height."""
    ensemble = packings.planned("profile", o, o.medium(), height=M)
    # heights share no radii
    averaged = packings.moments(ensemble, o.notice, f"figure 3, M = {M}", M << 32)
    band, (exact, _) = packings.band_of_spread(*averaged, o.seed), curves(M, o.medium())
    return Comparison(f"M = {M}: exact finite-M curve", band, exact)


def figure(o: Options) -> Made:
    """Simulation, exact finite-M curves and the printed curve; below, their ratio.

    Raises ``SceneError`` and what the sweeps raise near M*.
    """
    medium, q_model = o.medium(), "q-model" in o.models
    for M in o.heights:  # one that is too large is refused before any is solved
        packings.planned("profile", o, medium, height=M)
    cases = [simulated(M, o) for M in o.heights]
    critical = critical_height(Fraction(medium.std))
    mosaic, width = ("ac;bc", PAGE) if q_model else ("a;b", COLUMN)
    drawn, axes = panels(mosaic, width, 3.5, sharex=True, height_ratios=(2.6, 1))
    _draw(axes[0], cases, medium)
    _draw_ratio(axes[1], cases)
    layers = [
        (M, j, j / M, printed) for M in o.heights for j, printed in enumerate(curves(M, medium)[1])
    ]
    made = packings.compared(
        drawn, "figure3", o, cases, packings.table("height j z printed", layers),
        spacing_over_r=float(medium.spacing), relative_std=medium.std, critical_height=critical,
    )  # fmt: skip
    if not q_model:
        return made
    _draw_q_model(axes[2], o.heights)
    loads = [(M, *row) for M in o.heights for row in enumerate(weight_variance(M).tolist())]
    own = {"figure3_q_model": packings.table("height depth weight_variance", loads)}
    return Made(drawn, {**made.tables, **own}, made.facts, made.lines)


def _draw(axes: Axes, cases: Sequence[Comparison], medium: Medium) -> None:
    """Draw all σ_f/⟨f⟩ over M^(3/2)."""
    power = -math.floor(math.log10(medium.std))
    z = np.linspace(0, 1, 201)
    printed = leading_stds("surface", 1, z, float(medium.phi)) * medium.std
    axes.plot(z, printed * 10.0**power, "k--", lw=1, label="Eq. (13), printed")
    axes.plot([], [], color=GREY, label="exact at finite $M$")
    for c, case in enumerate(cases):
        M = len(case.theory)
        unit, z, some = M**1.5 / 10.0**power, np.arange(M) / M, marked(M, c, 3)
        low, high = case.band.limits
        axes.plot(z, case.theory / unit, color=f"C{c}")
        axes.fill_between(z, low / unit, high / unit, color=f"C{c}", alpha=0.25, lw=0)
        points(axes, z[some], case.band.value[some] / unit, c, f"simulated, $M={M}$")
    axes.fill_between([], [], color=GREY, alpha=0.25, lw=0, label=f"{LEVEL:.0%} band")
    axes.set(xlim=(0, 1), ylabel=rf"$10^{{{power}}}\,M^{{-3/2}}\,\sigma_f/\langle f\rangle$")
    axes.set_ylim(bottom=0)
    axes.legend(loc="lower left")


def _draw_ratio(axes: Axes, cases: Sequence[Comparison]) -> None:
    """Draw simulation over the exact curve, minus 1, in %: all of a band has to hold zero."""
    axes.axhline(0, color="0.6", lw=0.7, zorder=0.5)
    widest = 0.0
    for c, case in enumerate(cases):
        M = len(case.theory)
        z, some = np.arange(M) / M, marked(M, c, 3)
        low, high = (100 * (edge / case.theory - 1) for edge in case.band.limits)
        axes.fill_between(z, low, high, color=f"C{c}", alpha=0.18, lw=0)
        axes.plot(z, low, z, high, color=f"C{c}", lw=0.5)
        points(axes, z[some], (100 * (case.band.value / case.theory - 1))[some], c, ms=2.6)
        widest = max(widest, -1.15 * low.min(), 1.15 * high.max())
    axes.set(xlabel=RELATIVE_HEIGHT, ylabel="simulated over\nexact, minus 1 (%)")
    axes.set_ylim(-widest, widest)


def _draw_q_model(axes: Axes, heights: Sequence[int]) -> None:
    """Draw how σ falls towards the surface: of forces, of Brownian paths and of the q-model."""
    z = np.linspace(0, 1, 201)
    axes.plot(z, (1 - z) * np.sqrt(2 * z + 1), "k", label="Eq. (13), printed")
    axes.plot(z, np.sqrt(1 - z), ":", color="0.45", label=r"Brownian, $\sqrt{1-z}$")
    for c, M in enumerate(heights):
        std, here = np.sqrt(weight_variance(M)), 1 - np.arange(M + 1) / M
        axes.plot(here, std / std[-1], color=f"C{c}")
        some = marked(M + 1, 0, 1)
        points(axes, here[some], (std / std[-1])[some], c, f"$q$-model, $M={M}$")
    axes.set(xlabel=RELATIVE_HEIGHT, ylabel=r"$\sigma(z)\,/\,\sigma(0)$", ylim=(0, 1.04))
    axes.legend(loc="lower left")
