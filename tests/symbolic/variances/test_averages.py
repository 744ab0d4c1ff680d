"""Averages over the layers: the closed form against the layers one by one."""

from fractions import Fraction

import pytest
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import M, phi, r, sigma
from force_diffusion.symbolic.variances.averages import layer_average

from tests.soundness.witnesses.comparing import stated

MODULES = pytest.mark.parametrize("module", [eq13, eq14], ids=["surface", "bulk"])


@pytest.mark.long(sample=1)
@MODULES
def test_it_is_the_mean_of_the_layers(module) -> None:
    average = layer_average(module.exact_forms())
    values: explicit.Values = {phi: Fraction(-2, 7), sigma: 3, r: Fraction(5, 2)}
    totals: dict[int, Fraction] = {}
    for height, _, value in stated(module.VARIANCE, 12, values):
        totals[height] = totals.get(height, Fraction(0)) + value
    small = dict(average.exceptions)
    for height, total in totals.items():
        form = small.get(height, average.expression)
        assert explicit.number(form, {**values, M: height}) == total / height
