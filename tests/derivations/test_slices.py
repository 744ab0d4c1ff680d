"""Slices of spheres: a form is taken for the lowest packing only where it is that packing's."""

import pytest
import sympy
from force_diffusion.derivations.beyond.slices import BULK, SURFACE, variance
from force_diffusion.symbolic.algebra.affine import Region
from force_diffusion.symbolic.symbols import M, j
from force_diffusion.symbolic.variances.weights import UndeterminedError

BASE = {j: sympy.Integer(0)}


def test_a_packing_that_is_a_case_of_its_own_is_not_swallowed() -> None:
    with pytest.raises(UndeterminedError):
        variance(SURFACE, BASE, Region({M: 1}))  # M = 1 has another variance


def test_a_packing_that_is_none_is() -> None:
    """Under a bulk load M = 1 follows from the form of those above it."""
    whole = variance(BULK, BASE, Region({M: 1}))
    assert (whole - variance(BULK, BASE, Region({M: 2}))).is_zero()
