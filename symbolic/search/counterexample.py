"""Explicit values at which a statement is false, drawn for all that it leaves free."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, lru_cache
from itertools import islice, product

import sympy

from .. import symbols as sy
from ..kernel.where import LATTICE, Loading, Where
from ..printing.text import text
from . import limits
from .dual import (
    NOWHERE,
    Dual,
    Number,
    TooLargeError,
    Vector,
)
from .packing import (
    AbsentError,
    BelowError,
    Geometry,
    Given,
    Packing,
    given,
)
from .points import Point, points
from .values import (
    Budget,
    Evaluator,
    NoSumError,
    NoValueError,
    UnreadableError,
    WithoutValue,
)

READS = 300_000
"""Expressions that are read of one statement at most; Eq. 11, its packings new, takes a quarter."""

_MOST_NODES = 5000
_PLANE = 2


@dataclass(frozen=True)
class World:
    """Values of the continuous symbols, n_x and n_y being rational."""

    n: tuple[Fraction, Fraction]
    radius: Fraction
    numbers: tuple[Fraction, ...]
    neighbours: int

    @property
    def geometry(self) -> Geometry:
        """The packing of these contacts and this radius."""
        return _geometry(self)

    def given(self, name: str | None, place: tuple[int, ...]) -> Given:
        """What the loading of a name says at its place, in these loads."""
        (x, y), (f_load, m_g, *_, plus, minus) = self.n, self.numbers
        tilted = Vector(Dual((minus - plus) * x), Dual(-(plus + minus) * y))
        return given(name, place, f_load, m_g, tilted)

    def values(self) -> dict[sympy.Symbol, Number]:
        """Value of each continuous symbol."""
        x, y = self.n
        f_load, m_g, sigma, epsilon, z, plus, minus = self.numbers
        return {
            sy.n_x: x,
            sy.n_y: y,
            sy.phi: y * y - x * x,
            sy.r: self.radius,
            sy.spacing: 4 * self.radius * x,
            sy.sigma: sigma,
            sy.epsilon: epsilon,
            sy.f_load: f_load,
            sy.m_g: m_g,
            sy.z: z,
            sy.L_plus: plus,
            sy.L_minus: minus,
            sy.t: minus / plus,
            sy.N: self.neighbours,
        }


def _world(n: tuple[int, int, int], radius: str, numbers: str, neighbours: int) -> World:
    x, y, length = n
    fractions = tuple(map(Fraction, numbers.split()))
    direction = (Fraction(x, length), Fraction(y, length))
    return World(direction, Fraction(radius), fractions, neighbours)


# n_x : n_y : 1, r, then f_load, mg, σ, ε, z, L⁺, L⁻, then N
WORLDS = (
    _world((4, 3, 5), "7/3", "11/7 13/5 3/11 2/13 5/17 19/6 23/10", 3),
    _world((3, 4, 5), "5/11", "17/9 7/11 5/7 -3/7 9/13 6/23 14/19", 2),
    _world((21, 20, 29), "13/8", "3/13 29/4 8/3 7/9 2/11 25/7 31/8", 5),
    _world((33, 56, 65), "4/9", "23/3 5/19 11/6 -4/5 13/16 8/15 3/29", 1),
)


@cache
def _geometry(world: World) -> Geometry:
    return Geometry(world.n, world.radius)


@lru_cache(maxsize=512)
def _packing(world: World, name: str | None, place: tuple[int, ...]) -> Packing:
    return Packing(world.geometry, world.given(name, place))


def counterexample(
    statement: sympy.Eq,
    where: Where,
    *,
    at_most: int | None = None,
    force: sympy.Eq | None = None,
) -> str | None:
    """Words for values at which a statement is false; None where none is found.

    Where it has no value at all they are ``WithoutValue``.

    All points of ``points`` are tried, or ``at_most`` so many of them. Points at which it speaks of
    a bead below the base say nothing, unless all do. A statement in a limit is looked at where the
    indices are large; its moments have to be worked out before, and ``force`` says what the force
    is that it is about. Moments are not evaluated: the kernel works them out.

    What can't be evaluated is not refuted: unknown symbols, floats and roots, a number beside a
    vector, a sum whose upper bound is below its lower one by more than one, what is too large.
    """
    try:
        if where.dimension != _PLANE:
            return None
        if where.limit:
            return limits.counterexample(statement, where, force)
        return _search(statement, where, at_most)
    except Exception:  # whatever the tree, also one that is too deep for Python: nothing is found
        return None


def _search(statement: sympy.Eq, where: Where, at_most: int | None = None) -> str | None:
    if not isinstance(statement, sympy.Eq):
        return None
    free = _free_symbols(statement)
    budget, below, compared = Budget(READS), None, False
    for at, world in islice(_drawn(_with_all_indices(where, free)), at_most):
        values = _values(at, world)
        try:
            found = _at(statement, where.loading, world, values, budget)
        except (NoSumError, TooLargeError):
            continue
        except BelowError as reason:
            below = below or (at, values, WithoutValue(reason))
            continue
        compared = True
        if found:
            return _words(at, values, free, found)
    return _words(below[0], below[1], free, below[2]) if below and not compared else None


def _words(
    at: Point, values: Mapping[sympy.Symbol, Number], free: set[sympy.Symbol], found: str
) -> str:
    named = [one for one in values if one in at or one in free or one == sy.phi]
    shown = (f"{text(one)} = {_exact(values[one])}" for one in named)
    words = f"at {', '.join(shown)}: {found}"
    return WithoutValue(words) if isinstance(found, WithoutValue) else words


def _drawn(where: Where) -> Iterator[tuple[Point, World]]:
    """Points of a domain, each with values of the continuous symbols; few points with all."""
    tried = 0
    for tried, at in enumerate(points(where), start=1):
        yield at, WORLDS[(tried - 1) % len(WORLDS)]
    if tried < len(WORLDS):
        for at, world in product(points(where), WORLDS[tried:]):
            yield at, world


def _values(at: Point, world: World) -> dict[sympy.Symbol, Number]:
    """Values of indices, then of continuous symbols; z = j/M where both are indices."""
    values = {**at, **world.values(), **at}  # N is one of both: an index first
    if sy.j in at and at.get(sy.M):
        values[sy.z] = Fraction(at[sy.j], at[sy.M])
    return values


def _at(
    statement: sympy.Eq,
    loading: Loading | None,
    world: World,
    values: Mapping[sympy.Symbol, Number],
    budget: Budget,
) -> str | None:
    """What is wrong with a statement at explicit values, in words."""
    evaluator = Evaluator(_packing(world, None, ()), values, budget)
    if loading:
        place = tuple(map(evaluator.whole, loading.place))
        evaluator.packing = _packing(world, loading.name, place)
    try:
        left, right = map(evaluator.value, statement.args)
    except BelowError:
        raise
    except (AbsentError, NoValueError) as reason:
        return WithoutValue(reason)
    left, right = _beside(left, right), _beside(right, left)
    if isinstance(left, Vector) != isinstance(right, Vector):
        raise UnreadableError("a number is set equal to a vector")
    return None if left == right else _unequal(left, right)


def _beside(side: Dual | Vector, other: Dual | Vector) -> Dual | Vector:
    """The number 0 beside a vector is the vector 0."""
    return NOWHERE if isinstance(other, Vector) and isinstance(side, Dual) and not side else side


def _free_symbols(statement: sympy.Basic) -> set[sympy.Symbol]:
    """Symbols that are not summed over. Parts that a statement holds twice are read once.

    Raises:
        UnreadableError: it is too large.
    """
    known: dict[int, set[sympy.Symbol]] = {}

    def free(node: sympy.Basic) -> set[sympy.Symbol]:
        found = known.get(id(node))
        if found is None:
            if len(known) > _MOST_NODES:
                raise UnreadableError("it is too large")
            if isinstance(node, sympy.Symbol):
                found = {node}
            elif isinstance(node, sympy.Sum):
                found = free(node.function)
                for index, *bounds in node.limits:
                    found = (found - {index}).union(*map(free, bounds))
            else:
                found = set().union(*map(free, node.args))
            known[id(node)] = found
        return found

    return free(statement)


def _with_all_indices(where: Where, free: set[sympy.Symbol]) -> Where:
    """The domain, and of further indices of the statement all that can be one."""
    more = [one for one in sy.INDICES if one in free and one not in where.indices]
    if not more:
        return where
    beads = [bead for bead in LATTICE if set(bead) & set(more)]
    layers = [layer >= 0 for _, layer in beads if layer in more]
    return where.also(*layers, indices=[*more, *(one for bead in beads for one in bead)])


def _unequal(left: Dual | Vector, right: Dual | Vector) -> str:
    shown = [_shown(side) for side in (left, right)]
    if any("." in words for words in shown):  # both, or they can't be compared at a glance
        shown = [_shown(side, fractions=False) for side in (left, right)]
    words = f"{shown[0]} on the left and {shown[1]} on the right"
    return (
        words if shown[0] != shown[1] else f"{words}, apart by {_shown(_difference(left, right))}"
    )


def _difference(left: Dual | Vector, right: Dual | Vector) -> Dual | Vector:
    if isinstance(left, Vector) and isinstance(right, Vector):
        return left - right
    assert isinstance(left, Dual)
    assert isinstance(right, Dual)
    return left - right


def _shown(value: Dual | Vector, *, fractions: bool = True) -> str:
    if isinstance(value, Vector):
        parts = (_shown(one, fractions=fractions) for one in (value.x, value.y))
        return f"({', '.join(parts)})"

    def number(exact: Number) -> str:
        if fractions or exact.denominator == 1:
            return _exact(exact)
        return f"{float(exact):.6g}".replace("-", "−")

    if not value.slope:
        return number(value.value)
    size = number(-value.slope if value.slope < 0 else value.slope)
    part = f"{'' if size == '1' else f'({size})' if '/' in size else size}ε"
    sign = "−" if value.slope < 0 else "+"
    if value.value:
        return f"{number(value.value)} {sign} {part}"
    return f"−{part}" if value.slope < 0 else part


def _exact(number: Number) -> str:
    """A number as a fraction; a long one in decimals."""
    shown = str(number)
    return (shown if len(shown) <= 14 else f"{float(number):.6g}").replace("-", "−")
