"""Means, variances and covariances of what is linear in the radii.

The radii are independent, of mean zero and variance σ². So a form that is an ordered value plus
weights times deviations of radii has that value as its mean, and σ² times the sum of its squared
weights as its variance, if each radius is met once: every coincidence of two sites is decided on
the domain, or nothing is proved. Where one is not decided the domain is parted, and the value has
to be the same on all of its parts.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache, partial
from math import gcd

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.exact import FIELD, UNKNOWNS, NotExactError, RationalFunction
from ..algebra.linear_forms import CONSTANT, LinearForm
from ..algebra.weights import (
    Pieces,
    UndeterminedError,
    sum_of_products,
    take_apart,
)
from ..as_printed import equation
from ..notation import by_name
from ..printing.text import text
from . import any_dimension, second_order
from .rules import Rule
from .theorem import (
    Facts,
    Normal,
    NotProvedError,
    Theorem,
    check,
    flat,
    made,
    put_in,
)
from .where import LATTICE, Where

_KNOWN = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS} - {sy.epsilon}
_RADII = (sy.DeltaR, sy.SecondDifference)
_ACROSS = {across for across, _ in LATTICE}
_MOST_RELATIONS = 16  # of a domain that is parted further

Alone = tuple[sympy.Expr, ...]
"""Distances of neighbours whose covariance is looked at by itself; between them it is zero."""


def moment(
    *facts: Theorem | tuple[Theorem, ...],
    whole: Where | None = None,
    cases: Sequence[Iterable[sympy.Basic]] = ((),),
    alone: Alone = (),
) -> Rule:
    """Both sides are the same once facts are put in and the moments are worked out.

    Args:
        facts: are put in one after the other, those of a tuple at once.
        whole: a domain on which that is done once, for statements on parts of it.
        cases: parts that leave no integer point of a statement's domain out: sums of squares are
            taken apart on each, as places that are two elsewhere may be one there.
        alone: of a sum over neighbours, at which distances two of them may be correlated.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        domain = whole or where
        if where != domain.also(*where.relations):
            raise NotProvedError("it is not about a part of the whole domain")
        parts = [where.also(*relations) for relations in cases]
        if not where.covered_by(parts):
            raise NotProvedError("the cases leave something of the domain out")
        names = _named(formula)
        for part in parts:
            if part.is_empty:
                continue
            apart = _on_part(partial(_apart, formula, facts), where, part)
            found = {name: value(one, facts, domain, part, alone) for one, name in names.items()}
            if not apart.mapped(partial(_put_for, found)).is_zero():
                raise NotProvedError("the moments of both sides differ")
        return made(formula, where, "moment", flat(facts))

    return rule


def _named(formula: sympy.Eq) -> dict[sympy.Expr, sympy.Symbol]:
    """A name for each moment of an equation; one for which none is left is not read."""
    return dict(zip(by_name(formula.atoms(sy.Moment)), UNKNOWNS[1], strict=False))


def _put_for(
    known: Mapping[sympy.Symbol, RationalFunction], weight: RationalFunction
) -> RationalFunction:
    """Values of names of which a weight is a polynomial."""
    for name, one in known.items():
        total = FIELD.zero
        for coefficient in reversed(weight.coefficients(name)):
            total = total * one + coefficient
        weight = total
    return weight


@lru_cache(maxsize=256)
def _apart(formula: sympy.Eq, facts: Facts, where: Where) -> LinearForm:
    """Left less right side, facts put in beside the moments, which are named."""
    named = (side.xreplace(_named(formula)) for side in formula.args)
    sides = [put_in(side, facts, where, facts) for side in named]
    forms = Normal(where, *sides).difference(equation(*sides))
    if len(forms) != 1:
        raise NotProvedError("a moment is no vector")
    return forms[0]


