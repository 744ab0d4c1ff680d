"""The command ``cost`` as a user calls it."""

import csv
import hashlib
import io
import json

import pytest

from tests.cli.conftest import SCENE

pytestmark = pytest.mark.usefixtures("timed_once")


def test_json_and_files(scene, tmp_path, printed):
    out = tmp_path / "out"
    data = json.loads(printed("cost", scene, "--out", out, "--json"))
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
    assert data["command"] in (out / "cost.svg").read_text()


def test_the_table(scene, printed):
    lines = printed("cost", scene).splitlines()
    assert lines[0].split() == ["way", "digits", "error", "seconds", "relative", "cost"]
    assert [line.split()[:2] for line in lines[1:]] == [
        ["float64", "16"], ["balls", "15"], ["balls", "30"], ["balls", "100"], ["mpmath", "30"]
    ]  # fmt: skip
    assert max(map(len, lines)) <= 80
    scene.write_text(SCENE.replace("height = 3", "height = 40, allow_images = true"))
    assert printed("cost", scene, "--seconds", "1e-6").count("estimated") == 10


@pytest.mark.usefixtures("without_matplotlib")
def test_without_matplotlib_only_the_plot_is_missing(scene, tmp_path, call):
    out = tmp_path / "out"
    status, stdout, stderr = call("cost", scene, "--out", out, "--json")
    assert status == 0
    assert json.loads(stdout)["rows"]
    assert "force-diffusion[plots]" in stderr
    assert {path.name for path in out.iterdir()} == {"cost.csv", "cost.json"}
