"""A formula as a function for NumPy, in float64, with a signature and a docstring of its own."""

import inspect
import numbers
from collections.abc import Callable, Collection, Iterable, Mapping
from decimal import Decimal
from functools import partial
from typing import Any

import mpmath
import numpy as np
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.mechanics.lattice import kappa_in
from force_diffusion.symbolic.printing.text import text

from .arrays import at_element, shared_shape
from .evaluation import (
    TOGETHER,
    ArgumentError,
    Evaluation,
    in_order,
    range_of,
)

Arrays = dict[sympy.Symbol, Any]
"""Float64 arrays of one shape, by symbol."""

Call = Callable[[Arrays], Any]
"""An expression, or a relation, as an array of that shape."""

_MEANINGS = {sy.M: "height of the packing", sy.j: "layer, 0 at the base"}
_COMPARED = {
    sympy.Eq: np.equal, sympy.Ge: np.greater_equal, sympy.Le: np.less_equal,
    sympy.Gt: np.greater, sympy.Lt: np.less,
}  # fmt: skip


def numpy_function(
    evaluation: Evaluation, name: str, heading: str, meanings: Mapping[sympy.Basic, str]
) -> Callable[..., Any]:
    """The function; it refuses what ``Evaluation.at`` refuses.

    Args:
        evaluation: what is evaluated.
        name: of the function.
        heading: first line of its docstring.
        meanings: of symbols, in words.
    """
    by_name, derived = _arguments(evaluation)
    compiled = _Compiler(list(by_name.values()), derived)
    sides = [compiled.value(side) for side in evaluation.sides]
    domain = [(relation, compiled.relation(relation)) for relation in evaluation.domain]
    signature = inspect.Signature(
        [inspect.Parameter(one, inspect.Parameter.POSITIONAL_OR_KEYWORD) for one in by_name]
    )

    def function(*args: Any, **kwargs: Any) -> Any:
        given = signature.bind(*args, **kwargs).arguments
        arrays = {one: _floats(one, given[one]) for one in by_name}
        shape = shared_shape({one: array for one, array in arrays.items() if array.ndim})
        values = {by_name[one]: np.broadcast_to(array, shape) for one, array in arrays.items()}
        _assert_allowed(evaluation, values)
        _assert_together(values)
        for relation, holds in domain:
            _refuse(~holds(values), partial(_outside, evaluation, relation, values))
        with np.errstate(all="ignore"):
            found = [side(values)[()] for side in sides]
        for one in found:
            _refuse(~np.isfinite(one), lambda _: "the value is beyond the range of floats: use at")
        return found[0] if len(found) == 1 else tuple(found)

    function.__name__ = function.__qualname__ = name
    function.__doc__ = _docstring(evaluation, heading, by_name, meanings)
    function.__signature__ = signature  # type: ignore[attr-defined]
    return function


def _arguments(
    evaluation: Evaluation,
) -> tuple[dict[str, sympy.Symbol], dict[sympy.Symbol, sympy.Expr]]:
    """What the function takes, in order, and the symbols that follow from it."""
    needed = set(evaluation.needed)
    derived: dict[sympy.Symbol, sympy.Expr] = {}
    if sy.kappa in needed:
        derived[sy.kappa] = kappa_in(sy.d if sy.d in needed else evaluation.dimension)
        needed |= {sy.phi}
    if {sy.phi, sy.n_y} <= needed:
        derived[sy.n_y] = sympy.sqrt((1 + sy.phi) / 2)
    taken = {symbol.in_code: symbol for symbol in needed - set(derived)}
    return {name: taken[name] for name in in_order(taken)}, derived


class _Compiler:
    """Makes expressions functions of arrays, by symbol, which give arrays of their shape."""

    def __init__(self, symbols: list[sympy.Symbol], derived: Arrays) -> None:
        self._symbols, self._derived = symbols, derived

    def value(self, expression: sympy.Expr) -> Callable[[Arrays], Any]:
        sums = {series: _without_a_loop(series) for series in expression.atoms(sympy.Sum)}
        put_in = expression.xreplace(sums).xreplace(dict(self._derived))
        call = sympy.lambdify(self._symbols, put_in, modules=[{"harmonic": _harmonic}, "numpy"])

        def value(values: Arrays) -> Any:
            found = call(*(values[symbol] for symbol in self._symbols))
            shape = np.broadcast_shapes(*(array.shape for array in values.values()))
            return np.array(np.broadcast_to(found, shape), dtype=float)

        return value

    def relation(self, relation: sympy.Basic) -> Callable[[Arrays], Any]:
        difference = self.value(relation.lhs - relation.rhs)
        compare = _COMPARED[relation.func]

        def holds(values: Arrays) -> Any:
            return compare(difference(values), 0)

        return holds


