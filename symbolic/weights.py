"""Weights on sites: what is linear in the deviations of the radii, as polynomials on integer sets.

A form Σ w(x) δr_x is its function w of the sites x, and of the indices i, j, M, … that it is
written in. Such a function is a sum of pieces: a set of sites and indices, and a polynomial that
counts there. Sums and products of forms are sums and products of pieces, cases split and join by
themselves, and two forms are the same where no piece of their difference is left.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import sympy
from flint import fmpq

from . import sets
from .algebra.exact import FIELD, NotExactError, RationalFunction, sum_over
from .sets import Set
from .shortest import joined
from .symbols import H_M, M, n_x, n_y, phi

Fixed = Mapping[sympy.Symbol, RationalFunction]

Piece = tuple[Set, RationalFunction]

_NUMBERS: dict[sympy.Expr, Any] = {
    symbol: fmpq(101 + 7 * number) for number, symbol in enumerate(FIELD.generators)
}
_NUMBERS |= {n_x: fmpq(3, 5), n_y: fmpq(4, 5), phi: fmpq(7, 25)}
"""Numbers for symbols, no two of them alike; those of φ, n_x and n_y belong together."""


@dataclass(frozen=True)
class Weights:
    """A sum of pieces; they may share points."""

    pieces: tuple[Piece, ...] = ()

    @classmethod
    def of(cls, *relations: sympy.Basic, value: RationalFunction = FIELD.one) -> "Weights":
        """A value where all of some relations hold, and 0 elsewhere."""
        return cls(((sets.where(*relations), value),))

    def __add__(self, other: "Weights") -> "Weights":
        summed: dict[Set, RationalFunction] = {}
        for points, value in (*self.pieces, *other.pieces):
            summed[points] = summed[points] + value if points in summed else value
        return Weights(tuple(piece for piece in summed.items() if not piece[1].is_zero()))

    def __sub__(self, other: "Weights") -> "Weights":
        return self + other.scaled(FIELD.constant(-1))

    def scaled(self, factor: RationalFunction) -> "Weights":
        """The same, times a factor."""
        if factor.is_zero():
            return Weights()
        return Weights(tuple((points, value * factor) for points, value in self.pieces))

    def mapped(self, change: Callable[[RationalFunction], RationalFunction]) -> "Weights":
        """The same with its values changed."""
        return Weights(tuple((points, change(value)) for points, value in self.pieces))

    def times(self, other: "Weights") -> "Weights":
        """The product at each point."""
        for first, rest in ((self, other), (other, self)):
            if len(first.pieces) == 1 and first.pieces[0][0] is sets.EVERYTHING:
                return rest.scaled(first.pieces[0][1])
        return Weights(
            tuple(
                (both, value * factor)
                for points, value in self.pieces
                for there, factor in other.pieces
                if not (both := points & there).is_empty()
            )
        )

    def on(self, points: Set) -> "Weights":
        """The same on a set, and 0 elsewhere."""
        pieces = ((there & points, value) for there, value in self.pieces)
        return Weights(tuple((there, value) for there, value in pieces if not there.is_empty()))

    def at(self, image: Mapping[sympy.Symbol, sympy.Expr]) -> "Weights":
        """The same at other indices.

        Raises:
            NotExactError: these are not affine.
        """
        if M in image and any(value.holds(H_M) for _, value in self.pieces):
            raise NotExactError("H_M is that of the height M alone")
        numbers = {symbol: sets.polynomial(sets.row(form)) for symbol, form in image.items()}
        return Weights(
            tuple(
                (sets.at(points, image), value.substitute(numbers)) for points, value in self.pieces
            )
        )

    def summed(self, *symbols: sympy.Symbol) -> "Weights":
        """Σ over all values of some symbols.

        Raises:
            OpenSumError: that has no closed form.
        """
        pieces = self.pieces
        for symbol in symbols:
            pieces = tuple(
                (there, sum_over(value, symbol, low, high))
                for points, value in pieces
                for there, low, high in sets.ranges(points, symbol)
            )
        return Weights(pieces)

    def without(self, *symbols: sympy.Symbol) -> "Weights":
        """The same in terms of other symbols, which give these on every piece.

        Raises:
            OpenSumError: they do not.
        """
        pieces = self.pieces
        for symbol in symbols:
            expressed = []
            for points, value in pieces:
                for part in sets.parts(points):
                    at = sets.given(part, symbol)
                    if at is None and value.holds(symbol):
                        raise sets.OpenSumError(f"{symbol} is not given by the others")
                    solved = {} if at is None else {symbol: at}
                    expressed.append((sets.without(part, symbol), value.substitute(solved)))
            pieces = tuple(expressed)
        return Weights(pieces)

    def cells(self) -> "Weights":
        """The same in convex pieces that share no point."""
        pieces = [(part, value) for points, value in self.pieces for part in sets.parts(points)]
        nonzero = []
        for cell, inside in sets.arrangement(tuple(part for part, _ in pieces)):
            value = FIELD.total(pieces[number][1] for number in inside)
            if not value.is_zero():
                nonzero.append((cell, value))
        return Weights(tuple(nonzero))

    def merged(self) -> "Weights":
        """The same in few convex pieces that share no point, none of which is 0.

        A cell belongs to another one's piece if the polynomial of that is also right on it.
        """
        return Weights(
            tuple((part, value) for whole, value in self.formulas() for part in sets.parts(whole))
        )

    def formulas(self) -> list[Piece]:
        """The same as few polynomials, each on a set of its own; where it is 0 is left out."""
        cells = [(sets.fixed(part), part, value) for part, value in self.cells().pieces]
        cells.sort(key=lambda cell: len(cell[0]))
        groups: list[tuple[RationalFunction, list[Set]]] = [(FIELD.zero, [])]
        for fixed, part, value in cells:
            numbers = [*{**_NUMBERS, **sets.sample(part)}.values()]
            own, divisor = value.numerator(*numbers), value.denominator(*numbers)
            for other, parts in groups:
                same = other.denominator == value.denominator
                scale = divisor if same else other.denominator(*numbers)
                alike = other.numerator(*numbers) * divisor == own * scale
                if alike and _agree(other, value, fixed):
                    parts.append(part)
                    break
            else:
                groups.append((value.substitute(fixed), [part]))
        return [(_joined(own) if own[1:] else own[0], value) for value, own in groups[1:]]

    def is_zero(self) -> bool:
        """Whether it is 0 everywhere."""
        zeros = (_agree(FIELD.zero, value, sets.fixed(part)) for part, value in self.cells().pieces)
        return all(zeros)


def _joined(parts: list[Set]) -> Set:
    """The union of sets, in few convex parts if these are found."""
    whole, shortened = sets.union(parts), joined(parts)
    return shortened if shortened == whole else whole


def _agree(value: RationalFunction, other: RationalFunction, fixed: Fixed) -> bool:
    """Whether two functions are the same where some symbols are given by the others."""
    try:
        return (value - other).substitute(fixed).is_zero()
    except NotExactError:  # a divisor vanishes there
        return False
