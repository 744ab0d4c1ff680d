"""What holds as indices grow together: the same leading order, or the same but for a factor.

Orders count all growing indices together, at fixed ratios. They hold uniformly while the ratios and
φ stay within closed parts of their ranges, as the leading parts of all divisors vanish nowhere.
"""

from collections.abc import Iterable, Sequence
from functools import lru_cache

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.exact import (
    FIELD,
    LAYER,
    NotExactError,
    Polynomial,
    RationalFunction,
)
from ..algebra.linear_forms import LinearForm
from ..algebra.reading import Reader
from ..algebra.signs import never_zero
from ..algebra.weights import Pieces
from ..as_printed import equation
from ..notation import by_name
from ..printing.text import text
from .moments import in_the_radii, pieces, value, without_moments
from .rules import Rule
from .theorem import (
    FORCES,
    Facts,
    NotProvedError,
    Theorem,
    check,
    flat,
    made,
)
from .where import Limit, Where

_NEVER = 10**9  # no order is as large
FIXED = {*sy.PARAMETERS} - {sy.epsilon, sy.z}
"""What stays as it is in every limit."""


def asymptotic(*facts: Theorem | tuple[Theorem, ...], late: Iterable[sympy.Basic] = ()) -> Rule:
    """Both sides are of the same leading order: left over right goes to 1.

    Facts are put in and moments worked out at finite size. What the right-hand side goes as
    vanishes nowhere, and the difference is of a lower order.

    Args:
        facts: are put in one after the other, those of a tuple at once.
        late: relations that hold for all but the first of what grows; moments are worked out there.
    """

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "∼")
        part = where.also(*late)
        limit_of(formula, part, "∼")
        left, right = read(formula, facts, where, part)
        low, high = order(left - right, limit), order(right, limit)
        if not low <= high - limit.orders:
            raise NotProvedError(
                f"left less right is of order {low}, the right-hand side of order {high}"
            )
        least = where.at_least
        if not even(FIELD.one / right, limit, least):
            raise NotProvedError("what the right-hand side goes as is not shown to vanish nowhere")
        if not even(left - right, limit, least):
            raise NotProvedError("the order of what is left is not shown to hold everywhere")
        return made(formula, where, "leading order", flat(facts))

    return rule


def bounded(*facts: Theorem | tuple[Theorem, ...]) -> Rule:
    """The weight of each radius, or its share in the variance, is of the order on the right."""

    def rule(formula: sympy.Eq, where: Where) -> Theorem:
        limit = limit_of(formula, where, "O")
        most, bound = formula.args
        if not isinstance(most, sy.LargestShare | sy.LargestWeight):
            raise NotProvedError(f"{text(most)} is no largest share, or weight, of a radius")
        finite = where.in_the_limit(None)
        parts = pieces(in_the_radii(_at_height(most.args[0], where), facts, finite), finite)
        square = read(equation(bound, bound), facts, where)[0]
        whole = parts.sum_of_squares() * square if isinstance(most, sy.LargestShare) else square**2
        _grows_as(whole, limit)
        if any(2 * one > order(whole, limit) for one in _orders(parts, limit)):
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
        finite = where.in_the_limit(None)
        force, factor = _one_force(formula, where)
        varies = value(sy.Variance(force), facts, finite) * factor**2
        _grows_as(varies, limit)
        rest = _difference(formula, facts, where)
        squares = pieces(rest, finite).sum_of_squares() * FIELD.generator(sy.sigma) ** 2
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
        finite = where.in_the_limit(None)
        alone = in_the_radii(_at_height(formula.lhs, where), facts, finite)
        large = [full for full, _ in pieces(alone, finite).special.values() if not full.is_zero()]
        sure = [one for one in large if even(one, limit) and even(FIELD.one / one, limit)]
        most = max((order(_fixed_but(one, limit), limit) for one in sure), default=-_NEVER)
        rest = pieces(_difference(formula, facts, where), finite)
        if not sure or any(one >= most for one in _orders(rest, limit)):
            raise NotProvedError("left less right has weights of the order of the largest of left")
        return made(formula, where, "heaviest weights", flat(facts))

    return rule


def _one_force(formula: sympy.Eq, where: Where) -> tuple[sympy.Expr, RationalFunction]:
    """The force that a statement is about, and its factor.

    Raises:
        NotProvedError: there is not one, or it has no factor.
    """
    reader = Reader(where.in_the_limit(None))
    try:
        left, right = (reader.scalar(_at_height(side, where)) for side in formula.args)
    except NotExactError as reason:
        raise NotProvedError(str(reason)) from None
    form, kinds = left - right, {one.__name__: one for one in FORCES}
    found = [(site, weight) for site, weight in form.sites.items() if site.family in kinds]
    if len(found) != 1:
        raise NotProvedError("it is not about one contact force")
    ((site, factor),) = found
    return kinds[site.family](*map(affine.to_sympy, (site.i, site.j))), factor.reduced()


def _difference(formula: sympy.Eq, facts: Facts, where: Where) -> LinearForm:
    """Left less right in the radii; their means agree."""
    finite = where.in_the_limit(None)
    left, right = (in_the_radii(_at_height(side, where), facts, finite) for side in formula.args)
    rest = left - right
    if not rest.at_zero.is_zero():
        raise NotProvedError(f"the means differ by {text(rest.at_zero.to_sympy())}")
    return rest


def _at_height(side: sympy.Expr, where: Where) -> sympy.Expr:
    """A side with z = j/M, and with what equations of the domain fix."""
    height = {sy.z: (sy.j / sy.M).xreplace(where.solved)}
    return side.xreplace(where.solved).xreplace(height)


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


def _orders(parts: Pieces, limit: Limit) -> list[int]:
    """The orders of all weights; of those along a diagonal, the highest in any layer."""
    weights = [run.weight for run in parts.runs] + [full for full, _ in parts.special.values()]
    if not all(even(_fixed_but(one, limit), limit) for one in weights):
        raise NotProvedError("the order of a weight is not shown to hold everywhere")
    return [_order_over_layers(one, limit) for one in weights]


def _order_over_layers(weight: RationalFunction, limit: Limit) -> int:
    """The order of a weight in any layer of its diagonal: a layer is at most of the order of M."""
    if weight.is_zero():
        return order(weight, limit)
    if weight.denominator.degrees()[FIELD.position[LAYER]] > 0:
        raise NotProvedError("a weight is divided by what depends on the layer")
    return max(_degrees(weight.numerator, (*limit.growing, LAYER))) - _degree(
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


def read(
    formula: sympy.Eq, facts: Facts, where: Where, part: Where | None = None
) -> tuple[RationalFunction, ...]:
    """Both sides as functions of what grows and of parameters, moments worked out at finite size.

    Facts are put in on the whole domain, and moments worked out on a part of it.

    Raises:
        NotProvedError: they hold something else, or are none.
    """
    limit = where.limit
    assert limit is not None
    finite = without_moments(formula, facts, *(
        one.in_the_limit(None) for one in (where, part or where)
    ))  # fmt: skip
    sides = [_at_height(side, where) for side in finite.args]
    known = {*FIXED, *limit.growing} | ({sy.d} if where.dimension == sy.d else set())
    if strange := by_name(set().union(*(side.free_symbols for side in sides)) - known):
        raise NotProvedError(f"{text(strange[0])} neither grows nor is fixed")
    try:
        return tuple(FIELD.from_sympy(side).reduced() for side in sides)
    except NotExactError as reason:
        raise NotProvedError(str(reason)) from None


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
