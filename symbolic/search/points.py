"""Integer points of a domain at which to try a statement: generic ones first, then small ones.

A statement may be wrong in one layer, at one height, or where two indices coincide; all small
combinations of layers, heights and counts are tried. Along a layer the packing is the same
everywhere, so that of the places there a few, ever others, are enough.
"""

from collections.abc import Iterable, Iterator
from functools import lru_cache
from itertools import product
from math import prod
from random import Random

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..kernel.where import LATTICE, Where

Point = dict[sympy.Symbol, int]

GENERIC, SMALL, LARGE = 4, 150, 2
"""How many of each kind are tried, at most."""

_MOST = 3000  # combinations of indices that are looked at
_FARTHEST = 12  # of small points, in each index
_TRIES = 400
_ACROSS = (0, 1, -1, 2, -3, 4, -2, 3, 5, -4, 6, -5)


def points(where: Where) -> Iterator[Point]:
    """Yield points of a domain in the order in which they are to be tried."""
    yield from generic(where)
    yield from small(where)


@lru_cache(maxsize=512)
def generic(where: Where) -> tuple[Point, ...]:
    """Points in the middle of a domain, drawn with a fixed seed."""
    return tuple(_first(GENERIC, _drawn(where, 2, 9), ()))


@lru_cache(maxsize=512)
def small(where: Where) -> tuple[Point, ...]:
    """Small points, then a few larger ones."""
    found = _first(SMALL, _smallest(where), generic(where))
    found += _first(LARGE, _drawn(where, 5, 14), (*generic(where), *found))
    return tuple(found)


def _first(count: int, source: Iterable[Point], known: Iterable[Point]) -> list[Point]:
    """The first points that are not known yet, each once."""
    seen = {tuple(at.items()) for at in known}
    found: list[Point] = []
    for at in source:
        key = tuple(at.items())
        if key not in seen:
            seen.add(key)
            found.append(at)
            if len(found) == count:
                break
    return found


class _Domain:
    """The indices of a domain that are free, and a point of it from their values."""

    def __init__(self, where: Where) -> None:
        self.where = where
        free = [one for one in where.indices if one not in where.solved]
        places = [across for across, _ in LATTICE]
        across = [one for one in free if one in places]
        self.along = across[:1]  # one place along a layer is as good as another
        self.others = across[1:] + [one for one in free if one not in places]
        self._even = [affine.from_sympy(one) for one in where.even]
        self._solved = [(one, affine.from_sympy(value)) for one, value in where.solved.items()]
        self._positive = [one for one in where.indices if one.is_positive]
        self._held_anywhere = not any(
            sympy.expand((one.lhs - one.rhs).xreplace(where.solved)).has(*self.along)
            for one in where.relations
        )

    def point(self, values: Iterable[int], along: Iterable[int]) -> Point | None:
        """The point with these values, with the first place along the layers at which it is one."""
        at = dict(zip(self.others, values, strict=True))
        for place in along if self.along else (0,):
            at.update(dict.fromkeys(self.along, place))
            for symbol, value in self._solved:
                at[symbol] = self._sum(value, at)
            if all(at[one] > 0 for one in self._positive) and self.where.holds(at):
                if not any(self._sum(one, at) % 2 for one in self._even):
                    return {symbol: at[symbol] for symbol in self.where.indices}
            elif self._held_anywhere:
                return None
        return None

    @staticmethod
    def _sum(value: affine.Affine, at: Point) -> int:
        terms = zip(sy.INDICES, value, strict=False)
        return value[-1] + sum(c * at[one] for one, c in terms if c)

    def combinations(self) -> list[tuple[int, ...]]:
        """Values of the other indices, small ones first; as large as it leaves them few enough."""
        signed = [not self.where.implies(symbol >= 0) for symbol in self.others]
        for reach in range(_FARTHEST, -1, -1):
            ranges = [range(-reach if sign else 0, reach + 1) for sign in signed]
            if prod(map(len, ranges)) <= _MOST:
                break
        return sorted(product(*ranges), key=lambda values: sum(map(abs, values)))


def _drawn(where: Where, low: int, high: int) -> Iterator[Point]:
    domain, random = _Domain(where), Random(2 * high + low)
    for _ in range(_TRIES):
        values = [random.randint(low, high) for _ in domain.others]
        start = random.randint(-high, high)
        at = domain.point(values, (start, start + 1))
        if at is not None:
            yield at


def _smallest(where: Where) -> Iterator[Point]:
    """Yield each combination at one place along the layers, then all at another, and so on."""
    domain = _Domain(where)
    combinations = domain.combinations()
    for turn in range(len(_ACROSS)):
        held = []
        for count, values in enumerate(combinations):
            start = (turn + count) % len(_ACROSS)
            at = domain.point(values, _ACROSS[start:] + _ACROSS[:start])
            if at is not None:
                held.append(values)
                yield at
        combinations = held
