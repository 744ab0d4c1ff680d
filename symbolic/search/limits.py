"""Explicit values at which a statement about M → ∞ is false: searches that share no code with
its decision, but for the exact form that it is compared with.

Of rational functions, what is of lower order has vanished, as a share of the whole, between one
size and its square; both are far beyond the coefficients of the formulas. Of sums over layers the
variance is a polynomial in the height, whose differences tell how it grows.
"""

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from itertools import pairwise, product

import sympy

from .. import symbols as sy
from ..algebra import explicit
from ..as_printed import bits
from ..kernel.where import Limit, Where
from ..mechanics.lattice import mirror
from ..printing.text import text
from .values import WithoutValue

HIGHEST_POWER = 20
DIGITS, MOST_DIGITS, MOST_OF_ROOTS = 100, 4000, 1500
"""Of a size, beside those of all numbers of what is compared; and of these, at the most."""
HEIGHTS = tuple(Fraction(*z) for z in ((1, 2), (1, 3), (1, 4), (1, 6), (3, 4), (1, 100), (99, 100)))
COSINES = tuple(Fraction(*c) for c in ((0, 1), (-1, 4), (1, 4), (1, 3), (49, 100), (-49, 100)))
DIRECTIONS = tuple(
    (Fraction(x, length), Fraction(y, length))
    for x, y, length in ((3, 4, 5), (4, 3, 5), (20, 21, 29), (21, 20, 29), (119, 120, 169))
)

_SHARE = Fraction(1, 10**30)  # of what is of a lower order, far less is left at these sizes
_LOW = Fraction(1, 3)

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


@cache
def _number(exact: sympy.Expr, values: tuple[tuple[sympy.Symbol, Fraction], ...]) -> Fraction:
    """Value of an exact form, which many candidates are compared with."""
    return explicit.number(exact, dict(values))


def _size(most: int, *compared: sympy.Basic) -> int | None:
    """The digits of a size beyond all their coefficients; None where that would take for ever."""
    own = sum(map(bits, compared)) // 3
    return DIGITS + own if own <= most else None


def _shown(number: Fraction) -> str:
    """A number, or about which power of ten it is where that is no float."""
    power = (number.numerator.bit_length() - number.denominator.bit_length()) * 0.30103
    return f"10^{power:.0f}" if abs(power) > 300 else f"{float(number):.3g}"


def parts_in_the_limit(
    exact: sympy.Expr, candidate: sympy.Expr, places: tuple[Place, ...]
) -> str | None:
    """Where the candidate has no value, or its share of difference from ``exact`` stays.

    Each place gives the symbols that grow, as multiples of one size. Nothing is found for what is
    no rational function.
    """
    digits = _size(MOST_DIGITS, exact, candidate)
    if digits is None or not _is_rational(candidate):
        return None
    for (a, geometry), (b, place) in product(enumerate(_geometries(candidate)), enumerate(places)):
        if min(a, b) > 1:
            continue  # every φ at two places, and every place at two φ
        shares = []
        where, grown = _in_words(geometry[sy.phi], place)
        for size in (10**digits, 10 ** (2 * digits)):
            values = {**_OTHERS, **geometry, **{s: c * size for s, c in place.items()}}
            if sy.M in values and sy.j in values:
                values[sy.z] = values[sy.j] / values[sy.M]
            try:
                found = explicit.number(candidate, values)
            except explicit.DivisionError:
                return WithoutValue(f"it has no value at {where}, however large {grown} is")
            except explicit.AmbiguousError:
                return None
            true = _number(exact, tuple(values.items()))
            shares.append(abs((found - true) / true))
        if shares[1] > _SHARE and shares[1] * 10 > shares[0]:
            share = _shown(shares[1])
            at = f"evaluated exactly at {grown} = 10^{2 * digits}"
            return f"at {where}, as {grown} → ∞, it stays off by {share} of the true value ({at})"
    return None


def _in_words(cosine: Fraction | int, place: Place) -> tuple[str, str]:
    """φ and how what grows stands to the first of it, and that, in words."""
    first, *others = place
    ratios = [f"{text(one)} = {_times(place[one] / place[first], text(first))}" for one in others]
    return ", ".join([f"{text(sy.phi)} = {cosine}", *ratios]), text(first)


def _times(ratio: Fraction, what: str) -> str:
    number = "" if ratio.numerator == 1 and ratio > 0 else str(ratio.numerator)
    divided = "" if ratio.denominator == 1 else f"/{ratio.denominator}"
    return f"{number} {what}{divided}".strip() if ratio else "0"


