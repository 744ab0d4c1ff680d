"""Covariances of linear forms, against weights on explicit sites."""

from fractions import Fraction

import pytest
import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.variances.means import covariance

DIAGONAL = sympy.Sum(sy.DeltaR(sy.i - sy.j + sy.m, sy.m), (sy.m, 1, sy.j + 3))
OTHER = sympy.Sum(sy.m * sy.DeltaR(sy.i + sy.j - sy.m, sy.m), (sy.m, 1, sy.j + 2))
ALONE = sy.phi * sy.DeltaR(sy.i, sy.j) - sy.DeltaR(sy.i - 2, sy.j)


@pytest.mark.parametrize(
    ("one", "two"), [(DIAGONAL, OTHER), (DIAGONAL, ALONE), (OTHER, ALONE), (ALONE, ALONE)]
)
def test_it_is_the_sum_of_products_of_weights(one: sympy.Expr, two: sympy.Expr) -> None:
    found = covariance(one, two, Region({sy.j: 2})).to_sympy()
    for layer in range(2, 6):
        at = {sy.i: layer, sy.j: layer, sy.phi: Fraction(2, 7), sy.sigma: 3}
        first, second = (explicit.weights(form, at) for form in (one, two))
        total = sum((w * second.get(site, 0) for site, w in first.items()), Fraction(0))
        assert total != 0
        assert explicit.number(found, at) == 9 * total
