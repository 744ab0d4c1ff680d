"""Contacts that are expected to pull, against those of exact packings."""

from statistics import NormalDist, fmean

import pytest
from force_diffusion.numeric.theory.expected import expected_tension, stds_by_layer

import force_diffusion as fd
from tests.numeric.scenes import question

PHI = 1 - 2 * 0.75**2  # s = 3 r
M, W = 16, 32


DISCS: dict[str, int] = {"height": M, "width": W}
SPHERES = {"height": 8, "width": 10, "dimension": 3}


def scene(load: fd.Load, relative_std: float, packing: dict[str, int] = DISCS) -> fd.Scene:
    return question("profile", kind="normal", std=relative_std, seed=8, load=load, **packing)


@pytest.mark.long(sample=3)
@pytest.mark.parametrize(
    ("load", "relative_std", "packing", "room"),
    [
        (fd.SurfaceLoad(), 0.0055, DISCS, 0.3),
        (fd.BulkLoad(), 0.0156, DISCS, 0.2),
        (fd.SurfaceLoad(angle_deg=20), 0.004, DISCS, 0.2),
        (fd.SurfaceLoad(angle_deg=50), 0.002, DISCS, 0.02),
        (fd.SurfaceLoad(), 0.02, SPHERES, 0.2),
        (fd.BulkLoad(), 0.03, SPHERES, 0.2),
    ],
)
def test_exact_packings_have_as_many(load, relative_std, packing, room):
    """To first order, and Gaussian only for many layers: so it is an estimate, good to ``room``.

    At 50° one branch pulls in the ordered packing: about half of all contacts do.
    """
    asked = scene(load, relative_std, packing)
    expected = asked.explain().data()["tension"]["expected_contacts"]
    assert expected > 1
    ensemble = fd.ensemble(asked, 120)
    assert ensemble.tensile.sum() / 120 == pytest.approx(expected, rel=room)


@pytest.mark.long(sample=9)
@pytest.mark.parametrize("load", ["surface", "bulk"])
@pytest.mark.parametrize("height", [1, 3, 40, 99, 100, 101, 399, 2000])
def test_the_number_is_the_fraction_times_the_contacts(load, height):
    """From 100 layers on not every layer is looked at: the sum is good to a thousandth."""
    std = 0.8 * height**-1.5
    tails = [NormalDist().cdf(-1 / (std * each)) for each in stds_by_layer(load, height, PHI)]
    number = expected_tension(height, 5000, PHI, std, load).contacts
    assert number == pytest.approx(fmean(tails) * 2 * 5000 * height, rel=1e-3, abs=1e-12)


@pytest.mark.parametrize("load", ["surface", "bulk"])
def test_the_height_of_one_is_where_the_number_passes_one(load):
    height = expected_tension(4, W, PHI, 0.0055, load).height_of_one
    assert height is not None
    below, here = (expected_tension(h, W, PHI, 0.0055, load).contacts for h in (height - 1, height))
    assert below < 1 <= here
    assert expected_tension(4, W, PHI, 1e-30, load).height_of_one is None


def test_a_scene_whose_packings_have_tension_is_named(tmp_path, call):
    path = tmp_path / "scene.toml"
    for std, has_tension in ((0.0026, False), (0.0055, True)):
        path.write_text(
            f"packing = {{height = {M}, width = {W}}}\nask = {{quantity = 'profile'}}\n"
            f"disorder = {{kind = 'uniform', relative_std = {std}}}\n"
        )
        for command in (["run"], ["explain"], ["ensemble", "--realisations", "3"]):
            status, _, stderr = call(*command, path)
            words = "a typical packing of this scene has tension"
            assert (status, words in stderr) == (0, has_tension)
    assert scene(fd.SurfaceLoad(), 0.0055).explain().data()["tension"]["height_of_one"] == 14
