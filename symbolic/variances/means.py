"""Means of products of two linear forms, in closed form for every layer.

The radii are independent with variance σ², so the mean of a product of two forms without constant
terms is σ² times the sum of the products of their weights: a quarter of Var(x+y) − Var(x−y).
"""

from collections.abc import Callable, Iterator

import sympy
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.symbols import M, j
from force_diffusion.symbolic.variances.cases import DEEPEST, Case, at_value
from force_diffusion.symbolic.variances.variance import (
    CASES,
    ClosedForm,
    variance,
    without_constant,
)
from force_diffusion.symbolic.variances.weights import UndeterminedError, take_apart


def covariance(x: sympy.Expr, y: sympy.Expr, region: Region) -> RationalFunction:
    """Covariance of two linear expressions in δr, exact in the region."""
    return (variance(x + y, region) - variance(x - y, region)) / FIELD.constant(4)


Layered = Callable[[dict[sympy.Symbol, sympy.Expr], Region], RationalFunction]
"""A value of a layer: what stands for indices there, and the region of those that are left."""


def by_layer(value: Layered) -> dict[str, ClosedForm]:
    """Closed forms at every 0 ≤ j < M: interior, both edges, and the packings that these miss."""

    def form(name: str) -> ClosedForm:
        at, region, validity, missed = CASES[name]
        exceptions = []
        for height in missed:
            size = {M: sympy.Integer(height)}
            layer = at[j].xreplace(size)
            small = value({**size, j: layer}, Region({}))
            exceptions.append((height, int(layer), small.to_sympy()))
        return ClosedForm(validity, tuple(exceptions), value(at, region))

    return {name: form(name) for name in CASES}


def covariances_by_case(
    x: sympy.Expr, y: sympy.Expr, lower: dict[sympy.Symbol, int], generic: int
) -> Iterator[Case]:
    """Σ of the products of both weights for all indices from their lower bounds on.

    As :func:`symbolic.variances.cases.squares_by_case`, for two expressions.
    """
    reader = Reader(Region(dict(lower)))
    first, second = (without_constant(reader.scalar(one)) for one in (x, y))
    yield from _by_case((first + second, first - second), lower, generic, {})


def _by_case(
    pair: tuple[LinearForm, LinearForm],
    lower: dict[sympy.Symbol, int],
    generic: int,
    at: dict[sympy.Symbol, int],
) -> Iterator[Case]:
    symbol = min(lower, key=lambda index: lower[index], default=None)
    try:
        if symbol is None or lower[symbol] >= generic:
            region = Region(dict(lower))
            both, apart = (take_apart(form, region).sum_of_squares() for form in pair)
            yield Case(at, lower, (both - apart) / FIELD.constant(4))
            return
    except UndeterminedError:
        if symbol is None or lower[symbol] >= DEEPEST:
            raise
    bound = lower[symbol]
    others = {index: least for index, least in lower.items() if index != symbol}
    fixed = at_value(pair[0], symbol, bound), at_value(pair[1], symbol, bound)
    yield from _by_case(fixed, others, generic, {**at, symbol: bound})
    yield from _by_case(pair, {**lower, symbol: bound + 1}, generic, at)
