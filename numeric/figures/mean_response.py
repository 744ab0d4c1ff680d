"""Figure B9: the mean response to a point load at order σ²: a plateau inside of the cone.

Simulated are exact, nonlinear packings, each solved to first order as well, whose mean response is
that of the ordered packing: the difference shows the mean at order σ². Curves are Eq. B9.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arithmetic.systems import Array
from ..scene.sections import PointLoad
from .packings import Notice, Row, forces_of, planned, solved
from .shifts import LEVEL, STD, Shift, cosine, shift

if TYPE_CHECKING:
    from matplotlib.figure import Figure

APEX, LAYER = 8, 2
SPACINGS = (Fraction(11, 5), Fraction(3))
"""s in units of r: φ = 0.395 with a positive plateau, φ = −1/8 with a negative one."""


def theory(spacing: Fraction) -> Array:
    """Mean of f⁺ in layer ``LAYER`` at order σ² beside the leg, from it on; shape (l − j − 1,).

    In units of f_load/2n_y and (σ/r)²: the first line, then the plateau (Eq. B9).
    """
    phi = cosine(spacing)
    first, plateau = (7 * phi**2 + 14 * phi - 5) / 4, 2 * phi**2 + 3 * phi - 1
    inside = np.full(APEX - LAYER - 1, plateau)
    inside[0] = first
    return inside / (1 - phi**2) ** 2


@dataclass(frozen=True)
class Cut:
    """One spacing; ``shift`` has shape (l − j − 1,)."""

    spacing: Fraction
    shift: Shift


@dataclass(frozen=True)
class MeanResponse:
    """What figure B9 shows."""

    realisations: int
    cuts: tuple[Cut, ...]

    @property
    def offsets(self) -> Array:
        """Columns i − k of the contacts' lower beads."""
        reach = APEX - LAYER
        return np.arange(2 - reach, reach, 2)

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a contact."""
        return {
            "figureB9": [
                {
                    "spacing": float(one.spacing),
                    "phi": cosine(one.spacing),
                    "offset": int(offset),
                    "mean_simulated": float(one.shift.mean[place]),
                    "band_half_width": float(one.shift.half[place]),
                    "mean_exact": float(theory(one.spacing)[place]),
                }
                for one in self.cuts
                for place, offset in enumerate(self.offsets)
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdicts and parameters."""
        return {
            "apex": APEX,
            "layer": LAYER,
            "realisations": self.realisations,
            "relative_std": STD,
            "simultaneous_level": LEVEL,
            "largest_deviations_in_half_widths": [
                one.shift.deviation(theory(one.spacing)) for one in self.cuts
            ],
        }

    def lines(self) -> list[str]:
        """Say whether theory holds, and whether no response at all would."""
        said = []
        for one in self.cuts:
            off = one.shift.deviation(theory(one.spacing))
            none = one.shift.deviation(np.zeros(len(self.offsets)))
            verdict = one.shift.band.verdict(off)
            said.append(
                f"s = {float(one.spacing):g} r: Eq. B9 {verdict}; no mean response would be "
                f"{none:.1f} of it off"
            )
        return said


def respond(realisations: int, seed: int, notice: Notice) -> MeanResponse:
    """Solve all packings exactly and to first order."""
    cuts = []
    for spacing in SPACINGS:
        ordered = 1 / (2 * np.sqrt((1 + cosine(spacing)) / 2))

        def changed(geometry: str, spacing: Fraction = spacing) -> Array:
            ensemble = planned(
                "response", height=APEX, width=None, seed=seed, std=STD, geometry=geometry,
                load=PointLoad(at=(0, APEX)), realisations=realisations, spacing=spacing,
            )  # fmt: skip
            what = f"figure B9, s = {float(spacing):g} r, {geometry}"
            each = [
                _beside(forces_of(answer).change, number)
                for answer, number in solved(ensemble, range(realisations), notice, what)
            ]
            return np.concatenate(each)

        cuts.append(Cut(spacing, shift(changed, seed, ordered)))
    return MeanResponse(realisations, tuple(cuts))


def _beside(change: Any, number: int) -> Array:
    """Changes of f⁺ inside of the cone, averaged with their mirror images; (number, l − j − 1)."""
    # row m holds what lies below the beads of layer m: l − m + 1 of them, from the left
    plus, minus = (side[LAYER + 1].reshape(number, -1) for side in (change.plus, change.minus))
    inside = APEX - LAYER - 1
    assert plus.shape[1] == inside + 1, plus.shape
    return np.asarray((plus[:, 1:] + minus[:, ::-1][:, 1:]) / 2)


def draw(data: MeanResponse) -> "Figure":
    """Draw both cuts, between the legs of the cone."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    reach = APEX - LAYER
    for place, one in enumerate(data.cuts):
        look = style.series(place)
        axes.plot(data.offsets, theory(one.spacing), color=look[0], lw=0.9)
        name = rf"$\phi={cosine(one.spacing):g}$, simulated"
        style.points(axes, data.offsets, one.shift.mean, one.shift.half, look, name)
    axes.axhline(0, color="0.6", lw=0.6)
    for edge in (-reach, reach):
        axes.axvline(edge, color="0.6", ls=":", lw=0.8)
    axes.set_xlabel(r"$i-k$ of a contact $f^{+}$ inside of the cone")
    axes.set_ylabel(r"$\langle f^{+}\rangle/(f^{\rm load}/2n_y)\;/\;(\sigma_{\delta r}/r)^2$")
    handles, _ = axes.get_legend_handles_labels()
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.45 * (high - low))
    axes.legend(handles=[style.line("0.35", "-", "Eq. (B9)"), *handles], loc="upper center")
    return figure
