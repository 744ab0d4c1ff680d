"""Means, variances and covariances of what is linear in the radii.

The radii are independent, of mean zero and variance σ². So a form that is an ordered value plus
weights times deviations of radii has that value as its mean, and σ² times the sum of its squared
weights as its variance, if each radius is met once: every coincidence of two sites is decided on
the domain, or nothing is proved.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache, partial

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import FIELD, UNKNOWNS, NotExactError, RationalFunction
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
    made,
    put_in,
)
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.variances.cases import at_value
from force_diffusion.symbolic.variances.weights import Pieces, take_apart

_KNOWN = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS} - {sy.epsilon}
_RADII = (sy.DeltaR, sy.SecondDifference)


def moment(
    *facts: Theorem | tuple[Theorem, ...],
    whole: Where | None = None,
    cases: Sequence[Iterable[sympy.Basic]] = ((),),
) -> Rule:
    """Both sides are the same once facts are put in and the moments are worked out.

    Args:
        facts: are put in one after the other, those of a tuple at once.
        whole: a domain on which that is done once, for statements on parts of it.
        cases: parts that leave no integer point of a statement's domain out: sums of squares are
            taken apart on each, as places that are two elsewhere may be one there.
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
            found = {name: value(one, facts, domain, part) for one, name in names.items()}
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


@lru_cache(maxsize=256)
def value(
    one: sy.Moment, facts: Facts, where: Where, part: Where | None = None
) -> RationalFunction:
    """A moment on a part of a domain, exact to leading order in the deviations of the radii."""
    part = part or where
    if isinstance(one, sy.Covariance):
        first, second = one.args
        of = (sy.Variance(first + second), sy.Variance(first), sy.Variance(second))
        both, left, right = (value(single, facts, where, part) for single in of)
        return (both - left - right) / FIELD.constant(2)
    form = _on_part(partial(in_the_radii, one.args[0], facts), where, part)
    if isinstance(one, sy.Mean):
        return form.at_zero
    if isinstance(one, sy.Variance):
        return _sum_of_squares(form, part) * FIELD.generator(sy.sigma) ** 2
    raise NotProvedError(f"{text(one)} is not worked out")


def _on_part(read: Callable[[Where], LinearForm], where: Where, part: Where) -> LinearForm:
    """What is read on a domain, on a part of it where some indices have one value."""
    further = {symbol: at for symbol, at in part.solved.items() if symbol not in where.solved}
    if not all(at.is_Integer for at in further.values()):
        return read(part)
    form = read(where)
    for symbol, at in further.items():
        form = at_value(form, symbol, int(at))
    return form


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


def _sum_of_squares(form: LinearForm, where: Where) -> RationalFunction:
    """Σ weight² of the radii of a form, each met once."""
    return pieces(form, where).sum_of_squares()


def pieces(form: LinearForm, where: Where) -> Pieces:
    """The weights of the radii of a form, each met once."""
    try:
        return take_apart(fluctuation(form), where)
    except NotExactError as reason:
        raise NotProvedError(f"two places may be one: {reason}") from None
