"""Means of products of two linear forms, in closed form for every layer.

The radii are independent with variance σ², so the mean of a product of two forms without constant
terms is σ² times the sum of the products of their weights: a quarter of Var(x+y) − Var(x−y).
"""

from collections.abc import Iterator

import sympy
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm
from force_diffusion.symbolic.algebra.reading import Reader
from force_diffusion.symbolic.algebra.weights import take_apart
from force_diffusion.symbolic.variances.cases import Case, by_case
from force_diffusion.symbolic.variances.variance import (
    variance,
    without_constant,
)


def covariance(x: sympy.Expr, y: sympy.Expr, region: Region) -> RationalFunction:
    """Covariance of two linear expressions in δr, exact in the region."""
    return (variance(x + y, region) - variance(x - y, region)) / FIELD.constant(4)


def covariances_by_case(
    x: sympy.Expr, y: sympy.Expr, lower: dict[sympy.Symbol, int], generic: int
) -> Iterator[Case]:
    """Σ of the products of both weights for all indices from their lower bounds on.

    As :func:`symbolic.variances.cases.by_case`, for two expressions.
    """
    reader = Reader(Region(dict(lower)))
    first, second = (without_constant(reader.scalar(one)) for one in (x, y))
    return by_case((first + second, first - second), lower, generic, _quarter)


def _quarter(forms: tuple[LinearForm, ...], region: Region) -> RationalFunction:
    both, apart = (take_apart(form, region).sum_of_squares() for form in forms)
    return (both - apart) / FIELD.constant(4)
