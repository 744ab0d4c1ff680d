"""Sums of rational multiples of square roots, whose equality is decided.

Roots of different square-free numbers are independent over the rationals.
"""

from collections import defaultdict
from math import gcd

import sympy

from ..algebra.exact import NotExactError

HIGHEST_POWER, MOST_BITS = 40, 100
"""Of what is read: longer numbers take for ever to be factored."""

Surd = dict[int, sympy.Rational]
"""By square-free numbers, the rational factors of their roots; none is zero."""


def surd(node: sympy.Expr) -> Surd:
    """Read a number made of rationals, sums, products, whole powers and square roots.

    Raises:
        NotExactError: for anything else.
    """
    if isinstance(node, sympy.Rational):
        return {1: node} if node else {}
    if isinstance(node, sympy.Add):
        found: Surd = defaultdict(lambda: sympy.S.Zero)
        for term in node.args:
            for root, factor in surd(term).items():
                found[root] += factor
        return {root: factor for root, factor in found.items() if factor}
    if isinstance(node, sympy.Mul):
        product: Surd = {1: sympy.S.One}
        for one in node.args:
            product = _product(product, surd(one))
        return product
    if isinstance(node, sympy.Pow) and isinstance(node.exp, sympy.Rational):
        return _power(node.base, node.exp)
    raise NotExactError(f"{node} is no sum of square roots of numbers")


def _product(left: Surd, right: Surd) -> Surd:
    found: Surd = defaultdict(lambda: sympy.S.Zero)
    for one, factor in left.items():
        for other, scale in right.items():
            common = gcd(one, other)
            found[one // common * (other // common)] += factor * scale * common
    return {root: factor for root, factor in found.items() if factor}


def _power(base: sympy.Expr, exponent: sympy.Rational) -> Surd:
    value = surd(base)
    if abs(exponent) > HIGHEST_POWER:
        raise NotExactError(f"the power {exponent} is not read: {HIGHEST_POWER} is the highest")
    if set(value) == {1} and value[1] > 0 and exponent.q == 2:
        number = value[1] ** exponent.p
        product = int(number.p * number.q)
        if product.bit_length() > MOST_BITS:
            raise NotExactError(f"the root of a number of {product.bit_length()} bits is not read")
        square_free, whole = 1, 1
        for prime, power in sympy.factorint(product).items():
            square_free *= prime ** (power % 2)
            whole *= prime ** (power // 2)
        return {int(square_free): sympy.Rational(int(whole), number.q)}
    if exponent.q == 1 and exponent.p >= 0:
        found: Surd = {1: sympy.S.One}
        for _ in range(exponent.p):
            found = _product(found, value)
        return found
    if exponent.q == 1 and set(value) == {1}:
        return {1: value[1] ** exponent.p}
    raise NotExactError(f"{base} to the power {exponent} is no sum of square roots of numbers")