def counterexample(statement: sympy.Eq, where: Where, force: sympy.Eq | None = None) -> str | None:
    """Where the sides of a statement in a limit, all moments put in, part; or None.

    ``force`` gives f⁺_ij in units of f_load/2n_y, in the radii, for what drops a part of it.
    """
    limit = where.limit
    if limit and limit.relation == "≈" and force is not None:
        return varies_too_much(force.rhs, statement)
    left, right = (side.xreplace(where.solved) for side in statement.args)
    if limit and limit.relation == "∝":
        return not_proportional(right, left / right)
    if limit is None or limit.relation != "∼" or not _is_rational(left):
        return None
    return parts_in_the_limit(left, right, _places(limit))


_RATIOS: Mapping[int, tuple[tuple[Fraction | int, ...], ...]] = {
    1: ((1,),),
    2: tuple((one, 1 - one) for one in HEIGHTS),
    3: ((1, 1, 1), (2, 1, 1), (3, 1, 2), (1, 2, 3), (1, 100, 1), (1, 1, 100)),
    4: ((1, 1, 1, 1), (2, 1, 1, 3), (1, 2, 3, 1)),
}
"""How what is positive in a limit stands to each other, by how many there are."""


@cache
def _places(limit: Limit) -> tuple[Place, ...]:
    """How the indices grow, as multiples of one size: what is positive in some fixed ratios."""
    found = []
    for ratio in _RATIOS[len(limit.positive)]:
        rows = (one - sympy.Rational(c) for one, c in zip(limit.positive, ratio, strict=True))
        (at,) = sympy.linsolve(list(rows), *limit.growing)
        multiples = (Fraction(int(c.p), int(c.q)) for c in at)
        found.append(dict(zip(limit.growing, multiples, strict=True)))
    return tuple(found)


LAYERS: tuple[Place, ...] = tuple({sy.M: Fraction(1), sy.j: z} for z in HEIGHTS)
"""Layers at fixed z, M growing."""

_APART: tuple[dict[sympy.Symbol, Fraction | int], ...] = (
    {},
    {sy.M: 0},  # its square
    {sy.sigma: Fraction(5, 11)},
    {sy.r: Fraction(1, 13)},
    {sy.z: _LOW},
)


def not_proportional(side: sympy.Expr, ratio: sympy.Expr) -> str | None:
    """Where a positive quantity has no value or is not positive, or ``ratio`` is not one number.

    The ratio has to be the same at one φ whatever else is put in, M being large: to 30 digits, of
    which three are compared.
    """
    digits = _size(MOST_OF_ROOTS, side, ratio)
    if digits is None or side.has(sympy.Sum):
        return None  # SymPy has a value of its own for reversed bounds
    for cosine in COSINES:
        found = []
        for changed in _APART:
            large = 10 ** (2 * digits if sy.M in changed else digits)
            values = {sy.z: Fraction(1, 2), **_OTHERS, sy.phi: cosine, **changed, sy.M: large}
            image = {symbol: sympy.Rational(value) for symbol, value in values.items()}
            for n, square in ((sy.n_x, 1 - image[sy.phi]), (sy.n_y, 1 + image[sy.phi])):
                image[n] = sympy.sqrt(square / 2)
            value, share = (part.xreplace(image).evalf(30) for part in (side, ratio))
            where = ", ".join(
                f"{text(one)} = {_shown(Fraction(values[one]))}" for one in (sy.phi, *changed)
            )
            if value.free_symbols or share.free_symbols:
                return None
            if value.has(sympy.zoo, sympy.nan, sympy.oo):
                return WithoutValue(f"it has no value at {where}")
            if not value.is_positive:
                return f"it is {value.evalf(3)}, which is not positive, at {where}"
            found.append((share, where))
        for share, where in found[1:]:
            if abs(share / found[0][0] - 1) > Fraction(1, 1000):
                return f"it is off by a factor that {where} changes"
    return None


HEIGHTS_AT = {Fraction(1, 2): range(8, 24, 2), Fraction(1, 3): range(12, 36, 3)}
"""Heights of packings at which a layer z M is looked at; all of them in the region of the limit."""

_ACROSS = 10**6  # a bead that no whole number in a formula means


