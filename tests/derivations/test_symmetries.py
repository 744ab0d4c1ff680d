"""What the printed equations must have in common with the packing: symmetries and counts."""

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from derivations import eq03_extrapolation as eq03
from derivations import eq11_total_force as eq11
from derivations.small_packings import SmallPacking, Truth
from symbolic import explicit
from symbolic import symbols as sy
from symbolic.lattice import mirror
from tests.derivations.strategies import small_packings

FORCE = eq11.in_radii(eq11.PRINTED.rhs)
LEFT_FORCE = eq11.in_radii(mirror(eq11.PRINTED.rhs))


def force_weights(
    packing: SmallPacking, across: int, layer: int, scale: Fraction = Fraction(1)
) -> explicit.Weights:
    values = explicit.geometry(*packing.n, scale)
    at = {**values, sy.M: packing.height, sy.i: across, sy.j: layer}
    return explicit.weights(FORCE, at)


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
    truth = Truth(packing, packing.surface_load())
    image = Truth(mirrored, packing.surface_load())
    for across, layer in packing.contacts:
        assert truth.force(across, layer, "+") == image.force(-across, layer, "-")
        at = {sy.M: packing.height, sy.j: layer}
        assert truth.scalar(FORCE, {**at, sy.i: across}) == image.scalar(
            LEFT_FORCE, {**at, sy.i: -across}
        )


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
        truth = Truth(packing, packing.surface_load())
        return [truth.force(i, j, "+")[1] for i, j in one.contacts]

    parts = zip(slopes(one.rho), slopes(sites), strict=True)
    assert slopes(total) == [a + factor * b for a, b in parts]


@given(small_packings())
def test_isostatic_count(packing: SmallPacking) -> None:
    """2N contacts for N supported beads: two below each, and each found once from below."""
    truth = Truth(packing, packing.surface_load())
    contacts = set()
    for layer in range(packing.height):
        for across in range(layer % 2, 2 * packing.width, 2):
            for branch, step in (("+", 1), ("-", -1)):
                truth.force(across, layer, branch)  # there is such a contact
                contacts.add(((across + step) % (2 * packing.width), layer + 1, branch))
    supported = packing.width * packing.height
    assert len(contacts) == 2 * supported
