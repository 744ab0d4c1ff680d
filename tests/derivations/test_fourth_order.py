"""How far Eqs. 13 and 14 are valid: order σ⁴ of the variance, measured; its leading order, fitted.

What docs/background/validity.md says of it. Nothing of this is proved.
"""

from fractions import Fraction
from itertools import product

import numpy as np
import pytest
from flint import fmpq

from tests.derivations.fourth_order import bulk_leading, other_laws, surface_leading, variances
from tests.numeric.mechanics import taylor

N = (Fraction(3, 5), Fraction(4, 5))
PHI = Fraction(7, 25)
ANOTHER = -0.3
"""No φ that the fit has seen: it was made at −1/8, 0, 7/25 and 2/5."""


def by_taylor(height: int, layer: int, load: str) -> tuple[fmpq, fmpq]:
    """The orders σ² and σ⁴ as fractions, of one radius or two at a time."""
    width = 2 * height + 3
    beads = [(2 * q + j % 2, j) for j, q in product(range(height + 1), range(width))]
    loads = {
        bead: (Fraction(0), -2 * N[1])
        for bead in beads
        if bead[1] == height or (load == "bulk" and bead[1])
    }

    def change(rho: dict[tuple[int, int], Fraction | fmpq]) -> list[fmpq]:
        solved = taylor.solve(width, height, n=N, rho=rho, loads=loads, order=3)
        coefficients = solved.force(layer % 2, layer, "+")
        return [coefficient / coefficients[0] for coefficient in coefficients]

    single = {bead: change({bead: Fraction(1)}) for bead in beads}
    weights = {bead: orders[1] for bead, orders in single.items()}
    squares = sum((orders[2] ** 2 for orders in single.values()), fmpq(0))
    for a, first in enumerate(beads):
        for second in beads[:a]:
            both = change({first: Fraction(1), second: Fraction(1)})[2]
            squares += (both - single[first][2] - single[second][2]) ** 2 / 2
    # T is trilinear: what w + e and w − e have beyond twice w is 6 T(w, e, e)
    alone, third = change(weights)[3], fmpq(0)
    for bead in beads:
        for sign in (1, -1):
            third += change({**weights, bead: weights[bead] + sign})[3] - alone
    return sum((w**2 for w in weights.values()), fmpq(0)), 2 * squares + third


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("load", ["surface", "bulk"])
@pytest.mark.parametrize(("height", "layer"), [(1, 0), (2, 0), (2, 1)])
def test_floats_are_the_exact_coefficients(load, height, layer):
    orders = variances(height, float(PHI), load == "bulk")[layer]
    exact = by_taylor(height, layer, load)
    assert orders == pytest.approx(tuple(map(float, exact)), rel=1e-11)  # a few hundred roundings


@pytest.mark.long(share=2)
@pytest.mark.parametrize("bulk", [False, True])
def test_the_leading_order_is_as_fitted_at_another_cosine(bulk):
    """From the fourth layer to the third below the surface it is one polynomial, of degree 4.

    Under a bulk load it is so times (M − j)², of degree 6, and has few of the powers.
    """
    powers = (
        [(a, b) for a in range(7) for b in range(min(3, 7 - a)) if b < 2 or a in (2, 4)]
        if bulk
        else [(a, b) for a in range(5) for b in range(5 - a)]
    )
    heights = range(7, 14 if bulk else 13)
    sites = [(height, j) for height in heights for j in range(4, height - 2)]
    assert len(sites) >= len(powers) + 6
    values = np.array([variances(height, ANOTHER, bulk)[j][1] for height, j in sites])
    if bulk:
        values *= [(height - j) ** 2 for height, j in sites]
    base = [(height - j if bulk else height, j) for height, j in sites]
    table = np.array([[float(m) ** a * float(j) ** b for a, b in powers] for m, j in base])
    scale = np.abs(values)[:, None]
    columns = np.abs(table / scale).max(axis=0)
    solution, *_ = np.linalg.lstsq(table / scale / columns, values / scale[:, 0], rcond=None)
    residuals = table / columns @ solution / values - 1
    assert np.abs(residuals).max() < 1e-11  # more values than coefficients
    degree = 6 if bulk else 4
    of = {power: value / unit for power, value, unit in zip(powers, solution, columns, strict=True)}
    highest = [of[a, b] for a, b in sorted(powers, reverse=True) if a + b == degree]
    coefficients = (bulk_leading if bulk else surface_leading)(ANOTHER)
    expected = [coefficient / (1 - ANOTHER**2) ** 4 for coefficient in coefficients]
    assert highest == pytest.approx(expected, rel=1e-6)


@pytest.mark.long(sample=1)
@pytest.mark.parametrize(("bulk", "degree"), [(False, 3), (True, 5)])
@pytest.mark.parametrize("layer", [0, 4])
def test_what_other_laws_of_the_radii_add_grows_as_the_cube_of_the_height(bulk, degree, layer):
    """In a fixed layer it is a polynomial in M, under a bulk load over (M − j)²."""
    heights = np.arange(7, 9 + degree)
    values = np.array([other_laws(height, float(PHI), bulk)[layer] for height in heights])
    if bulk:
        values *= (heights - layer)[:, None] ** 2
    assert (np.diff(values, n=degree, axis=0) > 1).all()
    assert np.abs(np.diff(values, n=degree + 1, axis=0)).max() < 1e-10 * values.max()
