"""Weights modulo a prime are those of fractions, from contacts and balances written anew."""

from fractions import Fraction

import pytest

from tests.derivations import first_principles
from tests.soundness.witnesses import modular

PHI = Fraction(-7, 25)
HEIGHTS = (1, 2, 3, 6)


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize(
    ("quantity", "kind", "load"),
    [("force", "+", "surface"), ("bulk", "+", "bulk"), ("bead", "p", "surface")],
)
def test_variances_of_means_are_those_of_fractions(
    height: int, quantity: str, kind: str, load: str
) -> None:
    exact = first_principles.weights(height, PHI, load)[kind]
    for layer in range(height):
        found = modular.mean_variances(quantity, height, layer, PHI)
        for count, value in enumerate(found[: height + 3], start=1):
            true = first_principles.mean_variance(exact[layer], count)
            assert value == modular.residue(true), (layer, count)


def test_covariances_between_layers_are_those_of_fractions() -> None:
    height = 6
    exact = first_principles.weights(height, PHI, "surface")["+"]
    for lower in range(height):
        for upper in range(lower, height):
            for places in range(-height - 1, height + 2):
                across = upper - lower + 2 * places
                true = first_principles.covariance(exact[lower], exact[upper], across)
                found = modular.between_layers(height, lower, upper, places, PHI)
                assert found == modular.residue(true), (lower, upper, places)


def test_what_has_no_value_modulo_the_prime_is_refused() -> None:
    assert modular.residue(Fraction(-1, 3)) * 3 % modular.PRIME == modular.PRIME - 1
    with pytest.raises(ZeroDivisionError, match="no value modulo"):
        modular.residue(Fraction(1, modular.PRIME))


def test_an_unknown_quantity_is_refused() -> None:
    with pytest.raises(ValueError, match='not of a "torque"'):
        modular.packing(2, PHI, "surface").weights("torque", 0)
