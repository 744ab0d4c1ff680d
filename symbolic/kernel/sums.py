"""Sums over layers, in closed form: powers by certificates, and what stands over the index by name.

Σ 1/k over lowest ≤ k ≤ highest is no rational function of its ends. It is kept by name, one name
for the same ends, and lies between 0 and the number of its terms, as k ≥ 1.
"""

from collections.abc import Mapping, Sequence

import sympy

from ..algebra import affine
from ..algebra.affine import Affine
from ..algebra.exact import (
    FIELD,
    UNKNOWNS,
    NotExactError,
    RationalFunction,
    sum_polynomial,
)
from ..as_printed import equation
from ..printing.text import text
from ..symbols import SiteFunction
from .rules import instance
from .theorem import NotProvedError, Theorem, placed
from .where import Mapped, Where

Ends = tuple[Affine, Affine]


class Sums:
    """Reads expressions with sums, at finite size.

    Args:
        where: the domain.
        known: what stands for some of their parts.
    """

    def __init__(self, where: Where, known: Mapping[sympy.Basic, RationalFunction] | None = None):
        self.where = where
        self.known: dict[sympy.Basic, RationalFunction] = dict(known or {})
        self.lengths: dict[sympy.Symbol, RationalFunction] = {}
        self._names: dict[Ends, sympy.Symbol] = {}

    def read(self, node: sympy.Expr) -> RationalFunction:
        """A rational function of indices, parameters and names of harmonic sums.

        Raises:
            NotProvedError: it is none.
        """
        try:
            return self._read(node)
        except (NotExactError, ZeroDivisionError) as reason:
            raise NotProvedError(str(reason)) from None

    def _read(self, node: sympy.Expr) -> RationalFunction:
        if node in self.known:
            return self.known[node]
        if isinstance(node, sympy.Sum):
            ((index, low, high),) = node.limits
            ends = self._read(low), self._read(high)
            return self.summed(self._read(node.function), index, *ends)
        if isinstance(node, sympy.Add):
            total = FIELD.zero
            for term in node.args:
                total = total + self._read(term)
            return total
        if isinstance(node, sympy.Mul):
            product = FIELD.one
            for factor in node.args:
                product = product * self._read(factor)
            return product
        if isinstance(node, sympy.Pow) and node.exp.is_Integer:
            return self._read(node.base) ** int(node.exp)
        fixed = self.where.solved.get(node)
        return FIELD.from_sympy(node if fixed is None else fixed)

    def summed(
        self,
        value: RationalFunction,
        index: sympy.Symbol,
        low: RationalFunction,
        high: RationalFunction,
    ) -> RationalFunction:
        """Σ value over low ≤ index ≤ high, which is no shorter than none (checked before)."""
        place = FIELD.position[index]
        factors = value.denominator.factor()[1]
        below = [one for one in factors if one[0].degrees()[place]]
        if not below:
            return sum_polynomial(value, index, low, high)
        k, low, high, back = self._counted(below[0][0], index, low, high)
        # refuses what still stands below: of a harmonic sum that is the index alone
        over, *powers = (value.substitute({index: back}) * k).coefficients(index)
        total = over * self._harmonic(low, high)
        for exponent, weight in enumerate(powers):
            total = total + sum_polynomial(weight * k**exponent, index, low, high)
        return total

    def _counted(
        self,
        factor: object,
        index: sympy.Symbol,
        low: RationalFunction,
        high: RationalFunction,
    ) -> tuple[RationalFunction, ...]:
        """k = ±index + c ≥ 1 in place of the index: k, its ends, and the index in terms of it."""
        whole = affine.from_sympy(RationalFunction(FIELD, factor, FIELD.one.numerator).to_sympy())
        k = FIELD.generator(index)
        for scale in (1, -1):
            one = affine.times(whole, scale)
            slope = affine.coefficient(one, index)
            rest = FIELD.from_sympy(affine.to_sympy(affine.without(one, index)))
            turn = FIELD.constant(slope)
            ends = sorted((low, high), key=lambda end: slope * (end is high))
            first, last = (turn * end + rest for end in ends)
            if abs(slope) == 1 and self.where.nonnegative(affine.shifted(_affine(first), -1)):
                return k, first, last, turn * (k - rest)
        raise NotProvedError(f"what stands below in a sum over {text(index)} may vanish")

    def _harmonic(self, low: RationalFunction, high: RationalFunction) -> RationalFunction:
        ends = _affine(low), _affine(high)
        if ends not in self._names and len(self._names) == len(UNKNOWNS[0]):
            raise NotProvedError("too many harmonic sums in one statement")
        if ends not in self._names:
            name = self._names[ends] = UNKNOWNS[0][len(self._names)]
            self.lengths[name] = high - low + FIELD.one
        return FIELD.generator(self._names[ends])

    def layers(
        self, series: sympy.Sum, layers: Sequence[Theorem]
    ) -> tuple[RationalFunction, list[Theorem]]:
        """A sum over layers, and the theorems of its terms.

        Raises:
            NotProvedError: of some layer nothing is known.
        """
        index, total, used = series.limits[0][0], FIELD.zero, []
        for first, last, theorem in layer_by_layer(series, layers, self.where):
            value, ends = self.read(theorem.formula.rhs), (self.read(first), self.read(last))
            if first == last:
                total = total + value.substitute({index: ends[0]})
            else:
                total = total + self.summed(value, index, *ends)
            used.append(theorem)
        return total, used


def _affine(value: RationalFunction) -> Affine:
    return affine.from_sympy(sympy.expand(value.to_sympy()))


def layer_by_layer(
    series: sympy.Sum, layers: Sequence[Theorem], where: Where
) -> list[tuple[sympy.Expr, sympy.Expr, Theorem]]:
    """First and last layer, and what is known there: consecutive, none missing, none met twice.

    Raises:
        NotProvedError: of some layer nothing is known.
    """
    ((_, low, high),) = series.limits
    following, found = low, []
    while not where.implies(equation(following, high + 1)):
        for one in layers:
            last = _last(series, one, following, where)
            if last is not None:
                theorem, end = last
                found.append((following, end, theorem))
                following = sympy.expand(end + 1)
                break
        else:
            raise NotProvedError(f"nothing is known of layer {text(following)}")
    return found


def _last(
    series: sympy.Sum, theorem: Theorem, first: sympy.Expr, where: Where
) -> tuple[Theorem, sympy.Expr] | None:
    """A theorem of the terms from ``first`` on, and the last of them that it holds for."""
    index = series.limits[0][0]
    image = _image(series.function, theorem, where.within(index, *series.limits[0][1:]))
    if image is None:
        return None
    for row in theorem.where.put_in(image, where.indices).rows:
        if affine.coefficient(row, index) != -1:
            continue
        last = affine.to_sympy(affine.without(row, index)).xreplace(where.solved)
        length = affine.from_sympy(sympy.expand(last - first + 1))
        if not where.nonnegative(length) or (not any(length[:-1]) and length[-1] == 0):
            continue  # one that is empty leads nowhere
        inner = where.within(index, first, last)
        try:
            there = instance(theorem, image, inner)
        except (NotProvedError, NotExactError):
            continue
        if there.formula.lhs == series.function:
            return there, last
    return None


def _image(term: sympy.Expr, theorem: Theorem, where: Where) -> Mapped | None:
    """The indices for which a theorem may be about a term: found, and checked where it is used."""
    for about in theorem.formula.lhs.atoms(SiteFunction):
        for atom in term.atoms(type(about)):
            return placed(theorem, about.args, atom.args, where)
    return None
