"""What holds as indices grow together: leading orders, of closed forms at finite size.

Orders count all growing indices together, at fixed ratios. A closed form has no divisor that mixes
an index with φ, so its orders hold uniformly while the ratios and φ stay within closed parts of
their ranges; of what has such a divisor nothing is said. H_M and its powers are of order 0: they
grow, but less than any power of M.
"""

from collections.abc import Iterable, Iterator, Sequence

import sympy

from .. import sets
from .. import symbols as sy
from ..algebra.exact import FIELD, SITE, NotProvedError, Polynomial, RationalFunction
from ..forms import FORCES, NUMBER, RADII, Form
from ..notation import OfExpressions, by_name
from ..printing.text import text
from ..second_order import covariance
from ..sets import EVERYTHING
from ..signs import sign
from ..trees import equation
from ..weights import Weights
from .domain import Domain, Limit
from .refuted import other_order, too_large
from .rules import Rule
from .statistics import MomentReader, worked_out
from .theorem import (
    Group,
    Groups,
    Theorem,
    check_domain,
    flat,
    made,
    read,
    written_out,
)

_NEVER = 10**9  # no order is as large
_FIXED = {*sy.PARAMETERS} - {sy.epsilon}
"""What stays as it is in every limit."""


def asymptotic(*groups: Group) -> Rule:
    """Both sides are of the same leading order: left over right goes to 1.

    Theorems are put in and moments worked out at finite size. What the right-hand side goes as
    vanishes nowhere, and the difference is of a lower order.
    """

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        limit = limit_of(formula, domain, "∼")
        left, right = (in_the_limit(side, domain, groups) for side in formula.args)
        apart, top = (left - right).reduced(), leading(right, limit)
        low, high = order(apart, limit), order(top, limit)
        if not apart.is_zero() and low > high - limit.orders:
            same = order(left, limit) == high and limit.orders == 1
            first = leading(left, limit) if same else None
            raise other_order(leading(apart, limit), first, top, limit)
        if not _vanishes_nowhere(top, limit, domain.dimension):
            raise NotProvedError("what the right-hand side goes as may vanish")
        return made(formula, domain, "comparing leading orders", flat(groups))

    return rule


def negligible(*groups: Group) -> Rule:
    """What a statement about one force drops varies less, by an order, than that force.

    Its left-hand side is a multiple of the force, but for what does not vary: otherwise it would be
    open what to compare with. Theorems are put in at finite size. Both sides have one mean.
    """

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        limit = limit_of(formula, domain, "≈")
        forces = set().union(*(side.atoms(*FORCES) for side in formula.args))
        left = sympy.expand(formula.lhs)
        beside = sympy.expand(left - sum(left.coeff(force) * force for force in forces))
        if len(forces) != 1 or beside.has(OfExpressions) or not left.has(*forces):
            raise NotProvedError("one contact force does not stand alone on its left")
        apart = sympy.Add(formula.lhs, -formula.rhs, evaluate=False)
        whole, rest = (_in_radii(each, groups, domain) for each in (formula.lhs, apart))
        if not rest.parts.get(NUMBER, Weights()).is_zero():
            raise NotProvedError("the means of both sides differ")
        kept, dropped = (_variance(form, domain) for form in (whole, rest))
        if not _vanishes_nowhere(leading(kept, limit), limit):
            raise NotProvedError("the force is not shown to vary everywhere")
        if not order(dropped, limit) < order(kept, limit):
            raise too_large(order(dropped, limit), order(kept, limit), limit)
        return made(formula, domain, "bounding dropped terms", flat(groups))

    return rule


def drop_terms(dropping: Theorem, *exact: Theorem) -> Rule:
    """The leading order of a variance, by that of what a statement about the force keeps.

    ``dropping`` says L ≈ R: var(L − R) is of a lower order than var(L). Since √var is a norm,
    var(L) and var(R) are then of the same leading order. ``exact`` are what is known of var(R).
    """

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        limit = limit_of(formula, domain, "∼")
        of = dropping.domain.limit
        same = of and (of.growing, of.positive) == (limit.growing, limit.positive)
        if of is None or of.relation != "≈" or not same:
            raise NotProvedError("what is dropped is so in another limit")
        if limit.orders != 1 or dropping.domain.loading != domain.loading:
            raise NotProvedError("what is dropped is so of other packings, or for one order alone")
        left, right = dropping.formula.args
        if not isinstance(formula.lhs, sy.Variance):
            raise NotProvedError("it is not the variance of what something was dropped from")
        (whole,) = formula.lhs.args
        read(equation(whole, whole), _late(domain))  # it has a value
        if not sympy.expand(whole - left).is_Rational:
            raise NotProvedError("it is not the variance of what something was dropped from")
        if not _late(domain).lies_in(dropping.domain):
            raise NotProvedError("what is dropped is so elsewhere")
        asymptotic(*exact)(equation(sy.Variance(right), formula.rhs), domain)
        return made(formula, domain, "dropping terms", (dropping, *exact))

    return rule


