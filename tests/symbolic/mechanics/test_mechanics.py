"""Paths and mirror images: each is the inverse of the other way round."""

import pytest
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.record import load
from force_diffusion.symbolic.mechanics.lattice import mirror


@pytest.mark.long(sample=6)
@pytest.mark.parametrize("number", [n for n in paper() if n <= 11])
def test_twice_mirrored_is_the_same(number):
    for printed in load(number).printed:
        assert mirror(mirror(printed)).doit() == printed.doit()
