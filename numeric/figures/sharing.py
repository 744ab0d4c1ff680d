"""Figure B15: what the load of either branch gives to f⁺ in the mean, at order σ².

The points are Taylor coefficients of exact, nonlinear packings, one bead enlarged after the other,
as fractions: they have no error. The curves are Eq. B15, which is linear in t = L⁻/L⁺.
"""

from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..mechanics import taylor
from .packings import Notice, Row
from .stress import DIRECTIONS, HEIGHT, cosine

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ZERO, ONE = Fraction(0), Fraction(1)


def theory(n: tuple[Fraction, Fraction]) -> tuple[list[Fraction], list[Fraction]]:
    """By layer, in units of (σ/r)²: of L⁺ what f⁺ has less L⁺, and what it has of L⁻ (Eq. B15)."""
    form = closed_forms.surface_mean_shift_at_angle
    own, both = (
        [form(HEIGHT, j, t, cosine(n), ONE, ONE) for j in range(HEIGHT)] for t in (ZERO, ONE)
    )
    return own, [b - a for a, b in zip(own, both, strict=True)]


def measured(n: tuple[Fraction, Fraction], notice: Notice) -> tuple[list[Fraction], list[Fraction]]:
    """The same from the order ε² of exact packings, summed over the bead that is enlarged."""
    width = 2 * HEIGHT + 3
    found = [[ZERO] * HEIGHT, [ZERO] * HEIGHT]
    for source in range(HEIGHT + 1):
        notice(f"figure B15, φ = {cosine(n)}: radii of layer {source}")
        rho = {(source % 2, source): ONE}
        for part, across in zip(found, (-n[0], n[0]), strict=True):
            loads = {(i, HEIGHT): (across, -n[1]) for i in range(HEIGHT % 2, 2 * width, 2)}
            solved = taylor.solve(width, HEIGHT, n=n, rho=rho, loads=loads, order=2)
            for j in range(HEIGHT):
                forces = (solved.force(i, j, "+") for i in range(j % 2, 2 * width, 2))
                part[j] += sum((force[2] for force in forces), ZERO)
    return found[0], found[1]


@dataclass(frozen=True)
class Sharing:
    """Changes by direction, branch and layer, as fractions in units of (σ/r)²."""

    measured: tuple[tuple[list[Fraction], list[Fraction]], ...]

    def agree(self) -> bool:
        """Whether all are those of Eq. B15, as fractions."""
        return self.measured == tuple(map(theory, DIRECTIONS))

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a layer."""
        return {
            "figureB15": [
                {
                    "phi": float(cosine(n)),
                    "load": load,
                    "j": j,
                    "shift_taylor": float(value),
                    "shift_closed_form": float(exact),
                }
                for n, parts in zip(DIRECTIONS, self.measured, strict=True)
                for load, values, known in zip(("+", "-"), parts, theory(n), strict=True)
                for j, (value, exact) in enumerate(zip(values, known, strict=True))
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdict and parameters."""
        return {"height": HEIGHT, "equal_as_fractions": self.agree()}

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        words = "equals" if self.agree() else "does not equal"
        return [f"M = {HEIGHT}: Eq. B15 {words} the Taylor coefficients, as fractions"]


def shares(notice: Notice) -> Sharing:
    """Solve the packings."""
    return Sharing(tuple(measured(n, notice) for n in DIRECTIONS))


def draw(data: Sharing) -> "Figure":
    """Draw changes over M, against z."""
    from . import style

    figure = style.figure(style.COLUMN, 2.6)
    axes = figure.subplots()
    z = np.arange(HEIGHT) / HEIGHT
    place = 0
    for n, parts in zip(DIRECTIONS, data.measured, strict=True):
        for dashes, sign, values, known in zip("-:", "+-", parts, theory(n), strict=True):
            colour, marker = style.series(place)
            axes.plot(z, [float(v) / HEIGHT for v in known], dashes, color=colour)
            axes.plot(
                z, [float(v) / HEIGHT for v in values], marker, color=colour, mfc="white", ms=3.4,
                mew=0.7, label=rf"of $L^{sign}$, $\phi={float(cosine(n)):g}$",
            )  # fmt: skip
            place += 1
    axes.axhline(0, color="0.6", lw=0.6)
    axes.set_xlim(-0.02, 1)
    axes.set_xlabel("relative height $z=j/M$")
    axes.set_ylabel(r"change of $\langle f^+\rangle/L^\pm$ over $M(\sigma_{\delta r}/r)^2$")
    axes.legend(loc="upper left")
    return figure
