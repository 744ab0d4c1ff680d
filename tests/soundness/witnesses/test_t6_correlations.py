"""Eqs. B7, B8, B12 and B21: means over neighbours, and covariances between layers."""

from collections.abc import Iterable, Iterator
from fractions import Fraction
from itertools import combinations, product

import pytest
from force_diffusion.derivations.beyond import t6_correlations as t6
from force_diffusion.derivations.beyond import t6_neighbours
from force_diffusion.derivations.parts.neighbours import Means
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.symbols import M, N, j, l, phi, r, sigma

from tests.soundness.witnesses import modular, neighbours
from tests.soundness.witnesses.comparing import assert_equal
from tests.soundness.witnesses.draws import SmallPacking

pytestmark = pytest.mark.long(sample=1)

every_mean = pytest.mark.parametrize(
    ("means", "quantity"),
    [
        pytest.param(t6_neighbours.UNDER_SURFACE, "force", id="B7"),
        pytest.param(t6_neighbours.OF_BEADS, "bead", id="B8"),
        pytest.param(t6_neighbours.UNDER_BULK, "bulk", id="B21"),
    ],
)


def cosine_of(packing: SmallPacking) -> Fraction:
    return packing.n[1] ** 2 - packing.n[0] ** 2


def stated(means: Means, height: int, layer: int, count: int, cosine: Fraction) -> Fraction:
    """The variance of the mean over N neighbours, for r = σ = 1."""
    at = {M: height, j: layer, N: count}
    forms = ((means.printed.rhs, means.where, means.by), *means._forms())
    form = next(form for form, where, _ in forms if where.holds(at))
    return explicit.number(form, {**at, phi: cosine, sigma: 1, r: 1})


@every_mean
def test_small_packings_summed_before_they_are_squared(
    means: Means, quantity: str, packing: SmallPacking
) -> None:
    """Exact packings of M ≤ 4, every layer, N from 2 to 7."""

    def pairs() -> Iterator[tuple[str, Fraction, Fraction]]:
        for height, count in product(range(1, 5), range(2, 8)):
            for layer in range(height):
                true = neighbours.mean_variance(quantity, height, layer, count, packing.n)
                where = f"M = {height}, j = {layer}, N = {count}"
                yield where, stated(means, height, layer, count, cosine_of(packing)), true

    assert_equal(pairs())


@every_mean
def test_high_packings_modulo_a_prime(means: Means, quantity: str, packing: SmallPacking) -> None:
    """Packings of 12 ≤ M ≤ 15, every layer and N ≤ 2M."""
    cosine, height = cosine_of(packing), 9 + packing.height

    def pairs() -> Iterator[tuple[str, int, int]]:
        for layer in range(height):
            true = modular.mean_variances(quantity, height, layer, cosine)
            for count in range(2, 2 * height + 1):
                form = stated(means, height, layer, count, cosine)
                where = f"M = {height}, j = {layer}, N = {count}"
                yield where, modular.residue(form), true[count - 1]

    assert_equal(pairs())


def covariances(
    heights: Iterable[int], cosine: Fraction
) -> Iterator[tuple[str, tuple[int, int, int], Fraction]]:
    """What is stated of pairs of layers: where, (M, j, l), the covariance for r = σ = 1."""
    forms = [(t6.between(*t6.INSIDE), t6.LAYERS.rhs)]
    forms += [(t6.between(*one.domain), one.expression) for one in t6.edges().values()]
    for height in heights:
        for lower, upper in combinations(range(height), 2):
            at = {M: height, j: lower, l: upper}
            form = next(form for where, form in forms if where.holds(at))
            value = explicit.number(form, {**at, phi: cosine, sigma: 1, r: 1})
            yield f"M = {height}, j = {lower}, l = {upper}", (height, lower, upper), value


def test_layers_of_small_packings(packing: SmallPacking) -> None:
    assert_equal(
        (where, value, neighbours.between_layers(*at, packing.n))
        for where, at, value in covariances((2, 3, 4, 5), cosine_of(packing))
    )


def test_layers_of_high_packings_modulo_a_prime(packing: SmallPacking) -> None:
    cosine = cosine_of(packing)
    assert_equal(
        (where, modular.residue(value), modular.between_layers(*at, 0, cosine))
        for where, at, value in covariances((13, 20), cosine)
    )
