"""Eq. B1: forces under a load in any direction against exact packings, at orders ε⁰ and ε¹."""

from collections.abc import Iterator
from fractions import Fraction

import pytest
from force_diffusion.derivations.beyond import t1_forces as t1
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import M, i, j, t

from tests.numeric.mechanics import taylor
from tests.soundness.witnesses.comparing import assert_equal
from tests.soundness.witnesses.draws import SmallPacking


@pytest.mark.parametrize(("part", "branch"), [(0, "+"), (1, "-")])
def test_forces_are_those_of_the_packing(part: int, branch: str, packing: SmallPacking) -> None:
    solved = taylor.solve(
        packing.width,
        packing.height,
        n=packing.n,
        rho=packing.rho,
        loads=packing.tilted_load(),
        order=1,
    )
    plus, minus = packing.components
    form = t1.in_radii(part)
    values = {**explicit.geometry(*packing.n, Fraction(1)), M: packing.height, t: minus / plus}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for across, layer in packing.contacts:
            ordered, slope = solved.force(across, layer, branch)
            weights = explicit.weights(form, {**values, i: across, j: layer})
            share, linear = packing.components[part], Fraction(0)
            for (family, at, of), weight in weights.items():
                if family:
                    linear += weight * packing.rho[at % (2 * packing.width), of]
            yield f"{across}, {layer}, ε⁰", weights["", 0, 0], ordered / share
            yield f"{across}, {layer}, ε¹", linear, slope / share

    assert_equal(pairs())
