"""Eqs. B2 and B3: exact variances against squared weights of exact packings, all j < M ≤ 4."""

from collections.abc import Iterator
from fractions import Fraction

import pytest
from force_diffusion.derivations.beyond import t2_variance as t2
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import sigma, t

from tests.soundness.witnesses.comparing import assert_equal, stated
from tests.soundness.witnesses.draws import SmallPacking
from tests.soundness.witnesses.squared_weights import weights_of_forces

pytestmark = pytest.mark.long(sample=1)


@pytest.mark.parametrize("case", [t2.SURFACE, t2.BULK], ids=["B2", "B3"])
@pytest.mark.parametrize("branch", "+-")
def test_variances(case: t2.Case, branch: str, packing: SmallPacking) -> None:
    plus, minus = packing.components
    ratio = minus / plus
    share = ratio if branch == "+" else 1 / ratio
    values = {**explicit.geometry(*packing.n, Fraction(1)), sigma: 1, t: share}

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for height, layer, form in stated(case.variance, 4, values):
            load = case.load.name
            weights = weights_of_forces(height, packing.n, load, ratio=ratio, branch=branch)
            total = sum((w**2 for w in weights[layer].values()), Fraction(0))
            yield f"M = {height}, j = {layer}", form, total

    assert_equal(pairs())
