"""Figure B2: how much contact forces fluctuate as a surface load leaves the vertical.

Simulated are exact, nonlinear packings of W = 2M beads a layer; the curves are Eq. B2, exact to
first order at finite M. Both are root mean squares over all layers.
"""

from fractions import Fraction
from math import asin, degrees, radians, sqrt, tan

import numpy as np

from ..scene.sections import SurfaceLoad
from ..theory.expected import stds_by_layer
from . import packings
from .packings import N_X, PAPER_STD, PHI, Comparison, Made, Options
from .style import COLUMN, panels, points

HEIGHT = 24
ANGLES = (-40, -30, -20, -10, 0, 10, 20, 30, 40)
"""Degrees from the vertical; the contacts are at ±48.6° for s = 3 r."""
LIMIT = degrees(asin(N_X))


def ratio(angle: float) -> float:
    """L⁻/L⁺ of a load at an angle in degrees from straight down, positive towards +i."""
    slope = tan(radians(angle)) * sqrt(1 - N_X**2) / float(N_X)
    return (1 + slope) / (1 - slope)


def theory(angle: float) -> tuple[float, float]:
    """Root mean square over the layers of σ_f/⟨f⟩ of f⁺ and of f⁻ (Eq. B2)."""
    share, phi = ratio(angle), float(PHI)
    plus, minus = (
        np.sqrt((stds_by_layer("surface", HEIGHT, phi, (1.0, t)) ** 2).mean())
        for t in (share, 1 / share)
    )
    return plus * PAPER_STD, minus * PAPER_STD


def simulated(o: Options) -> Comparison:
    """Simulate all angles, each on radii of its own: f⁺ at all of them, then f⁻."""
    averaged = []
    for place, angle in enumerate(ANGLES):
        load = SurfaceLoad(angle_deg=Fraction(angle))
        ensemble = packings.planned("profile", o, height=HEIGHT, load=load)
        what = f"figure B2, {angle} degrees"
        averaged.append(packings.moments(ensemble, o.notice, what, place << 32, axes=(0, 3)))
    mean, square = (
        np.stack(parts, axis=2).reshape(o.realisations, -1) for parts in zip(*averaged, strict=True)
    )
    exact = np.array([theory(angle) for angle in ANGLES]).T.ravel()
    what = f"M = {HEIGHT}, {len(ANGLES)} angles, both branches: Eq. B2"
    return Comparison(what, packings.band_of_spread(mean, square, o.seed), exact)


def figure(o: Options) -> Made:
    """σ_f/⟨f⟩ of both branches over the angle of the load, up to that of the contacts."""
    comparison, count = simulated(o), len(ANGLES)
    fine = np.linspace(-0.93 * LIMIT, 0.93 * LIMIT, 161)
    curves = np.array([theory(angle) for angle in fine]).T
    drawn, (axes,) = panels("a", COLUMN, 2.6)
    for b, branch in enumerate("+-"):
        axes.plot(fine, curves[b], color=f"C{b}", label=f"$f^{branch}$, exact")
    for b, branch in enumerate("+-"):
        own = slice(b * count, (b + 1) * count)
        name = f"$f^{branch}$, simulated"
        points(axes, ANGLES, comparison.band.value[own], b, name, comparison.bars[:, own])
    for edge in (-LIMIT, LIMIT):
        axes.axvline(edge, color="0.6", ls=":", lw=0.7, zorder=0.5)
    axes.set(xlabel="angle of the load from the vertical (degrees)", xlim=(-52, 52), yscale="log")
    axes.set_ylabel(r"$\sigma_f/\langle f\rangle$, r.m.s. over layers")
    axes.set_ylim(top=6 * curves.max())
    axes.legend(loc="upper center", ncols=2)
    rows = {
        "angle_deg": [*ANGLES, *ANGLES],
        "branch": [*"+" * count, *"-" * count],
        "t": [ratio(angle) for angle in (*ANGLES, *ANGLES)],
    }
    return packings.compared(
        drawn, "figureB2", o, [comparison], rows, height=HEIGHT, relative_std=PAPER_STD
    )
