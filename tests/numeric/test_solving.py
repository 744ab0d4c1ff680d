"""Radii of one's own: every bead is in balance, in space and exactly."""

import math
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.mechanics.sweep import UnbuildableError
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

import force_diffusion as fd


def test_radii_and_their_deviations_are_the_same_packing():
    delta = np.random.default_rng(3).normal(0, 1e-3, (5, 12))
    radii = 2 + delta  # rounded: what is solved are these doubles
    solution = fd.solve(radii, radius=2, spacing=6)
    other = fd.solve(delta_r=radii - 2, radius=2, spacing=6)
    assert np.array_equal(solution.force, other.force)
    assert np.array_equal(solution.position, other.position)


@pytest.mark.parametrize(("shape", "dimension"), [((3, 4, 7), None), ((2, 3, 4, 4), 3)])
def test_a_batch_is_its_packings(shape, dimension):
    """Four axes can only be spheres."""
    batch = 1 + np.random.default_rng(4).uniform(-1e-4, 1e-4, shape)
    together = fd.solve(batch, radius=1)
    d = dimension or 2
    assert together.force.shape == (shape[0], d, shape[1] - 1, *shape[2:])
    assert together.position.shape == (*shape, d)
    for k, radii in enumerate(batch):
        alone = fd.solve(radii, radius=1, dimension=dimension)
        for name in ("force", "change", "position"):
            assert np.array_equal(getattr(together, name)[k], getattr(alone, name))


def test_equal_radii_are_the_ordered_packing():
    solution = fd.solve(np.ones((4, 6)))
    assert solution.change.astype(float).tolist() == np.zeros((2, 3, 6)).tolist()
    n_y = math.sqrt(1 - (3 / 4) ** 2)
    assert solution.force.astype(float) == pytest.approx(np.full((2, 3, 6), 1 / (2 * n_y)))


DISCS, SPHERES = np.ones((3, 4)), np.ones((3, 4, 4))
REFUSED: list[tuple[dict[str, Any], str]] = [
    ({}, "give either radii or delta_r"),
    ({"radii": np.ones(4)}, r"shape \(layers, W\)"),
    ({"radii": np.full((3, 4), np.nan)}, r"\[0, 0\] is not"),
    ({"radii": np.ones((1, 4))}, "at least 2 layers"),
    ({"radii": np.zeros((3, 0))}, "empty"),
    ({"radii": "a"}, "^radii = "),
    ({"radii": [[10**400, 1], [1, 1]]}, "real numbers"),
    ({"radii": DISCS + 1j}, "real numbers"),
    ({"radii": np.ma.masked_array(DISCS, mask=np.eye(3, 4))}, "masked"),
    ({"radii": DISCS * 1.7e308}, r"(?s)^radii = .*at most 1e\+300"),
    ({"delta_r": DISCS, "radius": 10**400}, "radius = .*another unit"),
    ({"radii": DISCS, "radius": 9}, "^radius = 9"),
    ({"radii": 1.001 * DISCS, "spacing": 9}, r"^spacing = 9: .* \(it is about 8\.99\d* r\)"),
    ({"radii": DISCS, "load": "surface"}, r"must be SurfaceLoad\(\)"),
    ({"radii": DISCS, "load": fd.PointLoad(at=(1, 2))}, r"i \+ j must be even"),
    ({"radii": DISCS, "load": fd.PointLoad(at=(3, 8))}, "j must be from 1, above the base"),
    ({"radii": DISCS, "tolerance": "x"}, "not a finite decimal number"),
    ({"radii": DISCS, "certified": True}, "needs a tolerance"),
    ({"radii": DISCS, "dimension": 3}, r"shape \(3, 4\): spheres take \(layers, W, W\)"),
    ({"radii": DISCS, "dimension": 4}, "^dimension = 4: must be 2, of discs, or 3, of spheres"),
    ({"radii": np.ones((2, *SPHERES.shape)), "dimension": 2}, r"discs take \(layers, W\)"),
    ({"radii": SPHERES[:1], "dimension": 3}, "at least 2 layers"),
    (
        {"radii": np.ones((5, 4, 4)), "dimension": 3},
        r"5 layers of 4 × 4 beads.*images; if you want that.*allow_images=True",
    ),
    ({"radii": SPHERES, "dimension": 3, "load": fd.PointLoad(at=(0, 2))}, r"load.at.*\[p, q, j\]"),
]


@pytest.mark.parametrize(("arguments", "says"), REFUSED, ids=range(len(REFUSED)))
def test_what_is_refused(arguments, says):
    with pytest.raises(fd.SceneError, match=says) as refused:
        fd.solve(**arguments)
    assert refused.value.exit_status == 2


@pytest.mark.parametrize(
    ("shape", "remedy"), [((13, 4), "radii.T"), ((2, 13, 4), "radii.swapaxes(-1, -2)")]
)
def test_an_array_that_may_be_transposed_is_refused(shape, remedy):
    with pytest.raises(fd.SceneError, match=r"13 layers of \d+ beads.*allow_images") as refused:
        fd.solve(np.ones(shape))
    assert f"if transposed, give {remedy};" in str(refused.value)
    assert fd.solve(np.ones(shape), allow_images=True).force.shape[-2:] == (12, shape[-1])


