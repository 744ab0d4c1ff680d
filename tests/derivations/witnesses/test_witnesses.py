"""Witnesses: what is drawn is a packing, and exact packings speak against what is false."""

from fractions import Fraction

import pytest
import sympy
from force_diffusion.derivations.framework.loading import load
from force_diffusion.derivations.witnesses.both_sides import (
    AbsentError,
    Points,
    compare,
    each_bead,
    each_contact,
    inside_cone,
    left_edge,
    loaded_bead,
    straight_below,
)
from force_diffusion.derivations.witnesses.draws import DIRECTIONS, draw
from force_diffusion.derivations.witnesses.squared_weights import weights_below_a_load
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.search.mutants import mutants
from hypothesis import given
from hypothesis import strategies as st


@given(st.integers(0, 10**6))
def test_draws_are_valid_packings(seed: int) -> None:
    packing = draw(seed)
    assert packing == draw(seed)
    assert packing.width > packing.height
    assert all((i + j) % 2 == 0 for i, j in (*packing.rho, packing.loaded, *packing.contacts))


SCENES = {
    1: ("none", each_contact),
    2: ("none", each_bead),
    3: ("none", each_bead),
    4: ("none", each_contact),
    5: ("none", each_contact),
    6: ("single", loaded_bead),
    7: ("single", loaded_bead),
    8: ("single", left_edge),
    9: ("single", straight_below),
    10: ("single", inside_cone),
}


def is_refuted(statement: sympy.Eq, scene: str, points: Points) -> bool:
    """Whether one of four exact packings speaks against it, or gives it no value."""
    try:
        found = [compare(statement, draw(seed), scene, points).verdict for seed in range(4)]
    except (AbsentError, explicit.DivisionError):
        return True
    return Verdict.DISAGREES in found


@pytest.mark.long(sample=3)
@pytest.mark.parametrize("number", SCENES)
def test_packings_refute_mutants_too(number: int) -> None:
    """Exact packings, which know nothing of the algebra, speak against every mutant."""
    derivation = load(number)
    for equation in derivation.printed:
        assert not is_refuted(equation, *SCENES[number])
        for _, change, mutant in mutants(equation):
            assert is_refuted(mutant, *SCENES[number]), change


@pytest.mark.parametrize("n", DIRECTIONS[:2])
def test_a_layer_carries_the_load_whatever_the_radii(n: tuple[Fraction, Fraction]) -> None:
    """The witness's own weights: vertical forces of one layer add up to f_load at order ε¹ too."""
    vertical, _ = weights_below_a_load(4, n)
    for layer in range(4):
        total: dict[tuple[int, int], Fraction] = {}
        for ((_, at), _), weights in vertical.items():
            for bead, weight in weights.items():
                total[bead] = total.get(bead, Fraction(0)) + weight * (at == layer)
        assert not any(total.values())
