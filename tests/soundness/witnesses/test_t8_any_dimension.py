"""Eqs. B11, B13, B14, B20, B24 and B25: variances in any dimension."""

from collections.abc import Iterator
from fractions import Fraction

import mpmath
import pytest
from force_diffusion.derivations.beyond import t8_any_dimension as t8
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import d, phi, r, sigma, tau_1, tau_2

from tests.numeric.mechanics.any_dimension import force_weights, squared, together
from tests.soundness.witnesses import dimensions
from tests.soundness.witnesses.comparing import assert_equal, stated
from tests.soundness.witnesses.draws import SmallPacking

pytestmark = pytest.mark.long(sample=1)

RATIOS = (Fraction(3, 5), Fraction(4, 7), Fraction(5, 3))
"""L^a/L^1 of the loads that lean, a = 2, 3, 4."""
OF_SPHERES = (t8.B13, t8.B14, t8.B24, t8.B25)


def ratios_of(case: t8.Case, dimension: int) -> tuple[tuple[Fraction, ...], explicit.Values]:
    """Those of a case, and their sums as values."""
    ratios = (RATIOS if case.leaning else (Fraction(1),) * len(RATIOS))[: dimension - 1]
    return ratios, {tau_1: sum(ratios), tau_2: sum(one**2 for one in ratios)}


@pytest.mark.parametrize("case", [t8.B11, t8.B20, *OF_SPHERES], ids=lambda one: one.number)
def test_squared_weights_by_the_recursion_from_bead_to_bead(
    case: t8.Case, packing: SmallPacking
) -> None:
    """In up to four dimensions."""
    cosine = dimensions.cosine_of(packing)

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        fixed = case.dimension if isinstance(case.dimension, int) else None
        for dimension in (fixed,) if fixed else (2, 3, 4):
            if 1 + dimension * cosine <= 0:
                continue
            ratios, sums = ratios_of(case, dimension)
            values: explicit.Values = {phi: cosine, sigma: 1, r: 1, d: dimension, **sums}
            for height, layer, form in stated(case.variance, 7 if fixed else 5, values):
                both = force_weights(
                    dimension, height, layer, cosine, bulk=case.bulk, ratios=ratios
                )
                where = f"d = {dimension}, M = {height}, j = {layer}"
                yield where, form, squared(together(both))

    assert_equal(pairs())


@pytest.mark.parametrize("case", OF_SPHERES, ids=lambda one: one.number)
def test_exact_packings_of_spheres(case: t8.Case, packing: SmallPacking) -> None:
    """Solved as rational series, all j < M ≤ 3."""
    cosine = dimensions.cosine_of(packing)
    ratios, sums = ratios_of(case, 3)
    values: explicit.Values = {phi: cosine, sigma: 1, r: 1, **sums}
    load = "bulk" if case.bulk else "surface"
    assert_equal(
        (
            f"M = {height}, j = {layer}",
            form,
            dimensions.squares_of_spheres(cosine, height, load, ratios)[layer],
        )
        for height, layer, form in stated(case.variance, 3, values)
    )


def test_spheres_solved_at_50_digits(packing: SmallPacking) -> None:
    worst = max(off for _, off in dimensions.remainders(dimensions.cosine_of(packing), 2, 1))
    # a central difference at 1e-20 with 50 digits: rounding 1e-30, curvature 1e-40
    assert worst < mpmath.mpf(10) ** -27
