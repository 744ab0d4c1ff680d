"""Numbers put into formulas: exact for exact arguments, and only where the formula is meant."""

import math
import numbers
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from functools import cached_property
from typing import Any, TypeAlias

import mpmath
import sympy
from flint import fmpq
from force_diffusion.numeric.arithmetic.errors import ForceDiffusionError
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.mechanics.lattice import kappa_in
from force_diffusion.symbolic.notation import Symbol
from force_diffusion.symbolic.printing.code import name_of
from force_diffusion.symbolic.printing.text import text

from ..export.prose import either

Number: TypeAlias = int | float | Fraction | Decimal
"""What is put in: int, Fraction, Decimal and, at run time, SymPy's Rational are exact."""

_ORDER = "M l j z i k phi sigma r"
_ALLOWED: dict[sympy.Symbol, tuple[str, Callable[[Any], Any]]] = {
    sy.d: ("a whole number from 2 on", lambda value: value >= 2),
    sy.z: ("0 ≤ z ≤ 1", lambda value: (value >= 0) & (value <= 1)),
    sy.sigma: ("a number from 0 on", lambda value: value >= 0),
    sy.M: ("a whole number from 1 on", lambda value: value >= 1),
    sy.j: ("a whole number from 0 on", lambda value: value >= 0),
    sy.N: ("a whole number from 1 on", lambda value: value >= 1),
    sy.l: ("a whole number from 0 on", lambda value: value >= 0),
}
TOGETHER: dict[tuple[sympy.Symbol, ...], tuple[str, Callable[[Any, Any], Any]]] = {
    (sy.j, sy.M): ("0 ≤ j < M", lambda j, height: j < height),
    (sy.j, sy.l): ("0 ≤ j ≤ l", lambda j, level: j <= level),
    (sy.i, sy.j): ("an even sum i + j", lambda i, j: (i + j) % 2 == 0),
    (sy.k, sy.l): ("an even sum k + l", lambda k, level: (k + level) % 2 == 0),
}
"""What holds of two together; of numbers, and of arrays element by element."""

_ROUNDING = sympy.Rational(4, 2**53)
"""Of n_y, relative: a rounding of each of n_y and φ, and those of a square root and of a sum."""


EXACT = (numbers.Rational, Decimal)
"""Types of exact numbers; others are taken for floats."""


class ArgumentError(ForceDiffusionError, ValueError):
    """A formula can't be evaluated with these arguments; the message says what is allowed."""


@dataclass(frozen=True)
class Evaluation:
    """A formula that numbers are put into, and where it is meant.

    Attributes:
        about: what it is, for messages.
        sides: one expression, or several that are evaluated together.
        dimension: of the packing, d; no spheres overlap where −1/d < φ < 1/2.
        domain: relations of whole numbers, all of which hold where it is meant.
        validity: the same in words.
    """

    about: str
    sides: tuple[sympy.Expr, ...]
    dimension: int = 2
    domain: tuple[sympy.Basic, ...] = ()
    validity: str = ""

    @cached_property
    def needed(self) -> set[sympy.Symbol]:
        """The symbols that decide its value, and whether it has one."""
        return set().union(*(one.free_symbols for one in (*self.sides, *self.domain)))

    def at(self, given: Mapping[str, Number]) -> Any:
        """The value for single numbers: exact for exact ones, else a float; a tuple of several.

        Raises:
            ArgumentError: a name is unknown or missing, or a value is not allowed.
        """
        values, exact = read_arguments(self.about, self.needed, given, self.dimension)
        for relation in self.domain:
            if not holds(relation, values):
                at = told(sorted(relation.free_symbols, key=str), values)
                raise ArgumentError(f"{self.about} is for {self.validity}, not for {at}")
        found = tuple(value_of(side, values, exact=exact) for side in self.sides)
        return found[0] if len(found) == 1 else found


@dataclass(frozen=True)
class _Named:
    """What the arguments of a formula are called, and which of them stand for others."""

    symbols: dict[str, sympy.Symbol]
    by_layer: bool  # j is given in place of z
    holds_kappa: bool  # worked out from φ
    holds_angle: bool  # of φ and n_y one may be left out