def bounded(*groups: Group) -> Rule:
    """No radius has more than a share of some order in a variance."""

    def rule(formula: sympy.Eq, domain: Domain) -> Theorem:
        limit = limit_of(formula, domain, "O")
        most, bound = formula.args
        if not isinstance(most, sy.LargestShare):
            raise NotProvedError(f"{text(most)} is no largest share of a radius")
        form = _in_radii(most.args[0], groups, domain)
        whole = _variance(form, domain) * in_the_limit(bound, domain)
        if not _vanishes_nowhere(leading(whole, limit), limit):
            raise NotProvedError("what is compared with is not shown to vanish nowhere")
        weights = form.parts.get(RADII, Weights()).pieces
        if any(2 * _order_at_sites(weight, limit) > order(whole, limit) for _, weight in weights):
            raise NotProvedError("a radius has more, or that is not excluded")
        return made(formula, domain, "bounding the largest share", flat(groups))

    return rule


def _order_at_sites(weight: RationalFunction, limit: Limit) -> int:
    """The order of a weight at any site: a bead is at most of the order of M away."""
    _uniform(weight, limit)
    if any(weight.denominator.degrees()[FIELD.position[coordinate]] > 0 for coordinate in SITE):
        raise NotProvedError("a weight is divided by what depends on the site")
    above = _degrees(weight.numerator, (*limit.growing, *SITE, sy.H_M))  # H_M is at most M
    return max(above) - max(_degrees(weight.denominator, limit.growing))


def _in_radii(expression: sympy.Expr, groups: Groups, domain: Domain) -> Form:
    """The weights of the radii; the place across the packing, which does not matter, is put at 0.

    Raises:
        NotProvedError: they are not given, or that place does matter.
    """
    finite = _late(domain)
    symbols = set().union(*(relation.free_symbols for relation in domain.relations))
    free = {sy.i, sy.k, sy.site_r} & {*domain.indices} - symbols
    form = MomentReader.on(finite, groups).in_radii(written_out(expression, domain))
    if free:  # a step to the right, of the bead and of all sites
        step = {s: s - 1 if s in finite.straight.back else s + 2 for s in free}
        step |= {SITE[0]: SITE[0] + 1, SITE[1]: SITE[1] - 1}
        if len(free) > 1 or not (form.at(step) - form).is_zero():
            raise NotProvedError("the place across the packing matters")
    return form.at(dict.fromkeys(free, sympy.S.Zero)).merged()


def _variance(form: Form, domain: Domain) -> RationalFunction:
    return _formula_in_the_limit(covariance(form, form), domain)


# one function in all of a limit


def in_the_limit(side: sympy.Expr, domain: Domain, groups: Groups = ()) -> RationalFunction:
    """The one function that a side is as indices grow, moments worked out at finite size.

    Raises:
        NotProvedError: it is not one, or holds what neither grows nor is fixed.
    """
    number = worked_out(written_out(side, domain), _late(domain), groups)
    if {*number.parts} - {NUMBER}:
        raise NotProvedError(f"{text(side)} belongs to single beads")
    return _formula_in_the_limit(number.parts.get(NUMBER, Weights()), domain)


def _formula_in_the_limit(number: Weights, domain: Domain) -> RationalFunction:
    limit = domain.limit
    assert limit is not None
    points = _late(domain).points
    formulas = number.on(points).formulas()
    if not formulas:
        return FIELD.zero
    (whole, value), *others = formulas
    if others or not points.is_subset(whole):
        raise NotProvedError(f"it is not one function in all of {limit.words}")
    back = {s: FIELD.from_sympy(at) for s, at in domain.straight.back.items()}
    given = sets.fixed(sets.where(*domain.relations), _not_in(limit.growing))
    value = value.substitute(back).substitute(given).reduced()
    _uniform(value, limit)
    return value


_LARGE = 1000
"""From which value on what grows is looked at: with fewer, no statement has small packings."""


