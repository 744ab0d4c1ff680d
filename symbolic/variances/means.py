"""Means of products of two linear forms, in closed form for every layer.

The radii are independent with variance σ², so the mean of a product of two forms without constant
terms is σ² times the sum of the products of their weights: a quarter of Var(x+y) − Var(x−y).
"""

from collections.abc import Callable

import sympy
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.symbols import M, j
from force_diffusion.symbolic.variances.variance import CASES, ClosedForm, variance


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
