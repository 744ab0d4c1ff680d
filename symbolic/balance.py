"""Force balance of one bead on its two supports: the 2×2 system, inverted, to first order.

With N^± = n^± + ε δn^± the supports' directions, an incoming force −P is balanced by
f⁺N⁺ + f⁻N⁻ = P. Dotted with n⁺ and n⁻ this is a 2×2 system whose matrix holds φ and the two
numbers that δn has: n⁺·δn⁺ = n⁻·δn⁻ = 0.
"""

from functools import cache

import sympy

from symbolic.symbols import epsilon, phi

tilt_plus = sympy.Symbol("nu_plus")  # n⁻·δn⁺ of the supporting contact along n⁺
tilt_minus = sympy.Symbol("nu_minus")  # n⁺·δn⁻ of the supporting contact along n⁻
tilt_incoming = sympy.Symbol("nu_in")  # the same of an incoming contact force


def balance_matrix() -> sympy.ImmutableMatrix:
    """Columns N⁺ and N⁻, dotted with n⁺ (first row) and n⁻ (second row)."""
    return sympy.ImmutableMatrix([[1, phi + epsilon * tilt_minus], [phi + epsilon * tilt_plus, 1]])


def inverted() -> sympy.ImmutableMatrix:
    """Return the inverse of the balance matrix, as its adjugate over its determinant."""
    return balance_matrix().inv(method="ADJ")


def incoming(kind: str) -> sympy.ImmutableMatrix:
    """P dotted with n⁺ and n⁻: n⁺ + n⁻ for "load", N⁺ for "+", N⁻ for "-" (unit forces)."""
    along = {
        "load": [1 + phi, 1 + phi],
        "+": [1, phi + epsilon * tilt_incoming],
        "-": [phi + epsilon * tilt_incoming, 1],
    }
    return sympy.ImmutableMatrix(along[kind])


@cache
def solved(kind: str) -> tuple[tuple[sympy.Expr, sympy.Expr], tuple[sympy.Expr, sympy.Expr]]:
    """Forces (f⁺, f⁻) of the supports: their values at ε = 0, and their slopes in ε there."""
    forces = inverted() * incoming(kind)
    at_zero, slope = forces.subs(epsilon, 0), sympy.diff(forces, epsilon).subs(epsilon, 0)
    return tuple(map(sympy.cancel, at_zero)), tuple(map(sympy.factor, slope))
