"""A contact of two discs: its exact constraint, and what is left of it to first order.

The physics is done by SymPy on plain Cartesian symbols: the constraint is differentiated with
respect to the strength ε of the disorder, at ε = 0.
"""

from dataclasses import dataclass

import sympy

from ..notation import Symbol
from ..symbols import (
    DeltaR,
    DeltaX,
    Dot,
    e_x,
    e_y,
    epsilon,
    r,
)

# δx of the bead less that of its support, and δr of the bead plus that of its support
dx = Symbol("delta_x", r"\Delta x", "Δx", real=True)
dy = Symbol("delta_y", r"\Delta y", "Δy", real=True)
radii = Symbol("rho", r"\rho", "ρ", real=True)


Site = tuple[sympy.Expr, sympy.Expr]


def of_beads(upper: Site, lower: Site) -> dict[sympy.Symbol, sympy.Expr]:
    """What Δx, Δy and ρ are for the contact of two beads."""
    apart = DeltaX(*upper) - DeltaX(*lower)
    return {
        dx: Dot(e_x, apart),
        dy: Dot(e_y, apart),
        radii: DeltaR(*upper) + DeltaR(*lower),
    }


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
