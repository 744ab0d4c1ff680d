"""The same expressions on an explicit small packing, with Fractions: a second, plain reading.

Nothing is shared with the normal form but SymPy's tree: vectors are Cartesian, sums are loops,
braces are looked up. It finds counterexamples, and the tests hold the normal form against it.
"""

from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import lru_cache
from math import prod

import sympy

from .. import symbols as sy

Weights = dict[tuple[str, int, int], Fraction]
"""Weight of each lattice quantity (family, i, j); ("", 0, 0) is the constant term."""

Vector = tuple[Weights, Weights]
Values = Mapping[sympy.Symbol, Fraction | int]

_CONSTANT = ("", 0, 0)
_ZERO, _ONE = Fraction(0), Fraction(1)


class AmbiguousError(ValueError):
    """The expression has no single value here."""


class DivisionError(AmbiguousError):
    """It has none because it divides by zero here."""


class _Explicit(dict[sympy.Symbol, Fraction | int]):
    """Values, and what was read with them: expressions that differ in a place share the others."""

    def __init__(self, values: Mapping[sympy.Symbol, Fraction | int]) -> None:
        super().__init__(values)
        self.read: dict[sympy.Expr, Weights | Vector] = {}


@lru_cache(maxsize=2048)
def _of(values: frozenset[tuple[sympy.Symbol, Fraction | int]]) -> _Explicit:
    return _Explicit(dict(values))


def _explicit(values: Values) -> _Explicit:
    return values if isinstance(values, _Explicit) else _of(frozenset(values.items()))


class ReversedError(AmbiguousError):
    """It has none because a sum's bounds are reversed here: empty in a loop, not so for SymPy."""


def terms_of(low: Fraction, high: Fraction) -> range:
    """The values of an index that is summed over; none where ``high`` is ``low`` less one.

    Raises:
        ReversedError: it is lower still.
        AmbiguousError: one of them is no whole number.
    """
    if low.denominator != 1 or high.denominator != 1:
        raise AmbiguousError(f"a sum from {low} to {high}")
    if high < low - 1:
        raise ReversedError(f"a sum from {low} to {high}")
    return range(int(low), int(high) + 1)


def geometry(n_x: Fraction, n_y: Fraction, radius: Fraction) -> dict[sympy.Symbol, Fraction | int]:
    """Values of the geometric symbols for rational base vectors n^± = (±n_x, n_y)."""
    if n_x**2 + n_y**2 != 1:
        raise ValueError(f"({n_x}, {n_y}) is not a unit vector")
    return {
        sy.n_x: n_x,
        sy.n_y: n_y,
        sy.phi: n_y**2 - n_x**2,
        sy.r: radius,
        sy.spacing: 4 * n_x * radius,
    }


def weights(expression: sympy.Expr, values: Values) -> Weights:
    """Weights of a scalar, linear expression; zero weights are left out."""
    result = _read(expression, _explicit(values))
    if isinstance(result, tuple):
        if not result[0] and not result[1]:
            return {}
        raise AmbiguousError(f"{expression} is a vector")
    return result


def vector_weights(expression: sympy.Expr, values: Values) -> Vector:
    """Weights of the Cartesian components of a vector expression."""
    result = _read(expression, _explicit(values))
    if isinstance(result, tuple):
        return result
    if not result:
        return {}, {}
    raise AmbiguousError(f"{expression} is no vector")


def number(expression: sympy.Expr, values: Values) -> Fraction:
    """Value of an expression that holds no lattice quantity."""
    result = weights(expression, values)
    if set(result) - {_CONSTANT}:
        raise AmbiguousError(f"{expression} holds lattice quantities")
    return result.get(_CONSTANT, Fraction(0))


def _accumulate(total: Weights, part: Weights) -> None:
    for key, weight in part.items():
        value = total[key] + weight if key in total else weight
        if value:
            total[key] = value
        else:
            del total[key]


def _sum(*parts: Weights) -> Weights:
    total: Weights = {}
    for part in parts:
        _accumulate(total, part)
    return total


def _base_vectors(values: Values) -> dict[sympy.Symbol, tuple[Fraction, Fraction]]:
    if sy.n_x not in values:
        raise AmbiguousError("no values for the base vectors")
    x, y = Fraction(values[sy.n_x]), Fraction(values[sy.n_y])
    return {
        sy.n_plus: (x, y),
        sy.n_minus: (-x, y),
        sy.b_plus: (1 / (2 * x), 1 / (2 * y)),
        sy.b_minus: (-1 / (2 * x), 1 / (2 * y)),
        sy.e_y: (Fraction(0), Fraction(1)),
    }


def _read(expression: sympy.Expr, values: _Explicit) -> Weights | Vector:
    found = values.read.get(expression)
    if found is None:
        found = values.read[expression] = _read_anew(expression, values)
    return found


