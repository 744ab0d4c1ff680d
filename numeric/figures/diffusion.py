"""Figure 2: how (a) the geometry broadens upwards, and (b) the forces broaden downwards.

Both to first order, exact at a finite height M. From Eq. 3, in units of r and for j ≥ 1,

    Var(δx) = (4 j − 3) σ²/(2 n_x²),        Var(δy) = (4 j − 1) σ²/(2 n_y²),

which is Brownian; the forces, Eq. 13, are not.
"""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arithmetic.systems import Array
from .comparison import curves
from .packings import PAPER, Medium, Notice, Row

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 16


def displacement_std(height: int, medium: Medium = PAPER) -> tuple[Array, Array]:
    """Give σ_x and σ_y of beads in layers 0 … M, in units of σ_δr; exact to first order (Eq. 3)."""
    nx, j = float(medium.n_x), np.arange(height + 1)
    ny = np.sqrt(1 - nx**2)
    x, y = (4 * j - 3) / (2 * nx**2), (4 * j - 1) / (2 * ny**2)
    return np.sqrt(np.where(j > 0, x, 0)), np.sqrt(np.where(j > 0, y, 0))


@dataclass(frozen=True)
class Diffusion:
    """Standard deviations by layer: displacements (M + 1,) in σ_δr, forces (M,) as σ_f/⟨f⟩."""

    height: int
    medium: Medium
    x: Array
    y: Array
    force: Array
    printed: Array

    @property
    def brownian(self) -> Array:
        """√(1 − z), as wide as the printed form at the base; shape (M,)."""
        z = np.arange(self.height) / self.height
        return np.asarray(self.printed[0] * np.sqrt(1 - z))

    def tables(self) -> dict[str, list[Row]]:
        """CSV files: panel (a) and panel (b)."""
        layers = range(self.height + 1)
        geometry = [
            {
                "j": j,
                "sigma_x_over_sigma_r": float(self.x[j]),
                "sigma_y_over_sigma_r": float(self.y[j]),
            }
            for j in layers
        ]
        forces = [
            {
                "j": j,
                "z": j / self.height,
                "exact_finite_M": float(self.force[j]),
                "printed": float(self.printed[j]),
                "brownian": float(self.brownian[j]),
            }
            for j in layers[:-1]
        ]
        return {"figure2_geometry": geometry, "figure2_forces": forces}

    def facts(self) -> dict[str, Any]:
        """What was put in."""
        return {
            "height": self.height,
            "spacing_over_r": float(self.medium.spacing),
            "relative_std": self.medium.std,
        }

    def lines(self) -> list[str]:
        """Nothing is decided here."""
        return [f"exact first-order widths at M = {self.height}"]


def widths(height: int, medium: Medium, notice: Notice) -> Diffusion:
    """Evaluate the closed forms."""
    notice("figure 2")
    return Diffusion(height, medium, *displacement_std(height, medium), *curves(height, medium))


def draw(data: Diffusion) -> "Figure":
    """Draw both distributions as clouds, as wide at each height as they are there."""
    from . import style

    figure = style.figure(style.COLUMN, 2.75)
    left, right = figure.subplots(1, 2, sharey=True)
    z = np.arange(data.height + 1) / data.height
    fine = np.linspace(0, 1, 201)
    _cloud(left, z, data.y / data.y[-1], style.BLUE)
    _cloud(right, z, np.append(data.force, 0) / data.printed[0], style.VERMILLION)
    _edges(left, np.sqrt(fine), fine, ":")
    _edges(right, (1 - fine) * np.sqrt(1 + 2 * fine), fine, "--")
    _edges(right, np.sqrt(1 - fine), fine, ":")
    left.set_ylabel("relative height $z=j/M$")
    left.set_xlabel(r"$\delta y_{ij}\,/\,\sigma_{\delta y}(M)$")
    right.set_xlabel(r"$(f_{ij}-\langle f\rangle)\,/\,\sigma_f(0)$")
    for axes in (left, right):
        axes.set_xlim(-2.3, 2.3)
        axes.set_xticks([-2, -1, 0, 1, 2])
        axes.set_ylim(0, 1)
    style.letter((left, right))
    figure.legend(
        handles=[
            style.line("0.35", "-", rf"$\pm\sigma$, exact at $M={data.height}$"),
            style.line("black", "--", "Eq. (13), printed"),
            style.line("black", ":", "Brownian"),
            style.shade("0.35", r"within $\pm\sigma$", 0.45),
            style.shade("0.35", r"within $\pm2\sigma$", 0.18),
        ],
        loc="outside lower center", ncols=3, columnspacing=1.0, handletextpad=0.5,
    )  # fmt: skip
    return figure


def _edges(axes: "Axes", std: Array, z: Array, dashes: str) -> None:
    for sign in (-1, 1):
        axes.plot(sign * std, z, dashes, color="black", lw=0.9)


def _cloud(axes: "Axes", z: Array, std: Array, colour: str) -> None:
    """Shade a normal distribution of the given width at each height, and its ±σ and ±2σ."""
    for times, alpha in ((2, 0.18), (1, 0.3)):
        axes.fill_betweenx(z, -times * std, times * std, color=colour, alpha=alpha, lw=0)
    for sign in (-1, 1):
        axes.plot(sign * std, z, color=colour, lw=0.9)
