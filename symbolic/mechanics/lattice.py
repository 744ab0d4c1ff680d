"""The ordered lattice: base vectors as Cartesian columns, and the mirror image of an equation."""

import sympy

from .. import symbols as sy

MIRRORED_SYMBOLS = {
    sy.n_plus: sy.n_minus,
    sy.n_minus: sy.n_plus,
    sy.b_plus: sy.b_minus,
    sy.b_minus: sy.b_plus,
}
MIRRORED_FUNCTIONS = {
    sy.DeltaNPlus: sy.DeltaNMinus,
    sy.DeltaNMinus: sy.DeltaNPlus,
    sy.ForcePlus: sy.ForceMinus,
    sy.ForceMinus: sy.ForcePlus,
    sy.VerticalPlus: sy.VerticalMinus,
    sy.VerticalMinus: sy.VerticalPlus,
}

_HORIZONTAL = (sy.i, sy.k, sy.site_r)


def mirror(expression: sympy.Basic) -> sympy.Basic:
    """The mirror image at a vertical line: i → −i at every site, n⁺ ↔ n⁻ and b⁺ ↔ b⁻.

    Applied to an equation at (i, j), it gives the equation at (i, j) for the other branch.
    """
    if expression in MIRRORED_SYMBOLS:
        return MIRRORED_SYMBOLS[expression]
    if isinstance(expression, sy.SiteFunction):
        kind = MIRRORED_FUNCTIONS.get(type(expression), type(expression))
        return kind(*mirrored_place(*expression.args))
    if expression.is_Atom:
        return expression
    arguments = [mirror(argument) for argument in expression.args]
    if isinstance(expression, sympy.Add | sympy.Mul | sympy.Eq):
        return expression.func(*arguments, evaluate=False)
    return expression.func(*arguments)


def mirrored_place(across: sympy.Expr, layer: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """Where a site at (across, layer) is in the mirror image of an equation."""
    return -across.xreplace({symbol: -symbol for symbol in _HORIZONTAL}), layer


def mirrored_relation(relation: sympy.Basic) -> sympy.Basic:
    """The same of a relation between indices, whose places across the packing change their sign."""
    turned = {symbol: -symbol for symbol in _HORIZONTAL}
    return relation.func(*(side.xreplace(turned) for side in relation.args), evaluate=False)
