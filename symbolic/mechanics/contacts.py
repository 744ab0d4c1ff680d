"""A contact of two discs: its exact constraint, and what is left of it to first order.

The physics is done by SymPy on plain Cartesian symbols: the constraint is differentiated with
respect to the strength ε of the disorder, at ε = 0.
"""

from dataclasses import dataclass

import sympy
from force_diffusion.symbolic.mechanics.lattice import N_MINUS, N_PLUS
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import epsilon, r

# δx of the bead less that of its support, and δr of the bead plus that of its support
dx = Symbol("delta_x", r"\Delta x", "Δx", real=True)
dy = Symbol("delta_y", r"\Delta y", "Δy", real=True)
radii = Symbol("rho", r"\rho", "ρ", real=True)


def separation(ordered: sympy.Matrix) -> sympy.Matrix:
    """x − x_support at strength ε: the ordered one plus ε times the difference of displacements."""
    return ordered + epsilon * sympy.Matrix([dx, dy])


@dataclass(frozen=True)
class Linearised:
    """The contact constraint |x − x_support|² − (R + R′)² by order in ε."""

    exact: sympy.Expr
    order_0: sympy.Expr
    order_1: sympy.Expr


def contact_constraint(ordered: sympy.Matrix) -> Linearised:
    """Differentiate the constraint of a contact whose ordered separation is given."""
    apart = separation(ordered)
    exact = apart.dot(apart) - (2 * r + epsilon * radii) ** 2
    return Linearised(exact, exact.subs(epsilon, 0), sympy.diff(exact, epsilon).subs(epsilon, 0))


def constraint_matrix() -> sympy.ImmutableMatrix:
    """Rows n⁺ and n⁻: what the two constraints measure of a displacement."""
    return sympy.ImmutableMatrix.vstack(N_PLUS.T, N_MINUS.T)


def unit_vector_change(ordered: sympy.Matrix) -> sympy.ImmutableMatrix:
    """δn^± in Cartesian components, from the exact unit vector of a contact.

    The centres are exactly R + R′ = 2r + ερ apart, so the unit vector is their separation over
    that length; its derivative at ε = 0 is δn^±.
    """
    unit = separation(ordered) / (2 * r + epsilon * radii)
    return sympy.ImmutableMatrix(sympy.diff(unit, epsilon).subs(epsilon, 0))