def without_moments(
    formula: sympy.Eq, facts: Facts, where: Where, part: Where | None = None
) -> sympy.Eq:
    """An equation on a part of a domain, moments worked out, and facts put in elsewhere.

    Raises:
        NotProvedError: one of them can't be.
    """
    moments = by_name(formula.atoms(sy.Moment))
    image = {one: worked_out(one, facts, where, part) for one in moments}
    sides = (side.xreplace(image) for side in formula.args)
    return equation(*(put_in(side, facts, where, facts) for side in sides))


@lru_cache(maxsize=256)
def worked_out(one: sy.Moment, facts: Facts, where: Where, part: Where | None = None) -> sympy.Expr:
    """The same as ``value``, in factors."""
    return value(one, facts, where, part).to_sympy()


@lru_cache(maxsize=1024)
def value(
    one: sy.Moment, facts: Facts, where: Where, part: Where | None = None, alone: Alone = ()
) -> RationalFunction:
    """A moment on a part of a domain, exact to leading order in the deviations of the radii.

    Raises:
        NotProvedError: it holds what is not known, or is not one function on all of the part.
    """
    part, sigma = part or where, FIELD.generator(sy.sigma) ** 2
    if one.has(*sy.CONTACTS):
        return any_dimension.value(one, part)
    if isinstance(one, sy.Shift):
        inside = one.args[0].xreplace(part.solved)
        found = second_order.shift(inside, part, lambda of, there: value(of, facts, there), facts)
        return found.reduced()
    try:
        if isinstance(one, sy.Variance) and (mean := _neighbours(one.args[0], facts, where, alone)):
            fixed = {symbol: FIELD.from_sympy(at) for symbol, at in part.solved.items()}
            return mean.variance(part).substitute(fixed) * sigma
        forms = [_on_part(partial(in_the_radii, side, facts), where, part) for side in one.args]
        if isinstance(one, sy.Mean):
            return forms[0].at_zero
        if isinstance(one, sy.Variance | sy.Covariance):
            return _products(forms[0], forms[-1], part) * sigma
    except UndeterminedError as reason:
        raise NotProvedError(f"two places may be one: {reason}") from None
    raise NotProvedError(f"{text(one)} is not worked out")


def _products(one: LinearForm, other: LinearForm, where: Where) -> RationalFunction:
    """Σ weight · weight′ of the radii of two forms, one function on all of the domain."""
    try:
        return sum_of_products(fluctuation(one), fluctuation(other), where)
    except UndeterminedError as reason:
        parts = _parts(where, reason)
        found = []
        for part in parts:
            at = {symbol: affine.from_sympy(place) for symbol, place in part.solved.items()}
            found.append(_products(one.put_in(at), other.put_in(at), part))
        return _agreed(parts, found, reason)
    except NotExactError as reason:
        raise NotProvedError(str(reason)) from None


