"""Contacts and beads of solved packings: their geometry, tables, pictures and files."""

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import force_diffusion as fd
from tests.numeric.scenes import listed_loads, question

ROUNDING = 1e-14  # a few roundings of numbers of about 1


def radii_of(*shape: int) -> Any:
    return 1 + 0.01 * np.random.default_rng(7).standard_normal(shape)


SOLVED = {
    "discs": lambda: fd.solve(radii_of(5, 8), spacing=2.7),
    "bulk": lambda: fd.solve(radii_of(6, 9), load=fd.BulkLoad()),
    "balls": lambda: fd.solve(radii_of(4, 6), tolerance=1e-25),
    "spheres": lambda: fd.solve(radii_of(4, 6, 6), dimension=3),
    "packings": lambda: fd.solve(radii_of(3, 4, 6)),
    "deviations": lambda: fd.solve(delta_r=2.5 * (radii_of(4, 6) - 1), radius=2.5, spacing=7),
}


@pytest.mark.parametrize("name", SOLVED)
def test_beads_touch_and_stand(name):
    """From first principles: centres are two radii apart, and each bead's forces add up to 0."""
    solution = SOLVED[name]()
    contacts, beads = solution.contacts, solution.beads
    lower, upper = contacts.pairs.T
    length, scale = contacts.ends[..., 1, :] - contacts.ends[..., 0, :], beads.radii.max()
    apart = beads.radii[..., lower] + beads.radii[..., upper]
    assert np.abs(np.linalg.norm(length, axis=-1) - apart).max() < ROUNDING * scale
    assert np.abs(np.linalg.norm(contacts.normals, axis=-1) - 1).max() < ROUNDING
    touches = contacts.ends[..., 0, :] + beads.radii[..., lower, None] * contacts.normals
    assert np.abs(touches - contacts.points).max() < ROUNDING * scale
    centres = beads.positions.astype(float)
    straight = ~contacts.wraps
    assert np.allclose(contacts.ends[..., 1, :][..., straight, :], centres[..., upper[straight], :])
    assert (np.abs(length - (centres[..., upper, :] - centres[..., lower, :])).max(-1) > 1)[
        ..., contacts.wraps
    ].all()  # a period, and no rounding
    for packing in np.ndindex(*centres.shape[:-2]):
        total = borne(solution, packing)
        loaded = beads.layers > 0 if name == "bulk" else beads.layers == beads.layers.max()
        total[loaded, -1] -= 1
        assert np.abs(total[beads.layers > 0]).max() < 10 * ROUNDING


def borne(solution: fd.Solution, packing: tuple[int, ...] = ()) -> Any:
    """Give what the contacts of each bead bear, (beads, d)."""
    lower, upper = solution.contacts.pairs.T
    force = solution.contacts.force_vector[packing]
    total = np.zeros((len(solution.beads.layers), force.shape[-1]))
    np.add.at(total, upper, force)
    np.add.at(total, lower, -force)
    return total


LEANING = -np.sin(np.radians(20)), 0, np.cos(np.radians(20))
STEEP = np.sin(np.radians(89)), 0, np.cos(np.radians(89))


@pytest.mark.parametrize(
    ("load", "forces"),
    [
        (fd.BulkLoad(angle_deg=20), dict.fromkeys(np.ndindex(6, 6, 3), LEANING)),
        (fd.PointLoad(at=(1, 2, 2), angle_deg=-89), {(1, 2, 1): STEEP}),
        (None, {(0, 1, 1): (-0.5, 0.25, 1), (2, 2, 0): (1, -2, -0.125)}),
    ],
)
def test_spheres_bear_any_load(load, forces, tmp_path):
    """Against the load, by column and by layer above the base; without one, they are in a file."""
    rows, expected = [], np.zeros((3, 6, 6, 3))
    for (p, q, j), (x, y, z) in forces.items():
        expected[j, p, q] = x, y, z
        rows.append((p, q, j + 1, -x, -y, -z))
    load = load or listed_loads(tmp_path, rows, "p,q,j,fx,fy,fz")
    result = borne(fd.solve(radii_of(4, 6, 6), dimension=3, load=load))[36:]
    assert result == pytest.approx(expected.reshape(-1, 3), abs=100 * ROUNDING)


