"""Build expressions that keep the paper's order of terms and factors."""

import sympy

from .trees import equation


def terms(*summands: sympy.Expr) -> sympy.Add:
    """A sum that is not reordered."""
    return sympy.Add(*summands, evaluate=False)


def times(*factors: sympy.Expr) -> sympy.Mul:
    """A product that is not reordered or expanded; a factor of 1 is left out."""
    return sympy.Mul(*(factor for factor in factors if factor != 1), evaluate=False)


def power(base: sympy.Expr, exponent: sympy.Expr | int) -> sympy.Pow:
    """A power that is not distributed over its base's factors."""
    return sympy.Pow(base, exponent, evaluate=False)


def minus(expression: sympy.Expr) -> sympy.Mul:
    """The negative, kept as a product with −1."""
    return sympy.Mul(-1, expression, evaluate=False)


def certificate(total: sympy.Sum, up_to_n: sympy.Expr) -> tuple[sympy.Eq, sympy.Eq]:
    """What a sum up to n is, and its term at n as what that gains there: two lines of a step."""
    index, _, high = total.limits[0]
    parts = up_to_n.args if isinstance(up_to_n, sympy.Add) else (up_to_n,)
    after = [part for part in parts if part.has(high)]  # the others cancel
    before = [-part.xreplace({high: high - 1}) for part in after]
    term = total.function.xreplace({index: high})
    return equation(total, up_to_n), equation(term, terms(*after, *before))
