"""Figure 2: how (a) the geometry broadens upwards, and (b) the forces broaden downwards.

Both to first order, exact at a finite height M. From Eq. 3, in units of r and for j ≥ 1,

    Var(δx) = (4 j − 3) σ²/(2 n_x²),        Var(δy) = (4 j − 1) σ²/(2 n_y²),

which is Brownian; the forces, Eq. 13, are not: the exponent d ln σ²/d ln (1 − z) of their leading
order is 6z/(2z + 1), above 1 for z > ¼ and below it for z < ¼.
"""

import numpy as np
from matplotlib.axes import Axes

from ..arithmetic.systems import Array
from .comparison import curves
from .packings import PAPER, Made, Medium, Options
from .style import COLUMN, GREY, RELATIVE_HEIGHT, panels

HEIGHT = 16
CROSSOVER = 0.25
"""z below which the forces spread more slowly than a Brownian path."""


def displacement_std(height: int, medium: Medium = PAPER) -> tuple[Array, Array]:
    """Give σ_x and σ_y of beads in layers 0 … M, in units of σ_δr; exact to first order (Eq. 3)."""
    nx, ny, j = float(medium.n_x), medium.n_y, np.arange(height + 1)
    x, y = (4 * j - 3) / (2 * nx**2), (4 * j - 1) / (2 * ny**2)
    return np.sqrt(np.where(j > 0, x, 0)), np.sqrt(np.where(j > 0, y, 0))


def draw_cloud(axes: Axes, z: Array, std: Array, colour: str) -> None:
    """Shade a normal distribution of the given width at each height, with its ±σ and ±2σ."""
    for n, alpha in ((2, 0.18), (1, 0.3)):
        axes.fill_betweenx(z, -n * std, n * std, color=colour, alpha=alpha, lw=0)
    axes.plot(-std, z, std, z, color=colour)


def figure(o: Options) -> Made:
    """Both distributions as clouds, as wide at each height as they are there."""
    o.notice("figure 2")
    M, medium = HEIGHT, o.medium()
    (x, y), (force, printed) = displacement_std(M, medium), curves(M, medium)
    z, fine = np.arange(M + 1) / M, np.linspace(0, 1, 201)
    brownian = printed[0] * np.sqrt(1 - z[:-1])
    drawn, (left, right) = panels("ab", COLUMN, 2.85, sharey=True)
    draw_cloud(left, z, y / y[-1], "C0")
    left.plot(-np.sqrt(fine), fine, "k:", np.sqrt(fine), fine, "k:")
    draw_cloud(right, z, np.append(force, 0) / printed[0], "C1")
    right.plot([], [], color=GREY, label=rf"$\pm\sigma$, exact at $M={M}$")
    for width, dashes, name in (
        ((1 - fine) * np.sqrt(1 + 2 * fine), "k--", "Eq. (13), printed"),
        (np.sqrt(1 - fine), "k:", "Brownian"),
    ):
        right.plot(-width, fine, dashes)
        right.plot(width, fine, dashes, label=name)
    right.axhline(CROSSOVER, color=GREY, ls="-.", label="superdiffusive above, subdiffusive below")
    right.fill_between([], [], color=GREY, alpha=0.45, lw=0, label=r"within $\pm\sigma$")
    right.fill_between([], [], color=GREY, alpha=0.18, lw=0, label=r"within $\pm2\sigma$")
    left.set(xlabel=r"$\delta y_{ij}\,/\,\sigma_{\delta y}(M)$", ylabel=RELATIVE_HEIGHT)
    right.set(xlabel=r"$(f_{ij}-\langle f\rangle)\,/\,\sigma_f(0)$")
    for axes in (left, right):
        axes.set(xlim=(-2.3, 2.3), xticks=range(-2, 3), ylim=(0, 1))
    drawn.legend(loc="outside lower center", ncols=2)
    table = {
        "j": range(M + 1),
        "z": z,
        "sigma_x_over_sigma_r": x,
        "sigma_y_over_sigma_r": y,
        "exact": [*force, ""],  # no contact starts at the surface
        "printed": [*printed, ""],
        "brownian": [*brownian, ""],
    }
    facts = {"height": M, "spacing_over_r": float(medium.spacing), "relative_std": medium.std}
    return Made(drawn, {"figure2": table}, facts, [f"exact first-order widths at M = {M}"])
