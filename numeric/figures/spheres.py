"""Figure B13: figure 3 in three dimensions, σ_f/⟨f⟩ of exact packings of spheres against theory.

Simulated are exact, nonlinear packings of W = 2M by 2M beads a layer, which see no image. The
curves are Eqs. B13 and B14, exact to first order at finite M, and their leading orders.
"""

from typing import NamedTuple

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..scene.sections import BulkLoad, SurfaceLoad
from . import specification as spec
from .packings import PAPER_STD, PHI, Options, band_of_spread, moments, of_ensembles, planned


class Case(NamedTuple):
    """A load, and the height of the packings under it."""

    load: str
    height: int

    @property
    def z(self) -> Array:
        """Relative heights of its layers."""
        return np.arange(self.height) / self.height


CASES = (Case("surface", 8), Case("surface", 16), Case("bulk", 16))
LOADS = {"surface": ("B13", SurfaceLoad), "bulk": ("B14", BulkLoad)}


def exact(case: Case) -> Array:
    """σ_f/⟨f⟩ by layer, to first order at finite M (Eqs. B13 and B14); shape (M,)."""
    bulk = case.load == "bulk"
    form = (
        closed_forms.bulk_variance_of_spheres if bulk else closed_forms.surface_variance_of_spheres
    )
    M = case.height
    return np.sqrt([float(form(M, j, float(PHI), PAPER_STD, 1.0)) for j in range(M)])


def leading(load: str, z: Array) -> Array:
    """The leading orders over M^(3/2)."""
    surface, bulk = (
        closed_forms.surface_diffusion_of_spheres,
        closed_forms.bulk_diffusion_of_spheres,
    )
    form = bulk if load == "bulk" else surface
    return np.sqrt([form(1, at, float(PHI), PAPER_STD, 1.0) for at in z])


def over_contacts(change: Array) -> Array:
    """Average over all contacts of a layer at once; (realisations, M)."""
    return np.asarray(change.mean(axis=(1, 3)).T)


def simulated(o: Options, place: int, case: Case) -> spec.Comparison:
    """Simulate a case, each on radii of its own."""
    M, (number, load) = case.height, LOADS[case.load]
    ensemble = planned(
        "profile", height=M, seed=o.seed, realisations=o.realisations, load=load(), dimension=3
    )  # fmt: skip
    what = f"{case.load} load, M = {M}"
    found = moments(ensemble, o.notice, f"figure B13, {what}", over_contacts, place << 32)
    return spec.Comparison(f"{what}: Eq. {number}", band_of_spread(*found, o.seed), exact(case))


def figure(o: Options) -> spec.Figure:
    """Points with bands, the exact curves, and the leading orders, over M^(3/2)."""
    found = [simulated(o, place, case) for place, case in enumerate(CASES)]
    fine, unit = np.linspace(0, 1, 101), [PAPER_STD * case.height**1.5 for case in CASES]
    panel = spec.Panel(
        [
            spec.Line(name="exact at finite $M$"),
            spec.Line(name=r"$M\to\infty$", dashes="--"),
            *(
                one.drawn(case.z, c, f"{case.load}, $M={case.height}$", unit=unit[c])
                for c, (case, one) in enumerate(zip(CASES, found, strict=True))
            ),
            *(spec.Line(fine, leading(load, fine) / PAPER_STD, dashes="--") for load in LOADS),
        ],
        spec.RELATIVE_HEIGHT,
        spec.Axis(r"$M^{-3/2}\,(\sigma_f/\langle f\rangle)\,/\,(\sigma_{\delta r}/r)$", 0),
        legend="upper right",
    )
    layers = [(*case, j, z) for case in CASES for j, z in enumerate(case.z.tolist())]
    printed = [leading(case.load, case.z) * case.height**1.5 for case in CASES]
    return spec.Figure(
        spec.Picture([panel], 2.8),
        tables={
            "figureB13": spec.table("load M j z", layers)
            | spec.stacked([one.columns() for one in found])
            | {"printed": np.concatenate(printed)}
        },
        facts={
            **of_ensembles(o, PAPER_STD, cases=[case._asdict() for case in CASES]),
            "largest_deviation_in_half_widths": [one.deviation() for one in found],
        },
        comparisons=found,
    )
