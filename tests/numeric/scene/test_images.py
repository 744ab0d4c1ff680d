"""Radii from an image: a packing is solved, drawn turned and in pixels, and read back."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import force_diffusion as fd
from tests.numeric.scenes import question

SPACING, SCALE, ORIGIN = 7.2, 20.0, (300.0, 1200.0)
RADII = 2.5 + 0.01 * np.random.default_rng(3).standard_normal((9, 14))


def image(
    folder: Path,
    rotation: float = 4.0,
    delimiter: str = ",",
    without: int | None = None,
    shift: float = 0.0,
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
def test_a_packing_is_read_back(rotation: float, delimiter: str, tmp_path: Path) -> None:
    """Centres lie off the lattice, by about 2 % of r: so near the fit comes."""
    found = fd.read_radii(image(tmp_path, rotation, delimiter), spacing=SPACING)
    assert found.radii / found.radii.mean() == pytest.approx(RADII / RADII.mean(), rel=1e-12)
    assert found.scale == pytest.approx(SCALE, rel=1e-3)
    assert found.rotation == pytest.approx(rotation, abs=0.1)
    assert found.origin == pytest.approx(ORIGIN, abs=0.02 * 2.5 * SCALE)
    assert 0.005 < found.residual < 0.05
    solved = fd.solve(found.radii, spacing=found.spacing)
    expected = fd.solve(RADII, spacing=SPACING)
    assert solved.force == pytest.approx(expected.force, abs=1e-3)


@pytest.mark.parametrize(
    "given",
    [{"scale": SCALE}, {"scale": SCALE, "rotation": 4.0}, {"spacing": SPACING, "origin": ORIGIN}],
)
def test_what_is_given_is_kept_and_the_rest_is_the_best(
    given: dict[str, Any], tmp_path: Path
) -> None:
    """No other value of what is fitted has a smaller residual."""
    path = image(tmp_path)
    found = fd.read_radii(path, **given)
    for name, value in given.items():
        assert getattr(found, name) == pytest.approx(value, rel=1e-12)
    everything = {name: getattr(found, name) for name in ("spacing", "scale", "rotation", "origin")}
    again = fd.read_radii(path, **everything)
    assert again.residual == pytest.approx(found.residual, rel=1e-4)
    assert fd.read_radii(path, **everything | {"origin": np.array(found.origin)}) is not None
    x, y = found.origin
    for other in (
        {"rotation": found.rotation + 0.05},
        {"origin": (x + 1, y)},
        {"origin": (x, y + 1)},
    ):
        if not other.keys() & given.keys():
            assert fd.read_radii(path, **everything | other).residual > found.residual


def test_what_is_no_packing_is_refused(tmp_path: Path) -> None:
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
def test_columns_of_radii_files_may_have_any_order(header: str, tmp_path: Path) -> None:
    delimiter = ";" if ";" in header else "\t"
    lines = [header]
    for j in range(4):
        for q in range(6):
            lines.append(delimiter.join((str(RADII[j, q]), str(j), "fine", str(2 * q + j % 2))))
    (tmp_path / "radii.csv").write_text("\n".join(lines) + "\n")
    radii = fd.Disorder(kind="file", file="radii.csv")
    scene = question("contact_forces", 3, 6, radius=2.5, spacing=7.5, radii=radii, folder=tmp_path)
    solved = fd.solve(RADII[:4, :6], radius=2.5, spacing=7.5)
    expected = solved.forces.arrays["force"]  # of doubles, not of the decimals that they print
    assert scene.run().arrays["force"] == pytest.approx(expected, rel=1e-13)
    (tmp_path / "radii.csv").write_text("i,j,r,radius\n0,0,1,1\n")
    with pytest.raises(fd.TableError, match="names r twice; radius is r, too"):
        scene.run()
