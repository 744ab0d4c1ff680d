"""What holds as indices grow together: the same leading order, or the same but for a factor.

Orders count all growing indices together, at fixed ratios. They hold uniformly while the ratios and
φ stay within closed parts of their ranges, as the leading parts of all divisors vanish nowhere.
"""

from collections.abc import Sequence
from functools import lru_cache

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.exact import (
    FIELD,
    LAYER,
    NotExactError,
    Polynomial,
    RationalFunction,
)
from force_diffusion.symbolic.algebra.signs import never_zero
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.moments import in_the_radii, pieces, without_moments
from force_diffusion.symbolic.kernel.rules import Rule
from force_diffusion.symbolic.kernel.theorem import (
    Facts,
    NotProvedError,
    Theorem,
    check,
    flat,
    made,
)
from force_diffusion.symbolic.kernel.where import Limit, Where
from force_diffusion.symbolic.notation import by_name
from force_diffusion.symbolic.printing.text import text

_FIXED = {*sy.PARAMETERS} - {sy.epsilon, sy.z}


def asymptotic(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """Both sides are of the same leading order: left over right goes to 1.

    Facts are put in and moments worked out at finite size. What the right-hand side goes as
    vanishes nowhere, and the difference is of a lower order.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = _limit(formula, where, "∼")
        left, right = read(formula, facts, where)
        low, high = order(left - right, limit), order(right, limit)
        if not low < high:
            raise NotProvedError(
                f"left less right is of order {low}, the right-hand side of order {high}"
            )
        if not (even(right, limit) and even(FIELD.one / right, limit)):
            raise NotProvedError("what the right-hand side goes as is not shown to vanish nowhere")
        if not even(left - right, limit):
            raise NotProvedError("the order of what is left is not shown to hold everywhere")
        return made(formula, where, "leading order", flat(facts))

    return rule


def bounded(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """One radius has at most a share of the order of the right-hand side in a variance."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = _limit(formula, where, "O")
        share, bound = formula.args
        if not isinstance(share, sy.LargestShare):
            raise NotProvedError(f"{text(share)} is not the largest share of a radius")
        finite = where.in_the_limit(None)
        parts = pieces(in_the_radii(share.args[0], facts, finite), finite)
        whole = parts.sum_of_squares() * read(equation(bound, bound), facts, where)[0]
        if whole.is_zero() or not even(FIELD.one / whole, limit):
            raise NotProvedError("what is divided by is not shown to vanish nowhere")
        fixed = {*sy.INDICES} - {*limit.growing}
        ends = [affine.to_field(one) for run in parts.runs for one in (run.first, run.last)]
        weights = [run.weight for run in parts.runs]
        weights += [full for full, _ in parts.special.values()]
        if any(one.holds(index) for one in (*ends, *weights) for index in fixed):
            raise NotProvedError("a weight, or where it stands, holds an index that does not grow")
        for weight in weights:
            if not even(weight, limit) or 2 * _order_over_layers(weight, limit) > order(
                whole, limit
            ):
                raise NotProvedError("a radius has a larger share, or that is not excluded")
        return made(formula, where, "largest share", flat(facts))

    return rule


def _order_over_layers(weight: RationalFunction, limit: Limit) -> int:
    """The order of a weight in any layer of its diagonal: a layer is at most of the order of M."""
    if weight.is_zero():
        return order(weight, limit)
    if weight.denominator.degrees()[FIELD.position[LAYER]] > 0:
        raise NotProvedError("a weight is divided by what depends on the layer")
    return max(_degrees(weight.numerator, (*limit.growing, LAYER))) - _degree(
        weight.denominator, limit
    )


def _limit(formula: sympy.Eq, where: Where, relation: str) -> Limit:
    """The limit of a statement, if its domain holds all but the first of what grows so.

    Raises:
        NotProvedError: it is another one, or leaves the domain.
    """
    check(formula, where, in_a_limit=True)
    limit = where.limit
    if limit is None or limit.relation != relation:
        raise NotProvedError(f"it is not in a limit, or not with the sign {relation}")
    coordinates = _coordinates(limit)
    if any(one in where.solved for one in limit.growing):
        raise NotProvedError(f"its domain does not hold all of {limit.words}")
    for row in where.rows:
        whole = sympy.expand(affine.to_sympy(row).xreplace(where.solved))
        if whole == 0:
            continue  # the index that an equation fixes is given by the others
        at_large = (whole - whole.as_coeff_Add()[0]).xreplace(coordinates)
        parts = sympy.expand(at_large).as_coefficients_dict()
        inside = all(c > 0 for c in parts.values() if c) and any(parts.values())
        if not inside or at_large.free_symbols - set(_NAMES):
            raise NotProvedError(f"its domain does not hold all of {limit.words}")
    return limit


_NAMES = tuple(sympy.Dummy(f"grows_{place}", positive=True) for place in range(4))


@lru_cache(maxsize=64)
def _coordinates(limit: Limit) -> dict[sympy.Symbol, sympy.Expr]:
    """The growing indices in terms of what is positive and grows in fixed ratios."""
    names = _NAMES[: len(limit.positive)]
    rows = [one - name for one, name in zip(limit.positive, names, strict=True)]
    found = sympy.solve(rows, limit.growing, dict=True)
    if len(found) != 1 or set(found[0]) != set(limit.growing):
        raise NotProvedError("the limit does not say how every index grows")
    return dict(found[0])


def read(formula: sympy.Eq, facts: Facts, where: Where) -> tuple[RationalFunction, ...]:
    """Both sides as functions of what grows and of parameters, moments worked out at finite size.

    Raises:
        NotProvedError: they hold something else, or are none.
    """
    limit = where.limit
    assert limit is not None
    finite = without_moments(formula, facts, where.in_the_limit(None))
    height = {sy.z: (sy.j / sy.M).xreplace(where.solved)}
    sides = [side.xreplace(where.solved).xreplace(height) for side in finite.args]
    known = {*_FIXED, *limit.growing}
    if strange := by_name(set().union(*(side.free_symbols for side in sides)) - known):
        raise NotProvedError(f"{text(strange[0])} neither grows nor is fixed")
    try:
        return tuple(FIELD.from_sympy(side).reduced() for side in sides)
    except NotExactError as reason:
        raise NotProvedError(str(reason)) from None


def order(value: RationalFunction, limit: Limit) -> int:
    """The power with which a function grows; less than any for zero."""
    if value.is_zero():
        return -(10**9)
    return _degree(value.numerator, limit) - _degree(value.denominator, limit)


def leading(value: RationalFunction, limit: Limit) -> RationalFunction:
    """The part of highest order."""
    return _top(value.numerator, limit) / _top(value.denominator, limit)


def even(value: RationalFunction, limit: Limit) -> bool:
    """Whether its order holds at all ratios and φ: what its divisor goes as vanishes nowhere."""
    below = _top(value.denominator, limit).to_sympy().xreplace(_coordinates(limit))
    return never_zero(below, _NAMES)


def _degree(polynomial: Polynomial, limit: Limit) -> int:
    return max(_degrees(polynomial, limit.growing))


def _degrees(polynomial: Polynomial, growing: Sequence[sympy.Symbol]) -> list[int]:
    places = [FIELD.position[one] for one in growing]
    return [sum(int(powers[place]) for place in places) for powers in polynomial.to_dict()]


def _top(polynomial: Polynomial, limit: Limit) -> RationalFunction:
    degrees = _degrees(polynomial, limit.growing)
    kept = {
        powers: c
        for (powers, c), degree in zip(polynomial.to_dict().items(), degrees, strict=True)
        if degree == max(degrees)
    }
    return RationalFunction(FIELD, FIELD.context.from_dict(kept), FIELD.context.constant(1))