def _late(domain: Domain) -> Domain:
    """The part of a domain in which all that grows is large, at finite size."""
    assert domain.limit is not None
    return domain.in_the_limit(None).also(*_large(domain.limit))


def _large(limit: Limit) -> Iterator[sympy.Basic]:
    return (sympy.Ge(expression, _LARGE, evaluate=False) for expression in limit.positive)


def _not_in(symbols: Iterable[sympy.Symbol]) -> tuple[sympy.Symbol, ...]:
    return tuple(dimension for dimension in sets.DIMENSIONS if dimension not in {*symbols})


def large(domain: Domain, limit: Limit) -> sets.Set:
    """Where all that grows is large."""
    return sets.where(*map(domain.straight.relation, _large(limit)))


def limit_of(formula: sympy.Eq, domain: Domain, relation: str) -> Limit:
    """The limit of a statement, if its domain holds all but the first of what grows so.

    Raises:
        NotProvedError: it is another one, or leaves the domain.
    """
    check_domain(formula, domain, in_a_limit=True)
    limit = domain.limit
    assert limit is not None
    if limit.relation != relation:
        raise NotProvedError(f"it is not in a limit, or not with the sign {relation}")
    if sy.z in formula.free_symbols and not {sy.j, sy.M} <= {*domain.indices}:
        raise NotProvedError(f"{text(sy.z)} neither grows nor is fixed")
    positive = (total.xreplace(domain.straight.image) for total in limit.positive)
    symbols = set().union(*(total.free_symbols for total in positive))
    late = large(domain, limit)
    if not late.is_subset(sets.without(domain.points, *_not_in(symbols))):
        raise NotProvedError(f"its domain does not hold all of {limit.words}")
    return limit


# orders


def order(value: RationalFunction, limit: Limit) -> int:
    """The power with which a function grows, powers of H_M aside; less than any for zero."""
    if value.is_zero():
        return -_NEVER
    above = _degrees(value.numerator, limit.growing)
    return max(above) - max(_degrees(value.denominator, limit.growing))


def leading(value: RationalFunction, limit: Limit) -> RationalFunction:
    """The part of highest order."""
    return _top(value.numerator, limit) / _top(value.denominator, limit)


def _uniform(value: RationalFunction, limit: Limit) -> None:
    """Refuse a function unless its order holds everywhere.

    Raises:
        NotProvedError: it holds what neither grows nor is fixed, or a divisor mixes what grows with
            what is fixed, or goes as what may vanish.
    """
    known = {*_FIXED, *limit.growing, *SITE} | ({sy.H_M} if sy.M in limit.growing else set())
    strange = by_name(
        generator
        for generator in FIELD.generators
        if value.holds(generator) and generator not in known
    )
    if strange:
        raise NotProvedError(f"{text(strange[0])} neither grows nor is fixed")
    growing = [FIELD.position[symbol] for symbol in (*limit.growing, sy.H_M)]
    for factor, _ in value.denominator.factor()[1]:
        degrees = factor.degrees()
        grows = any(degrees[place] > 0 for place in growing)
        if grows and sum(degree > 0 for degree in degrees) > sum(degrees[p] > 0 for p in growing):
            raise NotProvedError("a divisor mixes what grows with what is fixed")
        if grows and not _vanishes_nowhere(FIELD.polynomial(_top(factor, limit).numerator), limit):
            raise NotProvedError("what a divisor goes as may vanish")


def _vanishes_nowhere(value: RationalFunction, limit: Limit, dimension: int = 2) -> bool:
    """Whether a leading order is shown to differ from zero at all ratios and φ."""
    if value.holds(sy.H_M) or value.is_zero():
        return False
    grown = zip(limit.growing, limit.positive, strict=True)
    there = value.substitute({s: FIELD.from_sympy(2 * s - unit) for s, unit in grown})
    return sign(there, EVERYTHING, limit.growing, dimension) != 0


def _degrees(polynomial: Polynomial, growing: Sequence[sympy.Symbol]) -> list[int]:
    places = [FIELD.position[symbol] for symbol in growing]
    return [sum(int(powers[place]) for place in places) for powers in polynomial.to_dict()]


def _top(polynomial: Polynomial, limit: Limit) -> RationalFunction:
    degrees = _degrees(polynomial, limit.growing)
    highest = {
        powers: c
        for (powers, c), degree in zip(polynomial.to_dict().items(), degrees, strict=True)
        if degree == max(degrees)
    }
    return FIELD.polynomial(FIELD.context.from_dict(highest))
