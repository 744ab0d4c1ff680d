"""Sets of whole numbers: which sites and indices a statement is about. All are made here.

isl does the arithmetic (islpy). It compares sets of different spaces without complaint, so there is
one space here: every index of the paper, the coordinates of a site, and those of a second site.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache, reduce
from typing import Any

import islpy as isl
import sympy
from flint import fmpq_mat

from .algebra.exact import FIELD, SITE, SOURCE, NotExactError, RationalFunction
from .symbols import INDICES, M, N

Set = Any  # islpy's Set, which ships no types
Row = tuple[dict[sympy.Symbol, int], int]
"""A whole-number form: the factor of each symbol, and a constant."""

DIMENSIONS = (*INDICES, *SITE, *SOURCE)
_PLACE = {symbol: place for place, symbol in enumerate(DIMENSIONS)}
_NAMES = [f"x{place}" for place in range(len(DIMENSIONS))]
_SPACE = isl.Space.create_from_names(isl.DEFAULT_CONTEXT, set=_NAMES)
_LOCAL = isl.LocalSpace.from_space(_SPACE)
_DIM = isl.dim_type.set
EVERYTHING: Set = isl.Set.universe(_SPACE)
NOTHING: Set = isl.Set.empty(_SPACE)
_FIXED_FIRST = {
    symbol: place
    for place, symbol in enumerate(
        (*SITE, *SOURCE, *(symbol for symbol in INDICES if symbol not in (M, N)), N, M)
    )
}
"""Which symbol an equation gives, the first that it holds: M and N also stand in denominators."""
LARGEST = 2**62  # isl takes machine integers

_remembered = lru_cache(maxsize=2048)  # one proof looks at the same sets many times


class OpenSumError(NotExactError):
    """A sum over a set has no closed form of this kind, as its bounds have to be rounded."""


@_remembered
def row(form: sympy.Expr) -> Row:
    """A form in indices with whole factors.

    Raises:
        NotExactError: it is not affine, holds another symbol, or a number too large for isl.
    """
    check_written(form)
    factors: dict[sympy.Symbol, int] = {}
    constant = 0
    for term, factor in sympy.expand(form).as_coefficients_dict().items():
        if not isinstance(factor, sympy.Integer) or abs(int(factor)) > LARGEST:
            raise NotExactError(f"{form} does not have whole factors of a usual size")
        if term == 1:
            constant = int(factor)
        elif term in _PLACE:
            factors[term] = int(factor)
        else:
            raise NotExactError(f"{form} is not affine in the indices")
    return factors, constant


@_remembered
def check_written(form: sympy.Expr) -> None:
    """Refuse a form that holds a divisor or a function, even if that cancels.

    Raises:
        NotExactError: it does.
    """
    if form.has(sympy.Function) or not form.is_polynomial(*form.free_symbols):
        raise NotExactError(f"{form} is not affine in the indices")


def constraint(form: Row, equation: bool) -> Any:
    """What isl takes for a form that is 0, or at least 0."""
    make = isl.Constraint.equality_alloc if equation else isl.Constraint.inequality_alloc
    row = make(_LOCAL).set_constant_val(isl.Val(form[1]))
    for symbol, factor in form[0].items():
        row = row.set_coefficient_val(_DIM, _PLACE[symbol], isl.Val(factor))
    return row


@_remembered
def condition(relation: sympy.Basic) -> tuple[Row, bool]:
    """What is at least 0 where a relation holds, and whether it is 0 there.

    Raises:
        NotExactError: it is no affine relation between whole numbers.
    """
    for side in relation.args:
        check_written(side)
    if isinstance(relation, sympy.Eq):
        return row(relation.lhs - relation.rhs), True
    if isinstance(relation, sympy.Ge | sympy.Gt):
        return row(relation.lhs - relation.rhs - int(isinstance(relation, sympy.Gt))), False
    if isinstance(relation, sympy.Le | sympy.Lt):
        return row(relation.rhs - relation.lhs - int(isinstance(relation, sympy.Lt))), False
    raise NotExactError(f"{relation} is not a relation between whole numbers")


@_remembered
def where(*relations: sympy.Basic) -> Set:
    """The points at which all relations between whole numbers hold.

    Raises:
        NotExactError: one of them is not affine.
    """
    basic = isl.BasicSet.universe(_SPACE)
    for relation in relations:
        if relation == sympy.true:
            continue
        if relation == sympy.false:
            return NOTHING
        basic = basic.add_constraint(constraint(*condition(relation)))
    return basic.to_set()


def even(form: sympy.Expr) -> Set:
    """The points at which a form is even."""
    whole = where(sympy.Eq(form - 2 * SOURCE[0], 0, evaluate=False))
    if SOURCE[0] in row(form)[0]:
        raise NotExactError(f"{SOURCE[0]} is not free in {form}")
    return without(whole, SOURCE[0])


def without(points: Set, *symbols: sympy.Symbol) -> Set:
    """The same, whatever some symbols are: their projection."""
    for symbol in symbols:
        points = points.eliminate(_DIM, _PLACE[symbol], 1)
    return points


def at(points: Set, image: Mapping[sympy.Symbol, sympy.Expr]) -> Set:
    """The points that an affine map takes into a set.

    Raises:
        NotExactError: the map is not affine.
    """
    return points.preimage_multi_aff(_map(tuple(image.items())))


@lru_cache(maxsize=1024)
def _map(image: tuple[tuple[sympy.Symbol, sympy.Expr], ...]) -> Any:
    mapping = isl.MultiAff.identity(_SPACE.map_from_set())
    for symbol, value in image:
        mapping = mapping.set_aff(_PLACE[symbol], _affine(row(value)))
    return mapping


def _affine(form: Row) -> Any:
    affine = isl.Aff.zero_on_domain(_LOCAL).set_constant_val(isl.Val(form[1]))
    for symbol, factor in form[0].items():
        affine = affine.set_coefficient_val(isl.dim_type.in_, _PLACE[symbol], isl.Val(factor))
    return affine


# what a set is made of


@_remembered
def parts(points: Set) -> Sequence[Set]:
    """Convex parts of a set, no two of which share a point."""
    convex = (part.to_set() for part in points.make_disjoint().get_basic_sets())
    return tuple(part for part in convex if not part.is_empty())


@_remembered
def rows(part: Set) -> tuple[Sequence[Row], Sequence[Row]]:
    """Forms that are 0, and that are at least 0, on a convex set.

    Raises:
        OpenSumError: the set holds a condition on remainders.
    """
    (basic,) = part.get_basic_sets()
    equations: list[Row] = []
    bounds: list[Row] = []
    for relation, form in _forms(basic):
        if form is None:
            raise OpenSumError("it depends on a remainder, such as whether a number is even")
        (equations if relation.is_equality() else bounds).append(form)
    return tuple(equations), tuple(bounds)


def _forms(part: Any) -> Iterator[tuple[Any, Row | None]]:
    """The constraints of a convex set, each with its form; None where it holds a remainder."""
    places = [(symbol, n) for symbol, n in _PLACE.items() if part.involves_dims(_DIM, n, 1)]
    for relation in part.get_constraints():
        if relation.involves_dims(isl.dim_type.div, 0, relation.dim(isl.dim_type.div)):
            yield relation, None
            continue
        involved = (pair for pair in places if relation.involves_dims(_DIM, pair[1], 1))
        factors = {s: _number(relation.get_coefficient_val(_DIM, n)) for s, n in involved}
        yield relation, (factors, _number(relation.get_constant_val()))


def _number(value: Any) -> int:
    """A whole number of isl's; of one beyond 64 bits it says 0, but writes it out."""
    return value.get_num_si() or value.to_python()  # type: ignore[no-any-return]


