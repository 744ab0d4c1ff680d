"""A plain evaluator of the paper's expressions at explicit values.

Numbers are dual, vectors Cartesian, sums are loops, of braces the one case that holds is looked at.
Nothing is rearranged first, and nothing is shared with normal forms but SymPy's tree.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

import sympy

from .. import symbols as sy
from ..printing.text import text
from .dual import (
    NOWHERE,
    ZERO,
    Dual,
    Number,
    Vector,
)
from .packing import AbsentError, Packing

HIGHEST_POWER = 64
MOST_TERMS = 1000
"""Of one sum."""

A_BEAD = 20
"""Laying or balancing a bead takes as long as so many reads."""


@dataclass
class Budget:
    """How many expressions may still be read, a bead or a long number counting as several."""

    left: float = float("inf")


class WithoutValue(str):
    """Words for values at which a statement has no value, so that none can be compared there."""

    __slots__ = ()


class UnreadableError(ValueError):
    """The expression is not of the paper's language, or takes too long to be evaluated."""


class NoValueError(ArithmeticError):
    """It divides by what is 0 without disorder, and so has no value to first order."""


class NoSumError(ArithmeticError):
    """A sum whose upper bound is below the lower one by more than one has no agreed value."""


class NotWholeError(NoSumError):
    """Neither has one with a bound that is no whole number."""


