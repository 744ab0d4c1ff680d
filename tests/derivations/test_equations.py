"""Every printed equation: proved, its mutants refuted, its witnesses driven by Hypothesis."""

import ast
from collections.abc import Callable
from pathlib import Path

import pytest
import sympy
from hypothesis import given
from hypothesis import strategies as st

from derivations import (
    eq01_ordered_positions,
    eq02_displacement,
    eq03_extrapolation,
    eq04_contact_plus,
    eq05_contact_minus,
    eq06_force_balance,
    eq07_load_split,
    eq08_propagation,
    eq09_straight_path,
    eq10_branched_path,
    eq11_total_force,
    eq12_delta_weights,
    eq13_surface_diffusion,
    eq14_bulk_diffusion,
    witnesses,
)
from derivations.record import Derivation
from derivations.small_packings import SmallPacking, draw
from symbolic.kernel import Ruling, Verdict
from symbolic.mutants import mutants
from tests.derivations.strategies import small_packings

ALL = [
    module.DERIVATION
    for module in (
        eq01_ordered_positions,
        eq02_displacement,
        eq03_extrapolation,
        eq04_contact_plus,
        eq05_contact_minus,
        eq06_force_balance,
        eq07_load_split,
        eq08_propagation,
        eq09_straight_path,
        eq10_branched_path,
        eq11_total_force,
        eq12_delta_weights,
        eq13_surface_diffusion,
        eq14_bulk_diffusion,
    )
]
# costly: twelve layers of exact packings for each draw
SEEDED = {12, 13, 14}

every_equation = pytest.mark.parametrize("derivation", ALL, ids=lambda d: f"eq{d.number:02}")


@every_equation
def test_proved(derivation: Derivation) -> None:
    for part, equation in enumerate(derivation.printed):
        ruling = derivation.decide(part, equation)
        assert ruling.verdict is Verdict.PROVED, ruling.note
    for claim in derivation.claims:
        ruling = claim.decide()
        assert ruling.verdict is Verdict.PROVED, (claim.name, ruling.note)


@every_equation
def test_mutants_are_refuted(derivation: Derivation) -> None:
    refuted, equivalent = 0, []
    for part, equation in enumerate(derivation.printed):
        for change, mutant in mutants(equation):
            ruling = derivation.decide(part, mutant)
            assert ruling.verdict in (Verdict.REFUTED, Verdict.PROVED), (change, ruling.note)
            assert ruling.note
            if ruling.verdict is Verdict.PROVED:
                equivalent.append(change)
            else:
                refuted += 1
    assert refuted >= 5
    # only Eq. 12 drops an order in which a mechanical change can hide
    assert not equivalent or derivation.number == 12, equivalent


@pytest.mark.parametrize(
    "derivation", [d for d in ALL if d.number not in SEEDED], ids=lambda d: f"eq{d.number:02}"
)
@given(packing=small_packings())
def test_witnesses_agree(derivation: Derivation, packing: SmallPacking) -> None:
    assert derivation.witnesses
    for witness in derivation.witnesses:
        ruling = witness.run(packing)
        assert ruling.verdict is Verdict.AGREES, (witness.name, ruling.note)


@pytest.mark.parametrize("number", sorted(SEEDED))
@pytest.mark.parametrize("seed", [1, 2])
def test_costly_witnesses_agree(number: int, seed: int) -> None:
    for witness in ALL[number - 1].witnesses:
        ruling = witness.run(draw(seed))
        assert ruling.verdict is Verdict.AGREES, (witness.name, ruling.note)


def disagrees(check: Callable[[sympy.Expr, SmallPacking], Ruling], equation: sympy.Eq) -> bool:
    """Some packing speaks against an equation, or it names a site or contact that is not there."""
    for seed in range(5):
        try:
            if check(equation.rhs, draw(seed)).verdict is Verdict.DISAGREES:
                return True
        except ValueError as reason:
            return any(says in str(reason) for says in ("no lattice site", "no contact starts"))
    return False


@pytest.mark.parametrize(
    ("derivation", "check"),
    [(ALL[8], witnesses.straight_path), (ALL[9], witnesses.branched_path)],
    ids=["eq09", "eq10"],
)
def test_a_wrong_equation_has_no_witness(
    derivation: Derivation, check: Callable[[sympy.Expr, SmallPacking], Ruling]
) -> None:
    (equation,) = derivation.printed
    assert not disagrees(check, equation)
    for change, mutant in mutants(equation):
        assert disagrees(check, mutant), change


def test_premises_are_the_imports() -> None:
    """The proof graph that is stated is the import graph, and it has no cycle."""
    folder = Path(eq01_ordered_positions.__file__).parent
    for derivation in ALL:
        (path,) = folder.glob(f"eq{derivation.number:02}_*.py")
        tree = ast.parse(path.read_text(encoding="utf-8"))
        imported = {
            int(alias.name[2:4])
            for node in ast.walk(tree)
            if isinstance(node, ast.ImportFrom) and node.module == "derivations"
            for alias in node.names
            if alias.name.startswith("eq")
        }
        stated = {premise.number for premise in derivation.premises}
        assert stated == imported, derivation.number
        assert all(number < derivation.number for number in stated)


@given(st.integers(0, 10**6))
def test_draws_are_valid_packings(seed: int) -> None:
    packing = draw(seed)
    assert packing == draw(seed)
    assert packing.width > packing.height
    assert all((i + j) % 2 == 0 for i, j in (*packing.rho, packing.loaded, *packing.contacts))
