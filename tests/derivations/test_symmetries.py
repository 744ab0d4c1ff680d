"""What the printed equations must have in common with the packing: symmetries and counts."""

from fractions import Fraction
from itertools import combinations

import mpmath
import pytest
import sympy
from force_diffusion.derivations import eq03_extrapolation as eq03
from force_diffusion.derivations import eq11_total_force as eq11
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.mechanics.lattice import mirror
from hypothesis import given
from hypothesis import strategies as st

from tests.derivations.strategies import small_packings
from tests.numeric.mechanics import taylor
from tests.numeric.mechanics.plain_packing import PlainPacking
from tests.soundness.witnesses.draws import SmallPacking

FORCE = eq11.in_radii(eq11.PRINTED.rhs)
LEFT_FORCE = eq11.in_radii(mirror(eq11.PRINTED.rhs))


def force_weights(
    packing: SmallPacking,
    across: int,
    layer: int,
    scale: Fraction = Fraction(1),
    form: sympy.Expr = FORCE,
) -> explicit.Weights:
    values = explicit.geometry(*packing.n, scale)
    at = {**values, sy.M: packing.height, sy.i: across, sy.j: layer}
    return explicit.weights(form, at)


def solved(packing: SmallPacking) -> taylor.TaylorPacking:
    """Exactly, to first order, under a surface load."""
    loads = packing.surface_load()
    return taylor.solve(
        packing.width, packing.height, n=packing.n, rho=packing.rho, loads=loads, order=1
    )


@given(small_packings(), st.integers(-3, 3))
def test_translation(packing: SmallPacking, steps: int) -> None:
    (across, layer), *_ = packing.contacts
    here = force_weights(packing, across, layer)
    there = force_weights(packing, across + 2 * steps, layer)
    moved = {(f, i + 2 * steps if f else 0, j): w for (f, i, j), w in here.items()}
    assert moved == there


@given(small_packings(), st.fractions(Fraction(1, 9), 9))
def test_scale_of_the_radii(packing: SmallPacking, scale: Fraction) -> None:
    """δr and r times λ: displacements times λ, forces unchanged."""
    (across, layer), *_ = packing.contacts
    one, scaled = (force_weights(packing, across, layer, s) for s in (Fraction(1), scale))
    assert {k: w / scale if k[0] else w for k, w in one.items()} == scaled
    at = {sy.i: across, sy.j: layer + 1}
    sizes = [explicit.geometry(*packing.n, s) for s in (Fraction(1), scale)]
    first, second = (explicit.vector_weights(eq03.PRINTED.rhs, {**v, **at}) for v in sizes)
    assert first == second


@given(small_packings())
def test_mirror_image(packing: SmallPacking) -> None:
    """f⁻ in the mirrored packing is f⁺ in the packing, in Eq. 11 and in the exact solution."""
    mirrored = SmallPacking(
        packing.width,
        packing.height,
        packing.n,
        {(-i % (2 * packing.width), j): rho for (i, j), rho in packing.rho.items()},
        packing.load,
        packing.loaded,
        packing.contacts,
    )
    truth, image = solved(packing), solved(mirrored)
    around = 2 * packing.width
    for across, layer in packing.contacts:
        assert truth.force(across, layer, "+") == image.force(-across % around, layer, "-")
        here = force_weights(packing, across, layer)
        there = force_weights(packing, -across, layer, form=LEFT_FORCE)
        assert here == {(f, -i if f else 0, j): w for (f, i, j), w in there.items()}


@given(small_packings(), small_packings(), st.fractions(-9, 9, max_denominator=9))
def test_linearity_in_the_radii(one: SmallPacking, two: SmallPacking, factor: Fraction) -> None:
    """Order ε¹ of the exact forces is linear: the response to ρ₁ + cρ₂ is the sum of both."""
    sites = {(i % (2 * one.width), j): rho for (i, j), rho in two.rho.items() if j <= one.height}
    total = {
        site: one.rho.get(site, Fraction(0)) + factor * sites.get(site, Fraction(0))
        for site in one.rho.keys() | sites.keys()
    }

    def slopes(rho: dict[tuple[int, int], Fraction]) -> list[Fraction]:
        packing = SmallPacking(
            one.width, one.height, one.n, rho, one.load, one.loaded, one.contacts
        )
        truth = solved(packing)
        return [truth.force(i, j, "+")[1] for i, j in one.contacts]

    parts = zip(slopes(one.rho), slopes(sites), strict=True)
    assert slopes(total) == [a + factor * b for a, b in parts]


@pytest.mark.long
@given(small_packings())
def test_isostatic_count(packing: SmallPacking) -> None:
    """Twice as many contacts as supported beads, counted on solved positions.

    A contact is a pair of beads exactly R + R′ apart; all pairs across the periodic strip are
    looked at, at 40 digits and ε = 1e-6.
    """
    width, strength = packing.width, Fraction(1, 10**6)
    rho = {
        ((i + j) // 2 % width, j): Fraction(0)
        for j in range(packing.height + 1)
        for i in range(j % 2, 2 * width, 2)
    }
    for (i, j), value in packing.rho.items():
        rho[(i + j) // 2 % width, j] += strength * value
    with mpmath.workdps(40):
        laid = PlainPacking(2, packing.height, width, 1 - 2 * packing.n[0] ** 2, rho)
        period = 2 * width * (laid.n[0] - laid.n[1])
        beads = [(laid.at((q, j - q)), 1 + value, j) for (q, j), value in rho.items()]
        touching = 0
        for (x, radius, layer), (x2, radius2, layer2) in combinations(beads, 2):
            if layer == layer2 == 0:
                continue  # the base is fixed, whether its beads touch or not
            both = mpmath.mpf((radius + radius2).numerator) / (radius + radius2).denominator
            for image in (-1, 0, 1):
                gap = mpmath.norm(x - x2 + image * period) - both
                touching += bool(abs(gap) < 1e-30)  # 40 digits, a few lost from layer to layer
    assert touching == 2 * width * packing.height
