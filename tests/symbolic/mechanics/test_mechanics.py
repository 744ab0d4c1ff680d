"""Paths and mirror images: each is the inverse of the other way round."""

import pytest
import sympy
from force_diffusion.derivations.framework.catalogue import paper
from force_diffusion.derivations.framework.loading import load
from force_diffusion.symbolic.mechanics.lattice import mirror
from force_diffusion.symbolic.mechanics.paths import (
    IN_CONE,
    STEPS_BELOW,
)
from force_diffusion.symbolic.symbols import k, l, p, q


def test_steps_below_a_bead_lead_back_to_it() -> None:
    for steps in (p, q):
        assert sympy.expand(STEPS_BELOW[steps].xreplace(IN_CONE)) == steps
    for index in (k, l):
        assert sympy.expand(IN_CONE[index].xreplace(STEPS_BELOW)) == index


@pytest.mark.long(sample=6)
@pytest.mark.parametrize("number", [n for n in paper() if n <= 11])
def test_twice_mirrored_is_the_same(number: int) -> None:
    for printed in load(number).printed:
        assert mirror(mirror(printed)).doit() == printed.doit()
