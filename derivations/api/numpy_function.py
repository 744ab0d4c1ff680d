"""A formula as a function for NumPy, in float64, with a signature and a docstring of its own."""

import inspect
import numbers
from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from typing import Any

import numpy as np
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.text import text

from ..framework.arrays import at_element, one_or_tuple, shared_shape
from ..framework.evaluation import TOGETHER, ArgumentError, in_order, range_of

Arrays = dict[sympy.Symbol, Any]
"""Float64 arrays of one shape, by symbol."""

_MEANINGS = {sy.M: "height of the packing", sy.j: "layer, 0 at the base"}


def numpy_function(
    expressions: Sequence[sympy.Expr], name: str, heading: str, meanings: Mapping[sympy.Basic, str]
) -> Callable[..., Any]:
    """The function; it refuses what ``Equation.at`` refuses.

    Args:
        expressions: one, or several that are evaluated together.
        name: of the function.
        heading: first line of its docstring.
        meanings: of symbols, in words.
    """
    needed = {s.in_code: s for one in expressions for s in one.free_symbols}
    by_name = {one: needed[one] for one in in_order(needed)}
    sides = [sympy.lambdify(by_name.values(), side, "numpy") for side in expressions]
    signature = inspect.Signature(
        [inspect.Parameter(one, inspect.Parameter.POSITIONAL_OR_KEYWORD) for one in by_name]
    )

    def function(*args: Any, **kwargs: Any) -> Any:
        given = signature.bind(*args, **kwargs).arguments
        arrays = {one: _floats(one, given[one]) for one in by_name}
        shape = shared_shape({one: array for one, array in arrays.items() if array.ndim})
        values = {by_name[one]: np.broadcast_to(array, shape) for one, array in arrays.items()}
        _assert_allowed(values)
        with np.errstate(all="ignore"):
            results = [_spread(side(*values.values()), shape) for side in sides]
        for one in results:
            _refuse(np.isfinite(one), lambda _: "the value is beyond the range of floats: use at")
        return one_or_tuple(results)

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
    if array.dtype != object or not all(isinstance(x, numbers.Real | Decimal) for x in array.flat):
        raise TypeError
    return np.vectorize(float, otypes=[float])(array)


def _assert_allowed(values: Arrays) -> None:
    for symbol, array in values.items():
        words, allowed = range_of(symbol)
        good = allowed(array) & (array == np.floor(array)) if symbol.is_integer else allowed(array)
        for right, said in ((np.isfinite(array), "finite numbers are"), (good, f"{words} is")):
            _refuse(right, lambda at: f"{symbol.in_code} = {array[at]:g}: {said} allowed")  # noqa: B023
    for pair, (words, together) in TOGETHER.items():
        if set(pair) <= set(values):
            right = together(*(values[symbol] for symbol in pair))
            message = ", ".join(f"{text(s)} = {{:g}}" for s in pair) + f": {words} is allowed"
            given = [values[symbol] for symbol in pair]
            _refuse(right, lambda at: message.format(*(one[at] for one in given)))  # noqa: B023


def _refuse(right: Any, words: Callable[[tuple[int, ...]], str]) -> None:
    """Raise for the first element that is not right."""
    if not np.all(right):
        at = tuple(int(place) for place in np.argwhere(np.logical_not(right))[0])
        raise ArgumentError(f"{at_element(at)}{words(at)}")


def _docstring(
    heading: str, by_name: Mapping[str, sympy.Symbol], meanings: Mapping[sympy.Basic, str]
) -> str:
    lines = [heading, "", "Args:"]
    for name, symbol in by_name.items():
        meaning = meanings.get(symbol) or _MEANINGS.get(symbol)
        allowed, _ = range_of(symbol)
        lines.append(f"    {name}: {f'{meaning}; ' if meaning else ''}{allowed}.")
    lines += ["", "Numbers or arrays that broadcast; float64 comes back, in their shape.", ""]
    lines += ["Raises:", "    ArgumentError: a value is not allowed."]
    return "\n".join(lines)