def _named(about: str, needed: Iterable[sympy.Symbol], given: Iterable[str]) -> _Named:
    """Look at the names alone."""
    by_name = {name_of(symbol): symbol for symbol in needed if not isinstance(symbol, sympy.Dummy)}
    by_layer = "z" in by_name and "j" in given
    if by_layer:
        if "z" in given:
            raise ArgumentError("z and j are given, and z is j/M: leave one of them out")
        del by_name["z"]
        by_name |= {"M": sy.M, "j": sy.j}
    holds_kappa = by_name.pop("kappa", None) is not None
    if holds_kappa:
        by_name["phi"] = sy.phi
    spared = [name for name in ("n_y", "phi") if {"n_y", "phi"} <= set(by_name)]
    left_out = next((name for name in spared if name not in given), None)
    _compare_names(about, {n: s for n, s in by_name.items() if n != left_out}, given)
    return _Named(by_name, by_layer, holds_kappa, bool(spared))


def compare_names(about: str, needed: Iterable[sympy.Symbol], given: Iterable[str]) -> None:
    """Refuse names that are unknown or missing.

    Raises:
        ArgumentError: there are some.
    """
    _named(about, needed, given)


def read_arguments(
    about: str,
    needed: Iterable[sympy.Symbol],
    given: Mapping[str, Number],
    dimension: int = 2,
    *,
    in_packing: bool = True,
) -> tuple[dict[sympy.Symbol, sympy.Rational], bool]:
    """Values of the symbols that a formula needs, and whether all of them are exact.

    In place of z, ``j`` may be given: z = j/M. κ is worked out from φ; of φ and n_y, where both
    are held, one may be left out.

    Args:
        about: what is evaluated, for messages.
        needed: symbols of the formula.
        given: values by name.
        dimension: of the packing, d; no spheres overlap where −1/d < φ < 1/2.
        in_packing: whether i, j, k, l and M have to be those of a bead and of a packing.

    Raises:
        ArgumentError: a name is unknown or missing, or a value is not allowed.
    """
    named = _named(about, needed, given)
    values = {named.symbols[name]: _exactly(name, value) for name, value in given.items()}
    if sy.d in values:
        _assert_allowed(sy.d, values[sy.d], given["d"], dimension)
        dimension = int(values[sy.d])
    for symbol, value in values.items():
        if in_packing or symbol not in sy.INDICES:
            _assert_allowed(symbol, value, given[name_of(symbol)], dimension)
        elif not value.is_integer:
            raise ArgumentError(f"{name_of(symbol)} = {value}: a whole number is allowed")
    if named.holds_angle:
        _put_angle(values, given)
    if named.holds_kappa:
        values[sy.kappa] = kappa_in(dimension).xreplace({sy.phi: values[sy.phi]})
    if in_packing:
        _assert_together(values)
    if named.by_layer:
        values[sy.z] = values[sy.j] / values[sy.M]
    return values, all(isinstance(value, EXACT) for value in given.values())


def _put_angle(values: dict[sympy.Symbol, sympy.Expr], given: Mapping[str, Number]) -> None:
    """Put φ beside n_y, or n_y beside φ, by 2n_y² = 1 + φ; two that differ are refused."""
    if sy.phi not in values:
        values[sy.phi] = 2 * values[sy.n_y] ** 2 - 1
        _assert_allowed(sy.phi, values[sy.phi], values[sy.phi], 2)
    expected = sympy.sqrt((1 + values[sy.phi]) / 2)
    rounded = any(isinstance(given.get(name), float) for name in ("n_y", "phi"))
    allowed = expected * _ROUNDING if rounded else 0
    if sy.n_y in values and abs(values[sy.n_y] - expected) > allowed:
        raise ArgumentError(
            f"n_y = {given['n_y']} and phi = {given['phi']} contradict each other: 2 n_y² = 1 + φ. "
            "Leave one of them out"
        )
    values.setdefault(sy.n_y, expected)


def in_order(names: Iterable[str]) -> list[str]:
    """Names of arguments in the order in which they are told and taken."""
    return sorted(names, key=lambda name: (_ORDER.find(name) if name in _ORDER else 99, name))


def _compare_names(about: str, known: Mapping[str, Symbol], given: Iterable[str]) -> None:
    names = in_order(known)
    takes = f"{about} takes " + ", ".join("z (or j)" if name == "z" else name for name in names)
    if unknown := [name for name in given if name not in known]:
        raise ArgumentError(f"{about} holds no {either(unknown)}: {takes}")
    if missing := [name for name in names if name not in given]:
        raise ArgumentError(f"{', '.join(missing)} missing: {takes}")


