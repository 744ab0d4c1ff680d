"""Figure B5: how the mean contact force departs from that of the ordered packing, at order σ².

Simulated are exact, nonlinear packings, each solved to first order as well (``shifts``). The curves
are Eqs. B5 and B6.
"""

from fractions import Fraction
from itertools import product

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..scene.sections import BulkLoad, SurfaceLoad
from . import specification as spec
from .packings import Options, by_layer, moments, of_ensembles, planned
from .shifts import STD, columns, cosine, facts, shift

HEIGHT = 12
SPACINGS = (Fraction(12, 5), Fraction(3))
"""s in units of r: φ = 7/25, where forces fall below z = φ; −1/8, where all rise but at j = 1."""
LOADS = {
    "surface": ("B5", SurfaceLoad, closed_forms.surface_mean_shift),
    "bulk": ("B6", BulkLoad, closed_forms.bulk_mean_shift),
}
CASES = list(product(SPACINGS, LOADS))
BULK = slice(2, HEIGHT - 1)
"""Layers of Eqs. B5 and B6; those beside base and surface have values of their own."""


def theory(load: str, height: int, spacing: Fraction) -> Array:
    """⟨f⟩ over its ordered value, less 1, in units of (σ/r)², shape (M,) (Eqs. B5, B6)."""
    *_, form = LOADS[load]
    return np.array([form(height, j, cosine(spacing), 1.0, 1.0) for j in range(height)])


def leading(load: str, z: Array, phi: float) -> Array:
    """The same over M as M → ∞."""
    rising = 2 * (z - phi) if load == "surface" else 2 * z - phi * (1 + z)
    return np.asarray(rising / ((1 - phi**2) * (1 + phi)))


def simulated(o: Options, spacing: Fraction, load: str) -> spec.Comparison:
    """Solve all packings exactly and to first order."""
    number, loaded, _ = LOADS[load]
    where = f"{load} load, s = {float(spacing):g} r"

    def changed(geometry: str) -> Array:
        ensemble = planned(
            "profile", height=HEIGHT, seed=o.seed, std=STD,
            realisations=o.realisations, geometry=geometry, spacing=spacing, load=loaded(),
        )  # fmt: skip
        return moments(ensemble, o.notice, f"figure B5, {where}, {geometry}", by_layer)[0]

    exact = theory(load, HEIGHT, spacing)
    return shift(f"{where}: Eq. {number}", changed, exact, o.seed)


def panel(load: str, found: list[spec.Comparison]) -> spec.Panel:
    """Shifts over M, a colour a spacing."""
    z, fine = np.arange(HEIGHT) / HEIGHT, np.linspace(0, 1, 201)
    phis = [cosine(spacing) for spacing in SPACINGS]
    return spec.Panel(
        [
            spec.Line(name=f"exact at $M={HEIGHT}$"),
            spec.Line(name=r"$M\to\infty$", dashes="--"),
            *(spec.Line(fine, leading(load, fine, phi), c, "--") for c, phi in enumerate(phis)),
            *(
                one.drawn(z, c, rf"$\phi={phi:g}$, simulated", unit=HEIGHT, bulk=BULK)
                for c, (one, phi) in enumerate(zip(found, phis, strict=True))
            ),
            spec.Rule("y", 0),
        ],
        spec.RELATIVE_HEIGHT,
        spec.Axis(
            r"$(\langle f\rangle/f_{0}-1)\,/\,[M(\sigma_{\delta r}/r)^2]$"
            if load == "surface"
            else ""
        ),
        title=f"{load} load",
        legend="upper left",
    )


def figure(o: Options) -> spec.Figure:
    """Shifts of the mean under both loads, at two spacings."""
    found = [simulated(o, *case) for case in CASES]
    layers = [(load, float(s), cosine(s), j) for s, load in CASES for j in range(HEIGHT)]
    return spec.Figure(
        spec.Picture([panel("surface", found[::2]), panel("bulk", found[1::2])], 2.6, page=True,
                share="y"),
        tables={"figureB5": spec.table("load spacing phi j", layers) | columns("shift", found)},
        facts=of_ensembles(o, STD, height=HEIGHT) | facts(found),
        words=[
            f"{one.verdict()}; without any shift it would be "
            f"{one.deviation(np.zeros(HEIGHT)):.1f}"
            for one in found
        ],
        comparisons=found,
    )  # fmt: skip
