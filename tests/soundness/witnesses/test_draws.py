"""What witnesses rest on: what is drawn is a packing, and its forces carry the load."""

from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.soundness.witnesses.draws import DIRECTIONS, draw
from tests.soundness.witnesses.squared_weights import weights_below_a_load


@given(st.integers(0, 10**6))
def test_draws_are_valid_packings(seed: int) -> None:
    packing = draw(seed)
    assert packing == draw(seed)
    assert packing.width > packing.height
    assert all((i + j) % 2 == 0 for i, j in (*packing.rho, packing.loaded, *packing.contacts))


@pytest.mark.parametrize("n", DIRECTIONS[:2])
def test_a_layer_carries_the_load_whatever_the_radii(n: tuple[Fraction, Fraction]) -> None:
    """The witness's own weights: vertical forces of one layer add up to f_load at order ε¹ too."""
    vertical, _ = weights_below_a_load(4, n)
    for layer in range(4):
        total: dict[tuple[int, int], Fraction] = {}
        for ((_, at), _), weights in vertical.items():
            for bead, weight in weights.items():
                total[bead] = total.get(bead, Fraction(0)) + weight * (at == layer)
        assert not any(total.values())
