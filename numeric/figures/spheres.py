"""Figure B13: figure 3 in three dimensions, σ_f/⟨f⟩ of exact packings of spheres against theory.

Simulated are exact, nonlinear packings of W = 2M by 2M beads a layer, which see no image. The
curves are Eqs. B13 and B14, exact to first order at finite M, and their leading orders.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..scene.sections import BulkLoad, Load, SurfaceLoad
from ..statistics.bands import Band, averaged, log_relative_std, simultaneous
from .packings import PAPER_STD, PHI, Notice, Row, changes, planned

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEVEL = 0.99


class Case(NamedTuple):
    """A load, and the height of the packings under it."""

    load: str
    height: int


CASES = (Case("surface", 8), Case("surface", 16), Case("bulk", 16))
LOADS: dict[str, type[Load]] = {"surface": SurfaceLoad, "bulk": BulkLoad}


def exact(case: Case) -> Array:
    """σ_f/⟨f⟩ by layer, to first order at finite M (Eqs. B13 and B14); shape (M,)."""
    bulk = case.load == "bulk"
    form = (
        closed_forms.bulk_variance_of_spheres if bulk else closed_forms.surface_variance_of_spheres
    )
    M = case.height
    return np.sqrt([float(form(M, j, float(PHI), PAPER_STD, 1.0)) for j in range(M)])


def leading(load: str, z: Array) -> Array:
    """The leading orders over M^(3/2); under a bulk load as that of discs is to Eq. 13."""
    form = closed_forms.diffusion_in_dimensions
    surface = np.array([form(3, 1, at, float(PHI), PAPER_STD, 1.0) for at in z])
    return np.asarray(
        np.sqrt(surface * (0.15 * (1 + 4 * z) / (1 + 2 * z) if load == "bulk" else 1))
    )


@dataclass(frozen=True)
class Spheres:
    """Simultaneous bands over all layers, one for each of ``CASES``."""

    realisations: int
    bands: tuple[Band, ...]

    def deviations(self) -> list[float]:
        """Largest deviation of theory, in half-widths of each band: inside is ≤ 1."""
        pairs = zip(self.bands, CASES, strict=True)
        return [band.deviation(exact(case)) for band, case in pairs]

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a layer of each case."""
        rows: list[Row] = []
        for case, band in zip(CASES, self.bands, strict=True):
            z, (low, high) = np.arange(case.height) / case.height, band.limits
            columns = {
                "z": z,
                "simulated": np.exp(band.estimate.log),
                "band_low": low,
                "band_high": high,
                "exact_first_order": exact(case),
                "printed": leading(case.load, z) * case.height**1.5,
            }
            for j in range(case.height):
                values = {name: float(column[j]) for name, column in columns.items()}
                rows.append({"load": case.load, "M": case.height, "j": j, **values})
        return {"figureB13": rows}

    def facts(self) -> dict[str, Any]:
        """Verdicts and parameters."""
        return {
            "cases": [case._asdict() for case in CASES],
            "realisations": self.realisations,
            "relative_std": PAPER_STD,
            "simultaneous_level": LEVEL,
            "largest_deviation_in_half_widths": self.deviations(),
        }

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        return [
            f"{case.load} load, M = {case.height}: Eq. {'B14' if case.load == 'bulk' else 'B13'} "
            f"{band.verdict(deviation)}"
            for case, band, deviation in zip(CASES, self.bands, self.deviations(), strict=True)
        ]


def simulate(realisations: int, seed: int, notice: Notice) -> Spheres:
    """Simulate all cases, each on radii of its own."""
    bands = []
    for place, case in enumerate(CASES):
        M = case.height
        ensemble = planned(
            "profile", height=M, width=2 * M, seed=seed, realisations=realisations,
            load=LOADS[case.load](), dimension=3,
        )  # fmt: skip
        start = place << 32
        what = f"figure B13, {case.load} load, M = {M}"
        numbers = range(start, start + realisations)
        means, squares = [], []
        for F, g in changes(ensemble, numbers, notice, what):
            each = (g / F[:, :1, None]).reshape(M, 3, g.shape[1], -1)
            means.append(each.mean(axis=(1, 3)).T)
            squares.append((each**2).mean(axis=(1, 3)).T)
        estimate = averaged(*log_relative_std(np.concatenate(means), np.concatenate(squares)))
        bands.append(simultaneous(estimate, LEVEL, seed))
    return Spheres(realisations, tuple(bands))


def draw(data: Spheres) -> "Figure":
    """Draw points with bands, the exact curves, and the leading orders, over M^(3/2)."""
    from . import style

    figure = style.figure(style.COLUMN, 2.8)
    axes = figure.subplots()
    fine = np.linspace(0, 1, 101)
    for place, (case, band) in enumerate(zip(CASES, data.bands, strict=True)):
        look, scale = style.series(place), case.height**-1.5 / PAPER_STD
        z, found = np.arange(case.height) / case.height, np.exp(band.estimate.log)
        low, high = band.limits
        axes.plot(z, scale * exact(case), color=look[0], lw=0.9)
        error = scale * (found - low), scale * (high - found)
        style.points(axes, z, scale * found, error, look, f"{case.load}, $M={case.height}$")
    for load in LOADS:
        axes.plot(fine, leading(load, fine) / PAPER_STD, color="0.35", ls="--", lw=0.8)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(r"$M^{-3/2}\,(\sigma_f/\langle f\rangle)\,/\,(\sigma_{\delta r}/r)$")
    points, _ = axes.get_legend_handles_labels()
    lines = [
        style.line("0.35", "-", "Eqs. (B13), (B14), exact"),
        style.line("0.35", "--", r"$M\to\infty$"),
    ]
    axes.legend(handles=[*lines, *points], loc="upper right")
    return figure