def _read_anew(expression: sympy.Expr, values: _Explicit) -> Weights | Vector:
    if isinstance(expression, sympy.Rational):
        value = Fraction(int(expression.p), int(expression.q))
        return {_CONSTANT: value} if value else {}
    if isinstance(expression, sympy.Symbol):
        if expression in values:
            return {_CONSTANT: Fraction(values[expression])} if values[expression] else {}
        if expression in sy.VECTORS:
            one = {_CONSTANT: _ONE}
            return tuple(_scaled(one, c) for c in _base_vectors(values)[expression])  # type: ignore[return-value]
        raise AmbiguousError(f"no value for {expression}")
    if isinstance(expression, sy.SecondDifference):
        return _read(expression.doit(), values)
    if isinstance(expression, sy.SiteFunction):
        return _atom(expression, values)
    if isinstance(expression, sympy.Add):
        return _total([_read(term, values) for term in expression.args])
    if isinstance(expression, sympy.Mul):
        return _product([_read(factor, values) for factor in expression.args])
    if isinstance(expression, sympy.Pow):
        base, exponent = number(expression.base, values), number(expression.exp, values)
        if exponent.denominator != 1:
            raise AmbiguousError(f"{expression} is no fraction")
        if base == 0 and exponent < 0:
            raise DivisionError(f"{expression} at {base}")
        power = base ** int(exponent)
        return {_CONSTANT: power} if power else {}
    if isinstance(expression, sympy.Sum):
        return _total(list(_terms(expression, values)))
    if isinstance(expression, sy.Braces):
        first, second, index, last = expression.args
        return _read(first if number(index, values) <= number(last, values) else second, values)
    if isinstance(expression, sy.Dot):
        u, v = (vector_weights(argument, values) for argument in expression.args)
        return _total([_product([u[0], v[0]]), _product([u[1], v[1]])])
    if isinstance(expression, sy.MatrixTimes):
        a, b, c, d = (number(entry, values) for entry in expression.args[:4])
        across, up = vector_weights(expression.args[4], values)
        return _sum(_scaled(across, a), _scaled(up, b)), _sum(_scaled(across, c), _scaled(up, d))
    raise AmbiguousError(f"{expression} is not read here")


def _scaled(form: Weights, factor: Fraction) -> Weights:
    if factor == 1:
        return form
    return {key: weight * factor for key, weight in form.items()} if factor else {}


def _atom(atom: sy.SiteFunction, values: Values) -> Weights | Vector:
    family, one = type(atom).__name__, _ONE
    site = (_index(atom.args[0], values), _index(atom.args[1], values))
    if not atom.is_vector:
        return {(family, *site): one}
    if isinstance(atom, sy.DeltaNPlus | sy.DeltaNMinus):
        base = _base_vectors(values)
        x, y = base[sy.b_minus if isinstance(atom, sy.DeltaNPlus) else sy.b_plus]
        return {(family, *site): x}, {(family, *site): y}
    return {(family + "x", *site): one}, {(family + "y", *site): one}


def _index(expression: sympy.Expr, values: Values) -> int:
    """Value of an index; sums of symbols and whole numbers, the usual case, stay in integers."""
    if isinstance(expression, sympy.Integer):
        return int(expression)
    if expression in values:
        value = values[expression]
        if value.denominator == 1:
            return int(value)
    if isinstance(expression, sympy.Add):
        return sum(_index(term, values) for term in expression.args)
    if isinstance(expression, sympy.Mul):
        return prod(_index(factor, values) for factor in expression.args)
    raise AmbiguousError(f"{expression} is no whole number here")


def _total(parts: list[Weights | Vector]) -> Weights | Vector:
    if any(isinstance(part, tuple) for part in parts):
        x: Weights = {}
        y: Weights = {}
        for part in parts:
            if not isinstance(part, tuple):
                if part:
                    raise AmbiguousError("a number added to a vector")
                continue
            _accumulate(x, part[0])
            _accumulate(y, part[1])
        return x, y
    total: Weights = {}
    for part in parts:
        assert isinstance(part, dict)
        _accumulate(total, part)
    return total


def _product(parts: list[Weights | Vector]) -> Weights | Vector:
    scale = _ONE
    linear: Weights | None = None
    vector: Vector | None = None
    for part in parts:
        if isinstance(part, tuple):
            if vector is not None:
                raise AmbiguousError("a product of two vectors")
            vector = part
        elif set(part) <= {_CONSTANT}:
            scale *= part.get(_CONSTANT, _ZERO)
        elif linear is not None:
            raise AmbiguousError("a product of two lattice quantities")
        else:
            linear = part
    if vector is None:
        return _scaled({_CONSTANT: _ONE} if linear is None else linear, scale)
    if linear is None:
        return _scaled(vector[0], scale), _scaled(vector[1], scale)
    x, y = (_product([linear, component]) for component in vector)
    assert isinstance(x, dict)
    assert isinstance(y, dict)
    return _scaled(x, scale), _scaled(y, scale)


def _terms(series: sympy.Sum, values: _Explicit) -> Iterator[Weights | Vector]:
    index, low, high = series.limits[-1]
    inner_limits = series.limits[:-1]
    body = sympy.Sum(series.function, *inner_limits) if inner_limits else series.function
    for value in terms_of(number(low, values), number(high, values)):
        yield _read(body, _explicit({**values, index: value}))
