"""Build expressions that keep the paper's order of terms and factors."""

import sympy


def terms(*summands: sympy.Expr) -> sympy.Add:
    """A sum that is not reordered."""
    return sympy.Add(*summands, evaluate=False)


def times(*factors: sympy.Expr) -> sympy.Mul:
    """A product that is not reordered or expanded."""
    return sympy.Mul(*factors, evaluate=False)


def power(base: sympy.Expr, exponent: sympy.Expr | int) -> sympy.Pow:
    """A power that is not distributed over its base's factors."""
    return sympy.Pow(base, exponent, evaluate=False)


def minus(expression: sympy.Expr) -> sympy.Mul:
    """The negative, kept as a product with −1."""
    return sympy.Mul(-1, expression, evaluate=False)


def equation(left: sympy.Expr, right: sympy.Expr) -> sympy.Eq:
    """An equation that is not evaluated to true or false."""
    return sympy.Eq(left, right, evaluate=False)
