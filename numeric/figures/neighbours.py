"""Figure B7: how the mean force of N neighbours fluctuates, for one branch and for beads.

Simulated are exact, nonlinear packings under a surface load; curves are Eqs. B7 and B8, exact to
first order, in the N that they are for, and what independent contacts would have.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..lattice.branch import Branch
from ..statistics.bands import Band, averaged, simultaneous
from .packings import N_X, PAPER_STD, PHI, Notice, Row, planned, solved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT, LAYER = 32, 16
WINDOWS = (1, 2, 3, 5, 8, 14)
LEVEL = 0.99


def contacts(count: int) -> float:
    """Variance of the mean of f⁺/⟨f⟩ over 3 ≤ N ≤ j − 1 neighbours in layer j (Eq. B7)."""
    form = closed_forms.contacts_mean_variance
    return float(form(HEIGHT, LAYER, count, float(PHI), PAPER_STD, 1.0))


def beads(count: int) -> float:
    """The same of the vertical force on a bead over its mean, 3 ≤ N ≤ j − 2 (Eq. B8)."""
    form = closed_forms.beads_mean_variance
    return float(form(HEIGHT, LAYER, count, float(PHI), PAPER_STD, 1.0))


@dataclass(frozen=True)
class Neighbours:
    """The band holds ln σ of windows of contacts, then of beads; one a window."""

    realisations: int
    band: Band

    def theory(self) -> Array:
        """σ where Eqs. B7 and B8 are meant, else NaN; in the band's order."""
        return np.sqrt(
            [
                form(count) if count >= 3 else np.nan
                for form in (contacts, beads)
                for count in WINDOWS
            ]
        )

    def deviation(self, scale: float = 1.0) -> float:
        """Largest deviation of theory, in half-widths of the band: inside is ≤ 1."""
        off = np.abs(np.log(scale * self.theory()) - self.band.estimate.log) / self.band.half
        return float(np.nanmax(off))

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a window."""
        low, high = self.band.limits
        found, exact = np.exp(self.band.estimate.log), self.theory()
        return {
            "figureB7": [
                {
                    "of": of,
                    "N": count,
                    "sigma_simulated": float(found[at]),
                    "band_low": float(low[at]),
                    "band_high": float(high[at]),
                    "sigma_exact_first_order": "" if count < 3 else float(exact[at]),
                }
                for b, of in enumerate(("contacts", "beads"))
                for at, count in enumerate(WINDOWS, start=b * len(WINDOWS))
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdict and parameters."""
        return {
            "height": HEIGHT,
            "layer": LAYER,
            "realisations": self.realisations,
            "relative_std": PAPER_STD,
            "simultaneous_level": LEVEL,
            "largest_deviation_in_half_widths": self.deviation(),
        }

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        verdict = self.band.verdict(self.deviation())
        return [f"M = {HEIGHT}, j = {LAYER}: Eqs. B7 and B8 {verdict}"]


def simulate(realisations: int, seed: int, notice: Notice) -> Neighbours:
    """Solve packings, and average neighbours of one layer in windows at every place."""
    ensemble = planned(
        "profile", height=HEIGHT, width=2 * HEIGHT, seed=seed, realisations=realisations
    )
    n_y = np.sqrt(1 - float(N_X) ** 2)
    squares = []
    for answer, number in solved(ensemble, range(realisations), notice, "figure B7"):
        forces, packing = answer.forces, answer.packing
        assert forces is not None
        assert packing is not None
        upper = LAYER + 1
        relative, vertical = [], []
        for sign, change, ordered in (
            (Branch.PLUS, forces.change.plus[upper], forces.ordered.plus[upper]),
            (Branch.MINUS, forces.change.minus[upper], forces.ordered.minus[upper]),
        ):
            a, b = (part[upper] for part in zip(*packing.dn[sign], strict=True))
            relative.append((change / ordered).reshape(number, -1))
            push = (ordered + change) * n_y * (1 + a + b) - ordered * n_y
            vertical.append(push.reshape(number, -1))
        # contacts are named by their upper bead: bead q of an even layer has f⁺ at q, f⁻ at q − 1
        bead = vertical[0] + np.roll(vertical[1], 1, axis=1)
        each = [
            (_windows(values, count) ** 2).mean(axis=1)
            for values in (relative[0], bead)
            for count in WINDOWS
        ]
        squares.append(np.stack(each, axis=1))
    square = np.concatenate(squares)
    mean = square.mean(axis=0)
    log, influence = np.log(mean) / 2, (square - mean) / (2 * mean)
    return Neighbours(realisations, simultaneous(averaged(log, influence), LEVEL, seed))


def _windows(values: Array, count: int) -> Array:
    """Means of ``count`` neighbours at every place of a periodic layer, (number, W)."""
    total = sum(np.roll(values, -place, axis=1) for place in range(count))
    return np.asarray(total / count)


def draw(data: Neighbours) -> "Figure":
    """Draw σ of the mean over N on logarithmic axes."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    found, exact = np.exp(data.band.estimate.log), data.theory()
    low, high = data.band.limits
    names = ("contacts of one branch, Eq. (B7)", "beads, vertical force, Eq. (B8)")
    every = np.array(WINDOWS)
    for b, name in enumerate(names):
        look = style.series(b)
        here = slice(b * len(WINDOWS), (b + 1) * len(WINDOWS))
        axes.plot(every, exact[here], color=look[0], label=name)
        error = found[here] - low[here], high[here] - found[here]
        style.points(axes, every, found[here], error, look)
    axes.plot(every, found[0] / np.sqrt(every), ":", color="0.35", label="independent contacts")
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks([1, 2, 5, 10], ["1", "2", "5", "10"])
    axes.minorticks_off()
    axes.set_xlabel("number of neighbours $N$")
    axes.set_ylabel(r"$\sigma$ of the mean over $N$, relative")
    axes.legend(loc="lower left")
    return figure
