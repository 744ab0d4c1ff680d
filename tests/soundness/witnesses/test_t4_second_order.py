"""Eqs. B4, B5, B6, B15 and B16: means at order ε² against exact packings, as fractions."""

from collections.abc import Iterator
from fractions import Fraction

import pytest
from force_diffusion.derivations.beyond import t4_second_order as t4
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import j, sigma, t

from tests.soundness.witnesses import second_order
from tests.soundness.witnesses.comparing import assert_equal, stated
from tests.soundness.witnesses.draws import SmallPacking

pytestmark = pytest.mark.long(sample=1)

HIGHEST = 5


def test_mean_positions(packing: SmallPacking) -> None:
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for layer, (x, y) in enumerate(second_order.means(HIGHEST, packing.n, "surface")[1]):
            form = t4.SETTLING.rhs
            found = explicit.number(form, {**values, j: layer}) if layer else Fraction(0)
            yield f"j = {layer}", found, y
            yield f"j = {layer}, horizontally", Fraction(0), x

    assert_equal(pairs())


@pytest.mark.parametrize(
    ("case", "load", "branches"),
    [
        pytest.param(t4.ON_SURFACE, "surface", "+", id="B5"),
        pytest.param(t4.IN_BULK, "bulk", "+", id="B6"),
        pytest.param(t4.SURFACE_AT_ANGLE, "surface", "+-", id="B15"),
        pytest.param(t4.BULK_AT_ANGLE, "bulk", "+-", id="B16"),
    ],
)
def test_mean_forces(case: t4.Case, load: str, branches: str, packing: SmallPacking) -> None:
    plus, minus = packing.components
    ratio = minus / plus if len(branches) == 2 else Fraction(1)

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for branch in branches:
            share = ratio if branch == "+" else 1 / ratio
            values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1, t: share}
            for height, layer, form in stated(case.mean, HIGHEST, values):
                true = second_order.means(height, packing.n, load, ratio, branch)[0][layer]
                yield f"f{branch}, M = {height}, j = {layer}", form, true

    assert_equal(pairs())
