"""Explicit values at which a statement about M → ∞ is false: a search that shares no code with
its decision, but for the exact form that it is compared with.

Only rational functions are read, and for these what is of lower order has vanished, as a share
of the whole, between one size and its square; both are far beyond the coefficients of any formula.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from itertools import product

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.printing.text import text

HIGHEST_POWER = 20
SIZES = (10**100, 10**200)
HEIGHTS = tuple(Fraction(*z) for z in ((1, 2), (1, 3), (1, 4), (1, 6), (3, 4), (1, 100), (99, 100)))
COSINES = tuple(Fraction(*c) for c in ((0, 1), (1, 4), (-1, 4), (1, 3), (49, 100), (-49, 100)))
DIRECTIONS = tuple(
    (Fraction(x, length), Fraction(y, length))
    for x, y, length in ((3, 4, 5), (4, 3, 5), (20, 21, 29), (21, 20, 29), (119, 120, 169))
)

Place = Mapping[sympy.Symbol, Fraction]
_OTHERS = {sy.sigma: Fraction(3, 7), sy.r: Fraction(7, 3), sy.t: Fraction(21, 55)}


def _geometries(candidate: sympy.Expr) -> Iterator[explicit.Values]:
    """Values of φ; with n_x and n_y only where the candidate holds them, as both are rational."""
    if candidate.has(sy.n_x, sy.n_y):
        for n in DIRECTIONS:
            yield explicit.geometry(*n, _OTHERS[sy.r])
    else:
        for cosine in COSINES:
            yield {sy.phi: cosine}


def _is_rational(expression: sympy.Basic) -> bool:
    """Made of +, ·, whole powers, rationals and symbols; high powers would take for ever."""
    if isinstance(expression, sympy.Pow):
        base, exponent = expression.args
        whole = isinstance(exponent, sympy.Integer) and abs(exponent) <= HIGHEST_POWER
        return whole and _is_rational(base)
    if isinstance(expression, sympy.Add | sympy.Mul):
        return all(map(_is_rational, expression.args))
    return isinstance(expression, sympy.Rational | sympy.Symbol)


def parts_in_the_limit(
    exact: sympy.Expr, candidate: sympy.Expr, places: tuple[Place, ...]
) -> str | None:
    """Where the candidate has no value, or its share of difference from ``exact`` stays.

    Each place gives the symbols that grow, as multiples of one size. Nothing is found for what is
    no rational function.
    """
    if not _is_rational(candidate):
        return None
    for geometry, place in product(_geometries(candidate), places):
        shares = []
        where = ", ".join(
            [f"{text(sy.phi)} = {geometry[sy.phi]}"]
            + [f"{text(s)} = {multiple} · size" for s, multiple in place.items()]
        )
        for size in SIZES:
            values = {**_OTHERS, **geometry, **{s: c * size for s, c in place.items()}}
            if sy.M in values and sy.j in values:
                values[sy.z] = values[sy.j] / values[sy.M]
            try:
                found = explicit.number(candidate, values)
            except explicit.AmbiguousError as reason:
                if "/0" in str(reason) or " at 0" in str(reason):
                    return f"it has no value at {where}"
                return None
            true = explicit.number(exact, values)
            shares.append(abs(found - true) / true)
        if shares[1] > Fraction(1, 1000) and shares[1] * 10 > shares[0]:
            return f"at {where}, size = 10²⁰⁰, it differs by the share {float(shares[1]):.3g}"
    return None


LAYERS: tuple[Place, ...] = tuple({sy.M: Fraction(1), sy.j: z} for z in HEIGHTS)
"""Layers at fixed z, M growing."""
