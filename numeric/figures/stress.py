"""Figure B10: how the ratio of mean stresses departs from a constant, at order σ².

The points are Taylor coefficients of exact, nonlinear packings, one bead enlarged after the other,
as fractions: they have no error. The curves are Eqs. B10 and B17.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import closed_forms
from ..arithmetic.systems import Series
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


LOADS: dict[str, tuple[str, Callable[..., Any]]] = {
    "surface": ("B10", closed_forms.surface_stress_ratio_shift),
    "bulk": ("B17", closed_forms.bulk_stress_ratio_shift),
}
"""Equation and closed form of each load."""


def theory(load: str, n: tuple[Fraction, Fraction]) -> list[Fraction]:
    """Shift of the ratio by layer, in units of (σ/r)² (Eqs. B10 and B17)."""
    one = Fraction(1)
    return [LOADS[load][1](HEIGHT, j, cosine(n), one, one) for j in range(HEIGHT)]


def measured(load: str, n: tuple[Fraction, Fraction], notice: Notice) -> list[Fraction]:
    """The same from the order ε² of exact packings, summed over the bead that is enlarged."""
    width, system = 2 * HEIGHT + 3, Series(2)
    loaded = range(1, HEIGHT + 1) if load == "bulk" else (HEIGHT,)
    sites = ((i, j) for j in loaded for i in range(j % 2, 2 * width, 2))
    loads = dict.fromkeys(sites, (Fraction(0), -2 * n[1]))
    found = [Fraction(0)] * HEIGHT
    for source in range(HEIGHT + 1):
        notice(f"figure B10, {load} load, φ = {cosine(n)}: radii of layer {source}")
        bead = (source % 2, source)
        solved = taylor.solve(width, HEIGHT, n=n, rho={bead: Fraction(1)}, loads=loads, order=2)
        for j, i in product(range(HEIGHT), range(0, 2 * width, 2)):
            site = i + j % 2, j
            upper = (site[0] + 1) % (2 * width), j + 1
            with system.active():
                length = system.series([Fraction(2), Fraction(bead in (site, upper))])
                push = system.series(solved.force(*site, "+")) * length
                turned = zip(n, solved.direction(*site, "+"), strict=True)
                x, y = (push * (system.number(a) + system.series(c)) ** 2 for a, c in turned)
                change = x[2] / x[0] - y[2] / y[0]
            found[j] += Fraction(int(change.p), int(change.q))
    return found


@dataclass(frozen=True)
class Ratios:
    """Shifts by load, direction and layer, as fractions in units of (σ/r)²."""

    measured: dict[str, tuple[list[Fraction], ...]]

    def agree(self, load: str) -> bool:
        """Whether all of a load are those of its equation, as fractions."""
        return self.measured[load] == tuple(theory(load, n) for n in DIRECTIONS)

    def tables(self) -> dict[str, list[Row]]:
        """CSV: one row a layer."""
        return {
            "figureB10": [
                {
                    "load": load,
                    "phi": float(cosine(n)),
                    "j": j,
                    "shift_taylor": float(value),
                    "shift_closed_form": float(exact),
                }
                for load, both in self.measured.items()
                for n, values in zip(DIRECTIONS, both, strict=True)
                for j, (value, exact) in enumerate(zip(values, theory(load, n), strict=True))
            ]
        }

    def facts(self) -> dict[str, Any]:
        """Verdict and parameters."""
        return {"height": HEIGHT, "equal_as_fractions": all(map(self.agree, LOADS))}

    def lines(self) -> list[str]:
        """Say whether theory holds."""
        return [
            f"M = {HEIGHT}: Eq. {number} {'equals' if self.agree(load) else 'does not equal'} the "
            "Taylor coefficients, as fractions"
            for load, (number, _) in LOADS.items()
        ]


def ratios(notice: Notice) -> Ratios:
    """Solve the packings."""
    return Ratios({load: tuple(measured(load, n, notice) for n in DIRECTIONS) for load in LOADS})


def draw(data: Ratios) -> "Figure":
    """Draw shifts over M, against z, one panel a load."""
    from . import style

    figure = style.figure(style.PAGE, 2.6)
    panels = figure.subplots(1, 2, sharey=True)
    z, fine = np.arange(HEIGHT) / HEIGHT, np.linspace(0, 1, 101)
    for axes, (load, both) in zip(panels, data.measured.items(), strict=True):
        for place, (n, values) in enumerate(zip(DIRECTIONS, both, strict=True)):
            colour, marker = style.series(place)
            phi = float(cosine(n))
            limit = (1 + phi) * fine - 2 * phi if load == "surface" else fine - phi
            axes.plot(fine, 4 * limit / (1 - phi**2) ** 2, "--", color=colour, lw=0.8)
            axes.plot(z, [float(v) / HEIGHT for v in theory(load, n)], color=colour)
            axes.plot(
                z, [float(v) / HEIGHT for v in values], marker, color=colour, mfc="white", ms=3.4,
                mew=0.7, label=rf"$\phi={phi:g}$, Taylor coefficients",
            )  # fmt: skip
        axes.axhline(0, color="0.6", lw=0.6)
        axes.set_xlim(-0.02, 1)
        axes.set_xlabel("relative height $z=j/M$")
        axes.set_title(f"{load} load, Eq. ({LOADS[load][0]})", pad=4)
    panels[0].set_ylabel(r"change of $\sigma_{xx}/\sigma_{yy}$ over $M(\sigma_{\delta r}/r)^2$")
    points, _ = panels[0].get_legend_handles_labels()
    lines = [
        style.line("0.35", "-", f"exact at $M={HEIGHT}$"),
        style.line("0.35", "--", r"$M\to\infty$"),
    ]
    panels[0].legend(handles=[*lines, *points], loc="lower right")
    return figure
