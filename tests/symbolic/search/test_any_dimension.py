"""Explicit packings in any dimension: against the recursion along paths, and false statements."""

from dataclasses import replace
from fractions import Fraction

import pytest
from force_diffusion.derivations.beyond import t8_any_dimension as t8
from force_diffusion.symbolic.as_printed import equation
from force_diffusion.symbolic.kernel.any_dimension import (
    BULK,
    BULK_LEANING,
    SURFACE,
    SURFACE_LEANING,
)
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.search.any_dimension import RATIOS, contact
from force_diffusion.symbolic.search.counterexample import counterexample
from force_diffusion.symbolic.symbols import ForceOfLayer, M, Variance, d, j, phi
from sympy import Integer

from tests.numeric.mechanics.any_dimension import force_weights, squared, together

WHERE = Where((j, M), (j >= 2, j + 2 <= M), SURFACE, dimension=3)


@pytest.mark.parametrize("dimension", [2, 3, 4])
@pytest.mark.parametrize("loading", [SURFACE, BULK, SURFACE_LEANING, BULK_LEANING])
def test_it_is_what_the_recursion_gives(dimension: int, loading) -> None:
    cosine, height = Fraction(-1, 5), 4
    for layer in range(height):
        at = {j: Integer(layer), M: Integer(height)}
        ordered, change = contact(ForceOfLayer(j), at, dimension, cosine, loading.name)
        ratios = RATIOS[: dimension - 1] if "leaning" in loading.name else None
        bulk = "bulk" in loading.name
        both = force_weights(dimension, height, layer, cosine, bulk=bulk, ratios=ratios)
        assert ordered == 1
        assert sum(w**2 for w in change.values()) == squared(together(both))


def test_statements_at_finite_size() -> None:
    exact = t8.B13.forms["interior"].expression
    variance = Variance(ForceOfLayer(j))
    assert counterexample(equation(variance, exact), WHERE) is None
    assert counterexample(equation(variance, exact * (1 + phi / 1000)), WHERE)
    assert counterexample(equation(variance, exact), replace(WHERE, loading=BULK))
    assert counterexample(equation(variance, exact), replace(WHERE, dimension=d))
    leaning = t8.B24.forms["interior"].expression
    assert (
        counterexample(equation(variance, leaning), replace(WHERE, loading=SURFACE_LEANING)) is None
    )
    assert counterexample(equation(variance, leaning), replace(WHERE, loading=BULK_LEANING))
    assert counterexample(equation(variance, exact), replace(WHERE, loading=SURFACE_LEANING))
