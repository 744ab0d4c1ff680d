"""What symbols mean, in words, unless an equation says more of them."""

import sympy
from force_diffusion.symbolic import symbols as sy

_MEANINGS = {
    sy.sigma: "standard deviation of the radii",
    sy.r: "mean radius",
    sy.M: "height of the packing in layers above the base",
    sy.z: "relative height j/M",
    sy.phi: "n⁺·n⁻, the cosine of the angle between the two contact directions",
    sy.N: "number of neighbours",
    sy.H_M: "1 + 1/2 + … + 1/M",
    sy.t: "L⁻/L⁺ of the load −(L⁺n⁺ + L⁻n⁻)",
    sy.t_2: "L²/L¹ of the load −Σ_a L^a n^a",
    sy.t_3: "L³/L¹",
    sy.n_plus: "unit vector (n_x, n_y), up and to the right",
    sy.n_minus: "unit vector (−n_x, n_y), up and to the left",
    sy.b_plus: "reciprocal vector (1/2n_x, 1/2n_y): n⁺·b⁺ = 1, n⁻·b⁺ = 0",
    sy.b_minus: "reciprocal vector (−1/2n_x, 1/2n_y): n⁻·b⁻ = 1, n⁺·b⁻ = 0",
    sy.m: "layer of a bead on a diagonal down to the base",
    sy.DeltaR(sy.i, sy.j): "deviation of the radius of bead (i, j) from r",
    sy.DeltaX(sy.i, sy.j): "displacement of bead (i, j) from its ordered position",
    sy.DeltaNPlus(sy.i, sy.j): "change of the direction from (i, j) to (i+1, j+1)",
    sy.DeltaNMinus(sy.i, sy.j): "change of the direction from (i, j) to (i−1, j+1)",
    sy.ForcePlus(sy.i, sy.j): "force of the contact from (i, j) to (i+1, j+1)",
    sy.ForceMinus(sy.i, sy.j): "force of the contact from (i, j) to (i−1, j+1)",
}


def usual(*symbols: sympy.Expr) -> tuple[tuple[sympy.Expr, str], ...]:
    """Symbols with their usual meaning in words, those that have one."""
    return tuple((symbol, _MEANINGS[symbol]) for symbol in symbols if symbol in _MEANINGS)
