"""Averages over the layers: the closed form against the layers one by one."""

from fractions import Fraction

import pytest
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import M, phi, r, sigma
from force_diffusion.symbolic.variances.averages import layer_average

import force_diffusion as fd


@pytest.mark.parametrize("number", [13, 14])
def test_it_is_the_mean_of_the_layers(number: int) -> None:
    of_layer = fd.equation(number).exact()
    average = layer_average(of_layer.function)
    values: explicit.Values = {phi: Fraction(-2, 7), sigma: 3, r: Fraction(5, 2)}
    numbers = {symbol.name: value for symbol, value in values.items()}
    small = dict(average.exceptions)
    for height in range(1, 13):
        layers = of_layer.at(**numbers, M=height, j=range(height))
        form = small.get(height, average.expression)
        assert explicit.number(form, {**values, M: height}) == Fraction(str(sum(layers) / height))
