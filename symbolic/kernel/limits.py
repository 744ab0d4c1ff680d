"""What holds as indices grow together: the same leading order, or the same but for a factor.

Orders count all growing indices together, at fixed ratios. They hold uniformly while the ratios and
φ stay within closed parts of their ranges, as the leading parts of all divisors vanish nowhere.
"""

from collections.abc import Sequence
from functools import lru_cache

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.exact import FIELD, SITE, NotExactError, Polynomial, RationalFunction
from ..algebra.signs import never_zero
from ..forms import NUMBER, Form
from ..notation import by_name
from ..printing.text import text
from ..second_order import RADII, covariance
from ..weights import Weights
from .rules import Rule
from .statistics import ClosedForm, Statistics
from .theorem import FORCES, DisprovedError, Facts, NotProvedError, Theorem, check, flat, made
from .where import Limit, Where

_NEVER = 10**9  # no order is as large
FIXED = {*sy.PARAMETERS} - {sy.epsilon, sy.z}
"""What stays as it is in every limit."""


def asymptotic(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """Both sides are of the same leading order: left over right goes to 1.

    Facts are put in and moments worked out at finite size. What the right-hand side goes as
    vanishes nowhere, and the difference is of a lower order.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "∼")
        left, right = read(formula, facts, where)
        low, high = order(left - right, limit), order(right, limit)
        if not low <= high - limit.orders:
            raise DisprovedError(how_apart(left, right, limit))
        least = where.dimension
        if not even(FIELD.one / right, limit, least):
            raise NotProvedError("what the right-hand side goes as is not shown to vanish nowhere")
        if not even(left - right, limit, least):
            raise NotProvedError("the order of what is left is not shown to hold everywhere")
        return made(formula, where, "leading order", flat(facts))

    return rule


def how_apart(left: RationalFunction, right: RationalFunction, limit: Limit) -> str:
    """How what is not of the same leading orders goes.

    Functions of what grows and of parameters that differ in their leading parts do so at almost
    every ratio and φ.
    """
    if left.is_zero() or right.is_zero():
        side = "left" if left.is_zero() else "right"
        return f"the {side}-hand side is zero, the other one is not"
    if order(left - right, limit) < order(right, limit):
        rest = _as_shown(leading(left - right, limit), limit)
        return f"left less right goes as {rest}, an order that both are to share"
    power = order(left, limit) - order(right, limit)
    share = _as_shown(leading(left, limit) / leading(right, limit), limit)
    goes = f"goes as the power {power} of what grows" if power else f"goes to {share}"
    true = _as_shown(leading(left, limit), limit)
    return f"left over right {goes}, not to 1: the left-hand side goes as {true}"


def _as_shown(value: RationalFunction, limit: Limit) -> str:
    """A function of what grows; at a fixed relative height, of that."""
    if limit.growing == (sy.M, sy.j):
        value = value.substitute({sy.j: FIELD.generator(sy.z) * FIELD.generator(sy.M)})
    return text(value.reduced().to_sympy())


def bounded(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """The weight of each radius, or its share in the variance, is of the order on the right."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "O")
        most, bound = formula.args
        if not isinstance(most, sy.LargestShare | sy.LargestWeight):
            raise NotProvedError(f"{text(most)} is no largest share, or weight, of a radius")
        weights = _in_radii(most.args[0], facts, where)
        whole = _read_side(bound, where) ** 2
        if isinstance(most, sy.LargestShare):
            whole = _sum_of_squares(weights, where) * _read_side(bound, where)
        _grows_as(whole, limit)
        if any(2 * one > order(whole, limit) for one in _orders(weights, limit)):
            raise NotProvedError("a radius has more, or that is not excluded")
        return made(formula, where, "largest share or weight", flat(facts))

    return rule


def negligible(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """What a statement about one force drops varies less, by an order, than that force.

    Facts are put in at finite size. Both sides have one mean. What they share beside that force
    counts for nothing.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "≈")
        varies = _sum_of_squares(_in_radii(_one_force(formula), facts, where), where)
        _grows_as(varies, limit)
        squares = _sum_of_squares(_difference(formula, facts, where), where)
        dropped, kept = order(_fixed_but(squares, limit), limit), order(varies, limit)
        if not even(squares, limit):
            raise NotProvedError("the order of what is dropped is not shown to hold everywhere")
        if not dropped < kept:
            raise NotProvedError(
                f"what is dropped varies as the power {dropped} of the height, the force as {kept}"
            )
        return made(formula, where, "dropped orders", flat(facts))

    return rule


def heaviest(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """All weights of left less right are of a lower order than the largest of left."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "≈ by weight")
        alone = _in_radii(formula.lhs, facts, where)
        sure = [
            one
            for _, one in alone.merged().pieces
            if even(one, limit) and even(FIELD.one / one, limit)
        ]
        most = max((order(_fixed_but(one, limit), limit) for one in sure), default=-_NEVER)
        rest = _difference(formula, facts, where)
        if not sure or any(one >= most for one in _orders(rest, limit)):
            raise NotProvedError("left less right has weights of the order of the largest of left")
        return made(formula, where, "heaviest weights", flat(facts))

    return rule


def _one_force(formula: sympy.Eq) -> sympy.Expr:
    """The force that a statement is about, with its factor.

    Raises:
        NotProvedError: there is not one.
    """
    found = by_name(set().union(*(side.atoms(*FORCES) for side in formula.args)))
    if len(found) != 1:
        raise NotProvedError("it is not about one contact force")
    apart = sympy.expand(formula.lhs - formula.rhs)
    return found[0] * apart.coeff(found[0])


def _in_radii(expression: sympy.Expr, facts: Facts, where: Where) -> Weights:
    """The weights of the radii, in the limit; the place across the packing is put at 0."""
    return _form(expression, facts, where).parts.get(RADII, Weights())


def _form(expression: sympy.Expr, facts: Facts, where: Where) -> Form:
    finite = where.in_the_limit(None)
    try:
        reader = Statistics.on(finite, flat(facts))
        form = reader.in_radii(_at_height(expression, where))
        free = {sy.i, sy.k, sy.site_r} & {*where.indices}
        free -= set().union(*(one.free_symbols for one in where.relations))
        _check_along_layers(expression, free)
        return form.at(dict.fromkeys(free, sympy.S.Zero)).merged()
    except NotExactError as reason:
        raise NotProvedError(str(reason)) from None


def _check_along_layers(expression: sympy.Expr, free: set[sympy.Symbol]) -> None:
    """That only the sites hold a place across the packing, and all move with it.

    Raises:
        NotProvedError: some don't.
    """
    sites = expression.atoms(sy.SiteFunction)
    across = [sympy.expand(one.args[0]).as_coefficients_dict() for one in sites]
    moving = {tuple((s, one[s]) for s in by_name(free) if one[s] != 0) for one in across}
    bare = expression.xreplace({one: sympy.Dummy() for one in sites})
    together = len(moving) <= 1 and all(len(one) <= 1 for one in moving)
    if bare.free_symbols & free or not together:
        found = by_name(expression.free_symbols & free)
        raise NotProvedError(f"{text(found[0])} neither grows nor is fixed")


def _difference(formula: sympy.Eq, facts: Facts, where: Where) -> Weights:
    """The weights of left less right; their means agree."""
    rest = _form(formula.lhs, facts, where) - _form(formula.rhs, facts, where)
    if not rest.parts.get(NUMBER, Weights()).is_zero():
        raise NotProvedError("the means of both sides differ")
    return rest.parts.get(RADII, Weights()).merged()


def _sum_of_squares(weights: Weights, where: Where) -> RationalFunction:
    form = Form({RADII: weights})
    return in_the_limit(covariance(form, form), where)


def in_the_limit(number: Weights, where: Where) -> RationalFunction:
    """The one function that a number is as indices grow.

    Raises:
        NotProvedError: it is not one throughout the limit.
    """
    limit = where.limit
    assert limit is not None
    reader = Statistics.on(where.in_the_limit(None), ())
    form = ClosedForm(number.on(reader.points), reader.points, reader.straight)
    for piece in form.pieces:
        if any(all(_is_late(one, where) for one in part) for part in piece.where):
            return piece.value.substitute(
                {symbol: FIELD.from_sympy(at) for symbol, at in where.solved.items()}
            )
    raise NotProvedError(f"it is not one function in all of {limit.words}")


def _is_late(relation: sympy.Basic, where: Where) -> bool:
    """Whether a relation holds for all but the first of what grows."""
    form = relation.lhs - relation.rhs
    return not isinstance(relation, sympy.Eq) and _grows(form, where, least=0)


def _grows(form: sympy.Expr, where: Where, least: int) -> bool:
    """Whether a form grows in the limit, or is a constant that is large enough."""
    assert where.limit is not None
    whole = sympy.expand(form.xreplace(where.solved))
    rest = whole.as_coeff_Add()[0]
    at_large = (whole - rest).xreplace(_coordinates(where.limit))
    if at_large == 0:
        return bool(rest >= least)
    factors = sympy.expand(at_large).as_coefficients_dict()
    return all(c > 0 for c in factors.values()) and at_large.free_symbols <= set(_NAMES)


def _at_height(side: sympy.Expr, where: Where) -> sympy.Expr:
    """A side with z = j/M, and with what equations of the domain fix."""
    height = {sy.z: (sy.j / sy.M).xreplace(where.solved)}
    return side.xreplace(height)


def _grows_as(whole: RationalFunction, limit: Limit) -> None:
    """That it is at least of its order everywhere."""
    if _fixed_but(whole, limit).is_zero() or not even(FIELD.one / whole, limit):
        raise NotProvedError("what is compared with is not shown to be of one order everywhere")


def _fixed_but(value: RationalFunction, limit: Limit) -> RationalFunction:
    """The same, if only what grows stands in it beside what is fixed."""
    strange = [
        one for one in {*sy.INDICES, sy.z, sy.epsilon} - {*limit.growing} if value.holds(one)
    ]
    if strange:
        raise NotProvedError(f"{text(by_name(strange)[0])} neither grows nor is fixed")
    return value.reduced()


def _orders(weights: Weights, limit: Limit) -> list[int]:
    """The orders of all weights, at any site: a bead is at most of the order of M away."""
    found = [value for _, value in weights.merged().pieces]
    if not all(even(_fixed_but(one, limit), limit) for one in found):
        raise NotProvedError("the order of a weight is not shown to hold everywhere")
    return [_order_at_sites(one, limit) for one in found]


def _order_at_sites(weight: RationalFunction, limit: Limit) -> int:
    if any(weight.denominator.degrees()[FIELD.position[one]] > 0 for one in SITE):
        raise NotProvedError("a weight is divided by what depends on the site")
    return max(_degrees(weight.numerator, (*limit.growing, *SITE))) - _degree(
        weight.denominator, limit
    )


def limit_of(formula: sympy.Eq, where: Where, relation: str) -> Limit:
    """The limit of a statement, if its domain holds all but the first of what grows so.

    Raises:
        NotProvedError: it is another one, or leaves the domain.
    """
    check(formula, where, in_a_limit=True)
    limit = where.limit
    assert limit is not None
    if limit.relation != relation:
        raise NotProvedError(f"it is not in a limit, or not with the sign {relation}")
    _coordinates(limit)
    if any(one in where.solved for one in limit.growing):
        raise NotProvedError(f"its domain does not hold all of {limit.words}")
    for row in where.rows:
        whole = sympy.expand(affine.to_sympy(row).xreplace(where.solved))
        if not _grows(whole, where, least=0):
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
    known = {*FIXED, *limit.growing}
    found = []
    for side in formula.args:
        try:
            number = Statistics.on(where.in_the_limit(None), flat(facts)).number(
                _at_height(side, where)
            )
            if strange := {*number.parts} - {NUMBER}:
                raise NotProvedError(f"{min(strange)} belongs to single beads")
            value = in_the_limit(number.parts.get(NUMBER, Weights()), where).reduced()
        except NotExactError as reason:
            raise NotProvedError(str(reason)) from None
        for one in FIELD.generators:
            if value.holds(one) and one not in known:
                raise NotProvedError(f"{text(one)} neither grows nor is fixed")
        found.append(value)
    return tuple(found)


def _read_side(side: sympy.Expr, where: Where) -> RationalFunction:
    """A side that holds no moments."""
    return read(sympy.Eq(side, side, evaluate=False), (), where)[0]


def order(value: RationalFunction, limit: Limit) -> int:
    """The power with which a function grows; less than any for zero."""
    if value.is_zero():
        return -_NEVER
    return _degree(value.numerator, limit) - _degree(value.denominator, limit)


def leading(value: RationalFunction, limit: Limit) -> RationalFunction:
    """The part of highest order."""
    return _top(value.numerator, limit) / _top(value.denominator, limit)


def even(value: RationalFunction, limit: Limit, dimension: int = 2) -> bool:
    """Whether its order holds at all ratios and φ: what its divisor goes as vanishes nowhere."""
    below = _top(value.denominator, limit).to_sympy().xreplace(_coordinates(limit))
    return never_zero(below, _NAMES, dimension=dimension)


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
