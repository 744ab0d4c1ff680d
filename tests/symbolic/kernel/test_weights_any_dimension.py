"""Closed forms in any dimension against the recursion from bead to bead, and against discs."""

from fractions import Fraction
from itertools import product

import pytest
from force_diffusion.derivations import eq13_surface_diffusion as eq13
from force_diffusion.derivations import eq14_bulk_diffusion as eq14
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.exact import FIELD
from force_diffusion.symbolic.algebra.weights import UndeterminedError
from force_diffusion.symbolic.kernel.point_load import Weights
from force_diffusion.symbolic.kernel.weights_any_dimension import squares
from force_diffusion.symbolic.kernel.where import Where
from force_diffusion.symbolic.symbols import M, d, j, l, p, phi, q, r, sigma, tau_1, tau_2
from sympy import Eq, Integer

from tests.numeric.mechanics.any_dimension import force_weights, squared, together
from tests.soundness.witnesses import dimensions

CASES = {
    "interior": (j >= 2, j + 2 <= M),
    "base": (Eq(j, 0), M >= 3),
    "above it": (Eq(j, 1), M >= 3),
    "surface": (Eq(j, M - 1), M >= 3),
}
LOADS = {"surface": False, "bulk": True}


def form(relations: tuple, bulk: bool):
    where = Where((j, M), relations, dimension=d)
    return squares(*(one.xreplace(where.solved) for one in (j, M)), bulk, where), where


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("dimension", [2, 3, 4, 5])
def test_it_is_what_the_recursion_gives(load: str, case: str, dimension: int) -> None:
    found, where = form(CASES[case], LOADS[load])
    cosine, compared = Fraction(1, 7), 0
    for height, layer in product(range(3, 7 if dimension < 5 else 5), range(6)):
        if where.holds({j: layer, M: height}):
            both = force_weights(dimension, height, layer, cosine, bulk=LOADS[load])
            at = {j: layer, M: height, d: dimension, phi: cosine}
            assert found.at({s: Fraction(n) for s, n in at.items()}) == squared(together(both))
            compared += 1
    assert compared


@pytest.mark.parametrize("load", LOADS)
@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize(
    "ratios", [(Fraction(2, 3),), (Fraction(3), Fraction(1, 5)), (Fraction(1, 2),) * 3]
)
def test_a_load_leans_by_the_sums_of_ratios_and_of_their_squares(
    load: str, case: str, ratios: tuple[Fraction, ...]
) -> None:
    where = Where((j, M), CASES[case], dimension=d)
    layer, height = (one.xreplace(where.solved) for one in (j, M))
    found = squares(layer, height, LOADS[load], where, leaning=True)
    dimension, cosine, size = len(ratios) + 1, Fraction(-1, 6), 5
    at = next(at for at in range(1, size) if where.holds({j: at, M: size})) if case != "base" else 0
    both = force_weights(dimension, size, at, cosine, bulk=LOADS[load], ratios=ratios)
    values = {j: at, M: size, d: dimension, phi: cosine, tau_1: sum(ratios)}
    values |= {tau_2: sum(one**2 for one in ratios)}
    assert found.at({s: Fraction(n) for s, n in values.items()}) == squared(together(both))


@pytest.mark.parametrize("size", [(1, 0), (2, 0), (2, 1)])
def test_small_packings_have_forms_for_every_dimension(size: tuple[int, int]) -> None:
    height, layer = size
    where = Where((), (), dimension=d)
    found = squares(Integer(layer), Integer(height), False, where)
    for dimension, cosine in product((2, 3, 4), (Fraction(1, 5), Fraction(-1, 9))):
        true = squared(together(force_weights(dimension, height, layer, cosine)))
        assert found.at({d: Fraction(dimension), phi: cosine}) == true


@pytest.mark.parametrize(("load", "discs"), [("surface", eq13), ("bulk", eq14)])
def test_for_two_dimensions_it_is_that_of_discs(load: str, discs) -> None:
    names = {"interior": "interior", "above it": "base+1", "surface": "surface"}
    for case, theirs in names.items():
        found, _ = form(CASES[case], LOADS[load])
        whole = found.to_sympy().xreplace({d: Integer(2)}) * (sigma / r) ** 2
        stated = discs.exact_forms()[theirs].expression
        assert FIELD.from_sympy(whole - stated).is_zero()


@pytest.mark.parametrize(
    "relations", [(j >= 1, j + 2 <= M), (j >= 2, j + 1 <= M), (j >= 0, j <= 0, M >= 3)]
)
def test_what_the_domain_leaves_open_is_refused(relations: tuple) -> None:
    """The last one is the base, but not as an equation: two slices would be one."""
    with pytest.raises(UndeterminedError):
        form(relations, False)


def test_below_a_load_it_is_what_the_recursion_gives() -> None:
    cosine = Fraction(-1, 5)
    for layer, first, second, axis in product(range(4), (0, 1, 2), (0, 1, 3), (0, 1, 2)):
        level = layer + first + second
        weights = Weights(Where(dimension=3), affine.constant(level))
        bead = tuple(map(affine.constant, (first, second, 0)))
        ordered = weights.add_force(axis, bead)
        assert ordered == int(
            sum(map(bool, (first, second))) == 1 and bool((first, second, 0)[axis])
        )
        true = dimensions.response_weights(3, level, cosine, (first, second, 0), axis)
        assert weights.squares().at({phi: cosine}) == squared(true)


def test_an_open_place_below_a_load_is_refused() -> None:
    where = Where((j, l, p, q), (j >= 0, p >= 0, q >= 1, Eq(l, j + p + q)), dimension=3)
    weights = Weights(where, affine.from_sympy(j + p + q))
    with pytest.raises(UndeterminedError):
        weights.add_force(1, (affine.from_sympy(p), affine.from_sympy(q), affine.ZERO))
