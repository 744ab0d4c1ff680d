"""Force balance of one bead on its two supports: the 2×2 system, inverted, to first order.

A balance is a vector equation, linear in the two supporting forces. Dotted with n⁺ and n⁻ it is
a 2×2 system whose matrix holds φ and one number for each δn, its part along the other
direction: n⁺·δn⁺ = n⁻·δn⁻ = 0 by Eqs. 4 and 5. The strength ε multiplies every δn.
"""

from dataclasses import dataclass

import sympy

from ..algebra.exact import Domain
from ..as_printed import equation, terms
from ..notation import Symbol, by_name, raised
from ..symbols import (
    DeltaNMinus,
    DeltaNPlus,
    Dot,
    SiteFunction,
    epsilon,
    n_minus,
    n_plus,
    phi,
)

tilt_plus = Symbol("nu_plus", r"\nu^{+}", "ν⁺")  # n⁻·δn⁺ of the supporting contact along n⁺
tilt_minus = Symbol("nu_minus", r"\nu^{-}", "ν⁻")  # n⁺·δn⁻ of the supporting contact along n⁻
tilt_incoming = Symbol(
    "nu_in", r"\nu_{\mathrm{in}}", "ν_in"
)  # the same of an incoming contact force


def dotted(vector: sympy.Expr, tilts: dict[SiteFunction, sympy.Symbol]) -> sympy.ImmutableMatrix:
    """(n⁺·v, n⁻·v) of a vector expression; ``tilts`` names the one number of each δn."""
    rows = []
    for axis in range(2):
        image: dict[sympy.Basic, sympy.Expr] = {
            n_plus: (sympy.Integer(1), phi)[axis],
            n_minus: (phi, sympy.Integer(1))[axis],
        }
        for change, tilt in tilts.items():
            own = 0 if isinstance(change, DeltaNPlus) else 1
            image[change] = sympy.Integer(0) if axis == own else epsilon * tilt
        rows.append(vector.xreplace(image))
    return sympy.ImmutableMatrix(rows)


def _pair(name: str, order: str = "") -> tuple[Symbol, Symbol]:
    shown = order and f"_{order}"
    plus, minus = (
        Symbol(f"{name}_{word}{order}", f"{name}^{{{sign}}}{shown}", f"{name}{raised(sign)}{shown}")
        for word, sign in (("plus", "+"), ("minus", "-"))
    )
    return plus, minus


FORCES = _pair("F")
"""The forces along n⁺ and n⁻ that carry something, in units of it."""

ORDER_0, ORDER_1 = _pair("F", "0"), _pair("F", "1")
"""Their values at ε = 0, and their derivatives with respect to ε there."""


def _in_lowest_terms(value: sympy.Expr) -> sympy.Expr:
    return Domain([phi, *by_name(value.free_symbols - {phi})]).from_sympy(value).to_sympy()


@dataclass(frozen=True)
class Solved:
    """A balance as a 2×2 system, and its solution to first order in ε.

    Attributes:
        balance: n⁺ and n⁻ times the balance, in FORCES; both vanish.
        rows: the same as equations, what the supports have to carry on the right.
        solution: the forces, exact in ε.
        determinant: what they are divided by; 1 − φ² at ε = 0.
        at_zero: (f⁺, f⁻) at ε = 0.
        slope: their derivatives with respect to ε there.
        meaning: what the tilts ν stand for, as dot products.
    """

    balance: tuple[sympy.Expr, sympy.Expr]
    rows: tuple[sympy.Eq, sympy.Eq]
    solution: tuple[sympy.Expr, sympy.Expr]
    determinant: sympy.Expr
    at_zero: tuple[sympy.Expr, sympy.Expr]
    slope: tuple[sympy.Expr, sympy.Expr]
    meaning: dict[sympy.Symbol, sympy.Expr]

    def first_order(self, branch: int) -> sympy.Expr:
        """f⁺ (0) or f⁻ (1) to first order, in the symbols of the paper."""
        return self.at_zero[branch] + self.slope[branch].xreplace(self.meaning)


def solve(
    balance: sympy.Expr,
    forces: tuple[SiteFunction, SiteFunction],
    load: SiteFunction,
    carried: sympy.Expr,
) -> Solved:
    """Solve ``balance`` = 0 for the two forces, its load being −``carried``.

    SymPy inverts the matrix and differentiates the solution.
    """
    supports = [atom for atom in balance.atoms(DeltaNPlus, DeltaNMinus) if not carried.has(atom)]
    tilts = {atom: tilt_plus if isinstance(atom, DeltaNPlus) else tilt_minus for atom in supports}
    tilts |= dict.fromkeys(carried.atoms(DeltaNPlus, DeltaNMinus), tilt_incoming)
    system = dotted(
        balance.xreplace({load: -carried, **dict(zip(forces, FORCES, strict=True))}), tilts
    )
    matrix = sympy.ImmutableMatrix(system.jacobian(list(FORCES)))
    right = dotted(carried, tilts)
    # not matrix.inv(): it guesses by numbers whether the determinant is zero
    determinant = matrix.det()
    solution = matrix.adjugate() * right / determinant
    at_zero, slope = solution.subs(epsilon, 0), sympy.diff(solution, epsilon).subs(epsilon, 0)
    meaning = {
        tilt: Dot(n_minus if isinstance(atom, DeltaNPlus) else n_plus, atom)
        for atom, tilt in tilts.items()
    }
    rows = [
        equation(terms(*(entry * force for entry, force in zip(row, FORCES, strict=True))), side)
        for row, side in zip(matrix.tolist(), right, strict=True)
    ]
    return Solved(
        tuple(system),
        (rows[0], rows[1]),
        tuple(solution),
        determinant,
        tuple(map(_in_lowest_terms, at_zero)),
        tuple(map(_in_lowest_terms, slope)),
        meaning,
    )
