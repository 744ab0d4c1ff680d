"""Means, variances and covariances of what is linear in the radii.

The radii are independent, of mean zero and variance σ². So a form that is an ordered value plus
weights times deviations of radii has that value as its mean, and σ² times the sum of its squared
weights as its variance, if each radius is met once: every coincidence of two sites is decided on
the domain, or nothing is proved. Where one is not decided the domain is parted, and the value has
to be the same on all of its parts.
"""

from collections.abc import Iterator
from functools import lru_cache
from math import gcd

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Affine
from force_diffusion.symbolic.algebra.exact import FIELD, NotExactError, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import CONSTANT, LinearForm
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import (
    Facts,
    Normal,
    NotProvedError,
    Theorem,
    check,
    flat,
    holds,
    made,
    put_in,
)
from force_diffusion.symbolic.kernel.where import LATTICE, Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.variances.weights import UndeterminedError, take_apart

_KNOWN = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS} - {sy.epsilon}
_RADII = (sy.DeltaR, sy.SecondDifference)
_ACROSS = {across for across, _ in LATTICE}
_MOST_RELATIONS = 16  # of a domain that is parted further

Alone = tuple[sympy.Expr, ...]
"""Distances of neighbours whose covariance is looked at by itself; between them it is zero."""


def moment(*facts: Theorem | tuple[Theorem, ...], alone: Alone = ()) -> Rule:
    """Both sides are the same once facts are put in and the moments are worked out."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        if not holds(without_moments(formula, facts, where, alone), where):
            raise NotProvedError("the moments of both sides differ")
        return made(formula, where, "moment", flat(facts))

    return rule


def without_moments(
    formula: sympy.Eq, facts: Facts, where: Where, alone: Alone = ()
) -> sympy.Eq:
    """An equation with its moments worked out, and facts put in elsewhere.

    Raises:
        NotProvedError: one of them can't be.
    """
    found = by_name(formula.atoms(sy.Moment))
    image = {one: value(one, facts, where, alone).to_sympy() for one in found}
    sides = (side.xreplace(image) for side in formula.args)
    return equation(*(put_in(side, facts, where, facts) for side in sides))


@lru_cache(maxsize=1024)
def value(one: sy.Moment, facts: Facts, where: Where, alone: Alone = ()) -> RationalFunction:
    """A moment at finite size, exact to leading order in the deviations of the radii.

    Raises:
        NotProvedError: it holds what is not known, or is not one function on all of the domain.
    """
    try:
        return _value(one, facts, where, alone)
    except NotProvedError as reason:
        undecided = reason.__cause__
        if not isinstance(undecided, UndeterminedError) or undecided.apart is None:
            raise
        parts = tuple(_parts(where, undecided.apart))
        if where in parts or len(where.relations) > _MOST_RELATIONS:
            raise
        found = [value(one.xreplace(part.solved), facts, part, alone) for part in parts]
        for part, other in zip(parts[1:], found[1:], strict=True):
            known = {index: FIELD.from_sympy(at) for index, at in part.solved.items()}
            if not (found[0] - other).substitute(known).is_zero():
                raise
        return found[0]


def _parts(where: Where, apart: Affine) -> Iterator[Where]:
    """The parts of a domain where a whole number is positive, negative and zero."""
    divisor = gcd(*apart)
    number = affine.to_sympy(tuple(c // divisor for c in apart))
    for kind, side in ((sympy.Ge, 1), (sympy.Le, -1), (sympy.Eq, 0)):
        part = where.also(kind(number, sympy.Integer(side), evaluate=False))
        if not part.is_empty:
            yield part.tightened() if kind is sympy.Eq else part


def _value(one: sy.Moment, facts: Facts, where: Where, alone: Alone) -> RationalFunction:
    if isinstance(one, sy.Variance) and (taken := _neighbours(one.args[0], where)):
        return _of_neighbours(*taken, facts, where, alone)
    forms = tuple(in_the_radii(argument, facts, where) for argument in one.args)
    if isinstance(one, sy.Mean):
        return forms[0].at_zero
    squares = tuple(_sum_of_squares(form, where) for form in forms)
    sigma = FIELD.generator(sy.sigma) ** 2
    if isinstance(one, sy.Variance):
        return squares[0] * sigma
    both = _sum_of_squares(forms[0] + forms[1], where)
    return (both - squares[0] - squares[1]) * sigma / FIELD.constant(2)


def in_the_radii(expression: sympy.Expr, facts: Facts, where: Where) -> LinearForm:
    """A number as a linear form in the deviations of the radii, facts put in.

    Raises:
        NotProvedError: it holds something else that may depend on them.
    """
    known = put_in(expression, facts, where, facts)
    for one in by_name(known.atoms(sy.SiteFunction)):
        if not isinstance(one, _RADII):
            raise NotProvedError(f"{text(one)} is not given by the radii")
    if unknown := by_name(known.free_symbols - _KNOWN):
        raise NotProvedError(f"whether {text(unknown[0])} depends on the radii is not known")
    forms = Normal(where, known)(known)
    if len(forms) != 1:
        raise NotProvedError("a moment of a vector is not read")
    return forms[0]


def _sum_of_squares(form: LinearForm, where: Where) -> RationalFunction:
    """Σ weight² of the radii of a form, each met once."""
    fluctuation = LinearForm(
        {site: weight for site, weight in form.sites.items() if site.family != CONSTANT},
        dict(form.rays),
    )
    try:
        return take_apart(fluctuation, where).sum_of_squares()
    except NotExactError as reason:
        raise NotProvedError(f"two places may be one: {reason}") from reason


# sums over neighbours

Neighbours = tuple[sympy.Expr, sympy.Expr, sympy.Symbol, sympy.Expr]
"""A factor, what is summed at its first place, the index of places, and how many there are."""


def _neighbours(side: sympy.Expr, where: Where) -> Neighbours | None:
    """A sum over neighbours of one layer: all that it is about is two columns further each time."""
    sums = [one for one in sympy.Mul.make_args(side) if isinstance(one, sympy.Sum)]
    if len(sums) != 1 or len(sums[0].limits) != 1:
        return None
    index, low, high = sums[0].limits[0]
    factor = sympy.Mul(*(one for one in sympy.Mul.make_args(side) if one is not sums[0]))
    first = sums[0].function.xreplace({index: low})
    for across in by_name(_ACROSS & {*where.indices}):
        if first.xreplace({across: across + 2 * (index - low)}) == sums[0].function:
            return factor, first, across, high - low + 1
    return None


def _of_neighbours(
    factor: sympy.Expr,
    first: sympy.Expr,
    across: sympy.Symbol,
    count: sympy.Expr,
    facts: Facts,
    where: Where,
    alone: Alone,
) -> RationalFunction:
    """Variance of a sum over ``count`` neighbours: count C₀ + 2 Σ (count − p) C_p.

    C_p is the covariance of two that are p places apart, the same for all such pairs, since the
    domain leaves the place along the layer free. It is zero but for the distances ``alone``.
    """
    if factor.free_symbols - _KNOWN or factor.has(sy.SiteFunction):
        raise NotProvedError(f"whether {text(factor)} depends on the radii is not known")
    counted = count.free_symbols - first.free_symbols
    beads = where.without(counted & {sy.N})
    if any(across in one.free_symbols for one in beads.relations) or (
        where.loading and any(across in one.free_symbols for one in where.loading.place)
    ):
        raise NotProvedError(f"its domain says something of {text(across)}")
    if not _at_least(count, sympy.S.One, where):
        raise NotProvedError(f"{text(count)} may be less than 1")
    spare = [one for one in (sy.p, sy.q) if one not in where.indices]
    if not spare:
        raise NotProvedError("no index is left for the distance of two neighbours")
    apart = spare[0]

    def covariance(places: sympy.Expr, at: Where) -> RationalFunction:
        other = first.xreplace({across: across + 2 * places})
        found = value(sy.Covariance(first, other), facts, at)
        if found.holds(across):
            raise NotProvedError("covariances are not the same along the layer")
        return found

    total = FIELD.from_sympy(count) * covariance(sympy.S.Zero, beads)
    places = _in_order(alone, where)
    for low, high in zip((sympy.S.Zero, *places), (*places, None), strict=True):
        if _at_least(low, count - 1, where):
            break
        between = beads.also(apart >= low + 1, indices=(apart,))
        if high is not None:
            between = between.also(apart <= high - 1)
        if not between.is_empty and not covariance(apart, between).is_zero():
            raise NotProvedError(f"covariances between {text(low)} and {text(high)} are not zero")
        if high is None or _at_least(high, count, where):
            continue
        if _is_positive(count - high + 1, where):
            weight = FIELD.from_sympy(2 * (count - high))
            total = total + weight * covariance(high, beads)
    return total * FIELD.from_sympy(factor**2)


def _in_order(places: Alone, where: Where) -> list[sympy.Expr]:
    """Those of the distances that are positive, each once, in the order of the domain."""
    found: list[sympy.Expr] = []
    for place in places:
        if not _is_positive(place, where):
            continue
        before = [one for one in found if _is_positive(place - one, where)]
        if len(before) == len(found) or _is_positive(found[len(before)] - place, where):
            found.insert(len(before), place)
    return found


def _at_least(number: sympy.Expr, least: sympy.Expr, where: Where) -> bool:
    return where.nonnegative(affine.from_sympy(sympy.expand(number - least)))


def _is_positive(number: sympy.Expr, where: Where) -> bool:
    """Whether a whole number is positive on all of the domain, or nowhere.

    Raises:
        NotProvedError: neither is known; the domain may be parted by its sign.
    """
    value = affine.from_sympy(sympy.expand(number))
    if where.nonnegative(affine.shifted(value, -1)):
        return True
    if where.nonnegative(affine.times(value, -1)):
        return False
    undecided = UndeterminedError(f"the sign of {text(number)} is not known", value)
    raise NotProvedError(str(undecided)) from undecided
