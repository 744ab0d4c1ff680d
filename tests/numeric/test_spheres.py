"""Scenes in three dimensions: what they answer, and what they refuse."""

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.arithmetic.decimals import decimal_string
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down

import force_diffusion as fd
from tests.numeric.scenes import listed_loads, question
from tests.numeric.spheres import scene


def test_one_contact_and_one_bead_are_those_of_all():
    for row in scene(height=3, width=4).run().rows()[::11]:
        place = tuple(row[name] for name in ("p", "q", "j", "branch"))
        (contact,) = scene("contact", height=3, width=4, at=place).run().rows()
        assert (contact["branch"], contact["change"]) == (row["branch"], row["change"])
    beads = scene("positions", height=3, width=4).run()
    (bead,) = scene("positions", height=3, width=4, at=(3, 1, 2)).run().rows()
    assert bead in beads.rows()


@pytest.mark.long(sample=1)
@pytest.mark.parametrize("quantity", ["profile", "positions"])
@pytest.mark.parametrize(("geometry", "M"), [("first-order", 3), ("exact", 2)])
def test_images_are_seen_where_a_wider_packing_differs(quantity, geometry, M):
    """Which beads matter is tried one by one; images matter where two of them are W apart."""
    wide = 4 * M + 1
    region, linear = whole(wide**2, M, dimension=3), geometry == "first-order"
    rho = 1e-3 * np.random.default_rng(1).uniform(-1, 1, region.beads)
    # the last packing is as it was, in each other one bead is larger
    packings = rho + 1e-4 * np.eye(region.beads + 1, region.beads)
    with FLOAT64.active():
        placed = deposit(Fraction(1, 5), region, packings, FLOAT64, linear=linear)
        if quantity == "positions":
            answers = [sum(abs(placed.c(a, M)[:, 0]) for a in range(3))]
        else:
            forces = sweep_down(placed, region.rows, np.ones((3, M * wide**2)), linear=linear)
            answers = [forces.change(a, 1)[:, 0] for a in range(3)]
    middle = wide // 2
    matter = []
    for values in answers:
        j, p, q = np.unravel_index(
            np.flatnonzero(np.abs(values[:-1] - values[-1]) > 1e-15), (M + 1, wide, wide)
        )
        unwrapped = ((axis + middle) % wide - middle for axis in (p, q))
        matter.append({*zip(*(axis.tolist() for axis in (*unwrapped, j)), strict=True)})
    for width in range(1, 2 * M + 2):
        homes = [{(p % width, q % width, j) for p, q, j in beads} for beads in matter]
        sees = any(len(home) < len(beads) for home, beads in zip(homes, matter, strict=True))
        plan = scene(quantity, height=M, width=width, geometry=geometry).explain()
        assert plan.sees_images == sees, width


def test_a_profile_and_a_histogram_are_drawn():
    profile = scene("profile", height=2, width=6)
    axes = profile.run().plot().axes[0]
    names = axes.get_legend_handles_labels()[1]
    assert names == ["exact at finite $M$", *(f"simulated, $f^{a}$" for a in (1, 2, 3))]
    bins = fd.ensemble(scene("histogram", height=2, width=6, std=1e-4), 20).plot().axes[0]
    assert "theory: one Gaussian per layer" in bins.get_legend_handles_labels()[1]


@pytest.mark.parametrize("load", [fd.SurfaceLoad(), fd.BulkLoad(magnitude=2)])
def test_an_ensemble_has_the_width_of_theory(load):
    """With 400 packings σ_f is known to 1 %. Where images are seen there is no theory."""
    asked = scene("profile", height=4, width=6, std=1e-4, load=load)
    ensemble = fd.ensemble(asked, 400)
    assert ensemble.first_order_std is not None
    off = (ensemble.std - ensemble.first_order_std) / ensemble.std_error
    # 12 rows: one beyond 4.5 standard errors has a chance below 1e-4; the seed is fixed
    assert np.abs(off).max() < 4.5
    assert (ensemble.std_error / ensemble.std).max() < 0.02
    assert fd.ensemble(scene("profile", height=4, width=5, load=load), 4).first_order_std is None


def test_an_array_of_another_shape_is_refused(tmp_path):
    asked = {
        "packing": fd.Packing(height=3, width=5, dimension=3),
        "ask": fd.Ask(quantity="profile"),
    }
    for shape in ((4, 5), (4, 5, 4), (2, 2, 4, 5, 5)):
        with pytest.raises(fd.SceneError, match=r"give \(4, 5, 5\)|must be an array"):
            fd.Scene(disorder=fd.GivenRadii(radii=np.ones(shape)), **asked)
    np.save(tmp_path / "radii.npy", np.ones((4, 5)))
    given = fd.Disorder(kind="file", file="radii.npy")
    with pytest.raises(fd.ForceDiffusionError, match="of 5 × 5 beads"):
        fd.Scene(disorder=given, folder=tmp_path, **asked).run()


def test_a_plan_says_that_spheres_are_swept_whole_and_names_the_width_that_takes_memory():
    asked = scene("contact", height=3, width=9, at=(5, 5, 0, "1"))
    assert asked.explain().beads == 4 * 81
    wide = scene("contact", height=3, width=10**6, at=(5, 5, 0, "1"))
    with pytest.raises(fd.SceneError, match=r"packing.width = 1000000: this scene .*PB of"):
        wide.explain()


