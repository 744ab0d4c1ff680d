"""A contact of two discs: its exact constraint, and what is left of it to first order.

The physics is done by SymPy on plain Cartesian symbols: the constraint is differentiated with
respect to the strength ε of the disorder, at ε = 0.
"""

from dataclasses import dataclass

import sympy
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.symbols import (
    DeltaR,
    DeltaX,
    Dot,
    b_minus,
    b_plus,
    e_y,
    epsilon,
    n_x,
    r,
)

# δx of the bead less that of its support, and δr of the bead plus that of its support
dx = Symbol("delta_x", r"\Delta x", "Δx", real=True)
dy = Symbol("delta_y", r"\Delta y", "Δy", real=True)
radii = Symbol("rho", r"\rho", "ρ", real=True)


E_X = n_x * (b_plus - b_minus)
"""The horizontal unit vector."""

Site = tuple[sympy.Expr, sympy.Expr]


def of_beads(expression: sympy.Expr, upper: Site, lower: Site) -> sympy.Expr:
    """Put in what Δx, Δy and ρ are for the contact of two beads."""
    apart = DeltaX(*upper) - DeltaX(*lower)
    meaning = {
        dx: Dot(E_X, apart),
        dy: Dot(e_y, apart),
        radii: DeltaR(*upper) + DeltaR(*lower),
    }
    return expression.xreplace(meaning)


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


def resting(constraints: tuple[Linearised, Linearised], bead: Site, on: tuple[Site, Site]) -> Site:
    """Components of the displacement that keeps a bead on both supports, to first order.

    SymPy inverts the matrix of the two constraints, whose derivatives with respect to ε vanish.
    """
    derivatives = [constraint.order_1 for constraint in constraints]
    matrix = sympy.Matrix(derivatives).jacobian([dx, dy])
    right = []
    for derivative, support, row in zip(derivatives, on, matrix.tolist(), strict=True):
        carried = row[0] * Dot(E_X, DeltaX(*support)) + row[1] * Dot(e_y, DeltaX(*support))
        of_radii = derivative.xreplace({dx: sympy.Integer(0), dy: sympy.Integer(0)})
        right.append(carried - of_beads(of_radii, bead, support))
    across, up = matrix.inv() * sympy.Matrix(right)
    return across, up


def unit_vector_change(ordered: sympy.Matrix) -> sympy.Expr:
    """δn^± as a vector expression in Δx, Δy and ρ, from the exact unit vector of a contact.

    The centres are exactly R + R′ = 2r + ερ apart, so the unit vector is their separation over
    that length; its derivative at ε = 0 is δn^±.
    """
    unit = separation(ordered) / (2 * r + epsilon * radii)
    across, up = sympy.diff(unit, epsilon).subs(epsilon, 0)
    return across * E_X + up * e_y
