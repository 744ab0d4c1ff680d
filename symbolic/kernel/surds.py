"""Sums of rational multiples of square roots, whose equality is decided.

Roots of different square-free numbers are independent over the rationals.
"""

from collections import defaultdict
from math import gcd

import sympy
from force_diffusion.symbolic.algebra.exact import NotExactError

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
    if set(value) == {1} and value[1] > 0 and exponent.q == 2:
        number = value[1] ** exponent.p
        square_free, whole = 1, 1
        for prime, power in sympy.factorint(number.p * number.q).items():
            square_free *= prime ** (power % 2)
            whole *= prime ** (power // 2)
        return {int(square_free): sympy.Rational(int(whole), number.q)}
    if exponent.q == 1 and 0 <= exponent.p <= 40:
        product: Surd = {1: sympy.S.One}
        for _ in range(exponent.p):
            product = _product(product, value)
        return product
    if exponent.q == 1 and set(value) == {1}:
        return {1: value[1] ** exponent.p}
    raise NotExactError(f"{base} to the power {exponent} is no sum of square roots of numbers")
