"""Averages over the layers: the closed form against the layers one by one."""

from dataclasses import replace

import pytest
import sympy
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.symbols import phi, r, sigma
from force_diffusion.symbolic.variances.averages import layer_average, uniform_order
from force_diffusion.symbolic.variances.variance import packings, value_at

MODULES = pytest.mark.parametrize("module", [eq13, eq14], ids=["surface", "bulk"])


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


@MODULES
def test_a_bound_for_all_layers_holds_and_is_no_better_than_it_can_be(module) -> None:
    forms = module.exact_forms()
    printed = module.PRINTED.rhs
    assert uniform_order(forms, printed) == 2
    assert uniform_order(forms, 2 * printed) == 3
    base = forms["base"]  # right in the interior, wrong at the base alone
    wrong = replace(base, value=base.value * FIELD.constant(2))
    assert uniform_order({**forms, "base": wrong}, printed) == 3
