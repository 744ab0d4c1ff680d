"""The right-hand side of an equation as a NumPy function, with a docstring of its own."""

import inspect
from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import Any

import numpy as np
import sympy

from ..framework.evaluation import in_order, range_of, unpacked

_DOCSTRING = """{}

Args:
{}

Numbers or arrays that broadcast; float64 comes back, in their shape. Ranges are not checked
here: ``Equation.at`` does that.
"""


def numpy_function(
    expressions: Sequence[sympy.Expr], name: str, heading: str, meanings: Mapping[sympy.Basic, str]
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

    lines = []
    for symbol_name, symbol in by_name.items():
        allowed, _ = range_of(symbol)
        meaning = f"{meanings[symbol]}; " if symbol in meanings else ""
        lines.append(f"    {symbol_name}: {meaning}{allowed}.")
    function.__name__ = function.__qualname__ = name
    function.__doc__ = _DOCSTRING.format(heading, "\n".join(lines))
    return function