def depends_on(points: Set, symbol: sympy.Symbol) -> bool:
    """Whether conditions on a symbol say what is in a set."""
    return bool(points.involves_dims(_DIM, _PLACE[symbol], 1))


Condition = tuple[tuple[tuple[int, int], ...], int]
"""A form that is at least 0, by the places of its symbols."""


def _conditions(part: Set) -> Iterator[Condition]:
    """What holds on a convex set, and nowhere else."""
    equations, bounds = rows(part)
    for factors, constant in (*equations, *bounds):
        yield tuple((_PLACE[symbol], factor) for symbol, factor in factors.items()), constant
    for factors, constant in equations:
        yield tuple((_PLACE[symbol], -factor) for symbol, factor in factors.items()), -constant


@_remembered
def _negated(condition: Condition) -> Condition:
    return tuple((place, -factor) for place, factor in condition[0]), -condition[1] - 1


@_remembered
def _half(condition: Condition) -> Set:
    """The points at which a condition holds."""
    factors = {DIMENSIONS[place]: factor for place, factor in condition[0]}
    return EVERYTHING.add_constraint(constraint((factors, condition[1]), False))


Cell = tuple[Set, Sequence[int]]
"""A convex set, and the numbers of the sets that it lies in."""


@_remembered
def arrangement(parts: tuple[Set, ...]) -> Sequence[Cell]:
    """Convex cells, each in all of some sets and outside of the others: it, and which sets.

    Space is halved by the conditions of the sets, the most frequent one first, until none is left
    that parts a cell. What is outside of all sets is left out.
    """

    def halved(cell: Set, left: list[tuple[int, list[Condition]]]) -> Iterator[Cell]:
        frequency = Counter(condition for _, conditions in left for condition in conditions)
        parting = [condition for condition, _ in frequency.most_common()]
        while parting and cell.is_disjoint(_half(_negated(parting[0]))):
            del parting[0]  # it holds on all of the cell
        if not parting:
            yield cell, [number for number, _ in left]
        elif len(left) == 1:
            yield cell & parts[left[0][0]], [left[0][0]]
        else:
            cut, others = parting[0], {*parting[1:]}
            for side in (cut, _negated(cut)):
                there, shared = cell & _half(side), []
                for number, conditions in left:
                    on_side = side == cut if cut in conditions else not conditions
                    if on_side or (cut not in conditions and not there.is_disjoint(parts[number])):
                        shared.append((number, [each for each in conditions if each in others]))
                if shared:
                    yield from halved(there, shared)

    conditions = [(n, [*_conditions(part)]) for n, part in enumerate(parts)]
    return tuple(halved(EVERYTHING, conditions)) if parts else ()


