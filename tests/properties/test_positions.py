"""Eqs. 1–3: where the beads are."""

import sympy
from force_diffusion.symbolic.symbols import i, j
from hypothesis import given

from tests.properties.drawn import Drawn, fixed_packing, packings
from tests.properties.orders import holds_to_first_order, is_identity, printed


def without_disorder(equation: sympy.Eq, drawn: Drawn) -> None:
    equal = drawn.with_equal_radii()
    is_identity(equation, equal, ({i: a, j: b} for a, b in (*equal.base(), *equal.beads())))


def of_each_bead(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, ({i: a, j: b} for a, b in drawn.beads()))


CHECKS = {
    1: (without_disorder, [fixed_packing("surface")]),
    2: (of_each_bead, [fixed_packing("surface")]),
    3: (of_each_bead, [fixed_packing("surface")]),
}


@given(packings())
def test_eq_1_beads_of_equal_radii_lie_on_the_lattice(drawn):
    for line in printed(1):
        without_disorder(line, drawn)


@given(packings())
def test_eq_2_a_bead_rests_on_two_and_moves_with_them(drawn):
    """The distance to both supporting beads is the sum of the radii, to first order in the δr."""
    for line in printed(2):
        of_each_bead(line, drawn)


@given(packings())
def test_eq_3_displacements_are_sums_of_radii_along_two_diagonals(drawn):
    """By induction from the base, which is held, for slabs and for packings that repeat."""
    for line in printed(3):
        of_each_bead(line, drawn)
