"""What the sweep of forces can't do, and signs that it can't tell: said, with the bead."""

import flint
import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import UndecidedError
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls
from force_diffusion.numeric.lattice.branch import Branch, Contact
from force_diffusion.numeric.lattice.layers import Layer, Region
from force_diffusion.numeric.mechanics.sweep import (
    NotStandingError,
    check_standing,
    first_tension,
)

REGION = Region(None, ())


@pytest.mark.parametrize("place", [0, 1, 3])
def test_the_bead_whose_contacts_are_parallel_is_named(place: int) -> None:
    layer = Layer(j=3, first=-1, count=4)
    det = np.ones((2, layer.count))
    check_standing(det, layer, REGION, FLOAT64)
    det[1, place] = 0
    with pytest.raises(NotStandingError, match="parallel") as caught:
        check_standing(det, layer, REGION, FLOAT64)
    assert caught.value.site == (layer.sites()[place], 3)


def test_balls_too_wide_for_a_sign_ask_for_more_digits() -> None:
    system = Balls(64)
    layer = Layer(j=2, first=0, count=2)
    wide = np.array([flint.arb(1), flint.arb(0, 1)], dtype=object)
    sure = np.array([flint.arb(1), flint.arb(2)], dtype=object)
    zero = sure * 0
    with system.active():
        assert first_tension(layer, REGION, (sure, sure), (zero, zero), system) is None
        with pytest.raises(UndecidedError, match="layer 2"):
            first_tension(layer, REGION, (sure, wide), (zero, zero), system)
        pulls = first_tension(layer, REGION, (sure, wide - 3), (zero, zero), system)
    assert pulls == Contact(1, 1, Branch.MINUS)
