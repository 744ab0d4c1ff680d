"""The command ``cost`` as a user calls it."""

import csv
import hashlib
import io
import json
from pathlib import Path

import pytest
from force_diffusion.numeric.run import cost as module

SCENE = """
[packing]
height = 3
width = 5
[disorder]
kind = "uniform"
relative_std = 1e-4
[ask]
quantity = "contact_forces"
"""


@pytest.fixture(autouse=True)
def _one_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "SHORT", 0)


def written(folder: Path, text: str = SCENE) -> Path:
    path = folder / "scene.toml"
    path.write_text(text)
    return path


def test_json_and_files(tmp_path, call):
    out, scene = tmp_path / "out", written(tmp_path)
    status, stdout, stderr = call("cost", scene, "--out", out, "--json")
    assert (status, stderr) == (0, "")
    data = json.loads(stdout)
    assert data["rows"]
    assert json.loads((out / "cost.json").read_text()) == data
    assert data["command"].startswith("force-diffusion cost ")
    hashed = {"scene": hashlib.sha256(scene.read_bytes()).hexdigest()}
    assert (data["source"]["sha256"], data["source"]["file"]) == (hashed, "scene.toml")
    rows = list(csv.DictReader(io.StringIO((out / "cost.csv").read_text())))
    assert [float(row["error"]) for row in rows] == [row["error"] for row in data["rows"]]
    assert sorted(path.name for path in out.iterdir()) == [
        "cost.csv", "cost.json", "cost.pdf", "cost.png", "cost.svg"
    ]  # fmt: skip
    png = (out / "cost.png").read_bytes()
    assert png.startswith(b"\x89PNG")
    assert data["command"].encode() in png
    svg = (out / "cost.svg").read_text()
    assert data["command"] in svg


def test_the_table(tmp_path, call):
    status, stdout, stderr = call("cost", written(tmp_path))
    assert (status, stderr) == (0, "")
    lines = stdout.splitlines()
    assert lines[0].split() == ["way", "digits", "error", "seconds", "relative", "cost"]
    assert [line.split()[:2] for line in lines[1:]] == [
        ["float64", "16"], ["balls", "15"], ["balls", "30"], ["balls", "100"], ["mpmath", "30"]
    ]  # fmt: skip
    assert max(map(len, lines)) <= 80
    higher = SCENE.replace("height = 3", "height = 40\nallow_images = true")
    status, stdout, _ = call("cost", written(tmp_path, higher), "--seconds", "1e-6")
    assert status == 0
    assert stdout.count("estimated") == 10


@pytest.mark.usefixtures("without_matplotlib")
def test_without_matplotlib_only_the_plot_is_missing(tmp_path, call):
    out = tmp_path / "out"
    status, stdout, stderr = call("cost", written(tmp_path), "--out", out, "--json")
    assert status == 0
    assert json.loads(stdout)["rows"]
    assert "force-diffusion[plots]" in stderr
    names = sorted(path.name for path in out.iterdir())
    assert names == ["cost.csv", "cost.json"]
