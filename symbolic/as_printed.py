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


def in_place(node: sympy.Basic, meaning: Mapping[Any, Any]) -> sympy.Basic:
    """What is written in short, put in one after the other; no divisor is cancelled by it."""
    for what, image in meaning.items():
        node = _in_place(node, what, image)
    return node


def _in_place(node: sympy.Basic, what: Any, image: Any) -> sympy.Basic:
    if node == what:
        result: sympy.Basic = image
        return result
    if not node.has(what):
        return node
    args = [_in_place(one, what, image) for one in node.args]
    if isinstance(what, type) and isinstance(node, what):
        result = image(*args)
    elif isinstance(node, sympy.Add | sympy.Mul | sympy.Pow | sympy.Eq):
        result = node.func(*args, evaluate=False)
    else:
        result = node.func(*args)
    return result