def test_columns_stand_side_by_side_with_the_lattice():
    for name in ("discs", "spheres", "packings"):
        solution = SOLVED[name]()
        data, d = solution.to_xarray(), solution.position.shape[-1]
        across = ("column",) if d == 2 else ("p", "q")
        lead = ("packing",) if name == "packings" else ()
        force = data.force.transpose(*lead, "branch", "layer", *across)
        assert np.array_equal(force.values, solution.force)
        frame = solution.to_dataframe()
        assert np.array_equal(frame["upper_radius"], data.upper_radius.values.reshape(-1))
        scene = solution.forces
        assert np.allclose(frame["upper_x"], scene.arrays["upper_x"], atol=1e-10)
        assert np.array_equal(frame["wraps"], scene.arrays["wraps"])
        assert np.array_equal(frame["force"], scene.to_dataframe()["force"])


def test_contact_forces_say_where_contacts_are():
    """Places are those of positions; beads that the answer doesn't depend on have none."""
    results = question(["contact_forces", "positions"], 4, 9, std=1e-2).run().results
    places = {(r["i"], r["j"]): (r["x"], r["y"]) for r in results["positions"].rows()}
    for row in results["contact_forces"].rows():
        assert (row["x"], row["y"]) == pytest.approx(places[row["i"], row["j"]], abs=1e-10)
        i = row["i"] + (1 if row["branch"] == "+" else -1)
        turns, home = divmod(i, 18)
        x, y = places[home, row["j"] + 1]
        assert (row["upper_x"], row["upper_y"]) == pytest.approx((x + 27 * turns, y), abs=1e-10)
        assert row["wraps"] == (turns != 0)
    cone = question("contact_forces", 4, 9, load=fd.PointLoad(at=(4, 4))).run()
    unreached = np.isnan(cone.arrays["upper_x"])
    assert unreached.any()
    assert not cone.arrays["force"][unreached].any()
    assert {cone.text["upper_x"][k] for k in np.flatnonzero(unreached)} == {""}


def test_profiles_and_histograms_become_tables():
    for quantity, sizes in (("profile", {"layer": 4, "branch": 2}), ("histogram", None)):
        scene = question(quantity, 4, 10, kind="normal", realisations=3)
        for outcome in (scene.run(), fd.ensemble(scene, 3)):
            data = outcome.to_xarray()
            assert dict(data.sizes) == (sizes or {"bin": len(outcome.arrays["low"])})
            frame = outcome.to_dataframe()
            assert list(frame) == list(outcome.arrays)
    assert data["count"].values.tolist() == outcome.arrays["count"].tolist()


def test_without_the_libraries_tables_say_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(fd.ForceDiffusionError, match=r"pip install 'force-diffusion\[tables\]'"):
        SOLVED["discs"]().to_dataframe()


def vtk_of(path: Path) -> dict[str, Any]:
    """Read points, lines and columns of legacy VTK, by its description."""
    text = path.read_text().replace("\nLOOKUP_TABLE default", "")
    _, kind, data, *parts = re.split(r"\n(?=[A-Z]{3})", text)
    assert (kind, data) == ("ASCII", "DATASET POLYDATA")
    columns = {}
    for part in parts:
        head, *rows = part.splitlines()
        kind, name, *_ = head.split()
        numbers = np.array([row.split() for row in rows], float).squeeze()
        columns[name if kind in {"SCALARS", "VECTORS"} else kind] = numbers
    return columns


@pytest.mark.parametrize("name", ["discs", "spheres", "packings"])
def test_vtk_has_lines_as_long_as_two_radii(name, tmp_path):
    solution, packing = SOLVED[name](), 2 if name == "packings" else 0
    solution.to_vtk(tmp_path / "a.vtk", packing=packing)
    columns = vtk_of(tmp_path / "a.vtk")
    points, (two, *ends) = columns["POINTS"], columns["LINES"].T.astype(int)
    assert (two == 2).all()
    length = np.linalg.norm(points[ends[1]] - points[ends[0]], axis=1)
    radius = columns["radius"]
    assert len(radius) == len(points)
    assert np.abs(length - radius[ends].sum(axis=0)).max() < ROUNDING * 100
    assert np.array_equal(columns["force"], solution.contacts.of(packing).force)
    assert np.allclose(np.linalg.norm(columns["force_vector"], axis=1), np.abs(columns["force"]))
    assert columns["wraps"].sum() == solution.contacts.wraps.sum() > 0


