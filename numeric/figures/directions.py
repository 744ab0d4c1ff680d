"""Figure B2: how much contact forces fluctuate as a surface load leaves the vertical.

Simulated are exact, nonlinear packings of W = 2M beads a layer; the curves are Eq. B2, exact to
first order at finite M. Both are root mean squares over all layers.
"""

from fractions import Fraction
from math import asin, degrees, radians, sqrt, tan

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..scene.sections import SurfaceLoad
from . import specification as spec
from .packings import (
    N_X,
    PAPER_STD,
    PHI,
    Options,
    band_of_spread,
    moments,
    of_ensembles,
    planned,
)

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
    form, share = closed_forms.surface_variance_at_angle, ratio(angle)
    plus, minus = (
        sum(form(HEIGHT, j, t, float(PHI), PAPER_STD, 1.0) for j in range(HEIGHT))
        for t in (share, 1 / share)
    )
    return sqrt(plus / HEIGHT), sqrt(minus / HEIGHT)


def over_layers(change: Array) -> Array:
    """Average over all contacts of a branch; (realisations, branches)."""
    return np.asarray(change.mean(axis=3).mean(axis=0).T)


def simulated(o: Options) -> spec.Comparison:
    """Simulate all angles, each on radii of its own: f⁺ at all of them, then f⁻."""
    found = []
    for place, angle in enumerate(ANGLES):
        ensemble = planned(
            "profile", height=HEIGHT, seed=o.seed, realisations=o.realisations,
            load=SurfaceLoad(angle_deg=Fraction(angle)),
        )  # fmt: skip
        what = f"figure B2, {angle} degrees"
        found.append(moments(ensemble, o.notice, what, over_layers, place << 32))
    mean, square = (
        np.stack(parts, axis=2).reshape(o.realisations, -1) for parts in zip(*found, strict=True)
    )
    exact = np.array([theory(angle) for angle in ANGLES]).T.ravel()
    what = f"M = {HEIGHT}, {len(ANGLES)} angles, both branches: Eq. B2"
    return spec.Comparison(what, band_of_spread(mean, square, o.seed), exact)


def figure(o: Options) -> spec.Figure:
    """σ_f/⟨f⟩ of both branches over the angle of the load, up to that of the contacts."""
    found, count = simulated(o), len(ANGLES)
    fine = np.linspace(-0.93 * LIMIT, 0.93 * LIMIT, 161)
    curves = np.array([theory(angle) for angle in fine]).T
    halves = slice(0, count), slice(count, None)
    rms = r"$\sigma_f/\langle f\rangle$, r.m.s. over layers"
    panel = spec.Panel(
        [
            *(spec.Line(fine, curves[b], b, name=f"$f^{s}$, theory") for b, s in enumerate("+-")),
            *(
                found.points(ANGLES, b, f"$f^{s}$, simulated", rows=halves[b])
                for b, s in enumerate("+-")
            ),
            *(spec.Rule("x", edge, dashes=":") for edge in (-LIMIT, LIMIT)),
        ],
        spec.Axis("angle of the load from the vertical (degrees)", -52, 52),
        spec.Axis(rms, None, 6 * curves.max(), log=True),
        legend="upper center",
        columns=2,
    )  # fmt: skip
    table = {
        "angle_deg": [*ANGLES, *ANGLES],
        "branch": [*"+" * count, *"-" * count],
        "t": [ratio(angle) for angle in (*ANGLES, *ANGLES)],
        **found.columns(),
    }
    return spec.Figure(
        spec.Picture([panel], 2.6),
        tables={"figureB2": table},
        facts=of_ensembles(o, PAPER_STD, height=HEIGHT) | found.fact(),
        comparisons=[found],
    )
