"""Signs of functions on a domain, where −1/d < φ < ½, 0 < z < 1, and lengths are positive.

A sign is found exactly, by isl or by the number of real roots of a polynomial in an interval; what
is not shown to have one sign has none.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import sympy

from . import sets
from .algebra.exact import FIELD, SITE, SOURCE, NotExactError, RationalFunction
from .notation import by_name
from .symbols import INDICES, M, N, epsilon, n_x, n_y, phi, z

_WHOLE = {*INDICES, *SITE, *SOURCE}

Symbols = tuple[sympy.Symbol, ...]


def never_zero(value: RationalFunction, points: sets.Set, dimension: int = 2) -> bool:
    """Whether a function is shown to vanish nowhere on a set of indices.

    Disorder is as weak as one likes: what differs from zero at ε = 0 does.
    """
    value = value.substitute({epsilon: FIELD.zero})
    return bool(points.is_empty()) or sign(value, points, dimension=dimension) != 0


def sign(
    value: RationalFunction, points: sets.Set, positive: Symbols = (), dimension: int = 2
) -> int:
    """1 or −1 where a function is shown to be that side of zero everywhere; or else 0.

    Args:
        value: the function.
        points: where its indices lie.
        positive: further symbols that are positive.
        dimension: d of the packing.
    """
    product = 1
    for polynomial in (value.numerator, value.denominator):
        number, factors = _factors(frozenset(polynomial.to_dict().items()))
        product *= number
        for factor, power in factors:
            if product != 0:
                product *= _of_factor(factor, points, positive, dimension) ** power
    return product


@lru_cache(maxsize=1024)
def _factors(terms: frozenset[Any]) -> tuple[int, Sequence[tuple[sympy.Expr, int]]]:
    """The sign of a polynomial's constant factor, and its other factors with their powers."""
    number, factors = FIELD.context.from_dict(dict(terms)).factor()
    return (number > 0) - (number < 0), [(FIELD.expanded(f), int(power)) for f, power in factors]


@lru_cache(maxsize=1024)
def _of_factor(factor: sympy.Expr, points: sets.Set, positive: Symbols, dimension: int) -> int:
    symbols = factor.free_symbols
    if symbols <= _WHOLE and (result := _of_whole_numbers(factor, points)):
        return result
    if symbols <= {n_x, n_y, phi} and dimension == 2 and (result := _of_cosines(factor)):
        return result
    least = {symbol: _least(symbol, points) for symbol in symbols & _WHOLE}
    return _of_terms(factor, least, positive, sympy.Rational(-1, dimension))


def _of_whole_numbers(form: sympy.Expr, points: sets.Set) -> int:
    try:
        for side in (1, -1):
            other = sympy.Le(sympy.expand(side * form), 0, evaluate=False)
            if (points & sets.where(other)).is_empty():
                return side
    except NotExactError:
        pass
    return 0


def _least(symbol: sympy.Symbol, points: sets.Set) -> int:
    """The least value of an index, M and N being 1 or more."""
    low = sets.least(symbol, points)
    floor = 1 if symbol in (M, N) else -1
    return floor if low is None else max(low, floor)


def _on_interval(polynomial: sympy.Poly, low: sympy.Expr, high: sympy.Expr) -> int:
    """The sign between low and high, both left out (their roots are counted by Sturm)."""
    inside = polynomial.count_roots(low, high)
    inside -= sum(polynomial(end) == 0 for end in (low, high))
    return 0 if inside else int(sympy.sign(polynomial((low + high) / 2)))


@lru_cache(maxsize=256)
def _of_cosines(factor: sympy.Expr) -> int:
    """A polynomial in n_x = 2u/(1 + u²), n_y = (1 − u²)/(1 + u²) and φ = n_y² − n_x².

    As −½ < φ < ½, u is between tan 15° and tan 30°: it is looked at in a range a little wider,
    without the factors that vanish at these ends; between them these are below zero.
    """
    u = sympy.Dummy("u")
    x, y = 2 * u / (1 + u**2), (1 - u**2) / (1 + u**2)
    quotient = factor.xreplace({n_x: x, n_y: y, phi: y**2 - x**2})
    polynomial = sympy.Poly(sympy.Mul(*sympy.fraction(sympy.together(quotient))), u)
    for end in (u**2 - 4 * u + 1, 3 * u**2 - 1):
        while polynomial and polynomial.rem(sympy.Poly(end, u)).is_zero:
            polynomial = -polynomial.quo(sympy.Poly(end, u))
    return _on_interval(polynomial, sympy.Rational(4, 15), sympy.Rational(26, 45))


def _of_terms(
    factor: sympy.Expr, least: dict[sympy.Symbol, int], positive: Symbols, lowest: sympy.Rational
) -> int:
    """All terms of one sign, factors in φ included, and one that is not zero anywhere."""
    symbols = by_name(factor.free_symbols - {phi})
    if factor.free_symbols == {z}:
        return _on_interval(sympy.Poly(factor, z), sympy.S.Zero, sympy.S.One)
    may_vanish = {symbol for symbol in symbols if least.get(symbol) == 0}
    if not all(
        s == z or s in positive or least.get(s, 0 if s.is_positive else -1) >= 0 for s in symbols
    ):
        return 0
    signs_of_terms, strict = set(), False
    whole = sympy.Poly(factor, *symbols, phi).as_expr()
    for powers, c in sympy.Poly(whole, *symbols).terms() if symbols else (((), whole),):
        own, never = _in_phi(c, lowest)
        signs_of_terms.add(own)
        involved = {symbol for symbol, power in zip(symbols, powers, strict=True) if power}
        strict = strict or (never and not may_vanish & involved)
    return signs_of_terms.pop() if strict and len(signs_of_terms) == 1 else 0


def _in_phi(factor: sympy.Expr, lowest: sympy.Rational) -> tuple[int, bool]:
    """The sign of a polynomial in φ, and whether it vanishes nowhere; it may at φ = 0."""
    polynomial = sympy.Poly(factor, phi)
    power = min(power for (power,) in polynomial.monoms())
    rest = sympy.Poly({(p - power,): c for (p,), c in polynomial.terms()}, phi)
    return (0 if power % 2 else _on_interval(rest, lowest, sympy.S.Half)), not power
