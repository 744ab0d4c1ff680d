"""Formulas evaluated for numbers and arrays: exact for exact arguments, and only on their domain.

Each element of an array is evaluated as if it were alone.
"""

import math
import numbers
from collections.abc import Callable, Iterable, Mapping, Sequence, Set
from decimal import Decimal
from fractions import Fraction
from typing import Any, TypeAlias

import lazy_loader
import sympy
from flint import fmpq, fmpz
from force_diffusion.numeric.arithmetic.errors import ArgumentError, WrongTypeError, quoted
from force_diffusion.symbolic import sets
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.code import name_of
from force_diffusion.symbolic.printing.text import text

from .lists import both, either

np = lazy_loader.load("numpy")

Number: TypeAlias = int | float | Fraction | Decimal
"""What is put in: int, Fraction, Decimal and, at run time, SymPy's Rational are exact."""

Values: TypeAlias = Mapping[sympy.Symbol, sympy.Rational]
"""Exact numbers by symbol."""

_ORDER = "M l j z i k phi sigma r"
_WHOLE: tuple[str, Callable[[Any], Any]] = ("a whole number", lambda _: True)
_ALLOWED: dict[sympy.Symbol, tuple[str, Callable[[Any], Any]]] = {
    sy.z: ("0 ≤ z ≤ 1", lambda value: (value >= 0) & (value <= 1)),
    sy.sigma: ("a number from 0 up", lambda value: value >= 0),
    sy.M: ("a whole number from 1 up", lambda value: value >= 1),
    sy.j: ("a whole number from 0 up", lambda value: value >= 0),
    sy.l: ("a whole number from 0 up", lambda value: value >= 0),
}
_TOGETHER: dict[tuple[sympy.Symbol, ...], tuple[str, Callable[[Any, Any], Any]]] = {
    (sy.j, sy.M): ("0 ≤ j < M", lambda j, height: j < height),
    (sy.j, sy.l): ("0 ≤ j ≤ l", lambda j, level: j <= level),
}
"""What holds of two together; of numbers, and of arrays element by element."""

EXACT = (numbers.Rational, Decimal, fmpq, fmpz)
"""Types of exact numbers; floats of Python and NumPy up to float64 are taken, too."""

_LONGEST = 10_000  # digits of a Decimal that is written out


def arguments(
    about: str, needed: Iterable[sympy.Symbol], given: Iterable[str]
) -> dict[str, sympy.Symbol]:
    """The symbols by their names, j in place of z where it is given; looks at the names alone.

    Raises:
        ArgumentError: a name is unknown or missing.
    """
    by_name = {name_of(symbol): symbol for symbol in needed if not isinstance(symbol, sympy.Dummy)}
    if "z" in by_name and "j" in given:
        if "z" in given:
            raise ArgumentError("z and j are given, and z is j/M: leave one of them out")
        del by_name["z"]
        by_name |= {"M": sy.M, "j": sy.j}
    names = in_order(by_name)
    takes = f"{about} takes " + ", ".join("z (or j)" if name == "z" else name for name in names)
    if unknown := [name for name in given if name not in by_name]:
        raise ArgumentError(f"{about} has no {either(unknown)}: {takes}")
    if missing := [name for name in names if name not in given]:
        raise ArgumentError(f"{both(missing)} must be given: {takes}")
    return by_name


def _values(
    symbols: Mapping[str, sympy.Symbol],
    given: Mapping[str, Number],
    dimension: int,
    in_packing: bool,
) -> Values:
    """Values of symbols by name, exactly; of z, too, where M and j of a packing are given.

    Raises:
        ArgumentError: a value is not allowed.
    """
    values = {symbols[name]: _exactly(name, value) for name, value in given.items()}
    for name, symbol in symbols.items():
        number, value = given[name], values[symbol]
        words, allowed = range_of(symbol, dimension)
        if symbol in sy.INDICES and not in_packing:
            number, (words, allowed) = value, _WHOLE
        if not allowed(value) or (symbol.is_integer and not value.is_integer):
            raise ArgumentError(f"{name} = {quoted(number)}: {words} is allowed")
    for pair, (words, together) in _TOGETHER.items() if in_packing else ():
        if set(pair) <= set(values) and not together(*(values[symbol] for symbol in pair)):
            raise ArgumentError(f"{with_values(pair, values)}: {words} is allowed")
    if in_packing and {sy.j, sy.M} <= {*values}:
        values[sy.z] = values[sy.j] / values[sy.M]
    return values


def in_order(names: Iterable[str]) -> list[str]:
    """Names of arguments in the order in which they are told and taken."""
    return sorted(names, key=lambda name: (_ORDER.find(name) if name in _ORDER else 99, name))


def _exactly(name: str, value: Number) -> sympy.Rational:
    if isinstance(value, numbers.Rational | fmpq | fmpz):
        return sympy.Rational(int(value.numerator), int(value.denominator))
    if isinstance(value, Decimal) and value.is_finite():
        if max(abs(value.adjusted()), len(value.as_tuple().digits)) > _LONGEST:
            raise ArgumentError(f"{name}: a Decimal of at most {_LONGEST} digits is allowed")
        return sympy.Rational(*value.as_integer_ratio())
    if isinstance(value, float | np.float32 | np.float16) and math.isfinite(value):
        return sympy.Rational(*float(value).as_integer_ratio())
    raise ArgumentError(
        f"{name} = {quoted(value)}: one int, Fraction, SymPy Rational, Decimal or finite float is "
        "allowed; of a longer float give the Fraction that it is"
    )