def _parts(where: Where, reason: UndeterminedError) -> tuple[Where, ...]:
    """The parts of a domain where a number whose sign was undecided is > 0, < 0 and 0."""
    if reason.apart is None or len(where.relations) > _MOST_RELATIONS:
        raise NotProvedError(f"two places may be one: {reason}") from reason
    divisor = gcd(*reason.apart)
    number = affine.to_sympy(tuple(c // divisor for c in reason.apart))
    if not number.free_symbols <= {*where.indices}:
        raise NotProvedError(f"two places may be one: {reason}") from reason
    parts = [
        where.also(kind(number, sympy.Integer(side), evaluate=False))
        for kind, side in ((sympy.Ge, 1), (sympy.Le, -1), (sympy.Eq, 0))
    ]
    if where in parts:
        raise NotProvedError(f"two places may be one: {reason}") from reason
    return tuple(one.tightened() for one in parts if not one.is_empty)


def _agreed(
    parts: Sequence[Where], found: Sequence[RationalFunction], reason: UndeterminedError
) -> RationalFunction:
    """The value of the first part, if those of all others are the same there.

    Raises:
        UndeterminedError: they are not; the sum that they stand in may be, on the same parts.
    """
    for part, other in zip(parts[1:], found[1:], strict=True):
        known = {index: FIELD.from_sympy(at) for index, at in part.solved.items()}
        if not (found[0] - other).substitute(known).is_zero():
            raise UndeterminedError(reason.reason, reason.apart)
    return found[0]


def _on_part(read: Callable[[Where], LinearForm], where: Where, part: Where) -> LinearForm:
    """What is read on a domain, on a part of it where some indices have one value."""
    further = {symbol: at for symbol, at in part.solved.items() if symbol not in where.solved}
    if not all(at.is_Integer for at in further.values()):
        return read(part)
    return read(where).put_in({one: affine.constant(int(at)) for one, at in further.items()})


@lru_cache(maxsize=256)
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


def fluctuation(form: LinearForm) -> LinearForm:
    """The part of a form that depends on the radii."""
    sites = {site: weight for site, weight in form.sites.items() if site.family != CONSTANT}
    return LinearForm(sites, dict(form.rays))


def pieces(form: LinearForm, where: Where) -> Pieces:
    """The weights of the radii of a form, each met once."""
    try:
        return take_apart(fluctuation(form), where)
    except NotExactError as reason:
        raise NotProvedError(f"two places may be one: {reason}") from None


# sums over neighbours


@dataclass(frozen=True)
class _Neighbours:
    """A sum over neighbours of one layer, all that it is about two columns further each time.

    Attributes:
        factor: of the sum.
        first: what is summed, at its first place.
        across: the index across the packing.
        count: how many are summed.
        alone: how many places apart two of them may be correlated.
        facts: what gives it in the radii.
        beads: the domain, as far as it does not speak of N.
    """

    factor: sympy.Expr
    first: sympy.Expr
    across: sympy.Symbol
    count: sympy.Expr
    alone: Alone
    facts: Facts
    beads: Where

    def variance(self, where: Where) -> RationalFunction:
        """Variance over σ² on a domain, which is parted as far as it takes."""
        try:
            return self._on(where)
        except UndeterminedError as reason:
            parts = _parts(where, reason)
            return _agreed(parts, [self.variance(part) for part in parts], reason)

    def _on(self, where: Where) -> RationalFunction:
        """Factor² [count C₀ + 2 Σ (count − p) C_p].

        C_p is the covariance of two that are p places apart, the same for all such pairs, since
        the domain leaves the place along the layer free. It is zero but for p in ``alone``.
        """
        count, *places = (
            sympy.expand(one.xreplace(where.solved)) for one in (self.count, *self.alone)
        )
        near = _in_order([one for one in places if _reached(one, count, where)], where)
        spare = [one for one in (sy.p, sy.q, sy.n) if one not in where.indices]
        if not spare:
            raise NotProvedError("no index is left for the distance of two neighbours")
        apart, beads = spare[0], self._of_beads(where)
        total = FIELD.from_sympy(count) * _between(self._one, sympy.S.Zero, beads)
        for low, high in zip((sympy.S.Zero, *near), (*near, None), strict=True):
            domain, last = (where, count - 1) if high is None else (beads, high - 1)
            between = domain.also(apart >= low + 1, apart <= last, indices=(apart,))
            if not between.is_empty and not _between(self._one, apart, between).is_zero():
                raise NotProvedError(f"covariances beyond {text(low)} places are not zero")
            if high is not None:
                weight = FIELD.from_sympy(2 * (count - high))
                reached = sympy.Le(high, count - 1, evaluate=False)
                counted = self._of_beads(where.also(reached))
                total = total + weight * _between(self._one, high, counted)
        return total * FIELD.from_sympy(self.factor**2)

    @property
    def _one(self) -> tuple[sympy.Expr, sympy.Symbol, Facts, Where]:
        return self.first, self.across, self.facts, self.beads

    def _of_beads(self, where: Where) -> Where:
        found = where.without({sy.N} - self.first.free_symbols)
        return self.beads if found.rows == self.beads.rows else found


@lru_cache(maxsize=1024)
def _between(
    one: tuple[sympy.Expr, sympy.Symbol, Facts, Where], places: sympy.Expr, domain: Where
) -> RationalFunction:
    """Covariance over σ² with the neighbour so many places away, on a part of the domain of one.

    Raises:
        NotProvedError: it depends on the place along the layer.
    """
    solved = tuple(domain.solved.items())
    found = _products(
        _placed(one, sympy.S.Zero, solved), _placed(one, sympy.expand(places), solved), domain
    )
    if found.holds(one[1]):
        raise NotProvedError("covariances are not the same along the layer")
    return found


@lru_cache(maxsize=1024)
def _placed(
    one: tuple[sympy.Expr, sympy.Symbol, Facts, Where],
    places: sympy.Expr,
    solved: tuple[tuple[sympy.Symbol, sympy.Expr], ...],
) -> LinearForm:
    """The neighbour so many places away in the radii, with indices that are fixed put in."""
    first, across, facts, beads = one
    at = {symbol: affine.from_sympy(place) for symbol, place in solved}
    further = {across: affine.from_sympy(across + 2 * places)}
    return in_the_radii(first, facts, beads).put_in(further).put_in(at)


def _neighbours(side: sympy.Expr, facts: Facts, where: Where, alone: Alone) -> _Neighbours | None:
    """What is a sum over neighbours, times a factor.

    Raises:
        NotProvedError: its domain says something of the place along the layer, or the factor
            may depend on the radii.
    """
    factors = sympy.Mul.make_args(side)
    sums = [one for one in factors if isinstance(one, sympy.Sum)]
    if len(sums) != 1 or len(sums[0].limits) != 1:
        return None
    index, low, high = sums[0].limits[0]
    factor = sympy.Mul(*(one for one in factors if one is not sums[0]))
    first = sums[0].function.xreplace({index: low})
    for across in by_name(_ACROSS & {*where.indices}):
        if first.xreplace({across: across + 2 * (index - low)}) == sums[0].function:
            break
    else:
        return None
    if factor.free_symbols - _KNOWN:
        raise NotProvedError(f"whether {text(factor)} depends on the radii is not known")
    place = where.loading.place if where.loading else ()
    if any(across in one.free_symbols for one in (*where.relations, *place)):
        raise NotProvedError(f"its domain says something of {text(across)}")
    beads = where.without({sy.N} - first.free_symbols)
    return _Neighbours(factor, first, across, high - low + 1, alone, facts, beads)


def _in_order(places: Sequence[sympy.Expr], where: Where) -> list[sympy.Expr]:
    """Those of the distances that are positive, each once, in the order of the domain."""
    found: list[sympy.Expr] = []
    for place in places:
        if not _is_positive(place, where):
            continue
        before = [one for one in found if _is_positive(place - one, where)]
        if len(before) == len(found) or _is_positive(found[len(before)] - place, where):
            found.insert(len(before), place)
    return found


def _reached(place: sympy.Expr, count: sympy.Expr, where: Where) -> bool:
    """Whether a distance is below ``count``, or just that, where nothing of it is counted."""
    return not _at_least(place, count, where) and _is_positive(count - place + 1, where)


def _at_least(number: sympy.Expr, least: sympy.Expr, where: Where) -> bool:
    return where.nonnegative(affine.from_sympy(sympy.expand(number - least)))


def _is_positive(number: sympy.Expr, where: Where) -> bool:
    """Whether a whole number is positive on all of the domain, or nowhere.

    Raises:
        UndeterminedError: neither is known.
    """
    value = affine.from_sympy(sympy.expand(number))
    if where.nonnegative(affine.shifted(value, -1)):
        return True
    if where.nonnegative(affine.times(value, -1)):
        return False
    raise UndeterminedError(f"the sign of {text(number)}", value)
