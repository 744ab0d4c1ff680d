"""Figure B11: σ_f/⟨f⟩ of a surface load in two, three and four dimensions.

The points are exact to first order at finite M: all weights of the radii, as fractions, squared and
summed. The curves are the leading order, Eq. B11.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Array
from ..mechanics.any_dimension import force_weights, squared, together
from .packings import Notice, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 24
DIMENSIONS = (2, 3, 4)
PHI = Fraction(1, 5)


def exact(dimension: int) -> Array:
    """σ_f/⟨f⟩ over σ/r by layer, shape (M,)."""
    found = [squared(together(force_weights(dimension, HEIGHT, j, PHI))) for j in range(HEIGHT)]
    return np.sqrt([float(value) for value in found])


def printed(dimension: int, z: Array) -> Array:
    """The leading order at relative heights z (Eq. B11)."""
    form = closed_forms.diffusion_in_dimensions
    return np.sqrt([form(dimension, HEIGHT, at, float(PHI), 1.0, 1.0) for at in z])


@dataclass(frozen=True)
class Widths:
    """σ_f/⟨f⟩ over σ/r, shape (M,), one for each of ``DIMENSIONS``."""

    exact: tuple[Array, ...]

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a layer."""
        z = np.arange(HEIGHT) / HEIGHT
        return {
            "figureB11": [
                {
                    "dimension": dimension,
                    "j": j,
                    "z": float(z[j]),
                    "exact_finite_M": float(values[j]),
                    "printed": float(printed(dimension, z)[j]),
                }
                for dimension, values in zip(DIMENSIONS, self.exact, strict=True)
                for j in range(HEIGHT)
            ]
        }

    def facts(self) -> dict[str, Any]:
        """What was put in, and the exact over the leading order at the base."""
        return {"height": HEIGHT, "phi": float(PHI), "exact_over_printed_at_base": self.ratios()}

    def ratios(self) -> list[float]:
        """σ_f at the base, exact over leading order."""
        base = np.zeros(1)
        return [
            float(values[0] / printed(dimension, base)[0])
            for dimension, values in zip(DIMENSIONS, self.exact, strict=True)
        ]

    def lines(self) -> list[str]:
        """Say how near the leading order is."""
        told = ", ".join(
            f"{ratio:.3f} for d = {dimension}"
            for dimension, ratio in zip(DIMENSIONS, self.ratios(), strict=True)
        )
        return [f"M = {HEIGHT}: exact over leading σ_f at the base: {told}"]


def widths(notice: Notice) -> Widths:
    """Sum the squared weights."""
    found = []
    for dimension in DIMENSIONS:
        notice(f"figure B11, d = {dimension}")
        found.append(exact(dimension))
    return Widths(tuple(found))


def draw(data: Widths) -> "Figure":
    """Draw points and curves over M^(3/2)."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    z, fine = np.arange(HEIGHT) / HEIGHT, np.linspace(0, 1, 101)
    scale = HEIGHT**-1.5
    for place, (dimension, values) in enumerate(zip(DIMENSIONS, data.exact, strict=True)):
        colour, marker = style.series(place)
        axes.plot(fine, scale * printed(dimension, fine), color=colour, lw=0.9)
        axes.plot(
            z, scale * values, marker, color=colour, mfc="white", ms=3.2, mew=0.7,
            clip_on=False, label=f"$d={dimension}$, exact at $M={HEIGHT}$",
        )  # fmt: skip
    axes.set_xlim(0, 1)
    axes.set_ylim(0, None)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(r"$M^{-3/2}\,(\sigma_f/\langle f\rangle)\,/\,(\sigma_{\delta r}/r)$")
    points, _ = axes.get_legend_handles_labels()
    axes.legend(handles=[style.line("0.35", "-", "Eq. (B11)"), *points], loc="upper right")
    return figure