def least(symbol: sympy.Symbol, points: Set) -> int | None:
    """The least value of a symbol on a set that is not empty; None where there is none."""
    value = points.min_val(_affine(({symbol: 1}, 0)))
    return value.to_python() if value.is_int() else None


@_remembered
def equations(points: Set) -> Sequence[Row]:
    """Forms that are 0 on all of a set; remainders are left out."""
    forms = _forms(points.affine_hull())
    return tuple(form for relation, form in forms if form is not None and relation.is_equality())


@_remembered
def fixed(
    points: Set, first: tuple[sympy.Symbol, ...] = ()
) -> Mapping[sympy.Symbol, RationalFunction]:
    """Symbols that the equations of a set fix, by those that they leave free.

    A polynomial in what is left that is zero on all of the set is zero, unless the set is finite in
    some direction.

    Args:
        points: the set.
        first: which symbols are fixed, rather than others.
    """
    forms = equations(points)
    rank = _FIXED_FIRST | {symbol: place - len(first) for place, symbol in enumerate(first)}
    symbols = sorted({s for factors, _ in forms for s in factors}, key=rank.__getitem__)
    if not symbols:
        return {}
    table = [[*(factors.get(s, 0) for s in symbols), constant] for factors, constant in forms]
    solved: dict[sympy.Symbol, RationalFunction] = {}
    for numbers in fmpq_mat(table).rref()[0].tolist():
        others = {s: -n for s, n in zip(symbols, numbers, strict=False) if n}
        if others:
            pivot = next(iter(others))
            del others[pivot]
            solved[pivot] = polynomial((others, -numbers[-1]))
    return solved


def polynomial(form: tuple[Mapping[sympy.Symbol, Any], Any]) -> RationalFunction:
    """A form as an element of the field."""
    terms = (FIELD.generator(symbol).numerator * factor for symbol, factor in form[0].items())
    return FIELD.polynomial(sum(terms, FIELD.context.constant(form[1])))


Range = tuple[Set, RationalFunction, RationalFunction]
"""Where a symbol takes every whole value between two bounds, and these."""


def ranges(points: Set, symbol: sympy.Symbol) -> Iterator[Range]:
    """For what other values a symbol runs between which bounds, each point once.

    Raises:
        OpenSumError: it does not take every whole value between bounds, or has none.
    """
    for part in parts(points):
        equations, inequalities = rows(part)
        shadow = without(part, symbol)
        equation = next((form for form in equations if symbol in form[0]), None)
        if equation is not None:
            value = _bound(equation, symbol, 0)
            yield shadow, value, value
            continue
        lows, highs = (list(_bounds(part, shadow, inequalities, symbol, sign)) for sign in (1, -1))
        for there, low in lows:
            for here, high in highs:
                if not there.is_disjoint(here):
                    yield there & here, low, high


def given(part: Set, symbol: sympy.Symbol) -> RationalFunction | None:
    """What a convex set says that a symbol is, by the others; None if the symbol does not matter.

    Raises:
        OpenSumError: the symbol matters, and is not given by the others.
    """
    equation = next((form for form in rows(part)[0] if symbol in form[0]), None)
    if equation is not None:
        return _bound(equation, symbol, 0)
    if not without(part, symbol).is_subset(part):
        raise OpenSumError(f"{symbol} is not given by the others")
    return None


def _bound(form: Row, symbol: sympy.Symbol, rest: int) -> RationalFunction:
    """What a symbol is where a form that holds it is ``rest``."""
    factors = {s: n for s, n in form[0].items() if s != symbol}
    return polynomial((factors, form[1] - rest)) / FIELD.constant(-form[0][symbol])


def _bounds(
    part: Set, shadow: Set, forms: Iterable[Row], symbol: sympy.Symbol, sign: int
) -> Iterator[tuple[Set, RationalFunction]]:
    """The least (sign 1) or largest (−1) values of a symbol, and where each of them is that.

    At the least value some form c·symbol + …, c > 0, is less than c: for each of these remainders,
    where it is reached, the value is known.
    """
    for form in forms:
        for rest in range(sign * form[0].get(symbol, 0)):
            reached = part.add_constraint(constraint((form[0], form[1] - rest), True))
            there = without(reached, symbol) & shadow
            if not there.is_empty():
                yield there, _bound(form, symbol, rest)
                shadow = shadow - there
                if shadow.is_empty():
                    return
    raise OpenSumError(f"{symbol} has no bound")


# points


@_remembered
def sample(points: Set) -> Mapping[sympy.Symbol, int]:
    """A point of a set that is not empty."""
    point = points.sample_point()
    return {
        symbol: point.get_coordinate_val(_DIM, place).to_python()
        for symbol, place in _PLACE.items()
    }


def union(pieces: Iterable[Set]) -> Set:
    """The points of any of several sets."""
    return reduce(isl.Set.union, pieces, NOTHING)
