"""Means, variances and covariances of what is linear in the radii.

The radii are independent, of mean zero and variance σ². So a form that is an ordered value plus
weights times deviations of radii has that value as its mean, and σ² times the sum of its squared
weights as its variance, if each radius is met once: every coincidence of two sites is decided on
the domain, or nothing is proved.
"""

from functools import lru_cache

import sympy
from force_diffusion.symbolic import symbols as sy
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
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text
from force_diffusion.symbolic.variances.weights import Pieces, take_apart

_KNOWN = {*sy.INDICES, *sy.PARAMETERS, *sy.VECTORS} - {sy.epsilon}
_RADII = (sy.DeltaR, sy.SecondDifference)


def moment(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """Both sides are the same once facts are put in and the moments are worked out."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        check(formula, where)
        if not holds(without_moments(formula, facts, where), where):
            raise NotProvedError("the moments of both sides differ")
        return made(formula, where, "moment", flat(facts))

    return rule


def without_moments(formula: sympy.Eq, facts: Facts, where: Where) -> sympy.Eq:
    """An equation with its moments worked out, and facts put in elsewhere.

    Raises:
        NotProvedError: one of them can't be.
    """
    image = {one: worked_out(one, facts, where) for one in by_name(formula.atoms(sy.Moment))}
    sides = (side.xreplace(image) for side in formula.args)
    return equation(*(put_in(side, facts, where, facts) for side in sides))


@lru_cache(maxsize=256)
def worked_out(one: sy.Moment, facts: Facts, where: Where) -> sympy.Expr:
    """The same as ``value``, in factors."""
    return value(one, facts, where).to_sympy()


@lru_cache(maxsize=256)
def value(one: sy.Moment, facts: Facts, where: Where) -> RationalFunction:
    """A moment at finite size, exact to leading order in the deviations of the radii."""
    forms = tuple(in_the_radii(argument, facts, where) for argument in one.args)
    if isinstance(one, sy.Mean):
        return forms[0].at_zero
    squares = tuple(_sum_of_squares(form, where) for form in forms)
    sigma = FIELD.generator(sy.sigma) ** 2
    if isinstance(one, sy.Variance):
        return squares[0] * sigma
    both = _sum_of_squares(forms[0] + forms[1], where)
    return (both - squares[0] - squares[1]) * sigma / FIELD.constant(2)


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
