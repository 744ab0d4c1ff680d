"""Figure B5: how the mean contact force departs from that of the ordered packing, at order σ².

Simulated are exact, nonlinear packings, each solved to first order as well (``band_of_shift``). The
curves are Eqs. B5 and B6.
"""

from fractions import Fraction
from itertools import product

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..planning.plan import Plan
from ..scene.sections import BulkLoad, SurfaceLoad
from . import packings
from .packings import Comparison, Made, Medium, Options
from .style import GREY, PAGE, RELATIVE_HEIGHT, curve, panels, points

HEIGHT = 12
STD = 1e-3
"""σ/r: what is of order σ⁴ is a share (M^(3/2) σ/r)², 0.002 for M = 12, of the shift or so."""
SPACINGS = (Fraction(12, 5), Fraction(3))
"""s in units of r: φ = 7/25, where forces fall below z = φ; −1/8, where all rise but at j = 1."""
LOADS = {
    "surface": ("B5", SurfaceLoad, closed_forms.surface_mean_shift),
    "bulk": ("B6", BulkLoad, closed_forms.bulk_mean_shift),
}
CASES = list(product(LOADS, SPACINGS))
BULK = slice(2, HEIGHT - 1)
"""Layers of Eqs. B5 and B6; those beside base and surface have values of their own."""


def cosine(spacing: Fraction) -> float:
    """φ of a spacing in units of r."""
    return float(Medium(spacing).phi)


def theory(load: str, height: int, spacing: Fraction) -> Array:
    """⟨f⟩ over its ordered value, minus 1, in units of (σ/r)², shape (M,) (Eqs. B5, B6)."""
    *_, form = LOADS[load]
    return np.array([form(height, j, height - j, cosine(spacing)) for j in range(height)])


def leading(load: str, z: Array, phi: float) -> Array:
    """The same over M as M → ∞."""
    rising = 2 * (z - phi) if load == "surface" else 2 * z - phi * (1 + z)
    return np.asarray(rising / ((1 - phi**2) * (1 + phi)))


def simulated(o: Options, load: str, spacing: Fraction) -> Comparison:
    """Solve all packings exactly and to first order."""
    number, loaded, _ = LOADS[load]
    where, medium = f"{load} load, s = {float(spacing):g} r", Medium(spacing, STD)

    def changes(plan: Plan) -> Array:
        what = f"figure B5, {where}, {plan.problem.route}"
        return packings.moments(plan, o.notice, what)[0]

    ensemble = packings.planned("profile", o, medium, height=HEIGHT, load=loaded())
    band = packings.band_of_shift(ensemble, changes, STD**2, o.seed)
    return Comparison(f"{where}: Eq. {number}", band, theory(load, HEIGHT, spacing))


def figure(o: Options) -> Made:
    """Shifts of the mean over M under both loads, at two spacings."""
    cases = [simulated(o, *case) for case in CASES]
    z, fine = np.arange(HEIGHT) / HEIGHT, np.linspace(0, 1, 201)
    drawn, axes = panels("ab", PAGE, 2.6, sharey=True)
    for panel, load, own in zip(axes, LOADS, (cases[:2], cases[2:]), strict=True):
        panel.axhline(0, color="0.6", lw=0.7, zorder=0.5)
        panel.plot([], [], color=GREY, label=f"exact at $M={HEIGHT}$")
        panel.plot([], [], "--", color=GREY, label=r"$M\to\infty$")
        for c, (result, phi) in enumerate(zip(own, map(cosine, SPACINGS), strict=True)):
            panel.plot(fine, leading(load, fine, phi), "--", color=f"C{c}")
            curve(panel, z, result.theory / HEIGHT, BULK, c)
            name = rf"$\phi={phi:g}$, simulated"
            points(panel, z, result.band.value / HEIGHT, c, name, result.bars / HEIGHT)
        panel.set(xlabel=RELATIVE_HEIGHT, xlim=(0, 1), title=f"{load} load")
        panel.legend(loc="upper left")
    shift = r"$(\langle f\rangle/f_{0}-1)\,/\,[M(\sigma_{\delta r}/r)^2]$"
    axes[0].set_ylabel(shift)
    layers = [(load, float(s), cosine(s), j) for load, s in CASES for j in range(HEIGHT)]
    rows = packings.table("load spacing phi j", layers)
    return packings.compared(drawn, "figureB5", o, cases, rows, height=HEIGHT, relative_std=STD)
