"""Averages over the layers: the closed form against the layers one by one."""

import pytest
import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.symbolic.symbols import phi, r, sigma
from force_diffusion.symbolic.variances.averages import layer_average
from force_diffusion.symbolic.variances.variance import packings, value_at

MODULES = pytest.mark.parametrize("module", [eq13, eq14], ids=["surface", "bulk"])


@pytest.mark.long(sample=1)
@MODULES
def test_it_is_the_mean_of_the_layers(module) -> None:
    forms = module.exact_forms()
    average = layer_average(forms)
    at = {phi: sympy.Rational(-2, 7), sigma: sympy.Integer(3), r: sympy.Rational(5, 2)}
    totals: dict[int, sympy.Expr] = {}
    for height, layer, case in packings(12):
        value = value_at(forms, height, layer, case).xreplace(at)
        totals[height] = totals.get(height, sympy.Integer(0)) + value
    for height, total in totals.items():
        assert average.value_at(height).xreplace(at) == total / height