def _exactly(name: str, value: Number) -> sympy.Rational:
    if isinstance(value, numbers.Rational):
        return sympy.Rational(int(value.numerator), int(value.denominator))
    if isinstance(value, Decimal) and value.is_finite():
        return sympy.Rational(*value.as_integer_ratio())
    if isinstance(value, numbers.Real) and math.isfinite(value):
        return sympy.Rational(*float(value).as_integer_ratio())
    raise ArgumentError(
        f"{name} = {value!r}: one int, Fraction, SymPy Rational, Decimal or finite float is allowed"
    )


def _assert_allowed(
    symbol: sympy.Symbol, value: sympy.Rational, given: Number, dimension: int
) -> None:
    words, allowed = range_of(symbol, dimension)
    if not allowed(value) or (symbol.is_integer and not value.is_integer):
        raise ArgumentError(f"{name_of(symbol)} = {given}: {words} is allowed")


def _assert_together(values: Mapping[sympy.Symbol, sympy.Rational]) -> None:
    for pair, (words, allowed) in TOGETHER.items():
        if set(pair) <= set(values) and not allowed(*(values[symbol] for symbol in pair)):
            raise ArgumentError(f"{told(pair, values)}: {words} is allowed")


def range_of(symbol: sympy.Symbol, dimension: int) -> tuple[str, Callable[[Any], Any]]:
    """What is allowed of a symbol in words, and of a number or an array: whether it is."""
    if symbol == sy.phi:
        # 2 φ < 1 and d φ > −1, without a quotient that floats would round
        words = f"−1/{dimension} < φ < 1/2"
        return words, lambda value: (dimension * value > -1) & (2 * value < 1)
    if symbol in _ALLOWED:
        return _ALLOWED[symbol]
    if symbol.is_integer:
        return "a whole number", lambda _: True
    if symbol.is_positive:
        return "a number above 0", lambda value: value > 0
    return "a number", lambda _: True


def told(symbols: Iterable[sympy.Symbol], values: Mapping[sympy.Symbol, sympy.Rational]) -> str:
    """Values in words."""
    return ", ".join(f"{text(symbol)} = {values[symbol]}" for symbol in symbols)


def holds(relation: sympy.Basic, values: Mapping[sympy.Symbol, sympy.Rational]) -> bool:
    """Whether a relation between whole numbers holds."""
    return relation.xreplace(values) is sympy.true


def value_of(
    expression: sympy.Expr, values: Mapping[sympy.Symbol, sympy.Rational], *, exact: bool
) -> sympy.Expr | float:
    """The value of a formula; a float is the exact value of the given floats, rounded once.

    Raises:
        ArgumentError: the value is beyond the range of floats.
    """
    value = expression.xreplace(values)
    sums = {series: _summed(series, exact=exact) for series in value.atoms(sympy.Sum)}
    value = value.xreplace(sums).doit()
    return value if exact else rounded(value)


def rounded(value: sympy.Expr) -> float:
    """The float nearest to a value.

    Raises:
        ArgumentError: the value is beyond the range of floats.
    """
    try:
        if isinstance(value, sympy.Rational):
            return int(value.p) / int(value.q)
        return float(value.evalf(30))
    except OverflowError:
        raise ArgumentError(
            "the value is beyond the range of floats: give exact arguments"
        ) from None


def _summed(series: sympy.Sum, *, exact: bool) -> sympy.Expr:
    """The value of a sum; SymPy would add up its terms one by one.

    For floats harmonic numbers are taken to 40 digits, which no packing is too high for.
    """
    index, low, high = series.limits[0]
    factor, term = series.function.as_independent(index, as_Add=False)
    if term != 1 / index:
        return series.doit()
    if not exact:
        with mpmath.workdps(40):
            number = mpmath.harmonic(int(high)) - mpmath.harmonic(int(low) - 1)
        return factor * sympy.Float(number, 40)
    found = fmpq.harmonic(int(high)) - fmpq.harmonic(int(low) - 1)
    return factor * sympy.Rational(int(found.p), int(found.q))