def varies_too_much(exact: sympy.Expr, candidate: sympy.Eq) -> str | None:
    """Where a statement on one force has no value, another mean, or drops a variance of order M³.

    ``exact`` is the first-order f⁺_ij in units of f_load/2n_y, in the radii. The force's own factor
    is taken out. Weights that are polynomials in M, j and m, with bounds near 1, j or M, give a
    variance that is a polynomial in M at fixed z: one below degree d has no differences of order d.
    """
    if found := _undefined(candidate):
        return found
    if not _is_polynomial(candidate):
        return None
    flat, upright, *_ = DIRECTIONS
    for n, z in ((flat, Fraction(1, 2)), (upright, Fraction(1, 2)), (flat, Fraction(1, 3))):
        geometry = {**_OTHERS, **explicit.geometry(*n, _OTHERS[sy.r]), sy.f_load: Fraction(1)}
        dropped, factors = [], []
        for height in HEIGHTS_AT[z]:
            values = {**geometry, sy.M: height, sy.j: int(z * height), sy.i: _ACROSS}
            where = f"M = {height}, z = {z}, φ = {geometry[sy.phi]}"
            try:
                total, factor = _in_radii(exact, candidate, values)
            except explicit.AmbiguousError:
                return None
            if mean := total.pop(("", 0, 0), 0):
                return f"at {where} the two sides differ by {mean} in the ordered packing"
            if not factor:
                return None
            dropped.append(sum((w**2 for w in total.values()), Fraction(0)))
            factors.append(factor)
            kept = 3 + 2 * _degree(factors)
            if len(dropped) > kept + 1:  # one more, as the factor's degree must have shown
                break
        else:
            return None
        if any(_differences(dropped, kept)):
            return (
                f"at z = {z}, φ = {geometry[sy.phi]}, what is dropped varies as M^{kept} at least"
            )
    return None


def _undefined(candidate: sympy.Eq) -> str | None:
    """A φ at which a side has no value."""
    for cosine, side in product(COSINES, candidate.args):
        values: explicit.Values = {**_OTHERS, sy.phi: cosine, sy.M: 22, sy.j: 11, sy.i: _ACROSS}
        try:
            explicit.weights(side, values)
        except explicit.DivisionError:
            return WithoutValue(f"it has no value at φ = {cosine}")
        except explicit.AmbiguousError:
            continue
    return None


def _is_polynomial(candidate: sympy.Eq) -> bool:
    """Whether indices stand in no divisor, and in bounds with small whole numbers only."""
    indices = {*sy.INDICES}
    powers = (power for power in candidate.atoms(sympy.Pow) if power.exp.is_negative)
    ends = [end for one in candidate.atoms(sympy.Sum) for limit in one.limits for end in limit[1:]]
    ends += [argument for one in candidate.atoms(sy.SiteFunction) for argument in one.args]
    ends += [one.args[3] for one in candidate.atoms(sy.Braces)]
    return not any(power.free_symbols & indices for power in powers) and all(
        abs(number) <= 3 for end in ends for number in end.atoms(sympy.Rational)
    )


def _in_radii(
    exact: sympy.Expr, candidate: sympy.Eq, values: explicit.Values
) -> tuple[explicit.Weights, Fraction]:
    """Weights of left less right side, the force put in; and its factor, 0 where there is none."""
    left, right = (explicit.weights(side, values) for side in candidate.args)
    total = {key: left.get(key, 0) - right.get(key, 0) for key in {**left, **right}}
    forces = [key for key in total if key[0] in _BRANCHES and total[key]]
    if not forces:
        return {key: Fraction(w) for key, w in total.items() if w}, Fraction(0)
    if len(forces) != 1:
        raise explicit.AmbiguousError("it is about several forces")
    (branch, across, layer), factor = forces[0], total.pop(forces[0]) / (2 * values[sy.n_y])
    frozen = tuple(sorted(({**values, sy.i: across, sy.j: layer}).items(), key=str))
    for key, weight in _force(_BRANCHES[branch](exact), frozen).items():
        total[key] = total.get(key, Fraction(0)) + Fraction(factor) * weight
    return {key: Fraction(w) for key, w in total.items() if w}, Fraction(factor)


_BRANCHES: dict[str, Callable[[sympy.Expr], sympy.Expr]] = {
    "ForcePlus": lambda exact: exact,
    "ForceMinus": cache(mirror),
}
"""What a force of either branch is, by that along n⁺."""


@cache
def _force(
    exact: sympy.Expr, values: tuple[tuple[sympy.Symbol, Fraction], ...]
) -> explicit.Weights:
    return explicit.weights(exact, dict(values))


def _degree(values: list[Fraction]) -> int:
    """Of the polynomial that takes these values at equal steps, as far as they tell."""
    return max(
        order for order in range(len(values)) if order == 0 or any(_differences(values, order))
    )


def _differences(values: list[Fraction], order: int) -> list[Fraction]:
    for _ in range(order):
        values = [after - before for before, after in pairwise(values)]
    return values
