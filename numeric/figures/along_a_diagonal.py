"""Figure B12: how the forces of two contacts on one diagonal go together, over their heights.

Simulated are exact, nonlinear packings under a surface load; curves are Eq. B12, exact to first
order, and its leading order as M → ∞.
"""

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..mechanics.problem import Solved
from . import specification as spec
from .packings import (
    PAPER_STD,
    PHI,
    Options,
    band_of_means,
    forces_of,
    gathered,
    of_ensembles,
    planned,
)

HEIGHT = 24
LOWER = (2, 8, 14)
UPPER = {j: tuple(range(j + 2, HEIGHT - 1, 2)) for j in LOWER}
PAIRS = [(j, upper) for j in LOWER for upper in UPPER[j]]
UNIT = float(HEIGHT**3 * PAPER_STD**2 / (1 - float(PHI) ** 2) ** 2)
"""M³(σ/r)²/(1−φ²)²."""


def leading(lower: float, upper: Array) -> Array:
    """Covariance at the heights z < z′ over ``UNIT``, as M → ∞."""
    return np.asarray((1 - upper) * (3 * (1 - lower**2) - (1 - upper) ** 2))


def products(answer: Solved, number: int) -> tuple[Array]:
    """Mean products of the relative forces of both contacts of all pairs; (number, pairs)."""
    forces = forces_of(answer)
    # by upper beads, of layer j + 1; from an odd to an even layer a diagonal gains a place
    change = {
        j: np.roll(
            (forces.change.plus[j + 1] / forces.ordered.plus[j + 1]).reshape(number, -1),
            -((j + 1) // 2),
            axis=1,
        )
        for j in range(HEIGHT)
    }
    return (np.stack([(change[low] * change[up]).mean(axis=1) for low, up in PAIRS], axis=1),)


def simulated(o: Options) -> spec.Comparison:
    """Solve packings; covariances of ``PAIRS``."""
    ensemble = planned("profile", height=HEIGHT, seed=o.seed, realisations=o.realisations)
    (product,) = gathered(ensemble, o.notice, "figure B12", products)
    form = closed_forms.layers_covariance
    exact = np.array([form(HEIGHT, *pair, float(PHI), PAPER_STD, 1.0) for pair in PAIRS])
    return spec.Comparison(f"M = {HEIGHT}: Eq. B12", band_of_means(product, o.seed), exact)


def figure(o: Options) -> spec.Figure:
    """The covariance over the height of the upper contact, a curve for each lower one."""
    found = simulated(o)
    panel: list[spec.Element] = []
    for c, j in enumerate(LOWER):
        rows = np.array([lower == j for lower, _ in PAIRS])
        z, fine = np.array(UPPER[j]) / HEIGHT, np.linspace(j / HEIGHT, 1, 101)
        panel += [
            spec.Line(fine, leading(j / HEIGHT, fine), c, "--"),
            *found.drawn(z, c, f"lower contact at $z={j}/{HEIGHT}$", unit=UNIT, rows=rows),
        ]
    panel += [
        spec.Line(name=f"exact at $M={HEIGHT}$"),
        spec.Line(name=r"its leading order, $M\to\infty$", dashes="--"),
    ]
    return spec.Figure(
        spec.Picture(
            [
                spec.Panel(
                    panel,
                    spec.Axis(r"height of the upper contact $z^\prime$", 0, 1),
                    spec.Axis(
                        r"cov. $/\,[\langle f\rangle^2M^3(\sigma_{\delta r}/r)^2(1-\phi^2)^{-2}]$",
                        0,
                        2.6,
                    ),
                    legend="upper right",
                )
            ],
            2.8,
        ),
        tables={"figureB12": spec.table("j l", PAIRS) | found.columns("covariance_", UNIT)},
        facts=of_ensembles(o, PAPER_STD, height=HEIGHT) | found.fact(),
        comparisons=[found],
    )
