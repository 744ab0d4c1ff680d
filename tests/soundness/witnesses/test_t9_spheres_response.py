"""Eq. B19: the response to a point load in three dimensions."""

from collections.abc import Iterator
from fractions import Fraction
from itertools import product

import pytest
import sympy
from force_diffusion.derivations.beyond import t9_spheres_response as t9
from force_diffusion.symbolic.symbols import j, l, p, phi, q, r, sigma

from tests.soundness.witnesses import dimensions
from tests.soundness.witnesses.comparing import assert_equal
from tests.soundness.witnesses.draws import SmallPacking

pytestmark = pytest.mark.long(sample=1)


def _exact(quantity: sympy.Basic, level: int, first: int, other: int, cosine: Fraction) -> Fraction:
    """The variance for σ = r = 1 by the recursion from bead to bead."""
    bead = (first, other, 0)
    several = {t9.ON_FACE: ((bead, 1),), t9.BEAD: ((bead, 0), (bead, 1))}
    contacts = several.get(quantity, ((bead, 0),))
    whole = dimensions.response_variance(level, cosine, contacts, vertical=quantity == t9.ON_LEG)
    return whole if quantity == t9.LEG_MAGNITUDE else whole / 9


def test_squared_weights_by_the_recursion_from_bead_to_bead(packing: SmallPacking) -> None:
    cosine = dimensions.cosine_of(packing)

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        sites = product(t9.QUANTITIES.values(), range(4), (1, 2, 3), (1, 2))
        for one, layer, first, second in sites:
            other = second if q in one.steps else 0
            if other or second == 1:
                at = {j: layer, p: first, q: other, l: layer + first + other}
                stated = one.value({phi: cosine, sigma: 1, r: 1, **at})
                where = f"{one.symbol.name}, j = {layer}, p = {first}, q = {other}"
                yield where, stated, _exact(one.symbol, at[l], first, other, cosine)

    assert_equal(pairs())


def test_an_exact_packing_of_spheres_with_one_load(packing: SmallPacking) -> None:
    """l = 4: order ε¹ of every contact, and exact zeros off legs and faces."""
    cosine, level = dimensions.cosine_of(packing), 4
    drawn = list(packing.rho.values())
    beads = [u for u in product(range(level + 1), repeat=3) if sum(u) <= level]
    rho = {bead: drawn[place % len(drawn)] for place, bead in enumerate(beads)}
    exact = dimensions.response_of_spheres(cosine, level, rho)

    def force(bead: tuple[int, ...], axis: int) -> Fraction:
        """First order on legs and faces by the recursion; zero elsewhere, as is stated."""
        if not bead[axis] or sum(map(bool, bead)) > 2:
            return Fraction(0)
        weights = dimensions.response_weights(3, level, cosine, bead, axis)
        return sum((w * rho[at] for at, w in weights.items()), Fraction(0))

    assert_equal(
        (f"from O − {bead} along {axis + 1}", force(bead, axis), true)
        for (bead, axis), true in exact.items()
        if min(bead) >= 0
    )
