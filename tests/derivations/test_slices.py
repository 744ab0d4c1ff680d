"""Slices of spheres: a form is taken for the lowest packing only where it is that packing's."""

import pytest
import sympy
from force_diffusion.derivations.beyond.slices import BULK, SURFACE, Carried, variance
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.symbols import M, j
from force_diffusion.symbolic.variances.weights import UndeterminedError


@pytest.mark.parametrize("carried", [SURFACE, BULK])
def test_a_packing_that_is_a_case_of_its_own_is_not_swallowed(carried: Carried) -> None:
    base = {j: sympy.Integer(0)}
    assert variance(carried, base, Region({M: 2}))
    with pytest.raises(UndeterminedError):
        variance(carried, base, Region({M: 1}))  # M = 1 has another variance
