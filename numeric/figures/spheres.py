"""Figure B13: figure 3 in three dimensions, σ_f/⟨f⟩ of exact packings of spheres against theory.

Simulated are exact, nonlinear packings of W = 2M by 2M beads a layer, which see no image. The
curves are Eqs. B13 and B14, exact to first order at finite M, and their leading orders.
"""

import numpy as np

from ..arithmetic.systems import Array
from ..scene.sections import BulkLoad, SurfaceLoad
from ..theory.expected import leading_stds, stds_by_layer
from . import packings
from .packings import PAPER_STD, PHI, Comparison, Made, Options
from .style import COLUMN, GREY, RELATIVE_HEIGHT, panels, points

CASES = (("surface", 8), ("surface", 16), ("bulk", 16))
LOADS = {"surface": ("B13", SurfaceLoad), "bulk": ("B14", BulkLoad)}


def exact(load: str, M: int) -> Array:
    """σ_f/⟨f⟩ by layer, to first order at finite M (Eqs. B13 and B14); shape (M,)."""
    return stds_by_layer(load, M, float(PHI), (1.0, 1.0, 1.0)) * PAPER_STD


def leading(load: str, z: Array) -> Array:
    """The leading orders over M^(3/2)."""
    return leading_stds(load, 1, z, float(PHI), spheres=True) * PAPER_STD


def simulated(o: Options, place: int) -> Comparison:
    """Simulate a case, each on radii of its own."""
    load, M = CASES[place]
    number, loaded = LOADS[load]
    ensemble = packings.planned("profile", o, height=M, load=loaded(), dimension=3)
    what = f"{load} load, M = {M}"
    averaged = packings.moments(ensemble, o.notice, f"figure B13, {what}", place << 32)
    band = packings.band_of_spread(*averaged, o.seed)
    return Comparison(f"{what}: Eq. {number}", band, exact(load, M))


def figure(o: Options) -> Made:
    """Points with bands, the exact curves, and the leading orders, over M^(3/2)."""
    cases, fine = [simulated(o, place) for place in range(len(CASES))], np.linspace(0, 1, 101)
    drawn, (axes,) = panels("a", COLUMN, 2.8)
    axes.plot([], [], color=GREY, label="exact at finite $M$")
    axes.plot([], [], "--", color=GREY, label=r"$M\to\infty$")
    for c, ((load, M), case) in enumerate(zip(CASES, cases, strict=True)):
        z, unit = np.arange(M) / M, PAPER_STD * M**1.5
        axes.plot(z, case.theory / unit, color=f"C{c}")
        name = f"{load}, $M={M}$, simulated"
        points(axes, z, case.band.value / unit, c, name, case.bars / unit)
    for load in LOADS:
        axes.plot(fine, leading(load, fine) / PAPER_STD, "--", color=GREY)
    axes.set(xlabel=RELATIVE_HEIGHT, xlim=(0, 1))
    axes.set_ylabel(r"$M^{-3/2}\,(\sigma_f/\langle f\rangle)\,/\,(\sigma_{\delta r}/r)$")
    axes.set_ylim(bottom=0)
    axes.legend(loc="upper right")
    layers = [
        (load, M, j, j / M, printed)
        for load, M in CASES
        for j, printed in enumerate((leading(load, np.arange(M) / M) * M**1.5).tolist())
    ]
    rows = packings.table("load M j z printed", layers)
    return packings.compared(drawn, "figureB13", o, cases, rows, relative_std=PAPER_STD)
