"""Arrays of arguments: a formula is evaluated for each element, and each as if it were alone."""

from collections.abc import Callable, Mapping, Sequence, Set
from typing import Any

import numpy as np
import sympy

from .evaluation import EXACT, ArgumentError, arguments, read_arguments, rounded
from .lists import both


def evaluate(
    formula: tuple[str, set[sympy.Symbol]],
    sides: Sequence[Callable[[Mapping[sympy.Symbol, sympy.Rational], bool], sympy.Expr]],
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
        given: values by name.
        dimension: as for ``read_arguments``.
        in_packing: as for ``read_arguments``.

    Raises:
        ArgumentError: a name is unknown or missing, a value is not allowed, or shapes differ; the
            message names the element.
    """

    def at(numbers: Mapping[str, Any]) -> list[Any]:
        values, exact = read_arguments(*formula, numbers, dimension, in_packing=in_packing)
        return [side(values, True) if exact else rounded(side(values, False)) for side in sides]

    arrays = {name: _array(name, value) for name, value in given.items() if is_several(value)}
    single = {
        name: value[()] if isinstance(value, np.ndarray) else value
        for name, value in given.items()
        if name not in arrays
    }
    if not arrays:
        return one_or_tuple(at(single))
    arguments(*formula, given)
    shape = shared_shape(arrays)
    spread = {name: np.broadcast_to(array, shape) for name, array in arrays.items()}
    rows = []
    for place in np.ndindex(shape):
        try:
            rows.append(at(single | {name: _element(one, place) for name, one in spread.items()}))
        except ArgumentError as error:
            raise ArgumentError(f"{at_element(place)}{error}") from None
    exact = all(isinstance(one, EXACT) for one in single.values())
    exact = exact and all(map(_is_exact, arrays.values()))
    return one_or_tuple(
        [_collected([row[n] for row in rows], shape, exact=exact) for n in range(len(sides))]
    )


def one_or_tuple(values: Sequence[Any]) -> Any:
    """The value of a single side, or a tuple of several."""
    return values[0] if len(values) == 1 else tuple(values)


def is_several(value: Any) -> bool:
    """Whether it is an array, or a sequence that is read as one."""
    if isinstance(value, str | bytes | Mapping | Set):
        return False
    return bool(np.ndim(value)) if hasattr(value, "__array__") else hasattr(value, "__len__")


def shared_shape(arrays: Mapping[str, Any]) -> tuple[int, ...]:
    """The shape that arrays are broadcast to.

    Raises:
        ArgumentError: there is none.
    """
    shapes = {name: np.shape(array) for name, array in arrays.items()}
    try:
        return np.broadcast_shapes(*shapes.values())
    except ValueError:
        shown = both([f"{name} of shape {shape}" for name, shape in shapes.items()])
        raise ArgumentError(
            f"{shown} do not go together: give arrays of one shape, or shapes that NumPy broadcasts"
        ) from None


def at_element(place: tuple[int, ...]) -> str:
    """Where in an array something is wrong; nothing for a single number."""
    return f"element [{', '.join(map(str, place))}]: " if place else ""


def _array(name: str, value: Any) -> Any:
    """The array; of a sequence one of objects, so that exact numbers stay what they are."""
    if isinstance(value, np.ma.MaskedArray):
        raise ArgumentError(f"{name} is a masked array: give one without a mask")
    if hasattr(value, "__array__"):
        return np.asarray(value)
    made = np.empty(len(value), dtype=object)
    for place, one in enumerate(value):
        made[place] = one
    nested = [one for one in made if is_several(one)]
    if len(nested) == len(made) and len({np.shape(one) for one in nested}) == 1:
        return np.array([_array(name, one) for one in made], dtype=object)
    return made


def _element(array: Any, place: tuple[int, ...]) -> Any:
    """One element; a number of NumPy's as one of Python's, as messages write it."""
    one = array[place]
    return one.item() if isinstance(one, np.generic) else one


def _is_exact(array: Any) -> bool:
    if array.dtype == object:
        return all(isinstance(one, EXACT) for one in array.flat)
    return array.dtype.kind in "iu"


def _collected(values: list[Any], shape: tuple[int, ...], *, exact: bool) -> Any:
    if exact:
        made = np.empty(len(values), dtype=object)
        made[:] = values
    else:
        floats = [rounded(one) if isinstance(one, sympy.Expr) else one for one in values]
        made = np.array(floats, dtype=float)
    return made.reshape(shape)
