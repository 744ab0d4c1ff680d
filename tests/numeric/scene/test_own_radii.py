"""Radii of one's own, in every form in which they may be given: one packing, one answer."""

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


def same(found: fd.Outcome, reference: Any) -> bool:
    """Radii that were rounded to doubles move forces by some 1e-16 / 1e-3 of their change."""
    return bool(np.allclose(found.arrays["change"], reference, rtol=0, atol=1e-15))


def test_an_array(tmp_path: Path, reference: Any) -> None:
    np.save(tmp_path / "radii.npy", R + DELTA)
    found = solved(tmp_path / "radii.npy")
    assert same(found, reference)
    assert set(found.source["sha256"]) == {"disorder.file"}


def test_a_table_of_places(tmp_path: Path, reference: Any) -> None:
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
def test_a_place_between_sites_is_refused(place: str, says: str, tmp_path: Path) -> None:
    path = tmp_path / "places.csv"
    path.write_text(f"x,y,r\n{place},{R}\n")
    with pytest.raises(TableError, match=rf"places.csv, line 2: .*{says}"):
        solved(path)


@pytest.mark.parametrize(
    ("header", "offset"), [("i,j,r", -R), ("i,j,r", 2 * R), ("i,j,delta_r", 1.9 * R)]
)
def test_another_mean_is_refused(header: str, offset: float, tmp_path: Path) -> None:
    start = R if header == "i,j,r" else 0.0
    rows = [(i, j, start + offset + abs(float(DELTA[j, q]))) for j, q, i in SITES]
    with pytest.raises(TableError, match="mean radius is"):
        solved(listed(tmp_path / "r.csv", header, rows))
