"""What derivations of a user's own are made of: forces, layers and a witness."""

import pytest
import sympy
from force_diffusion.derivations.witnesses.draws import draw
from force_diffusion.symbolic.kernel.decisions import Verdict
from force_diffusion.symbolic.kernel.where import SURFACE_TILTED

import force_diffusion as fd
from force_diffusion.derivation import (
    BULK,
    SURFACE,
    ForceMinus,
    ForcePlus,
    Layered,
    M,
    Symbol,
    Variance,
    forces,
    i,
    j,
    layers,
    mean_force,
    on_small_packings,
)

OWN = Symbol("own_variance")


@pytest.mark.parametrize(("loading", "number"), [(SURFACE, 13), (BULK, 14)])
@pytest.mark.parametrize("contact", [ForcePlus, ForceMinus])
def test_one_contact_has_the_paper_s_variance(loading, number, contact) -> None:
    moment = Variance(contact(i, j) / mean_force(loading))
    found = Layered(OWN, moment, (forces(loading),), loading, cases=layers()).exact()
    eq = fd.equation(number)
    assert tuple(found) == eq.cases
    for name, case in found.items():
        assert sympy.factor(case.expression - eq.exact(name).rhs) == 0
        assert [one.expression for one in case.missed] == list(eq.exact(name).missed.values())


@pytest.mark.parametrize(("loading", "minus"), [(SURFACE, 1), (BULK, -2)])
def test_the_witness_agrees_with_a_sum_and_with_no_other(loading, minus) -> None:
    both = (ForcePlus(i, j) + minus * ForceMinus(i, j)) / mean_force(loading)
    found = Layered(OWN, Variance(both), (forces(loading),), loading, cases=layers(3))
    right = on_small_packings(found, {"+": 1, "-": minus}, 4)
    assert right.run(draw(1)).verdict is Verdict.AGREES
    wrong = on_small_packings(found, {"+": 1, "-": minus + 1}, 4)
    assert wrong.run(draw(1)).verdict is Verdict.DISAGREES


@pytest.mark.parametrize("ask", [forces, mean_force])
def test_a_load_that_is_not_known_is_named(ask) -> None:
    with pytest.raises(fd.ForceDiffusionError, match="SURFACE or BULK"):
        ask(SURFACE_TILTED)


@pytest.mark.parametrize("first", [1, 2, 3, 5])
def test_layers_leave_none_out(first: int) -> None:
    for height in range(1, 9):
        for layer in range(height):
            at = {j: sympy.Integer(layer), M: sympy.Integer(height)}
            assert any(
                (height, layer) in case.missed
                or all(one.xreplace(at) is sympy.true for one in case.relations)
                for case in layers(first).values()
            )
