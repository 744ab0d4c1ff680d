"""A formula as a function for NumPy, in float64, with a signature and a docstring of its own."""

import inspect
import numbers
from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from typing import Any

import numpy as np
import sympy
from force_diffusion.numeric.arithmetic.errors import ArgumentError, quoted
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.printing.text import text

from ..framework.evaluation import TOGETHER, at_element, in_order, range_of, shared_shape, unpacked

Arrays = dict[sympy.Symbol, Any]
"""Float64 arrays of one shape, by symbol."""

REAL = numbers.Real | Decimal
_MEANINGS = {sy.M: "height of the packing", sy.j: "layer, 0 at the base"}


class NumpyFunction:
    """The function; it refuses what ``Equation.at`` refuses.

    Args:
        expressions: one, or several that are evaluated together.
        name: of the function.
        heading: first line of its docstring.
        meanings: of symbols, in words.
        equation: whose function it is; pickles hold that alone.
    """

    def __init__(
        self,
        expressions: Sequence[sympy.Expr],
        name: str,
        heading: str,
        meanings: Mapping[sympy.Basic, str],
        equation: Any,
    ) -> None:
        needed = {symbol.in_code: symbol for side in expressions for symbol in side.free_symbols}
        self._by_name = {name: needed[name] for name in in_order(needed)}
        self._sides = [sympy.lambdify(self._by_name.values(), rhs, "numpy") for rhs in expressions]
        self._equation = equation
        kind = inspect.Parameter.POSITIONAL_OR_KEYWORD
        self.__signature__ = inspect.Signature([inspect.Parameter(n, kind) for n in self._by_name])
        self.__name__ = self.__qualname__ = name
        self.__doc__ = _docstring(heading, self._by_name, meanings)

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        """Evaluate in float64; raises ``ArgumentError`` for what is not allowed."""
        given = self.__signature__.bind(*args, **kwargs).arguments
        arrays = {name: _floats(name, given[name]) for name in self._by_name}
        shape = shared_shape({name: array for name, array in arrays.items() if array.ndim})
        values = {self._by_name[n]: np.broadcast_to(array, shape) for n, array in arrays.items()}
        _assert_allowed(values)
        with np.errstate(all="ignore"):
            results = [side(*values.values()) for side in self._sides]
        for result in results:
            _refuse(
                np.isfinite(result), lambda _: "the value is beyond the range of floats: use at"
            )
        # a side may not depend on all of the arrays
        return unpacked([np.array(np.broadcast_to(side, shape), float)[()] for side in results])

    def __reduce__(self) -> tuple[Callable[[Any], Any], tuple[Any]]:
        return type(self._equation).function, (self._equation,)

    def __repr__(self) -> str:
        return f"{self.__name__}{self.__signature__}"


def _floats(name: str, value: Any) -> Any:
    try:
        array = np.asarray(value)
        exact = array.dtype == object and all(isinstance(x, REAL) for x in array.flat)
        if isinstance(value, np.ma.MaskedArray) or not (exact or array.dtype.kind in "iuf"):
            raise TypeError
        return array.astype(float)
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(
            f"{name} = {quoted(value)}: numbers are allowed, and arrays of them without a mask"
        ) from None


def _assert_allowed(values: Arrays) -> None:
    for symbol, array in values.items():
        words, allowed = range_of(symbol)
        good = allowed(array) & (array == np.floor(array)) if symbol.is_integer else allowed(array)
        for right, kinds in ((np.isfinite(array), "finite numbers are"), (good, f"{words} is")):
            _refuse(right, lambda at: f"{symbol.in_code} = {array[at]:g}: {kinds} allowed")  # noqa: B023
    for pair, (words, together) in TOGETHER.items():
        if set(pair) <= set(values):
            right = together(*(values[symbol] for symbol in pair))
            message = ", ".join(f"{text(s)} = {{:g}}" for s in pair) + f": {words} is allowed"
            given = [values[symbol] for symbol in pair]
            _refuse(right, lambda at: message.format(*(array[at] for array in given)))  # noqa: B023


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
