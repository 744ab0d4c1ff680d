"""Figure B9: the mean response to a point load at order σ²: a plateau inside the cone.

Simulated are exact, nonlinear packings, each solved to first order as well (``band_of_shift``),
whose mean response is that of the ordered packing. Curves are Eq. B9.
"""

from fractions import Fraction

import numpy as np

from ..arithmetic.systems import Array
from ..mechanics.sweep import Solved
from ..planning.plan import Plan
from ..scene.sections import PointLoad
from . import packings
from .mean_forces import STD, cosine
from .packings import Comparison, Made, Medium, Options
from .style import COLUMN, GREY, curve, panels, points

APEX, LAYER = 8, 2
SPACINGS = (Fraction(21, 10), Fraction(3))
"""s in units of r: φ = 0.449 with a positive plateau, φ = −1/8 with a negative one."""
REACH = APEX - LAYER
OFFSETS = np.arange(2 - REACH, REACH, 2)
"""Columns i − k of the contacts' lower beads."""


def theory(spacing: Fraction) -> Array:
    """Mean of f⁺ in layer ``LAYER`` at order σ² beside the leg, from it on; shape (l − j − 1,).

    In units of f_load/2n_y and (σ/r)²: the first line, then the plateau (Eq. B9).
    """
    phi = cosine(spacing)
    first, plateau = (7 * phi**2 + 14 * phi - 5) / 4, 2 * phi**2 + 3 * phi - 1
    inside = np.full(REACH - 1, plateau)
    inside[0] = first
    return inside / (1 - phi**2) ** 2


def beside(answer: Solved, number: int) -> Array:
    """Changes of f⁺ inside the cone, averaged with their mirror images; (number, l − j − 1)."""
    # row m holds what lies below the beads of layer m: l − m + 1 of them, from the left
    plus, minus = (answer.change(a, LAYER + 1) for a in range(2))
    return np.asarray((plus[:, 1:] + minus[:, ::-1][:, 1:]) / 2)


def simulated(o: Options, spacing: Fraction) -> Comparison:
    """Solve all packings exactly and to first order."""
    where, ordered = f"s = {float(spacing):g} r", 1 / (2 * np.sqrt((1 + cosine(spacing)) / 2))

    def changes(plan: Plan) -> Array:
        what = f"figure B9, {where}, {plan.problem.route}"
        return packings.gathered(plan, o.notice, what, beside)

    medium, load = Medium(spacing, STD), PointLoad(at=(0, APEX))
    ensemble = packings.planned("response", o, medium, height=APEX, width=None, load=load)
    band = packings.band_of_shift(ensemble, changes, ordered * STD**2, o.seed)
    return Comparison(f"{where}: Eq. B9", band, theory(spacing))


def figure(o: Options) -> Made:
    """The mean response in one layer between the legs of the cone, at two spacings."""
    cases = [simulated(o, spacing) for spacing in SPACINGS]
    drawn, (axes,) = panels("a", COLUMN, 2.6)
    axes.axhline(0, color="0.6", lw=0.7, zorder=0.5)
    for leg in (-REACH, REACH):
        axes.axvline(leg, color="0.6", ls=":", lw=0.7, zorder=0.5)
    axes.plot([], [], color=GREY, label="exact second order")
    for c, (case, spacing) in enumerate(zip(cases, SPACINGS, strict=True)):
        curve(axes, OFFSETS, case.theory, slice(1, None), c)
        name = rf"$\phi={cosine(spacing):.3g}$, simulated"
        points(axes, OFFSETS, case.band.value, c, name, case.bars)
    axes.set(xlabel=r"$i-k$ of a contact $f^{+}$ inside the cone", ylim=(-2.3, 3))
    mean = r"$2n_y\langle f^{+}\rangle\,/\,[f^{\rm load}(\sigma_{\delta r}/r)^2]$"
    axes.set_ylabel(mean)
    axes.legend(loc="upper center")
    places = [(float(s), cosine(s), int(offset)) for s in SPACINGS for offset in OFFSETS]
    rows = packings.table("spacing phi offset", places)
    return packings.compared(
        drawn, "figureB9", o, cases, rows, apex=APEX, layer=LAYER, relative_std=STD
    )
