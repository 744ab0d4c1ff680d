"""Signs over the whole domain: 0 < z < 1, −½ < φ < ½, and all that is positive by its name.

A sign is found exactly, by the number of real roots of a polynomial in an interval; what is not
shown to have one sign has none.
"""

from functools import cache

import sympy

from ..notation import by_name
from ..symbols import n_x, n_y, phi, z
from .exact import Domain, NotExactError

Symbols = tuple[sympy.Symbol, ...]

_COSINES = {n_x, n_y, phi}
_HALF, _QUARTER = sympy.Rational(1, 2), sympy.Rational(1, 4)


@cache
def sign(
    expression: sympy.Expr,
    positive: Symbols = (),
    nonnegative: Symbols = (),
    dimension: int = 2,
) -> int:
    """1 or −1 where the expression is that side of zero everywhere; 0 where that is not shown.

    ``positive`` names further symbols that are positive, ``nonnegative`` those that may be zero. φ
    is above −1/``dimension``.
    """
    if isinstance(expression, sympy.Mul):
        product = 1
        for factor in expression.args:
            product *= sign(factor, positive, nonnegative, dimension)
        return product
    if isinstance(expression, sympy.Pow) and isinstance(expression.exp, sympy.Rational):
        base = sign(expression.base, positive, nonnegative, dimension)
        if expression.exp.is_Integer:
            return base ** (int(expression.exp) % 2) if base else 0
        return base if base == 1 else 0
    domain = Domain(by_name(expression.free_symbols))
    try:
        value = domain.from_sympy(expression)
    except NotExactError:
        return 0
    if value.numerator == 0:
        return 0
    found = 1
    for polynomial in (value.numerator, value.denominator):
        number, powers = value.factors(polynomial)
        found *= 1 if number > 0 else -1
        for factor, power in powers.items():
            one = _of_factor(factor, positive, nonnegative, sympy.Rational(-1, dimension))
            found *= one ** (power % 2) if one else 0
    return found


def never_zero(
    expression: sympy.Expr,
    positive: Symbols = (),
    nonnegative: Symbols = (),
    dimension: int = 2,
) -> bool:
    """Whether it is shown to differ from zero everywhere in the domain."""
    return sign(expression, positive, nonnegative, dimension) != 0


def _of_factor(
    factor: sympy.Expr, positive: Symbols, nonnegative: Symbols, lowest: sympy.Rational
) -> int:
    if factor.free_symbols == {z}:
        return _on_interval(sympy.Poly(factor, z), sympy.S.Zero, sympy.S.One)
    if factor.free_symbols <= _COSINES and (found := _of_cosines(factor)):
        return found
    return _of_terms(factor, positive, nonnegative, lowest)


def _on_interval(polynomial: sympy.Poly, low: sympy.Expr, high: sympy.Expr) -> int:
    """The sign between low and high, both left out (their roots are counted by Sturm)."""
    inside = polynomial.count_roots(low, high)
    inside -= sum(polynomial(end) == 0 for end in (low, high))
    return 0 if inside else int(sympy.sign(polynomial((low + high) / 2)))


def _of_cosines(factor: sympy.Expr) -> int:
    """A polynomial in n_x, n_y and φ as A(n_x) + n_y B(n_x); its norm over ±n_y, ±n_x in n_x²."""
    u = sympy.Dummy("u")
    in_n = sympy.Poly(factor.xreplace({phi: 1 - 2 * n_x**2}), n_y)
    parts = [sympy.S.Zero, sympy.S.Zero]
    for (power,), c in in_n.terms():
        parts[power % 2] += c * (1 - n_x**2) ** (power // 2)
    norm = sympy.expand(parts[0] ** 2 - (1 - n_x**2) * parts[1] ** 2 if parts[1] else parts[0])
    both = sympy.Poly(sympy.expand(norm * norm.xreplace({n_x: -n_x})), n_x)
    in_u = sympy.Poly({(power // 2,): c for (power,), c in both.terms()}, u)
    if not _on_interval(in_u, _QUARTER, 3 * _QUARTER):
        return 0
    middle = sympy.sqrt(2) / 2  # φ = 0
    value = sympy.expand(factor.subs({n_x: middle, n_y: middle, phi: 0}))
    return 1 if value.is_positive else -1 if value.is_negative else 0


def _of_terms(
    factor: sympy.Expr, positive: Symbols, nonnegative: Symbols, lowest: sympy.Rational
) -> int:
    """All terms of one sign, factors in φ included, and one that is not zero anywhere."""
    symbols = by_name(factor.free_symbols - {phi})
    may_vanish = {*nonnegative} - set(positive)
    if not all(s in may_vanish or s == z or s.is_positive or s in positive for s in symbols):
        return 0
    found, strict = set(), False
    whole = sympy.Poly(factor, *symbols, phi).as_expr()
    for powers, c in sympy.Poly(whole, *symbols).terms() if symbols else (((), whole),):
        one, never = _in_phi(c, lowest)
        found.add(one)
        held = {symbol for symbol, power in zip(symbols, powers, strict=True) if power}
        strict = strict or (never and not may_vanish & held)
    return found.pop() if strict and len(found) == 1 else 0


def _in_phi(factor: sympy.Expr, lowest: sympy.Rational) -> tuple[int, bool]:
    """The sign of a polynomial in φ, and whether it vanishes nowhere; it may at φ = 0."""
    polynomial = sympy.Poly(factor, phi)
    power = min(power for (power,) in polynomial.monoms())
    rest = sympy.Poly({(p - power,): c for (p,), c in polynomial.terms()}, phi)
    return (0 if power % 2 else _on_interval(rest, lowest, _HALF)), not power
