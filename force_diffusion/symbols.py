"""The symbols in which observables are written, and in which exact forms answer.

``from force_diffusion.symbols import M, f_plus, i, j``. To SymPy a symbol with the same name and
other assumptions is another one, so take these. Symbols of your own are constants.

Indices, which are whole numbers:

``i``, ``j``
    A bead: its column, in steps of half a spacing, and its layer from the base up; i + j is even.
``k``, ``l``
    Another bead, such as the loaded one.
``p``, ``q``
    Distances, or whatever else is whole.
``M``
    Layers above the base; the surface is layer M.
``N``
    Neighbours over which a mean is taken.

Forces and radii, by their place:

``f_plus(i, j)``, ``f_minus(i, j)``
    Force of the contact from bead (i, j) to (i + 1, j + 1), up and to the right, or to
    (i − 1, j + 1), up and to the left; positive where it pushes. Relative to its value in the
    ordered packing.
``p_plus(i, j)``, ``p_minus(i, j)``
    Vertical components of these; relative to the load that a bead of that layer passes on.
``delta_r(i, j)``
    Deviation of the radius of bead (i, j) from r; relative to r.
``delta_x(i, j)``
    Displacement of bead (i, j) from its place in the ordered packing, a vector; relative to r.
``delta_n_plus(i, j)``, ``delta_n_minus(i, j)``
    Change of the contact's direction, a vector.
``f_along(a, x, y, z)``, ``p_along(a, x, y, z)``
    Force between spheres and its vertical component: x, y and z steps along the three base vectors
    lead to the lower one, in layer x + y + z; the upper one is along base vector a = 1, 2 or 3.

Vectors:

``dot(u, v)``
    Product of two vectors, such as ``dot(e_y, delta_x(i, j))``.
``e_x``, ``e_y``
    Unit vectors to the right and upwards.
``n_plus``, ``n_minus``
    Unit vectors (±n_x, n_y) from a bead to its upper neighbours in the ordered packing.
``b_plus``, ``b_minus``
    Their reciprocal vectors: b⁺·n⁺ = 1, b⁺·n⁻ = 0.

Parameters:

``phi``
    φ = n⁺·n⁻, the cosine of the angle between both contact directions.
``n_x``, ``n_y``
    Components of the contact directions: n_x² + n_y² = 1, φ = n_y² − n_x².
``r``, ``sigma``
    Mean and standard deviation of the radii.
``f_load``, ``m_g``
    Load on a bead of the surface or on the loaded bead; weight of a bead under a bulk load.
``L_plus``, ``t``
    L⁺ and L⁻/L⁺ of a leaning load −(L⁺n⁺ + L⁻n⁻) on a bead.
``t_2``, ``t_3``
    L²/L¹ and L³/L¹ of a leaning load on spheres.
``z``
    Relative height j/M, in leading orders.
``H_M``
    Sum of 1/m for 1 ≤ m ≤ M.
"""

from .symbolic.symbols import (
    H_M,
    DeltaNMinus,
    DeltaNPlus,
    DeltaR,
    DeltaX,
    Dot,
    ForceAlong,
    ForceMinus,
    ForcePlus,
    L_plus,
    M,
    N,
    VerticalAlong,
    VerticalMinus,
    VerticalPlus,
    b_minus,
    b_plus,
    e_x,
    e_y,
    f_load,
    i,
    j,
    k,
    l,
    m_g,
    n_minus,
    n_plus,
    n_x,
    n_y,
    p,
    phi,
    q,
    r,
    sigma,
    t,
    t_2,
    t_3,
    z,
)

f_plus, f_minus, f_along = ForcePlus, ForceMinus, ForceAlong
p_plus, p_minus, p_along = VerticalPlus, VerticalMinus, VerticalAlong
delta_r, delta_x, delta_n_plus, delta_n_minus = DeltaR, DeltaX, DeltaNPlus, DeltaNMinus
dot = Dot

__all__ = [
    "H_M", "L_plus", "M", "N", "b_minus", "b_plus", "delta_n_minus", "delta_n_plus", "delta_r",
    "delta_x", "dot", "e_x", "e_y", "f_along", "f_load", "f_minus", "f_plus", "i", "j", "k", "l",
    "m_g", "n_minus", "n_plus", "n_x", "n_y", "p", "p_along", "p_minus", "p_plus", "phi", "q", "r",
    "sigma", "t", "t_2", "t_3", "z",
]  # fmt: skip