def test_what_no_load_reaches_is_not_solved_and_bears_nothing():
    load = fd.PointLoad(at=(1, 1, 2))
    asked = scene("contact", height=5, width=6, at=(1, 1, 3, "1"), load=load)
    assert asked.explain().problem.region.top == 2
    assert asked.run().rows()[0]["force"] == 0
    assert fd.ensemble(asked, 4).mean.tolist() == [0]


@pytest.mark.parametrize("height", [2, 3])
@pytest.mark.parametrize("width", [1, 2, 3, 4])
def test_the_response_to_a_point_load_sees_images_where_its_cone_meets_itself(height, width):
    """All radii of a wide packing matter to some contact; images where two are W apart."""
    wide = 2 * height + 2
    apart = range(-height, 1)
    # the simplex below the load, whose beads all decide where the loaded bead lies
    beads = {(p, q, j) for j in range(height) for p in apart for q in apart
             if height - j + p + q >= 0}  # fmt: skip
    homes = {(p % width, q % width, j) for p, q, j in beads}
    load = fd.PointLoad(at=(0, 0, height))
    plan = scene("response", height=height, width=width, load=load).explain()
    assert plan.sees_images == (len(homes) < len(beads))
    assert not scene("response", height=height, width=wide, load=load).explain().sees_images


def test_radii_of_ones_own_have_many_forms(tmp_path):
    """As an array, in a file, or listed in any order: as δr, or in another unit."""
    radii = 1 + 1e-2 * np.random.default_rng(5).uniform(-1, 1, (4, 4, 4))

    def changes(disorder: fd.Disorder | fd.GivenRadii, unit: Fraction = Fraction(1)) -> Any:
        asked = question(
            "contact_forces", 3, 4, dimension=3, radius=unit, spacing=Fraction("2.9") * unit,
            radii=disorder, folder=tmp_path,
        )  # fmt: skip
        return asked.run(tolerance="1e-40").arrays["change"]

    np.save(tmp_path / "radii.npy", radii)
    answers = [changes(fd.Disorder(kind="file", file="radii.npy"))]
    for name, unit in (("delta_r", Fraction(1)), ("r", Fraction(1, 8))):
        lines = [f"p,q,j,{name}"]
        for (j, p, q), r in reversed([*np.ndenumerate(radii)]):
            value = (Fraction(r) - (name == "delta_r")) * unit
            lines.append(f"{p},{q},{j},{decimal_string(value)}")
        (tmp_path / "radii.csv").write_text("\n".join(lines))
        answers.append(changes(fd.Disorder(kind="file", file="radii.csv"), unit))
    for other in answers:
        for a, b in zip(changes(fd.GivenRadii(radii=radii)), other, strict=True):
            assert abs(float((a - b).mid())) < 1e-38


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("i,j,delta_r", "the first line must name the columns p,q,j,delta_r or p,q,j,r"),
        ("p,q,j,r\n0,2,1,1", r"line 2: bead \(0, 2, 1\): p and q must be from 0 to 1"),
        ("p,q,j,r\n0,0,0,1\n0,1,0,1\n1,1,0,1", r"bead \(1, 0, 0\) is missing"),
    ],
)
def test_what_is_wrong_in_a_list_of_radii_is_named(text, says, tmp_path):
    (tmp_path / "radii.csv").write_text(text)
    radii = fd.Disorder(kind="file", file="radii.csv")
    with pytest.raises(fd.ForceDiffusionError, match=says):
        scene("profile", height=1, width=2, radii=radii, folder=tmp_path).run()


@pytest.mark.parametrize("quantity", ["contact_forces", "profile", "histogram", "contact"])
def test_a_file_without_loads_is_known_to_load_nothing(quantity, tmp_path):
    """As in two dimensions: certified zeros, and why."""
    load = listed_loads(tmp_path, [], "p,q,j,fx,fy,fz")
    at = (1, 1, 1, "1") if quantity == "contact" else None
    outcome = scene(quantity, height=3, width=4, load=load, at=at).run()
    reasons = [*outcome.plan.skipped.values()]
    assert "no load reaches what is asked for: the forces are exactly zero" in reasons
    assert outcome.accuracy.certified
    for name in ("force", "change", "mean", "std", "fz", "change_z"):
        assert not any(float(f) for f in outcome.arrays.get(name, ()))


def test_no_theory_is_said_of_loads_at_an_angle():
    asked = scene("profile", height=3, width=6, load=fd.SurfaceLoad(angle_deg=5))
    assert "first_order_std" not in asked.run().arrays
    assert asked.explain().tension is None


@pytest.mark.parametrize("magnitude", ["1e-250", "1e300"])
def test_a_load_beyond_float64_is_answered_in_balls(magnitude, tmp_path):
    load = listed_loads(tmp_path, [(1, 2, 2, 0, magnitude, 0)], "p,q,j,fx,fy,fz")
    assert scene("profile", load=load, std=1e-60).run().accuracy.certified