@pytest.mark.parametrize("shape", [(13, 24, 24), (2, 3, 3)])
def test_a_stack_of_squares_needs_its_dimension(shape):
    """It is one packing of spheres or several of discs; nobody is to get the other one unawares."""
    layers, side = shape[0], shape[-1]
    with pytest.raises(fd.SceneError, match=r"dimension=3.*dimension=2") as refused:
        fd.solve(np.ones(shape))
    assert f"{layers} layers of {side} × {side}" in str(refused.value)
    flat = fd.solve(np.ones(shape), dimension=2)
    assert flat.force.shape == (layers, 2, side - 1, side)
    spheres = fd.solve(np.ones(shape), dimension=3)
    assert spheres.force.shape == (3, layers - 1, side, side)
    assert spheres.position.shape == (layers, side, side, 3)


@pytest.mark.parametrize("how", [{}, {"tolerance": "1e-20"}])
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_error_says_why_supports_do_not_hold_a_bead(dimension, how):
    """A bead of 0.2 r falls through a gap of r; one on a disc of 3.5 r misses that beside it."""
    radii = np.ones((2, 6, 6)[:dimension])
    place = (2,) * (dimension - 1)
    small, large = radii.copy(), radii.copy()
    small[1, *place] = 0.2
    large[0, *place], large[1] = 3.5, 1.5
    for axis in range(dimension - 1):
        for side in (1, -1):
            beside = list(place)
            beside[axis] += side
            large[0, *beside] = 0.1
    for odd, why, remedy in (
        (small, "too far apart to hold it;", "smaller spacing"),
        (large, "too close to hold it up", "larger spacing"),
    ):
        with pytest.raises(UnbuildableError, match=rf"^bead \(.*{why}.*{remedy}"):
            fd.solve(odd, dimension=dimension, radius=1, spacing=3, **how)


@pytest.mark.parametrize("how", [{}, {"tolerance": "1e-20"}])
@pytest.mark.parametrize("power", [-330, -130, 130, 330])
@pytest.mark.parametrize("name", ["radii", "delta_r"])
def test_units_of_length_change_no_digit(name, power, how):
    """Powers of two. Beside 1e-300 r errors of δr/r were lost: 12 digits, where 16 were stated."""
    deviations = 1e-12 * np.random.default_rng(0).uniform(-1, 1, (4, 6))
    given = 1 + deviations if name == "radii" else 7 * deviations
    usual, other = (
        fd.solve(**{name: np.ldexp(given, k)}, radius=Fraction(2) ** k, **how) for k in (0, power)
    )
    for column in ("force", "change"):
        assert other.forces.text[column] == usual.forces.text[column]
    assert other.error == pytest.approx(usual.error)


@pytest.mark.parametrize("power", [-980, 990])
def test_units_in_which_errors_would_vanish_are_solved_in_balls(power):
    given = 1 + 1e-12 * np.random.default_rng(0).uniform(-1, 1, (4, 6))
    solution = fd.solve(np.ldexp(given, power), radius=Fraction(2) ** power)
    usual = fd.solve(given, radius=1, tolerance="1e-20")
    assert solution.certified
    change = usual.change.astype(float)
    # float64 rounds a change by 1e-16 of itself
    assert solution.change.astype(float) == pytest.approx(change, rel=1e-15)


@given(
    st.sampled_from([(4, 7), (3, 4, 7), (5, 6), (3, 4, 4), (2, 3, 5, 5)]),
    st.sampled_from([fd.SurfaceLoad(), fd.BulkLoad(magnitude=2.5)]), st.integers(0, 2**32),
    st.sampled_from([1e-9, 1e-4, 3e-2]), st.sampled_from([1, 0.25]),
)  # fmt: skip
def test_forces_are_those_of_the_scene(shape, load, seed, size, radius):
    drawn = np.random.default_rng(seed).uniform(-size, size, shape)
    dimension = 3 if shape in {(3, 4, 4), (2, 3, 5, 5)} else 2
    try:
        solution = fd.solve(delta_r=radius * drawn, radius=radius, dimension=dimension, load=load)
    except fd.ForceDiffusionError:
        return
    assert "forces" not in vars(solution)  # it was solved without a scene
    places = solution.positions.arrays
    for k, axis in enumerate("xyz"[:dimension]):
        assert_array_equal(solution.position[..., k].ravel(), places[axis])
        assert_array_equal(solution.displacement[..., k].ravel(), places[f"d{axis}"])
    outcome = solution.forces
    for name in ("force", "change"):
        by_contact = np.moveaxis(getattr(solution, name), -dimension - 1, -1)
        assert_array_equal(by_contact.ravel(), outcome.arrays[name])
    assert solution.error == outcome.accuracy.error_bound
    assert solution.physical == outcome.physical
