"""Eqs. 6 and 7: a load on one bead and the two forces below it."""

import sympy
from force_diffusion.symbolic.symbols import k, l
from hypothesis import given

from tests.properties.drawn import Drawn, fixed_packing, packings
from tests.properties.orders import holds_to_first_order, is_identity, printed

LOADED = packings("point", "surface", "bulk")
"""The loaded bead carries nothing else: anywhere for a point load, otherwise in the top layer."""


def balanced(equation: sympy.Eq, drawn: Drawn) -> None:
    is_identity(equation, drawn, [{k: drawn.at[0], l: drawn.at[1]}])


def split(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, [{k: drawn.at[0], l: drawn.at[1]}])


CHECKS = {6: (balanced, [fixed_packing("point")]), 7: (split, [fixed_packing("point")])}


@given(LOADED)
def test_eq_6_the_load_and_both_forces_are_in_balance(drawn):
    for line in printed(6):
        balanced(line, drawn)


@given(LOADED)
def test_eq_7_the_load_is_shared_by_both_supports(drawn):
    """The supporting forces can be evaluated to first order in the δn^±."""
    for line in printed(7):
        split(line, drawn)
