"""Eqs. B10, B17 and B18: contact moments of every layer against exact packings of M ≤ 4."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import pytest
import sympy
from force_diffusion.derivations.beyond import t5_stress as t5
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import sigma, t

from tests.soundness.witnesses import second_order
from tests.soundness.witnesses.comparing import assert_equal, stated
from tests.soundness.witnesses.draws import SmallPacking

pytestmark = pytest.mark.long(sample=1)

SHARE = Fraction(3, 5)
"""t of the loads, where those drawn are vertical."""


def _exact(
    load: t5.Load, height: int, layer: int, n: tuple[Fraction, Fraction], share: Fraction
) -> dict[sympy.Symbol, Fraction]:
    """What exact packings say of all that is printed, less the ordered value, for r = σ = 1."""
    x, y = n[0] ** 2, n[1] ** 2
    xx, yy, xy = second_order.moments(height, n, load.name, share)[layer]
    places = second_order.means(height, n, load.name, share)[1]
    grown = (places[layer + 1][1] - places[layer][1]) / (2 * n[1])
    axes = y * yy - x * xx - (y - x) * xy
    return dict(zip(load.forms, (xx - yy, yy, yy - grown, xy, axes), strict=True))


@pytest.mark.parametrize(
    ("loads", "symbols"),
    [
        pytest.param((t5.OF_SURFACE,), slice(3), id="B10"),
        pytest.param((t5.OF_BULK,), slice(3), id="B17"),
        pytest.param(t5.LOADS, slice(3, 5), id="B18"),
    ],
)
def test_moments(loads: Sequence[t5.Load], symbols: slice, packing: SmallPacking) -> None:
    plus, other = packing.components
    share = other / plus if other != plus else SHARE
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1, t: share}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for load in loads:
            for symbol in load.printed[symbols]:
                for height, layer, form in stated(load.layered[symbol], 4, values):
                    true = _exact(load, height, layer, packing.n, share)[symbol]
                    yield f"{symbol.name}, M = {height}, j = {layer}", form, true

    assert_equal(pairs())
