"""Build expressions that keep the paper's order of terms and factors."""

from collections.abc import Mapping
from typing import Any

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


def put_in_place(expression: sympy.Basic, image: Mapping[Any, Any]) -> sympy.Basic:
    """The same with other parts, and nothing evaluated: a/a keeps its divisor.

    ``image`` says what stands for a part, or for a kind of function, of its arguments. (SymPy's own
    ``xreplace`` builds products anew, and cancels what their other factors share.)
    """
    if expression in image:
        return image[expression]
    if type(expression) in image:
        return image[type(expression)](*expression.args)
    arguments = [put_in_place(one, image) for one in expression.args]
    if all(new is old for new, old in zip(arguments, expression.args, strict=True)):
        return expression
    if isinstance(expression, sympy.Add | sympy.Mul | sympy.Pow | sympy.Eq):
        return expression.func(*arguments, evaluate=False)
    return expression.func(*arguments)
