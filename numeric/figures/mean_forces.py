"""Figure B5: how the mean contact force departs from that of the ordered packing, at order σ².

Simulated are exact, nonlinear packings, each solved to first order as well (``shifts``). The curves
are Eqs. B5 and B6.
"""

from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..scene.sections import BulkLoad, SurfaceLoad
from .packings import Notice, Row, changes, planned
from .shifts import LEVEL, STD, Shift, cosine, shift

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 12
SPACINGS = (Fraction(12, 5), Fraction(3))
"""s in units of r: φ = 7/25, where forces fall below z = φ; −1/8, where all rise but at j = 1."""
LOADS: tuple[Literal["surface", "bulk"], ...] = ("surface", "bulk")


def theory(load: str, height: int, spacing: Fraction) -> Array:
    """⟨f⟩ over its ordered value, less 1, in units of (σ/r)², shape (M,) (Eqs. B5, B6)."""
    form = {"surface": closed_forms.surface_mean_shift, "bulk": closed_forms.bulk_mean_shift}[load]
    return np.array([form(height, j, cosine(spacing), 1.0, 1.0) for j in range(height)])


@dataclass(frozen=True)
class Mean:
    """One load and spacing; ``shift`` has shape (M,)."""

    load: str
    spacing: Fraction
    shift: Shift

    @property
    def exact(self) -> Array:
        """What theory says."""
        return theory(self.load, HEIGHT, self.spacing)


@dataclass(frozen=True)
class MeanForces:
    """What figure B5 shows."""

    realisations: int
    means: tuple[Mean, ...]

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a layer."""
        rows = []
        for one in self.means:
            for j in range(HEIGHT):
                rows.append(
                    {
                        "load": one.load,
                        "spacing": float(one.spacing),
                        "phi": cosine(one.spacing),
                        "j": j,
                        "shift_simulated": float(one.shift.mean[j]),
                        "band_half_width": float(one.shift.half[j]),
                        "shift_exact": float(one.exact[j]),
                    }
                )
        return {"figureB5": rows}

    def facts(self) -> dict[str, Any]:
        """Verdicts and parameters."""
        return {
            "height": HEIGHT,
            "realisations": self.realisations,
            "relative_std": STD,
            "simultaneous_level": LEVEL,
            "largest_deviations_in_half_widths": [
                one.shift.deviation(one.exact) for one in self.means
            ],
        }

    def lines(self) -> list[str]:
        """Say whether theory holds, and whether a mean without shift would."""
        said = []
        for one in self.means:
            off, flat = one.shift.deviation(one.exact), one.shift.deviation(np.zeros(HEIGHT))
            number = "B5" if one.load == "surface" else "B6"
            verdict = one.shift.band.verdict(off)
            said.append(
                f"{one.load} load, s = {float(one.spacing):g} r: Eq. {number} {verdict}; no shift "
                f"at all would be {flat:.1f} of it off"
            )
        return said


def simulate(realisations: int, seed: int, notice: Notice) -> MeanForces:
    """Solve all packings exactly and to first order."""
    found = []
    for spacing, load in product(SPACINGS, LOADS):

        def changed(geometry: str, spacing: Fraction = spacing, load: str = load) -> Array:
            ensemble = planned(
                "profile", height=HEIGHT, width=2 * HEIGHT, seed=seed, std=STD,
                realisations=realisations, geometry=geometry, spacing=spacing,
                load=SurfaceLoad() if load == "surface" else BulkLoad(),
            )  # fmt: skip
            what = f"figure B5, {load} load, s = {float(spacing):g} r, {geometry}"
            return np.concatenate(
                [
                    (g / F[:, None]).mean(axis=2).reshape(HEIGHT, 2, -1).mean(axis=1).T
                    for F, g in changes(ensemble, range(realisations), notice, what)
                ]
            )

        found.append(Mean(load, spacing, shift(changed, seed)))
    return MeanForces(realisations, tuple(found))


def draw(data: MeanForces) -> "Figure":
    """Draw shifts over M for both loads; one colour a spacing."""
    from . import style

    figure = style.figure(style.PAGE, 2.6)
    panels = dict(zip(LOADS, figure.subplots(1, 2, sharey=True), strict=True))
    z = np.arange(HEIGHT) / HEIGHT
    for one in data.means:
        axes, place = panels[one.load], SPACINGS.index(one.spacing)
        look = style.series(place)
        phi = cosine(one.spacing)
        fine = np.linspace(0, 1, 201)
        rising = 2 * (fine - phi) if one.load == "surface" else 2 * fine - phi * (1 + fine)
        unit = (1 - phi**2) * (1 + phi)
        axes.plot(fine, rising / unit, "--", color=look[0], lw=0.8)
        axes.plot(z, one.exact / HEIGHT, color=look[0])
        name = rf"$\phi={phi:g}$, simulated"
        style.points(axes, z, one.shift.mean / HEIGHT, one.shift.half / HEIGHT, look, name)
    for load, axes in panels.items():
        axes.axhline(0, color="0.6", lw=0.6)
        axes.set_xlim(-0.02, 1)
        axes.set_xlabel("relative height $z=j/M$")
        axes.set_title(f"{load} load", pad=4)
    panels["surface"].set_ylabel(r"$(\langle f\rangle/f_{0}-1)\,/\,M(\sigma_{\delta r}/r)^2$")
    first = panels["surface"]
    number = {"surface": "B5", "bulk": "B6"}
    for load, axes in panels.items():
        own = [
            style.line("0.35", "-", f"Eq. ({number[load]}), exact at $M={HEIGHT}$"),
            style.line("0.35", "--", r"$M\to\infty$"),
        ]
        points, _ = axes.get_legend_handles_labels()
        axes.legend(handles=[*own, *points] if axes is first else own, loc="upper left")
    style.letter(list(panels.values()))
    return figure
