"""Eqs. 1–11 and B1: beads, contacts and forces, to first order in the disorder."""

from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest
import sympy
from force_diffusion.symbolic.symbols import i, j, k, l, n, site_r, site_s
from hypothesis import given

from tests.properties.drawn import Drawn, fixed_packing, packings, solved
from tests.properties.mutants import mutants
from tests.properties.orders import STRENGTHS, At, falls, holds_to_first_order, is_identity, printed
from tests.properties.packing import dot
from tests.properties.reading import steps_to


def without_disorder(equation: sympy.Eq, drawn: Drawn) -> None:
    equal = drawn.with_equal_radii()
    is_identity(equation, equal, ({i: a, j: b} for a, b in (*equal.base(), *equal.beads())))


def of_each_bead(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, ({i: a, j: b} for a, b in drawn.beads()))


def of_each_contact(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, ({i: a, j: b} for a, b in drawn.contacts()))


def balanced(equation: sympy.Eq, drawn: Drawn) -> None:
    is_identity(equation, drawn, [{k: drawn.at[0], l: drawn.at[1]}])


def split(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, [{k: drawn.at[0], l: drawn.at[1]}])


def through_a_bead(equation: sympy.Eq, drawn: Drawn) -> None:
    """The force f⁺_rs comes into bead (r, s) along −(n⁺ + δn⁺_rs)."""
    across, layer = drawn.at
    holds_to_first_order(equation, drawn, [{site_r: across - 1, site_s: layer - 1}])


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


def down_a_line(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, straight_below(drawn))


def round_a_corner(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, after_one_branch(drawn))


CHECKS = {
    1: (without_disorder, [fixed_packing("surface")]),
    2: (of_each_bead, [fixed_packing("surface")]),
    3: (of_each_bead, [fixed_packing("surface")]),
    4: (of_each_contact, [fixed_packing("surface")]),
    5: (of_each_contact, [fixed_packing("surface")]),
    6: (balanced, [fixed_packing("point")]),
    7: (split, [fixed_packing("point")]),
    8: (through_a_bead, [fixed_packing("contact")]),
    9: (down_a_line, [fixed_packing("contact"), fixed_packing("point")]),
    10: (round_a_corner, [fixed_packing("contact"), fixed_packing("point")]),
    11: (of_each_contact, [fixed_packing("surface")]),
    "B1": (of_each_contact, [fixed_packing("leaning")]),
}


def holds(number: int | str, drawn: Drawn) -> None:
    check, _ = CHECKS[number]
    for line in printed(number):
        check(line, drawn)


@pytest.mark.parametrize("number", [1, 2, 3, 4, 5])
@given(packings())
def test_beads_and_contacts_are_where_the_radii_put_them(number, drawn):
    """A bead rests on two, by induction from the base, which is held.

    Eq. 1 is for equal radii. For slabs and for packings that repeat.
    """
    holds(number, drawn)


@given(packings())
def test_the_change_of_a_direction_is_at_right_angles_to_it(drawn):
    """δn⁺·n⁺ = 0 ensures that n⁺ + δn⁺ is a unit vector to first order."""
    for a, b in drawn.contacts():
        for name, c in (("DeltaNPlus", 0), ("DeltaNMinus", 1)):
            planes = [solved(drawn, epsilon) for epsilon in STRENGTHS]
            dots = [abs(dot(plane.quantity(name, a, b), plane.packing.base[c])) for plane in planes]
            assert falls(dots, 2)


@pytest.mark.parametrize("number", [6, 7])
@given(packings("point", "surface", "bulk"))
def test_a_load_is_in_balance_with_both_supports_and_is_shared_by_them(number, drawn):
    """The loaded bead carries nothing else: anywhere for a point load, else in the top layer."""
    holds(number, drawn)


@given(packings("contact", level=2))
def test_a_force_that_comes_in_is_balanced_by_both_supports(drawn):
    """One force f⁺ enters a bead, and nothing else."""
    holds(8, drawn)


@pytest.mark.parametrize("number", [9, 10])
@given(packings("contact", "point", cone=True, level=2))
def test_the_ends_of_a_straight_path_contribute_and_with_one_branch_that_alone(number, drawn):
    """The force f⁺ below bead (k, l) alone, or the load on that bead; no image of it is met."""
    holds(number, drawn)


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


@given(packings("surface"))
def test_a_force_is_the_sum_over_all_loads_and_paths(drawn):
    """One straight path, and M − j − 1 paths which branch once."""
    holds(11, drawn)


@given(packings("leaning"))
def test_it_is_so_for_loads_in_any_direction(drawn):
    holds("B1", drawn)


GUIDE = Path(__file__).parents[2] / "docs" / "guides" / "properties.md"


def test_the_guide_shows_what_a_changed_sign_gives():
    (line,) = printed(4)
    changed = dict(mutants(line))["sign of −δr_(i+j,0) flipped"]
    one = Fraction(1)
    smallest = Drawn(Fraction(0), 1, 2, one, (1, 0, 0), "surface", one, (0, 2))
    with pytest.raises(AssertionError) as failed:
        of_each_contact(changed, smallest)
    assert f"AssertionError: {str(failed.value).splitlines()[0]}\n" in GUIDE.read_text("utf-8")
