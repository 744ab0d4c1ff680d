"""Whole-number affine expressions in the index symbols, and the region in which they live.

A region is written by lower bounds, each in terms of the symbols before it: ``Region({j: 1,
M: j + 1})`` is j ≥ 1, M ≥ j + 1. In the excess of each symbol over its bound an affine function
is nonnegative on the whole region exactly when its constant and all its coefficients are, so
that inequalities between bounds are decided.
"""

import operator
from collections.abc import Mapping

import sympy

from ..symbols import INDICES
from .exact import FIELD, NotExactError, RationalFunction
from .signs import never_zero

Affine = tuple[int, ...]
"""Coefficients of INDICES, then the constant."""

_POSITION = {symbol: number for number, symbol in enumerate(INDICES)}
_SIZE = len(INDICES) + 1
ZERO: Affine = (0,) * _SIZE
_EXCESS = {symbol: sympy.Dummy(f"{symbol} in excess", nonnegative=True) for symbol in INDICES}
_SIMPLE = {1: operator.add, -1: operator.sub}


def constant(value: int) -> Affine:
    """The constant affine expression."""
    return (*ZERO[:-1], value)


def add(left: Affine, right: Affine, scale: int = 1) -> Affine:
    """Return left + scale·right."""
    if scale in _SIMPLE:
        return tuple(map(_SIMPLE[scale], left, right))
    return tuple(a + scale * b for a, b in zip(left, right, strict=True))


def times(value: Affine, scale: int) -> Affine:
    """Return scale·value."""
    return tuple(scale * a for a in value)


def shifted(value: Affine, by: int) -> Affine:
    """Return value + by."""
    return (*value[:-1], value[-1] + by)


def coefficient(value: Affine, symbol: sympy.Symbol) -> int:
    """Coefficient of an index symbol."""
    return value[_POSITION[symbol]]


def without(value: Affine, symbol: sympy.Symbol) -> Affine:
    """The expression with the term in ``symbol`` left out."""
    place = _POSITION[symbol]
    return (*value[:place], 0, *value[place + 1 :])


def put_in(value: Affine, image: Mapping[sympy.Symbol, Affine]) -> Affine:
    """The expression with others in place of index symbols."""
    found = value
    for symbol in image:
        found = without(found, symbol)
    for symbol, other in image.items():
        found = add(found, other, coefficient(value, symbol))
    return found


def from_sympy(expression: sympy.Expr) -> Affine:
    """Read a whole-number affine SymPy expression.

    Raises:
        NotExactError: when it is not one.
    """
    if isinstance(expression, sympy.Integer):
        return constant(int(expression))
    if expression in _POSITION:
        place = _POSITION[expression]
        return (*ZERO[:place], 1, *ZERO[place + 1 :])
    if isinstance(expression, sympy.Add):
        total = ZERO
        for term in expression.args:
            total = add(total, from_sympy(term))
        return total
    if isinstance(expression, sympy.Mul):
        scale, rest = expression.as_coeff_Mul()
        if isinstance(scale, sympy.Integer) and rest is not expression:
            return times(from_sympy(rest), int(scale))
        # an unevaluated product such as -1·(j − m)
        numbers = [f for f in expression.args if isinstance(f, sympy.Integer)]
        others = [f for f in expression.args if not isinstance(f, sympy.Integer)]
        if len(others) == 1:
            product = 1
            for number in numbers:
                product *= int(number)
            return times(from_sympy(others[0]), product)
    raise NotExactError(f"{expression} is not a whole-number affine function of the indices")


def to_field(value: Affine) -> RationalFunction:
    """The expression as an element of the exact field."""
    total = FIELD.constant(value[-1])
    for symbol, c in zip(INDICES, value, strict=False):
        if c:
            total = total + FIELD.generator(symbol) * FIELD.constant(c)
    return total


def to_sympy(value: Affine) -> sympy.Expr:
    """The expression in SymPy."""
    return sympy.Add(
        value[-1], *(c * symbol for symbol, c in zip(INDICES, value, strict=False) if c)
    )


class Region:
    """Values that the index symbols may take, by lower bounds."""

    def __init__(self, lower_bounds: Mapping[sympy.Symbol, sympy.Expr | int]):
        self.lower_bounds = {
            symbol: sympy.Integer(bound) if isinstance(bound, int) else bound
            for symbol, bound in lower_bounds.items()
        }
        self._bounds = [(s, from_sympy(b)) for s, b in self.lower_bounds.items()]
        self._key = tuple(self.lower_bounds.items())
        self._free = [place for s, place in _POSITION.items() if s not in self.lower_bounds]

    def excess(self, value: Affine) -> Affine:
        """Rewrite in the excesses of the symbols over their bounds."""
        for symbol, bound in reversed(self._bounds):
            c = coefficient(value, symbol)
            if c:
                value = add(value, bound, c)
        return value

    def in_excess(
        self, expression: sympy.Expr
    ) -> tuple[sympy.Expr, tuple[sympy.Symbol, ...], tuple[sympy.Symbol, ...]]:
        """Any expression in the excesses; then what is positive, and what is not negative."""
        image: dict[sympy.Basic, sympy.Expr] = {}
        for symbol, bound in self.lower_bounds.items():
            image[symbol] = bound.xreplace(image) + _EXCESS[symbol]
        return expression.xreplace(image), (), tuple(_EXCESS[symbol] for symbol in image)

    def never_zero(self, expression: sympy.Expr) -> bool:
        """Whether an expression without lattice quantities is shown to vanish nowhere in it."""
        return never_zero(*self.in_excess(expression))

    def within(self, index: sympy.Symbol, low: sympy.Expr, _high: sympy.Expr) -> "Region":
        """The region of a sum's terms, too."""
        return Region({**self.lower_bounds, index: low})

    def nonnegative(self, value: Affine) -> bool:
        """Decide value ≥ 0 everywhere in the region (unbounded symbols must be absent)."""
        in_excess = self.excess(value)
        return min(in_excess) >= 0 and self._bounded(in_excess)

    def _bounded(self, value: Affine) -> bool:
        """Whether it holds only symbols that have a bound."""
        return not any(value[place] for place in self._free)

    def below(self, left: Affine, right: Affine) -> bool:
        """Decide left < right everywhere in the region."""
        return self.nonnegative(shifted(add(right, left, -1), -1))

    def differ(self, left: Affine, right: Affine) -> bool:
        """Decide that left ≠ right everywhere, by one being always the larger."""
        apart = add(left, right, -1)
        if not any(apart[:-1]):
            return apart[-1] != 0
        in_excess = self.excess(apart)
        above, below = min(in_excess) >= 0, max(in_excess) <= 0
        return (above or below) and in_excess[-1] != 0 and self._bounded(in_excess)

    def sample(self, *excesses: int) -> dict[sympy.Symbol, int]:
        """One point: the excess of each symbol over its bound, in order."""
        point: dict[sympy.Symbol, int] = {}
        for (symbol, bound), excess in zip(self._bounds, excesses, strict=True):
            value = bound[-1] + excess
            for other, c in zip(INDICES, bound, strict=False):
                if c:
                    value += c * point[other]
            point[symbol] = value
        return point

    def __len__(self) -> int:
        return len(self._bounds)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Region) and self._key == other._key

    def __hash__(self) -> int:
        return hash(self._key)

    def __str__(self) -> str:
        return ", ".join(f"{symbol} ≥ {bound}" for symbol, bound in self.lower_bounds.items())
