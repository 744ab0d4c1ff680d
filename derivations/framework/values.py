"""The value of a closed form for exact numbers: that of the formula which holds there."""

from collections.abc import Iterable, Mapping

import mpmath
import sympy
from flint import fmpq
from force_diffusion.numeric.arithmetic.errors import ArgumentError
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra.exact import RationalFunction
from force_diffusion.symbolic.piecewise import Piece
from force_diffusion.symbolic.quotients import factored

from .evaluation import Values

Whole = Mapping[sympy.Symbol, int]
"""Whole numbers for indices."""

_DIGITS = 40  # of harmonic numbers, beside floats
_HIGHEST = 100_000  # M up to which they are exact


def hold(relations: Iterable[sympy.Basic], whole: Whole) -> bool:
    """Whether relations hold of whole numbers."""
    totals = ((_total(form, whole), equal) for form, equal in map(sets.condition, relations))
    return all(total == 0 if equal else total >= 0 for total, equal in totals)


def are_even(sums: Iterable[sympy.Expr], whole: Whole) -> bool:
    """Whether sums of indices are even for whole numbers."""
    return not any(_total(sets.row(total), whole) % 2 for total in sums)


def _total(form: sets.Row, whole: Whole) -> int:
    return form[1] + sum(factor * whole[symbol] for symbol, factor in form[0].items())


def value_at(pieces: Iterable[Piece], whole: Whole, values: Values, exact: bool) -> sympy.Expr:
    """The value of the formula that holds for given numbers.

    Args:
        pieces: formulas, on parts of a domain that cover it.
        whole: indices of a point in that domain.
        values: of all symbols.
        exact: whether harmonic numbers are; otherwise they have 40 digits.

    Raises:
        ArgumentError: it divides by 0 there, or holds an exact harmonic number that is too long.
    """
    value = next(piece.value for piece in pieces if any(hold(part, whole) for part in piece.where))
    if value.holds(sy.H_M):
        values = {**values, sy.H_M: _harmonic(whole[sy.M], exact)}
    return _number(value, values)


def _harmonic(height: int, exact: bool) -> sympy.Rational:
    """H_M."""
    if not exact:
        with mpmath.workdps(_DIGITS):
            return sympy.Rational(str(mpmath.harmonic(height)))
    if height > _HIGHEST:
        raise ArgumentError(
            f"M = {height}: the exact sum of 1/k up to it is too long; give a float for one value"
        )
    return _rational(fmpq.harmonic(height))


def _number(value: RationalFunction, values: Values) -> sympy.Expr:
    """The exact value of a function; a root where n_x or n_y is left."""
    value = value.reduced()
    if any(value.holds(component) for component in (sy.n_x, sy.n_y)):
        cosine = values[sy.phi]
        sides = {sy.n_x: sympy.sqrt((1 - cosine) / 2), sy.n_y: sympy.sqrt((1 + cosine) / 2)}
        return factored(value).xreplace({**values, **sides})
    given = (values.get(symbol, sympy.S.Zero) for symbol in value.domain.generators)
    numbers = [fmpq(int(number.p), int(number.q)) for number in given]
    divisor = value.denominator(*numbers)
    if divisor == 0:
        raise ArgumentError("it has no value there: it divides by 0")
    return _rational(value.numerator(*numbers) / divisor)


def _rational(number: fmpq) -> sympy.Rational:
    return sympy.Rational(int(number.p), int(number.q))
