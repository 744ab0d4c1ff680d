"""Eq. 15: exact averages over the layers against exact packings."""

from fractions import Fraction

from force_diffusion.derivations import eq15_general_form as eq15
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import M, sigma

from tests.soundness.witnesses.draws import SmallPacking
from tests.soundness.witnesses.squared_weights import weights_of_forces


def test_averages_are_means_of_squared_weights(packing: SmallPacking) -> None:
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1}
    averages = eq15.averages()
    assert averages
    for load, average in averages.items():
        small = dict(average.exceptions)
        for height in range(1, 5):
            form = small.get(height, average.expression)
            layers = weights_of_forces(height, packing.n, load)
            total = sum((w**2 for layer in layers for w in layer.values()), Fraction(0))
            mean = explicit.number(form, {**values, M: height})
            assert mean == total / height, (load, height)
