"""Eqs. 8–10: how one contact force comes down through the packing."""

from collections.abc import Iterator

import sympy
from force_diffusion.symbolic.symbols import i, j, k, l, n, site_r, site_s
from hypothesis import given

from tests.properties.drawn import Drawn, fixed_packing, packings, solved
from tests.properties.orders import STRENGTHS, At, falls, holds_to_first_order, printed
from tests.properties.reading import steps_to

ENTERING = packings("contact", level=2)
"""One force f⁺ enters a bead, and nothing else."""

BELOW_ONE_LOAD = packings("contact", "point", cone=True, level=2)
"""The force f⁺ below the bead (k, l) alone, or the load on that bead; no image of it is met."""


def straight_below(drawn: Drawn) -> Iterator[At]:
    """Contacts f⁺_ij with k − i = l − j."""
    across, layer = drawn.at
    for depth in range(1, layer + 1):
        yield {i: across - depth, j: layer - depth, k: across, l: layer}


def after_one_branch(drawn: Drawn) -> Iterator[At]:
    """Contacts f⁻_ij for which n = ½[(l − j) − (k − i)] obeys 1 ≤ n < l − j."""
    across, layer = drawn.at
    for below in range(layer - 1):
        for count in range(1, layer - below):
            at = across - (layer - below) + 2 * count
            yield {i: at, j: below, k: across, l: layer, n: count}


def through_a_bead(equation: sympy.Eq, drawn: Drawn) -> None:
    across, layer = drawn.at
    holds_to_first_order(equation, drawn, [{site_r: across - 1, site_s: layer - 1}])


def down_a_line(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, straight_below(drawn))


def round_a_corner(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, after_one_branch(drawn))


CHECKS = {
    8: (through_a_bead, [fixed_packing("contact")]),
    9: (down_a_line, [fixed_packing("contact"), fixed_packing("point")]),
    10: (round_a_corner, [fixed_packing("contact"), fixed_packing("point")]),
}


@given(ENTERING)
def test_eq_8_a_force_that_comes_in_is_balanced_by_both_supports(drawn):
    """The force f⁺_rs comes into bead (r, s) along −(n⁺ + δn⁺_rs)."""
    for line in printed(8):
        through_a_bead(line, drawn)


@given(BELOW_ONE_LOAD)
def test_eq_9_without_a_branch_only_the_ends_of_the_path_contribute(drawn):
    for line in printed(9):
        down_a_line(line, drawn)


@given(BELOW_ONE_LOAD)
def test_eq_10_with_one_branch_the_branch_alone_contributes(drawn):
    for line in printed(10):
        round_a_corner(line, drawn)


@given(packings("contact", cone=True, level=2))
def test_all_other_contacts_receive_zero_contribution(drawn):
    """Of f⁺_(k−1,l−1), to first order: what takes two branches is of second order."""
    planes = [solved(drawn, epsilon) for epsilon in STRENGTHS]
    home = planes[0].packing.home
    reached = {
        *(("ForcePlus", home(steps_to(at[i], at[j]))) for at in straight_below(drawn)),
        *(("ForceMinus", home(steps_to(at[i], at[j]))) for at in after_one_branch(drawn)),
    }
    for a, b in drawn.contacts():
        for name in ("ForcePlus", "ForceMinus"):
            if (name, home(steps_to(a, b))) not in reached:
                assert falls([abs(plane.quantity(name, a, b)) for plane in planes], 2)