class Evaluator:
    """Values of expressions on one packing.

    Args:
        packing: what site functions are taken from.
        numbers: values of symbols, whole ones for indices.
        budget: expressions that may be read; shared by all that one statement asks for.
    """

    def __init__(
        self,
        packing: Packing,
        numbers: Mapping[sympy.Symbol, Number],
        budget: Budget | None = None,
    ) -> None:
        self.packing = packing
        self.numbers: dict[sympy.Symbol, Number] = dict(numbers)
        self.budget = budget or Budget()
        x, y = packing.geometry.n
        across, up = Fraction(1, 2 * x), Fraction(1, 2 * y)
        self._vectors = {
            sy.n_plus: Vector(Dual(x), Dual(y)),
            sy.n_minus: Vector(Dual(-x), Dual(y)),
            sy.b_plus: Vector(Dual(across), Dual(up)),
            sy.b_minus: Vector(Dual(-across), Dual(up)),
            sy.e_y: Vector(ZERO, Dual(1)),
        }

    def value(self, node: sympy.Basic) -> Dual | Vector:
        """Value of an expression.

        Raises:
            UnreadableError: it is not of the language, or it takes too long.
            TooLargeError: so does a number or a packing.
            NoValueError: it divides by zero.
            NoSumError: it holds a sum without an agreed value.
            AbsentError: it speaks of a bead or a contact that is not there.
        """
        self._spend(1)
        if isinstance(node, sympy.Rational):
            return Dual(int(node) if node.q == 1 else Fraction(int(node.p), int(node.q)))
        if isinstance(node, sympy.Symbol):
            return self._symbol(node)
        if isinstance(node, sympy.Add):
            return self._total([self.value(term) for term in node.args])
        if isinstance(node, sympy.Mul):
            return self._product([self.value(factor) for factor in node.args])
        if isinstance(node, sympy.Pow):
            return self._power(node)
        if isinstance(node, sy.SiteFunction):
            across, layer = map(self._index, node.args)
            known = self.packing.beads()
            found = self.packing.quantity(type(node).__name__, across, layer)
            self._spend(A_BEAD * (self.packing.beads() - known))
            return found
        if isinstance(node, sy.Dot):
            u, v = map(self._vector, node.args)
            return u.dot(v)
        if isinstance(node, sympy.Sum):
            return self._sum(node)
        if isinstance(node, sy.Braces):
            first, second, index, last = node.args
            return self.value(first if self._plain(index) <= self._plain(last) else second)
        if isinstance(node, sy.MatrixTimes):
            a, b, c, d = map(self._number, node.args[:4])
            v = self._vector(node.args[4])
            return Vector(a * v.x + b * v.y, c * v.x + d * v.y)
        raise UnreadableError(f"{type(node).__name__} is not evaluated")

    def _spend(self, reads: int) -> None:
        self.budget.left -= reads
        if self.budget.left < 0:
            raise UnreadableError("it takes too long")

    def whole(self, node: sympy.Basic) -> int:
        """Value of a whole number."""
        value = self._plain(node)
        if value.denominator != 1:
            raise NotWholeError(f"{value} is no whole number")
        return int(value)

    def _index(self, node: sympy.Basic) -> int:
        try:
            return self.whole(node)
        except NotWholeError as reason:
            raise AbsentError(f"there is no such bead: {reason}") from None

    def _symbol(self, symbol: sympy.Symbol) -> Dual | Vector:
        if symbol in self.numbers:
            return Dual(self.numbers[symbol])
        if symbol in self._vectors:
            return self._vectors[symbol]
        raise UnreadableError(f"no value is known for {symbol.name}")

    def _number(self, node: sympy.Basic) -> Dual:
        value = self.value(node)
        if isinstance(value, Vector):
            raise UnreadableError("a vector where a number is needed")
        return value

    def _vector(self, node: sympy.Basic) -> Vector:
        value = self.value(node)
        if isinstance(value, Vector):
            return value
        if value:
            raise UnreadableError("a number where a vector is needed")
        return NOWHERE

    def _plain(self, node: sympy.Basic) -> Number:
        """Value of what does not depend on the disorder; sums of indices, the usual case, first."""
        if isinstance(node, sympy.Integer):
            return int(node)
        if isinstance(node, sympy.Symbol) and node in self.numbers:
            return self.numbers[node]
        if isinstance(node, sympy.Add):
            self._spend(1)
            return sum(map(self._plain, node.args))
        value = self._number(node)
        if value.slope:
            raise UnreadableError("a bound or an index depends on the disorder")
        return value.value

    def _power(self, node: sympy.Pow) -> Dual:
        base, exponent = self._number(node.base), self._plain(node.exp)
        if exponent.denominator != 1 or not -HIGHEST_POWER <= exponent <= HIGHEST_POWER:
            raise UnreadableError(f"the power {exponent} is not evaluated")
        if exponent < 0 and not base.value:
            which = "which is 0 without disorder" if base else "which is 0"
            raise NoValueError(f"it divides by {_brief(node.base)}, {which}")
        return base ** int(exponent)

    def _sum(self, series: sympy.Sum) -> Dual | Vector:
        """The last limit is the outermost."""
        return self._limits(series.function, list(series.limits))

    def _limits(self, body: sympy.Basic, limits: list[sympy.Tuple]) -> Dual | Vector:
        if not limits:
            return self.value(body)
        *inner, (index, low, high) = limits
        first, last = self.whole(low), self.whole(high)
        if last < first - 1:
            raise NoSumError(f"a sum from {first} to {last} has no agreed value")
        if last - first >= MOST_TERMS:
            raise UnreadableError(f"a sum of more than {MOST_TERMS} terms")
        outside = self.numbers.get(index)
        parts = []
        try:
            for value in range(first, last + 1):
                self.numbers[index] = value
                parts.append(self._limits(body, inner))
        finally:
            if outside is None:
                self.numbers.pop(index, None)
            else:
                self.numbers[index] = outside
        return self._total(parts)

    def _total(self, parts: list[Dual | Vector]) -> Dual | Vector:
        total, vector = ZERO, None
        for part in parts:
            if isinstance(part, Dual):
                total = self._paid(total + part)
            else:
                vector = part if vector is None else vector + part
                self._paid(vector.x), self._paid(vector.y)
        if vector is None:
            return total
        if total:
            raise UnreadableError("a number is added to a vector")
        return vector

    def _product(self, parts: list[Dual | Vector]) -> Dual | Vector:
        scale, vector = Dual(1), None
        for part in parts:
            if isinstance(part, Dual):
                scale = self._paid(scale * part)
            elif vector is None:
                vector = part
            else:
                raise UnreadableError("a product of two vectors")
        return scale if vector is None else vector.times(scale)

    def _paid(self, number: Dual) -> Dual:
        """Long numbers take as long as many reads."""
        if thousands := number.thousands_of_bits():
            self._spend(thousands**2)
        return number


def _brief(node: sympy.Basic) -> str:
    shown = text(node)
    return shown if len(shown) <= 64 else f"{shown[:62]} …"