def dumped(path: Path, kind: str) -> tuple[list[list[float]], dict[str, Any]]:
    """Read bounds and columns of a dump of LAMMPS."""
    lines = path.read_text().splitlines()
    assert lines[:3] == ["ITEM: TIMESTEP", "0", f"ITEM: NUMBER OF {kind}"]
    assert lines[4].startswith("ITEM: BOX BOUNDS ")
    head, *names = lines[8].removeprefix("ITEM: ").split()
    assert head == kind
    rows = np.array([line.split() for line in lines[9:]], float)
    assert len(rows) == int(lines[3])
    bounds = [[float(word) for word in line.split()] for line in lines[5:8]]
    return bounds, dict(zip(names, rows.T, strict=True))


@pytest.mark.parametrize("name", ["discs", "spheres"])
def test_dumps_of_beads_and_contacts_fit_together(name, tmp_path):
    """Numbers of beads are those of the other file; periods make all contacts two radii long."""
    solution = SOLVED[name]()
    solution.to_dump(tmp_path / "beads")
    solution.to_dump_local(tmp_path / "contacts")
    bounds, beads = dumped(tmp_path / "beads", "ATOMS")
    same, contacts = dumped(tmp_path / "contacts", "ENTRIES")
    assert bounds == same
    assert contacts["index"].tolist() == list(range(1, len(contacts["index"]) + 1))
    first, second = (np.searchsorted(beads["id"], contacts[name]) for name in ("batom1", "batom2"))
    places = np.stack([beads[x] for x in "xyz"], axis=1)
    lean = bounds[0][2] if name == "spheres" else 0.0
    periods = [[bounds[0][1] - bounds[0][0] - lean, 0, 0]]
    if name == "spheres":
        periods.append([lean, bounds[1][1] - bounds[1][0], 0])
    apart = places[second] - places[first]
    for shift in np.ndindex(*[3] * len(periods)):
        turned = places[second] - places[first] + (np.array(shift) - 1) @ np.array(periods)
        shorter = (turned**2).sum(axis=1) < (apart**2).sum(axis=1)
        apart[shorter] = turned[shorter]
    both = beads["radius"][first] + beads["radius"][second]
    assert np.abs(np.linalg.norm(apart, axis=1) - both).max() < 100 * ROUNDING
    force = np.stack([contacts[x] for x in ("fx", "fy", "fz")], axis=1)
    assert np.allclose(force, contacts["force"][:, None] * apart / both[:, None])


def test_a_plot_has_a_line_for_each_contact_that_bears_enough():
    plt = pytest.importorskip("matplotlib.pyplot")
    from matplotlib.collections import LineCollection

    solution = SOLVED["discs"]()
    figure, ax = plt.subplots()
    assert solution.plot(ax, color="change", least=0.7) is ax
    (lines,) = (c for c in ax.collections if isinstance(c, LineCollection))
    some = solution.contacts.force >= 0.7
    assert np.array_equal(lines.get_array(), solution.contacts.change[some])
    r = radii_of(5, 8).mean()
    assert np.allclose(lines.get_segments(), solution.contacts.ends[some] / r)
    widths = lines.get_linewidths()
    assert np.argmax(widths) == np.argmax(solution.contacts.force[some])
    plt.close(figure)
    drawn = solution.plot()
    assert sum(len(c.get_segments()) for c in drawn.collections if hasattr(c, "get_segments")) == 64
    for wrong, words in (
        ({"color": "colour"}, '"force", "change", "branch" or "wraps"'),
        ({"color": [1, 2]}, "a number for each of the 64 contacts"),
        ({"least": 9}, "no contact bears more than"),
        ({"least": "9"}, 'least = "9": must be a number'),
        ({"packing": 1}, "from 0 to 0"),
    ):
        with pytest.raises(fd.SceneError, match=words):
            solution.plot(**wrong)
    with pytest.raises(fd.SceneError, match="to_vtk"):
        SOLVED["spheres"]().plot()
