"""Eqs. 4 and 5: how contacts turn."""

from fractions import Fraction
from pathlib import Path

import pytest
import sympy
from force_diffusion.symbolic.symbols import i, j
from hypothesis import given

from tests.properties.drawn import Drawn, fixed_packing, packings, solved
from tests.properties.mutants import mutants
from tests.properties.orders import STRENGTHS, falls, holds_to_first_order, printed
from tests.properties.packing import dot


def of_each_contact(equation: sympy.Eq, drawn: Drawn) -> None:
    holds_to_first_order(equation, drawn, ({i: a, j: b} for a, b in drawn.contacts()))


CHECKS = {number: (of_each_contact, [fixed_packing("surface")]) for number in (4, 5)}


@given(packings())
def test_eq_4_contacts_along_n_plus_turn(drawn):
    """The direction from the centre of bead (i, j) to (i+1, j+1) is n⁺ + δn⁺."""
    for line in printed(4):
        of_each_contact(line, drawn)


@given(packings())
def test_eq_5_contacts_along_n_minus_turn(drawn):
    """A similar expression applies for contacts from (i, j) to (i−1, j+1)."""
    for line in printed(5):
        of_each_contact(line, drawn)


@given(packings())
def test_the_change_of_a_direction_is_at_right_angles_to_it(drawn):
    """δn⁺·n⁺ = 0 ensures that n⁺ + δn⁺ is a unit vector to first order."""
    for a, b in drawn.contacts():
        for name, c in (("DeltaNPlus", 0), ("DeltaNMinus", 1)):
            planes = [solved(drawn, epsilon) for epsilon in STRENGTHS]
            dots = [abs(dot(plane.quantity(name, a, b), plane.packing.base[c])) for plane in planes]
            assert falls(dots, 2)


GUIDE = Path(__file__).parents[2] / "docs" / "guides" / "properties.md"


def test_the_guide_shows_what_a_changed_sign_gives():
    (line,) = printed(4)
    (changed,) = (
        case.equation for case in mutants(line) if case.change == "sign of −δr_(i+j,0) flipped"
    )
    one = Fraction(1)
    smallest = Drawn(Fraction(0), 1, 2, one, (1, 0, 0), "surface", one, (0, 2))
    with pytest.raises(AssertionError) as failed:
        of_each_contact(changed, smallest)
    assert f"AssertionError: {str(failed.value).splitlines()[0]}\n" in GUIDE.read_text("utf-8")