def _without_a_loop(series: sympy.Sum) -> sympy.Expr:
    index, low, high = series.limits[0]
    factor, term = series.function.as_independent(index, as_Add=False)
    assert term == 1 / index, "the only sums that formulas hold"
    return factor * (sympy.harmonic(high) - sympy.harmonic(low - 1))


def _harmonic(n: Any) -> Any:
    """H_n; not a number for n < 0, of packings that have a value of their own."""
    return np.vectorize(
        lambda one: float(mpmath.harmonic(one)) if one >= 0 else np.nan, otypes=[float]
    )(n)


def _floats(name: str, value: Any) -> Any:
    try:
        if isinstance(value, np.ma.MaskedArray):
            raise TypeError
        array = np.asarray(value)
        return (array if array.dtype.kind in "iuf" else _from_objects(array)).astype(float)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(
            f"{name} = {value!r}: numbers are allowed, and arrays of them without a mask"
        ) from None


def _from_objects(array: Any) -> Any:
    known = (numbers.Real, Decimal)
    if array.dtype != object or not all(isinstance(one, known) for one in array.flat):
        raise TypeError
    return np.vectorize(float, otypes=[float])(array)


def _assert_allowed(evaluation: Evaluation, values: Arrays) -> None:
    dimension = values.get(sy.d, evaluation.dimension)
    for symbol in sorted(values, key=lambda one: bool(one != sy.d)):  # which φ goes by

        def told(at: tuple[int, ...], words: str, symbol: sympy.Symbol = symbol) -> str:
            return f"{symbol.in_code} = {values[symbol][at]:g}: {words}"

        array = values[symbol]
        _refuse(~np.isfinite(array), partial(told, words="finite numbers are allowed"))
        good = range_of(symbol, dimension)[1](array)
        if symbol.is_integer:
            good &= array == np.floor(array)
        words = _range_in_words(evaluation, symbol, values)
        _refuse(np.logical_not(good), partial(told, words=f"{words} is allowed"))


def _range_in_words(
    evaluation: Evaluation, symbol: sympy.Symbol, arguments: Collection[sympy.Symbol]
) -> str:
    """What is allowed of a symbol; of φ in d dimensions, where d is an argument."""
    if symbol == sy.phi and sy.d in arguments:
        return "−1/d < φ < 1/2"
    return range_of(symbol, evaluation.dimension)[0]


def _assert_together(values: Arrays) -> None:
    for pair, (words, together) in TOGETHER.items():
        if set(pair) <= set(values):
            wrong = ~together(*(values[symbol] for symbol in pair))
            _refuse(wrong, partial(_not_together, pair, words, values))


def _not_together(
    pair: tuple[sympy.Symbol, ...], words: str, values: Arrays, at: tuple[int, ...]
) -> str:
    return f"{_with_values(pair, values, at)}: {words} is allowed"


def _outside(
    evaluation: Evaluation, relation: sympy.Basic, values: Arrays, at: tuple[int, ...]
) -> str:
    symbols = sorted(relation.free_symbols & set(values), key=str)
    told = _with_values(symbols, values, at)
    return f"{evaluation.about} is for {evaluation.validity}, not for {told}"


def _with_values(symbols: Iterable[sympy.Symbol], values: Arrays, at: tuple[int, ...]) -> str:
    return ", ".join(f"{text(symbol)} = {values[symbol][at]:g}" for symbol in symbols)


def _refuse(wrong: Any, words: Callable[[tuple[int, ...]], str]) -> None:
    """Raise for the first element that is wrong."""
    if np.any(wrong):
        at = tuple(int(place) for place in np.argwhere(wrong)[0])
        raise ArgumentError(f"{at_element(at)}{words(at)}")


def _docstring(
    evaluation: Evaluation,
    heading: str,
    by_name: Mapping[str, sympy.Symbol],
    meanings: Mapping[sympy.Basic, str],
) -> str:
    lines = [heading, ""]
    if evaluation.validity:
        lines += [f"It holds for {evaluation.validity}.", ""]
    lines.append("Args:")
    for name, symbol in by_name.items():
        meaning = meanings.get(symbol) or _MEANINGS.get(symbol)
        allowed = _range_in_words(evaluation, symbol, by_name.values())
        lines.append(f"    {name}: {f'{meaning}; ' if meaning else ''}{allowed}.")
    lines += [
        "",
        "Numbers or arrays that broadcast; float64 comes back, in their shape.",
        "",
        "Raises:",
        "    ArgumentError: a value is not allowed.",
    ]
    return "\n".join(lines)
