"""Figure B10: how the ratio of mean stresses departs from a constant, at order σ².

The points are Taylor coefficients of exact, nonlinear packings, one bead enlarged after the other,
as fractions: they have no error. The curves are Eq. B10.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..mechanics import taylor
from .packings import Notice, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 8
DIRECTIONS = ((Fraction(3, 5), Fraction(4, 5)), (Fraction(4, 5), Fraction(3, 5)))
"""Rational n⁺: φ = 7/25 and −7/25."""


def cosine(n: tuple[Fraction, Fraction]) -> Fraction:
    """φ = n⁺·n⁻."""
    return n[1] ** 2 - n[0] ** 2


def theory(n: tuple[Fraction, Fraction]) -> list[Fraction]:
    """Shift of the ratio by layer, in units of (σ/r)² (Eq. B10)."""
    one = Fraction(1)
    form = closed_forms.stress_ratio_shift
    return [form(HEIGHT, j, cosine(n), one, one) for j in range(HEIGHT)]


def measured(n: tuple[Fraction, Fraction], notice: Notice) -> list[Fraction]:
    """The same from the order ε² of exact packings, summed over the bead that is enlarged."""
    width = 2 * HEIGHT + 3
    loads = {(i, HEIGHT): (Fraction(0), -2 * n[1]) for i in range(HEIGHT % 2, 2 * width, 2)}
    found = [Fraction(0)] * HEIGHT
    for source in range(HEIGHT + 1):
        notice(f"figure B10, φ = {cosine(n)}: radii of layer {source}")
        bead = (source % 2, source)
        solved = taylor.solve(width, HEIGHT, n=n, rho={bead: Fraction(1)}, loads=loads, order=2)
        for j in range(HEIGHT):
            for i in range(j % 2, 2 * width, 2):
                upper = (i + 1) % (2 * width), j + 1
                length = [Fraction(2), Fraction(bead in ((i, j), upper)), Fraction(0)]
                push = _product(solved.force(i, j, "+"), length)
                shares = []
                for axis, change in enumerate(solved.direction(i, j, "+")):
                    unit = [n[axis] + change[0], *change[1:]]
                    moment = _product(push, _product(unit, unit))
                    shares.append(moment[2] / moment[0])
                found[j] += shares[0] - shares[1]
    return found


def _product(one: list[Fraction], other: list[Fraction]) -> list[Fraction]:
    """Series multiplied, to order ε²."""
    return [
        sum((one[k] * other[order - k] for k in range(order + 1)), Fraction(0))
        for order in range(3)
    ]


@dataclass(frozen=True)
class Ratios:
    """Shifts by direction and layer, as fractions in units of (σ/r)²."""

    measured: tuple[list[Fraction], ...]

    def agree(self) -> bool:
        """Whether all are those of Eq. B10, as fractions."""
        return self.measured == tuple(map(theory, DIRECTIONS))

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a layer."""
        return {
            "figureB10": [
                {
                    "phi": float(cosine(n)),
                    "j": j,
                    "shift_taylor": float(value),
                    "shift_closed_form": float(theory(n)[j]),
                }
                for n, values in zip(DIRECTIONS, self.measured, strict=True)
                for j, value in enumerate(values)
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdict and parameters."""
        return {"height": HEIGHT, "equal_as_fractions": self.agree()}

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        words = "equals" if self.agree() else "does not equal"
        return [f"M = {HEIGHT}: Eq. B10 {words} the Taylor coefficients, as fractions"]


def ratios(notice: Notice) -> Ratios:
    """Solve the packings."""
    return Ratios(tuple(measured(n, notice) for n in DIRECTIONS))


def draw(data: Ratios) -> "Figure":
    """Draw shifts over M, against z."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    z, fine = np.arange(HEIGHT) / HEIGHT, np.linspace(0, 1, 101)
    for place, (n, values) in enumerate(zip(DIRECTIONS, data.measured, strict=True)):
        colour, marker = style.series(place)
        phi = float(cosine(n))
        limit = 4 * ((1 + phi) * fine - 2 * phi) / (1 - phi**2) ** 2
        axes.plot(fine, limit, "--", color=colour, lw=0.8)
        axes.plot(z, [float(v) / HEIGHT for v in theory(n)], color=colour)
        axes.plot(
            z, [float(v) / HEIGHT for v in values], marker, color=colour, mfc="white", ms=3.4,
            mew=0.7, label=rf"$\phi={phi:g}$, Taylor coefficients",
        )  # fmt: skip
    axes.axhline(0, color="0.6", lw=0.6)
    axes.set_xlim(-0.02, 1)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(r"change of $\sigma_{xx}/\sigma_{yy}$ over $M(\sigma_{\delta r}/r)^2$")
    points, _ = axes.get_legend_handles_labels()
    lines = [
        style.line("0.35", "-", f"Eq. (B10), exact at $M={HEIGHT}$"),
        style.line("0.35", "--", r"$M\to\infty$"),
    ]
    axes.legend(handles=[*lines, *points], loc="lower right")
    return figure
