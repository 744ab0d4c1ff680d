"""Eqs. 11 and B1: the force of every contact under a load on all beads of the surface."""

import sympy
from force_diffusion.symbolic.symbols import i, j
from hypothesis import given

from tests.properties.drawn import Drawn, fixed_packing, packings
from tests.properties.orders import holds_to_first_order, printed


def of_each_contact(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, ({i: a, j: b} for a, b in drawn.contacts()))


CHECKS = {
    11: (of_each_contact, [fixed_packing("surface")]),
    "B1": (of_each_contact, [fixed_packing("leaning")]),
}


@given(packings("surface"))
def test_eq_11_the_force_is_the_sum_over_all_loads_and_paths(drawn):
    """One straight path, and M − j − 1 paths which branch once."""
    for line in printed(11):
        of_each_contact(line, drawn)


@given(packings("leaning"))
def test_eq_b1_the_same_for_loads_in_any_direction(drawn):
    for line in printed("B1"):
        of_each_contact(line, drawn)
