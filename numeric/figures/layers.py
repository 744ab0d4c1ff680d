"""Figure B12: how the forces of two contacts on one diagonal go together, over their heights.

Simulated are exact, nonlinear packings under a surface load; curves are Eq. B12, exact to first
order, and its leading order as M → ∞.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..statistics.bands import Band, averaged, simultaneous
from .packings import PAPER_STD, PHI, Notice, Row, planned, solved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 24
LOWER = (2, 8, 14)
UPPER = {j: tuple(range(j + 2, HEIGHT - 1, 2)) for j in LOWER}
PAIRS = [(j, upper) for j in LOWER for upper in UPPER[j]]
LEVEL = 0.99


def _leading(lower: float, upper: Array) -> Array:
    """Covariance at the heights z < z′ over M³(σ/r)²/(1−φ²)², as M → ∞."""
    return np.asarray((1 - upper) * (3 * (1 - lower**2) - (1 - upper) ** 2))


@dataclass(frozen=True)
class Layers:
    """The band holds ln of the covariances of ``PAIRS``, over ``unit``."""

    realisations: int
    band: Band

    @property
    def unit(self) -> float:
        """M³(σ/r)²/(1−φ²)²."""
        return float(HEIGHT**3 * PAPER_STD**2 / (1 - float(PHI) ** 2) ** 2)

    def theory(self) -> Array:
        """Eq. B12 over ``unit``, in the order of the pairs."""
        form = closed_forms.layers_covariance
        return (
            np.array([form(HEIGHT, *pair, float(PHI), PAPER_STD, 1.0) for pair in PAIRS])
            / self.unit
        )

    def deviation(self, scale: float = 1.0) -> float:
        """Largest deviation of theory, in half-widths of the band: inside is ≤ 1."""
        return self.band.deviation(scale * self.unit * self.theory())

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a pair."""
        found, (low, high) = np.exp(self.band.estimate.log), self.band.limits
        return {
            "figureB12": [
                {
                    "j": lower,
                    "l": upper,
                    "covariance_simulated": float(found[at] / self.unit),
                    "band_low": float(low[at] / self.unit),
                    "band_high": float(high[at] / self.unit),
                    "covariance_exact_first_order": float(exact),
                }
                for at, ((lower, upper), exact) in enumerate(zip(PAIRS, self.theory(), strict=True))
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdict and parameters."""
        return {
            "height": HEIGHT,
            "realisations": self.realisations,
            "relative_std": PAPER_STD,
            "simultaneous_level": LEVEL,
            "largest_deviation_in_half_widths": self.deviation(),
        }

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        return [f"M = {HEIGHT}: Eq. B12 {self.band.verdict(self.deviation())}"]


def simulate(realisations: int, seed: int, notice: Notice) -> Layers:
    """Solve packings, and multiply the forces of both contacts of all diagonals."""
    ensemble = planned(
        "profile", height=HEIGHT, width=2 * HEIGHT, seed=seed, realisations=realisations
    )
    products = []
    for answer, number in solved(ensemble, range(realisations), notice, "figure B12"):
        forces = answer.forces
        assert forces is not None
        # by upper beads, of layer j + 1; from an odd to an even layer a diagonal gains a place
        change = {
            j: np.roll(
                (forces.change.plus[j + 1] / forces.ordered.plus[j + 1]).reshape(number, -1),
                -((j + 1) // 2),
                axis=1,
            )
            for j in range(HEIGHT)
        }
        products.append(
            np.stack([(change[low] * change[up]).mean(axis=1) for low, up in PAIRS], axis=1)
        )
    product = np.concatenate(products)
    mean = product.mean(axis=0)
    return Layers(
        realisations, simultaneous(averaged(np.log(mean), (product - mean) / mean), LEVEL, seed)
    )


def draw(data: Layers) -> "Figure":
    """Draw the covariance over the height of the upper contact, a curve for each lower one."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    found, exact = np.exp(data.band.estimate.log) / data.unit, data.theory()
    low, high = (side / data.unit for side in data.band.limits)
    for b, j in enumerate(LOWER):
        look = style.series(b)
        here = [at for at, (lower, _) in enumerate(PAIRS) if lower == j]
        z = np.array(UPPER[j]) / HEIGHT
        axes.plot(z, exact[here], color=look[0], label=f"$z={j}/{HEIGHT}$")
        fine = np.linspace(j / HEIGHT, 1, 101)
        axes.plot(fine, _leading(j / HEIGHT, fine), "--", color="0.55", lw=0.8)
        error = found[here] - low[here], high[here] - found[here]
        style.points(axes, z, found[here], error, look)
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    axes.set_xlabel("height of the upper contact $z'$")
    axes.set_ylabel(r"covariance $/\,M^3(\sigma/r)^2(1-\phi^2)^{-2}$")
    axes.legend(loc="upper right", title="lower contact")
    return figure
