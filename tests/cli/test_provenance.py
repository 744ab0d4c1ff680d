"""Every answer says where it came from, in every format; large ones are whole."""

import csv
import hashlib
import json
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import force_diffusion as fd

SCENES = Path(__file__).parents[2] / "scenes"


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def parquet_of(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    parquet = pytest.importorskip("pyarrow.parquet")
    table = parquet.read_table(path)
    return table.to_pydict(), json.loads(table.schema.metadata[b"force-diffusion"])


def npz_of(path: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    with np.load(path, allow_pickle=False) as file:
        columns = {name: file[name].tolist() for name in file.files if name != "about"}
        return columns, json.loads(str(file["about"]))


@pytest.mark.parametrize("command", ["run", "ensemble"])
@pytest.mark.parametrize("written", ["csv", "npz", "parquet"])
def test_an_answer_says_where_it_came_from(command, written, tmp_path, printed):
    scene = SCENES / ("measured.toml" if command == "run" else "figure3.toml")
    out = tmp_path / "out"
    assert printed(command, scene, "--out", out, "--format", written, "--quiet") == ""
    about = json.loads((out / "result.json").read_text())
    source = about["source"]
    assert source["version"] == version("force-diffusion")
    assert source["scene"]["packing"]["height"] == fd.read_scene(scene).packing.height
    assert source["scene"]["packing"]["spacing"] == ("7.2" if command == "run" else "3")
    assert source["sha256"]["scene"] == digest(scene)
    if command == "run":
        assert source["sha256"]["disorder.file"] == digest(SCENES / "radii.csv")
        assert source["seed"] is None
        assert source["command"].startswith("force-diffusion run")
    else:
        assert source["seed"] == fd.read_scene(scene).disorder.seed
    (quantity,) = about["results"]
    table = out / f"{quantity}.{written}"
    if written == "csv":
        rows = about["results"][quantity]
        with table.open() as file:
            read = list(csv.DictReader(file))
        assert read == [{name: str(value) for name, value in row.items()} for row in rows]
        return
    columns, inside = (npz_of if written == "npz" else parquet_of)(table)
    assert inside == about
    rows = len(next(iter(columns.values())))
    assert about["results"] == {quantity: {"file": table.name, "rows": rows}}
    if command == "run":
        outcome = fd.read_scene(scene).run()
        assert columns == {name: column.tolist() for name, column in outcome.arrays.items()}


@pytest.mark.parametrize("written", ["npz", "parquet"])
def test_numbers_of_more_digits_than_float64_are_decimals(written, tmp_path, printed):
    scene, out = SCENES / "one_contact.toml", tmp_path / "out"
    printed("run", scene, "--out", out, "--format", written, "-q")
    columns, _ = (npz_of if written == "npz" else parquet_of)(out / f"contact.{written}")
    (row,) = fd.read_scene(scene).run().decimals()
    assert columns == {name: [value] for name, value in row.items()}


def test_rows_are_printed_or_written_and_quiet_is_quiet(tmp_path, printed):
    scene = SCENES / "measured.toml"
    whole = printed("run", scene)
    first = [line for line in whole.splitlines() if not line.startswith("#")]
    assert first[0] == "i,j,branch,x,y,upper_x,upper_y,wraps,force,change"
    assert "# 38 more rows: --quiet prints all, --out DIR writes them" in whole
    rows = printed("run", scene, "--quiet").splitlines()
    assert (len(rows), rows[:11]) == (49, first)
    words = printed("run", scene, "--out", tmp_path / "a")
    assert "contact_forces: 48 rows" in words
    assert rows[1] not in words
    assert (tmp_path / "a" / "contact_forces.csv").read_text().splitlines() == rows
    assert printed("run", scene, "--out", tmp_path / "b", "-q") == ""


def test_a_format_needs_its_library(tmp_path, refused, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    arguments = ("run", SCENES / "measured.toml", "--out", tmp_path / "x", "--format", "parquet")
    assert "force-diffusion[tables]" in refused(*arguments)
    assert not (tmp_path / "x").exists()


def test_an_array_of_radii_is_identified_by_its_hash():
    radii = 1 + 1e-3 * np.random.default_rng(1).uniform(-1, 1, (5, 12))
    source = fd.solve(radii).forces.source
    assert source["sha256"] == {"disorder.radii": hashlib.sha256(radii.tobytes()).hexdigest()}
    assert source["scene"]["disorder"] == {"kind": "given", "radii": [5, 12]}
    assert source["seed"] is None
