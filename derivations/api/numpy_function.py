"""A formula as a function for NumPy, in float64, with a signature and a docstring of its own."""

import inspect
import numbers
from collections.abc import Callable, Iterable, Mapping
from decimal import Decimal
from typing import Any

import numpy as np
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.text import text

from ..formulas.arrays import at_element, shared_shape
from ..formulas.evaluation import (
    TOGETHER,
    ArgumentError,
    Evaluation,
    in_order,
    range_of,
)

Arrays = dict[sympy.Symbol, Any]
"""Float64 arrays of one shape, by symbol."""

_MEANINGS = {sy.M: "height of the packing", sy.j: "layer, 0 at the base"}


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
    by_name = {symbol.in_code: symbol for symbol in evaluation.needed}
    by_name = {one: by_name[one] for one in in_order(by_name)}
    sides = [sympy.lambdify(by_name.values(), side, "numpy") for side in evaluation.sides]
    signature = inspect.Signature(
        [inspect.Parameter(one, inspect.Parameter.POSITIONAL_OR_KEYWORD) for one in by_name]
    )

    def function(*args: Any, **kwargs: Any) -> Any:
        given = signature.bind(*args, **kwargs).arguments
        arrays = {one: _floats(one, given[one]) for one in by_name}
        shape = shared_shape({one: array for one, array in arrays.items() if array.ndim})
        values = {by_name[one]: np.broadcast_to(array, shape) for one, array in arrays.items()}
        _assert_allowed(values)
        _assert_together(values)
        with np.errstate(all="ignore"):
            found = [_spread(side(*values.values()), shape) for side in sides]
        for one in found:
            _refuse(np.isfinite(one), lambda _: "the value is beyond the range of floats: use at")
        return found[0] if len(found) == 1 else tuple(found)

    function.__name__ = function.__qualname__ = name
    function.__doc__ = _docstring(heading, by_name, meanings)
    function.__signature__ = signature  # type: ignore[attr-defined]
    return function


def _spread(value: Any, shape: tuple[int, ...]) -> Any:
    """A value in the shape of all arrays, some of which it may not depend on."""
    return np.array(np.broadcast_to(value, shape), dtype=float)[()]


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


def _assert_allowed(values: Arrays) -> None:
    for symbol, array in values.items():
        words, allowed = range_of(symbol)
        good = allowed(array) & (array == np.floor(array)) if symbol.is_integer else allowed(array)
        for right, said in ((np.isfinite(array), "finite numbers are"), (good, f"{words} is")):
            _refuse(right, lambda at: f"{symbol.in_code} = {array[at]:g}: {said} allowed")  # noqa: B023


def _assert_together(values: Arrays) -> None:
    for pair, (words, together) in TOGETHER.items():
        if set(pair) <= set(values):
            right = together(*(values[symbol] for symbol in pair))
            _refuse(right, lambda at: f"{_with_values(pair, values, at)}: {words} is allowed")  # noqa: B023


def _with_values(symbols: Iterable[sympy.Symbol], values: Arrays, at: tuple[int, ...]) -> str:
    return ", ".join(f"{text(symbol)} = {values[symbol][at]:g}" for symbol in symbols)


def _refuse(right: Any, words: Callable[[tuple[int, ...]], str]) -> None:
    """Raise for the first element that is not right."""
    if not np.all(right):
        at = tuple(int(place) for place in np.argwhere(np.logical_not(right))[0])
        raise ArgumentError(f"{at_element(at)}{words(at)}")


def _docstring(
    heading: str,
    by_name: Mapping[str, sympy.Symbol],
    meanings: Mapping[sympy.Basic, str],
) -> str:
    lines = [heading, ""]
    lines.append("Args:")
    for name, symbol in by_name.items():
        meaning = meanings.get(symbol) or _MEANINGS.get(symbol)
        allowed, _ = range_of(symbol)
        lines.append(f"    {name}: {f'{meaning}; ' if meaning else ''}{allowed}.")
    lines += [
        "",
        "Numbers or arrays that broadcast; float64 comes back, in their shape.",
        "",
        "Raises:",
        "    ArgumentError: a value is not allowed.",
    ]
    return "\n".join(lines)