def range_of(symbol: sympy.Symbol, dimension: int = 2) -> tuple[str, Callable[[Any], Any]]:
    """What is allowed of a symbol in words, and of a number or an array: whether it is."""
    if symbol == sy.phi:
        # 2 φ < 1 and d φ > −1, without a quotient that floats would round
        words = f"−1/{dimension} < φ < 1/2"
        return words, lambda value: (dimension * value > -1) & (2 * value < 1)
    if symbol in _ALLOWED:
        return _ALLOWED[symbol]
    if symbol.is_integer:
        return _WHOLE
    if symbol.is_positive:
        return "a number above 0", lambda value: value > 0
    return "a number", lambda _: True


def indices_at(
    at: Mapping[str, Any], known: Iterable[sympy.Symbol] = sy.INDICES
) -> dict[sympy.Symbol, sympy.Integer]:
    """Whole numbers for indices, by symbol.

    Raises:
        ArgumentError: a name is none of the indices known, or a value no whole number.
    """
    by_name = {symbol.name: symbol for symbol in known if symbol in sy.INDICES}
    for name, value in at.items():
        if name not in by_name:
            raise ArgumentError(f"{name} is no index: {', '.join(by_name)} are")
        if isinstance(value, bool) or not isinstance(value, numbers.Integral):
            raise ArgumentError(f"{name} = {quoted(value)}: a whole number is allowed")
        if abs(int(value)) > sets.LARGEST:
            raise ArgumentError(f"{name}: a whole number up to {sets.LARGEST} is allowed")
    return {by_name[name]: sympy.Integer(int(value)) for name, value in at.items()}


def with_values(symbols: Iterable[sympy.Symbol], values: Values) -> str:
    """Symbols with their values, in words."""
    return ", ".join(f"{text(symbol)} = {text(values[symbol])}" for symbol in symbols)


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


# arrays


def evaluate(
    formula: tuple[str, set[sympy.Symbol]],
    sides: Sequence[Callable[[Values, bool], sympy.Expr]],
    unnamed: Sequence[Any],
    given: Mapping[str, Any],
    dimension: int = 2,
    *,
    in_packing: bool = True,
) -> Any:
    """The value for numbers; for arrays, lists and ranges an array of the shape that they share.

    It is float64 where anything given is a float, each value rounded once; else it holds objects,
    SymPy's exact numbers. Of several sides a tuple is made.

    Args:
        formula: what it is, for messages, and the symbols that decide its value.
        sides: give the exact values for exact numbers, and know whether these were given.
        unnamed: values without names, of which there may be none.
        given: values by name.
        dimension: of the packing, d; no spheres overlap where −1/d < φ < 1/2.
        in_packing: whether i, j, k, l and M have to be those of a bead and of a packing.

    Raises:
        ArgumentError: a name is unknown or missing, a value is not allowed, or shapes differ; the
            message names the element.
        WrongTypeError: a value has no name.
    """
    if unnamed:
        call = ", ".join(f"{name}=…" for name in in_order(map(name_of, formula[1])))
        raise WrongTypeError(f"{quoted(unnamed[0])} has no name: give values as at({call})")
    symbols = arguments(*formula, given)
    arrays = {name: _array(name, value) for name, value in given.items()}
    exact = all(map(_is_exact, arrays.values()))
    shapes = {name: array.shape for name, array in arrays.items() if array.ndim}
    try:
        shape = np.broadcast_shapes(*shapes.values())
    except ValueError:
        shown = both([f"{name} of shape {shape}" for name, shape in shapes.items()])
        raise ArgumentError(
            f"{shown} do not go together: give arrays of one shape, or shapes that NumPy broadcasts"
        ) from None
    arrays = {name: np.broadcast_to(array, shape) for name, array in arrays.items()}
    results = np.empty((len(sides), *shape), dtype=object if exact else float)
    for place in np.ndindex(shape):
        numbers = {name: array[place] for name, array in arrays.items()}
        numbers |= {name: n.item() for name, n in numbers.items() if isinstance(n, np.generic)}
        try:
            values = _values(symbols, numbers, dimension, in_packing)
            for n, side in enumerate(sides):
                value = side(values, exact)
                results[n, *place] = value if exact else rounded(value)
        except ArgumentError as error:
            where = f"element [{', '.join(map(str, place))}]: " if place else ""
            raise ArgumentError(f"{where}{error}") from None
    return unpacked([result if shape or exact else float(result) for result in results])


def unpacked(values: Sequence[Any]) -> Any:
    """The value of a single side, or a tuple of several."""
    return values[0] if len(values) == 1 else tuple(values)


def _array(name: str, value: Any) -> Any:
    """The array; of a sequence one of objects, so that exact numbers stay what they are."""
    if isinstance(value, np.ma.MaskedArray):
        raise ArgumentError(f"{name} is a masked array: give one without a mask")
    if hasattr(value, "__array__"):
        return np.asarray(value)
    if hasattr(value, "__len__") and not isinstance(value, str | bytes | Mapping | Set):
        return np.array([*value], dtype=object)
    return np.array([value], dtype=object).reshape(())


def _is_exact(array: Any) -> bool:
    if array.dtype == object:
        return all(isinstance(element, EXACT) for element in array.flat)
    return array.dtype.kind in "iu"
