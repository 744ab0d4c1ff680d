"""Three dimensions: small disorder is first order, and what can't rest or stand is named."""

from fractions import Fraction
from itertools import product
from typing import Any

import flint
import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.errors import UndecidedError
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array, Balls
from force_diffusion.numeric.lattice.layers import Region, whole
from force_diffusion.numeric.mechanics import sweep
from force_diffusion.numeric.mechanics.physicality import Physicality, by_distance

from tests.numeric.spheres import scene


def spheres(rho: list[Array]) -> tuple[Region, Array]:
    """The region of layers (W, W), and δr/r of one packing."""
    region = whole(rho[0].size, len(rho) - 1, dimension=3)
    return region, np.stack(rho).reshape(1, -1)


def from_above(region: Region, share: Any) -> Array:
    """Ordered forces of a load on the highest layer, the same along all axes."""
    beads = region.beads - region.rows[0].count
    return np.full((region.dimension, beads), share)


def test_small_disorder_is_first_order():
    exact, first = (
        scene(height=3, width=4, std=1e-30, geometry=g).run(tolerance="1e-29")
        for g in ("exact", "first-order")
    )
    for a, b in zip(exact.arrays["change"], first.arrays["change"], strict=True):
        assert abs(float((a - b) / b)) < 1e-26  # second order, 1e-30, over the smallest change


def test_gaps_of_touching_beads_are_told_apart():
    """At s = 2r beads of a layer touch: no gap, to the last place."""
    region, rho = spheres([np.zeros((3, 3))] * 2)
    with FLOAT64.active():
        physicality = Physicality()
        physicality.look_at_gaps(sweep.deposit(Fraction(1, 2), region, rho, FLOAT64))
    assert physicality.smallest_gap == 0
    # three pairs a bead, in each of two layers
    assert (physicality.overlaps, physicality.undecided_gaps) == (0, 3 * 9 * 2)


@pytest.mark.parametrize(("dimension", "phi"), [(2, Fraction(-2, 5)), (3, Fraction(-3, 10))])
def test_pairs_come_by_distance_each_once(dimension, phi):
    pairs = [pair for pair, _ in zip(by_distance(dimension, float(phi)), range(400), strict=False)]
    assert [distance for distance, _ in pairs] == sorted(distance for distance, _ in pairs)
    steps = {step for _, step in pairs}
    assert len(steps) == len(pairs)
    assert not steps & {tuple(-s for s in step) for step in steps}
    last = pairs[-1][0]
    for step in product(range(-5, 6), repeat=dimension):
        square = 4 * (sum(s * s for s in step) * (1 - phi) + sum(step) ** 2 * phi)
        contact = sum(map(abs, step)) == 1
        if any(step) and not contact and float(square) ** 0.5 < last - 1e-9:
            assert step in steps or tuple(-s for s in step) in steps


def test_a_support_that_is_too_large_is_named():
    rho = [np.zeros((4, 4)), np.zeros((4, 4))]
    rho[0][2, 1] = 6.0
    with FLOAT64.active(), pytest.raises(sweep.UnbuildableError) as raised:
        sweep.deposit(Fraction(1, 5), *spheres(rho), FLOAT64)
    # it holds up (2, 1, 1), (3, 1, 1) and (2, 2, 1): the first in order is named
    assert raised.value.site == (2, 1, 1)


@pytest.mark.parametrize(
    "rho",
    [
        [[[0.7, 0.1], [0.2, 0.2]], [[2.0, 0.9], [1.1, 0.1]], [[1.1, -0.5], [-0.7, 1.6]]],
        [[[0.8, 1.3], [1.2, -0.8]], [[0.7, 1.7], [1.4, 1.0]], [[0.0, -0.4], [0.5, 1.8]]],
    ],
)
def test_supports_that_lie_too_steeply_are_named(rho):
    """In the first their plane is steeper than a base vector, in the second two change places."""
    with FLOAT64.active(), pytest.raises(sweep.UnbuildableError, match="steeper") as raised:
        sweep.deposit(Fraction(1, 5), *spheres([np.array(row) for row in rho]), FLOAT64)
    assert raised.value.site[2] == 2


def test_contacts_in_one_plane_hold_nothing_up():
    """The first contact of bead (1, 0, 1) is turned onto the second."""
    block = np.zeros((1, 12, 8))
    block[0, 3:5, 6] = -1, 1
    region, nothing = spheres([np.zeros((2, 2))] * 2)
    placed = sweep.Solved(Fraction(1, 5), FLOAT64, region, nothing, block)
    with FLOAT64.active(), pytest.raises(sweep.NotStandingError, match=r"\(1, 0, 1\).*one plane"):
        sweep.sweep_down(placed, region.rows, from_above(region, 1.0))


def test_what_balls_leave_open_is_undecided():
    system = Balls(60)
    with system.active():
        rho = [system.zeros(2, 2), system.zeros(2, 2)]
        rho[0][0, 1] = flint.arb(3, 3)  # a support of any size from r to 7 r
        with pytest.raises(UndecidedError, match="layer 1"):
            sweep.deposit(Fraction(1, 5), *spheres(rho), system)
