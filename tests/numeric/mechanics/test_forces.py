"""What the sweep of forces can't do: said, with the bead."""

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.lattice.layers import Layer, Region
from force_diffusion.numeric.mechanics.sweep import NotStandingError, check_standing

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
