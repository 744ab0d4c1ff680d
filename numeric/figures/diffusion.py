"""Figure 2: how (a) the geometry broadens upwards, and (b) the forces broaden downwards.

Both to first order, exact at a finite height M. From Eq. 3, in units of r and for j ≥ 1,

    Var(δx) = (4 j − 3) σ²/(2 n_x²),        Var(δy) = (4 j − 1) σ²/(2 n_y²),

which is Brownian; the forces, Eq. 13, are not: the exponent d ln σ²/d ln (1 − z) of their leading
order is 6z/(2z + 1), above 1 for z > ¼ and below it for z < ¼.
"""

import numpy as np

from ..arithmetic.systems import Array
from . import specification as spec
from .comparison import curves
from .packings import PAPER, Medium, Options

HEIGHT = 16
CROSSOVER = 0.25
"""z below which the forces spread more slowly than a Brownian path."""


def displacement_std(height: int, medium: Medium = PAPER) -> tuple[Array, Array]:
    """Give σ_x and σ_y of beads in layers 0 … M, in units of σ_δr; exact to first order (Eq. 3)."""
    nx, j = float(medium.n_x), np.arange(height + 1)
    ny = np.sqrt(1 - nx**2)
    x, y = (4 * j - 3) / (2 * nx**2), (4 * j - 1) / (2 * ny**2)
    return np.sqrt(np.where(j > 0, x, 0)), np.sqrt(np.where(j > 0, y, 0))


def cloud(z: Array, std: Array, colour: int) -> list[spec.Element]:
    """Shade a normal distribution of the given width at each height, with its ±σ and ±2σ."""
    return [
        *(
            spec.Area(z, -n * std, n * std, colour, alpha, sideways=True)
            for n, alpha in ((2, 0.18), (1, 0.3))
        ),
        *(spec.Line(sign * std, z, colour) for sign in (-1, 1)),
    ]


def figure(o: Options) -> spec.Figure:
    """Both distributions as clouds, as wide at each height as they are there."""
    o.notice("figure 2")
    M, medium = HEIGHT, o.medium()
    (x, y), (force, printed) = displacement_std(M, medium), curves(M, medium)
    z, fine = np.arange(M + 1) / M, np.linspace(0, 1, 201)
    brownian = printed[0] * np.sqrt(1 - z[:-1])
    sides = (-1, 1)
    left = [
        *cloud(z, y / y[-1], 0),
        *(spec.Line(sign * np.sqrt(fine), fine, "black", ":") for sign in sides),
    ]
    narrowing = (1 - fine) * np.sqrt(1 + 2 * fine)
    right = [
        *cloud(z, np.append(force, 0) / printed[0], 1),
        *(spec.Line(sign * narrowing, fine, "black", "--") for sign in sides),
        *(spec.Line(sign * np.sqrt(1 - fine), fine, "black", ":") for sign in sides),
        spec.Line(name=rf"$\pm\sigma$, exact at $M={M}$"),
        spec.Line(name="Eq. (13), printed", colour="black", dashes="--"),
        spec.Line(name="Brownian", colour="black", dashes=":"),
        spec.Line([-2.3, 2.3], [CROSSOVER] * 2, spec.GREY, "-."),
        spec.Line(name="superdiffusive above, subdiffusive below", colour=spec.GREY, dashes="-."),
        spec.Area(name=r"within $\pm\sigma$", alpha=0.45),
        spec.Area(name=r"within $\pm2\sigma$", alpha=0.18),
    ]
    ticks = (-2, -1, 0, 1, 2)
    displaced = spec.Axis(r"$\delta y_{ij}\,/\,\sigma_{\delta y}(M)$", -2.3, 2.3, ticks=ticks)
    forces = spec.Axis(r"$(f_{ij}-\langle f\rangle)\,/\,\sigma_f(0)$", -2.3, 2.3, ticks=ticks)
    panels = [
        spec.Panel(left, displaced, spec.RELATIVE_HEIGHT),
        spec.Panel(right, forces, spec.Axis(low=0, high=1), legend="below", columns=2),
    ]
    geometry = zip(range(M + 1), x.tolist(), y.tolist(), strict=True)
    columns = (z[:-1], force, printed, brownian)
    widths = zip(range(M), *(column.tolist() for column in columns), strict=True)
    return spec.Figure(
        spec.Picture(panels, 2.85, share="y"),
        tables={
            "figure2_geometry": spec.table("j sigma_x_over_sigma_r sigma_y_over_sigma_r", geometry),
            "figure2_forces": spec.table("j z exact_finite_M printed brownian", widths),
        },
        facts={
            "height": M,
            "spacing_over_r": float(medium.spacing),
            "relative_std": medium.std,
        },
        words=[f"exact first-order widths at M = {M}"],
    )
