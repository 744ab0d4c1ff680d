"""Radii of one's own, in every form in which they may be given: one packing, one answer."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from force_diffusion.numeric.scene.files import TableError

import force_diffusion as fd
from tests.numeric.scenes import question

M, W, R = 4, 9, 2.5
DELTA = R * 1e-3 * np.random.default_rng(3).uniform(-1, 1, (M + 1, W))
SITES = [(j, q, 2 * q + j % 2) for j in range(M + 1) for q in range(W)]


def solved(path: Path, **ask: Any) -> fd.Outcome:
    radii = fd.Disorder(kind="file", file=path.name)
    return question(
        "contact_forces", M, W, radius=R, spacing=7.2, radii=radii, folder=path.parent, **ask
    ).run()


def listed(path: Path, header: str, rows: list[tuple[Any, ...]]) -> Path:
    lines = [",".join(map(repr, row)) for row in rows]
    path.write_text("\n".join([header, *lines]) + "\n")
    return path


@pytest.fixture
def reference(tmp_path: Path) -> Any:
    rows = [(i, j, float(DELTA[j, q])) for j, q, i in SITES]
    return solved(listed(tmp_path / "delta.csv", "i,j,delta_r", rows)).arrays["change"]


def same(outcome: fd.Outcome, reference: Any) -> bool:
    """Radii that were rounded to doubles move forces by some 1e-16 / 1e-3 of their change."""
    return bool(np.allclose(outcome.arrays["change"], reference, rtol=0, atol=1e-15))


def test_an_array(tmp_path, reference):
    np.save(tmp_path / "radii.npy", R + DELTA)
    outcome = solved(tmp_path / "radii.npy")
    assert same(outcome, reference)
    assert set(outcome.source["sha256"]) == {"disorder.file"}


def test_a_table_of_places(tmp_path, reference):
    """Places as an experiment has them: displaced, in any order, some beyond the seam."""
    random = np.random.default_rng(4)
    step = 2 * R * (1 - (7.2 / (4 * R)) ** 2) ** 0.5
    rows = []
    for j, q, i in SITES:
        dx, dy = random.uniform(-0.3, 0.3, 2) * R
        around = random.integers(-1, 2) * W * 7.2
        rows.append((float(i * 3.6 + dx + around), float(j * step + dy), R + float(DELTA[j, q])))
    random.shuffle(rows)
    assert same(solved(listed(tmp_path / "places.csv", "x,y,r", rows)), reference)


@pytest.mark.parametrize(
    ("place", "says"),
    [
        ("1.8,0", r"nearest site \(0, 0\)"),
        *((far, r"more than 2\^50 r from bead") for far in ("1e400,0", "0,1e308", "0,-1e20")),
    ],
)
def test_a_place_between_sites_is_refused(place, says, tmp_path):
    path = tmp_path / "places.csv"
    path.write_text(f"x,y,r\n{place},{R}\n")
    with pytest.raises(TableError, match=rf"places.csv, line 2: .*{says}"):
        solved(path)


@pytest.mark.parametrize(
    ("header", "offset"), [("i,j,r", -R), ("i,j,r", 2 * R), ("i,j,delta_r", 1.9 * R)]
)
def test_another_mean_is_refused(header, offset, tmp_path):
    start = R if header == "i,j,r" else 0.0
    rows = [(i, j, start + offset + abs(float(DELTA[j, q]))) for j, q, i in SITES]
    with pytest.raises(TableError, match="mean radius is"):
        solved(listed(tmp_path / "r.csv", header, rows))


SPACING, SCALE, ORIGIN = 7.2, 20.0, (300.0, 1200.0)
RADII = 2.5 + 0.01 * np.random.default_rng(3).standard_normal((9, 14))


def image(
    folder: Path, rotation: float = 4.0, delimiter: str = ",", without: int = -1, shift: float = 0.0
) -> Path:
    """Write the beads in any order, as an image has them: y points down."""
    beads = fd.solve(RADII, spacing=SPACING).beads
    places = (beads.positions @ [1, 1j]) * SCALE * np.exp(1j * math.radians(rotation))
    lines = [delimiter.join(("label", "y", "radius", "area", "x"))]
    for k in np.random.default_rng(5).permutation(len(places)).tolist():
        x = ORIGIN[0] + places[k].real + (shift if k == 40 else 0)
        row = (f"bead {k}", ORIGIN[1] - places[k].imag, beads.radii[k] * SCALE, 1, x)
        if k != without:
            lines.append(delimiter.join(map(str, row)))
    path = folder / "beads.csv"
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("rotation", [-9.0, 0.0, 4.0])
def test_a_packing_is_read_back(rotation, delimiter, tmp_path):
    """Centres lie off the lattice, by about 2 % of r: so near the fit comes."""
    fit = fd.read_radii(image(tmp_path, rotation, delimiter), spacing=SPACING)
    assert fit.radii / fit.radii.mean() == pytest.approx(RADII / RADII.mean(), rel=1e-12)
    assert fit.scale == pytest.approx(SCALE, rel=1e-3)
    assert fit.rotation == pytest.approx(rotation, abs=0.1)
    assert fit.origin == pytest.approx(ORIGIN, abs=0.02 * 2.5 * SCALE)
    assert 0.005 < fit.residual < 0.05
    solved = fd.solve(fit.radii, spacing=fit.spacing)
    expected = fd.solve(RADII, spacing=SPACING)
    assert solved.force == pytest.approx(expected.force, abs=1e-3)


@pytest.mark.parametrize(
    "given",
    [{"scale": SCALE}, {"scale": SCALE, "rotation": 4.0}, {"spacing": SPACING, "origin": ORIGIN}],
)
def test_given_values_stay_and_the_others_fit_best(given, tmp_path):
    """No other value of what is fitted has a smaller residual."""
    path = image(tmp_path)
    fit = fd.read_radii(path, **given)
    for name, value in given.items():
        assert getattr(fit, name) == pytest.approx(value, rel=1e-12)
    everything = {name: getattr(fit, name) for name in ("spacing", "scale", "rotation", "origin")}
    again = fd.read_radii(path, **everything)
    assert again.residual == pytest.approx(fit.residual, rel=1e-4)
    right, up = np.array(fit.origin) + np.eye(2)
    for name, value in (("rotation", fit.rotation + 0.05), ("origin", right), ("origin", up)):
        if name not in given:
            assert fd.read_radii(path, **everything | {name: value}).residual > fit.residual


def test_what_is_no_packing_is_refused(tmp_path):
    path = image(tmp_path, without=40)
    with pytest.raises(fd.TableError, match=r"bead \(24, 2\) is missing: each layer needs the 14"):
        fd.read_radii(path)
    path = image(tmp_path, rotation=40.0)
    with pytest.raises(fd.TableError, match="turned by more than 15°"):
        fd.read_radii(path)
    assert fd.read_radii(path, rotation=40.0).residual < 0.05
    with pytest.raises(fd.TableError, match="in the same unit"):
        fd.read_radii(path, rotation=40.0, scale=1.0, spacing=7.2)
    with pytest.raises(fd.TableError, match=r"lies .* r from site"):
        fd.read_radii(image(tmp_path, shift=30.0), spacing=SPACING)
    path.write_text("x,y\n1,2\n")
    with pytest.raises(fd.TableError, match="must name the columns x,y,r"):
        fd.read_radii(path)
    for name, value in (("scale", -1), ("spacing", "7"), ("rotation", math.nan)):
        with pytest.raises(fd.SceneError, match=f"{name} = .*must be a number above"):
            fd.read_radii(path, **{name: value})
    for origin in (5, (1, 2, 3), ("a", 1), (math.nan, 0)):
        with pytest.raises(fd.SceneError, match=r"origin = .*must be two numbers"):
            fd.read_radii(path, origin=origin)


@pytest.mark.parametrize("header", ["r;j;note;i", "radius\tj\tnote\ti"])
def test_columns_of_radii_files_may_have_any_order(header, tmp_path):
    delimiter = ";" if ";" in header else "\t"
    rows = [(r, j, "fine", 2 * q + j % 2) for (j, q), r in np.ndenumerate(RADII[:4, :6])]
    lines = [header, *(delimiter.join(map(str, row)) for row in rows)]
    (tmp_path / "radii.csv").write_text("\n".join(lines) + "\n")
    radii = fd.Disorder(kind="file", file="radii.csv")
    scene = question("contact_forces", 3, 6, radius=2.5, spacing=7.5, radii=radii, folder=tmp_path)
    solved = fd.solve(RADII[:4, :6], radius=2.5, spacing=7.5)
    expected = solved.forces.arrays["force"]  # of doubles, not of the decimals that they print
    assert scene.run().arrays["force"] == pytest.approx(expected, rel=1e-13)
    (tmp_path / "radii.csv").write_text("i,j,r,radius\n0,0,1,1\n")
    with pytest.raises(fd.TableError, match="names r twice; radius is r, too"):
        scene.run()
