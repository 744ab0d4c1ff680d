"""Figure B19: fluctuations of the response to a point load in a packing of spheres.

Simulated are exact, nonlinear packings, W = 2l. Drawn is one layer: p, the vertical force that a
bead gets from its three upper contacts, along a face of the cone, and in rows further inside, where
nothing is of first order. The curve is Eq. B19.
"""

from dataclasses import dataclass
from math import sqrt
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..lattice.branch import PerAxis
from ..scene.sections import PointLoad
from ..statistics.bands import Band, averaged, simultaneous
from .packings import PAPER_STD, PHI, Notice, Row, forces_of, planned, solved

if TYPE_CHECKING:
    from matplotlib.figure import Figure

APEX, LAYER = 10, 4
LEVEL = 0.99
ROWS = (0, 1, 2)
"""Steps along the third vector: a face of the cone, and rows inside of it."""


def places(row: int) -> list[tuple[int, int, int]]:
    """Steps down from the loaded bead to the beads of a row, those on legs left out."""
    left = APEX - LAYER - row
    return [(left - q, q, row) for q in range(1, left)]


def theory() -> Array:
    """σ(p)/f_load over σ/r along the face (Eq. B19); shape (l − j − 1,)."""
    form = closed_forms.spheres_response
    return np.sqrt([float(form(steps, APEX, float(PHI), 1.0, 1.0)) for steps in places(0)])


@dataclass(frozen=True)
class Faces:
    """A simultaneous band along the face, σ(p)/f_load; and σ(p)/f_load in the rows inside."""

    realisations: int
    band: Band
    inside: tuple[Array, ...]

    def deviation(self) -> float:
        """Largest deviation of Eq. B19 along the face, in half-widths: inside is ≤ 1."""
        return self.band.deviation(theory() * PAPER_STD)

    def share(self) -> float:
        """The largest σ(p) inside of the cone over the smallest on the face by Eq. B19."""
        return float(max(values.max() for values in self.inside) / (theory().min() * PAPER_STD))

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a bead; without a band inside of the cone, where theory says zero."""
        low, high = self.band.limits
        rows: list[Row] = [
            {
                "row": 0,
                "q": q,
                "simulated": float(np.exp(self.band.estimate.log[q - 1])),
                "band_low": float(low[q - 1]),
                "band_high": float(high[q - 1]),
                "exact_first_order": float(theory()[q - 1] * PAPER_STD),
            }
            for _, q, _ in places(0)
        ]
        for row, values in zip(ROWS[1:], self.inside, strict=True):
            for (_, q, _), value in zip(places(row), values, strict=True):
                rows.append(
                    {
                        "row": row,
                        "q": q,
                        "simulated": float(value),
                        "band_low": None,
                        "band_high": None,
                        "exact_first_order": 0.0,
                    }
                )
        return {"figureB19": rows}

    def facts(self) -> dict[str, Any]:
        """Verdicts and parameters."""
        return {
            "apex": APEX,
            "layer": LAYER,
            "phi": float(PHI),
            "relative_std": PAPER_STD,
            "realisations": self.realisations,
            "simultaneous_level": LEVEL,
            "largest_deviation_in_half_widths": self.deviation(),
            "largest_inside_over_face": self.share(),
        }

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        return [
            f"l = {APEX}, j = {LAYER}: Eq. B19 {self.band.verdict(self.deviation())}; inside of "
            f"the cone σ(p) is at most {self.share():.1g} of that on its faces"
        ]


def vertical(change: PerAxis[Any], ordered: float, steps: tuple[int, int, int]) -> Array:
    """p/f_load of a bead, so many steps below the loaded one; shape (realisations,).

    A contact is found by its upper bead, in a layer of W × W.
    """
    total = np.zeros(1)
    for axis, (_, layers) in enumerate(change):
        upper = [count - (place == axis) for place, count in enumerate(steps)]
        beads = layers[APEX - sum(upper)]
        width = round(sqrt(beads.shape[-1]))
        at = (-upper[0] % width) * width + -upper[1] % width
        total = total + beads[..., at] / (3 * ordered)
    return total


def respond(realisations: int, seed: int, notice: Notice) -> Faces:
    """Simulate; by symmetry the three vectors are alike."""
    ensemble = planned(
        "response", height=APEX, width=2 * APEX, seed=seed, realisations=realisations,
        load=PointLoad(at=(0, 0, APEX)), dimension=3,
    )  # fmt: skip
    beads = [bead for row in ROWS for bead in places(row)]
    squares = []
    for answer, number in solved(ensemble, range(realisations), notice, "figure B19"):
        forces = forces_of(answer)
        assert isinstance(forces.change, PerAxis)
        ordered = float(np.ravel(forces.ordered.plus[APEX])[0])
        each = np.zeros((number, len(beads)))
        for place, bead in enumerate(beads):
            p, q, row = bead
            for steps in ((p, q, row), (q, row, p), (row, p, q)):
                each[:, place] += vertical(forces.change, ordered, steps) ** 2 / 3
        squares.append(each)
    square = np.concatenate(squares)
    mean = square.mean(axis=0)
    face = len(places(0))
    log = np.log(mean[:face]) / 2
    influence = (square[:, :face] - mean[:face]) / (2 * mean[:face])
    ends = np.cumsum([len(places(row)) for row in ROWS])[:-1]
    _, *inside = np.split(np.sqrt(mean), ends)
    band = simultaneous(averaged(log, influence), LEVEL, seed)
    return Faces(realisations, band, tuple(inside))


def draw(data: Faces) -> "Figure":
    """Draw σ(p) over σ/r, against the place in the row."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    q = np.array([steps[1] for steps in places(0)])
    found, (low, high) = np.exp(data.band.estimate.log), data.band.limits
    error = (found - low) / PAPER_STD, (high - found) / PAPER_STD
    look = style.series(0)
    axes.plot(q, theory(), color=look[0], lw=0.9)
    style.points(axes, q, found / PAPER_STD, error, look, "face of the cone")
    for row, values in zip(ROWS[1:], data.inside, strict=True):
        colour, marker = style.series(row)
        place = [steps[1] + row / 2 for steps in places(row)]
        axes.plot(
            place, values / PAPER_STD, marker, color=colour, mfc="white", ms=3.4, mew=0.7,
            label=f"{row} step{'s' * (row > 1)} inside",
        )  # fmt: skip
    axes.axhline(0, color="0.6", lw=0.6)
    axes.set_ylim(-0.15, None)
    axes.set_xticks(q)
    axes.set_xlabel("place along the row")
    axes.set_ylabel(r"$\sigma(p)/f^{\mathrm{load}}$ over $\sigma_{\delta r}/r$")
    points, _ = axes.get_legend_handles_labels()
    line = style.line("0.35", "-", "Eq. (B19), exact")
    axes.legend(handles=[line, *points], loc="center right")
    return figure
