"""The right-hand side of an equation as a NumPy function, with a docstring of its own."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import Any

import numpy as np
import sympy
from force_diffusion.symbolic import symbols as sy

from ..framework.evaluation import in_order, range_of, unpacked

_MEANINGS = {sy.M: "height of the packing", sy.j: "layer, 0 at the base"}


def numpy_function(
    expressions: Sequence[sympy.Expr],
    name: str,
    heading: str,
    meanings: Mapping[sympy.Basic, str],
) -> Callable[..., Any]:
    """The function, of float64; it computes what SymPy's ``lambdify`` writes.

    Args:
        expressions: one, or several that are evaluated together.
        name: of the function.
        heading: first line of its docstring.
        meanings: of symbols, in words.
    """
    needed = {symbol.in_code: symbol for side in expressions for symbol in side.free_symbols}
    by_name = {name: needed[name] for name in in_order(needed)}
    formulas = sympy.lambdify(by_name.values(), list(expressions), "numpy")
    bind = inspect.signature(formulas).bind

    @wraps(formulas)
    def function(*args: Any, **kwargs: Any) -> Any:
        arrays = (np.asanyarray(value, float) for value in bind(*args, **kwargs).arguments.values())
        return unpacked(formulas(*np.broadcast_arrays(*arrays, subok=True)))

    function.__name__ = function.__qualname__ = name
    function.__doc__ = _docstring(heading, by_name, meanings)
    return function


def _docstring(
    heading: str, by_name: Mapping[str, sympy.Symbol], meanings: Mapping[sympy.Basic, str]
) -> str:
    lines = [heading, "", "Args:"]
    for name, symbol in by_name.items():
        meaning = meanings.get(symbol) or _MEANINGS.get(symbol)
        allowed, _ = range_of(symbol)
        lines.append(f"    {name}: {f'{meaning}; ' if meaning else ''}{allowed}.")
    lines += [
        "",
        "Numbers or arrays that broadcast; float64 comes back, in their shape. Ranges are",
        "not checked here: ``Equation.at`` does that.",
    ]
    return "\n".join(lines)
