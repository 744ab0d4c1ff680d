"""``--set``: scenes with other values than their files have."""

import csv
import io
import json
from pathlib import Path

import pytest

SCENE = """
packing = {height = 3, width = 6}
disorder = {kind = "uniform", relative_std = 1e-3}
ask = {quantity = "profile"}
"""


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    return path


def rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_set_gives_the_results_of_a_changed_file(scene, call):
    changed = scene.with_name("changed.toml")
    text = SCENE.replace("height = 3", "height = 4")
    changed.write_text(text.replace('"uniform"', '"normal", seed = 7'))
    status, plain, _ = call("run", changed, "--json")
    assert status == 0
    words = ("packing.height=4", "disorder.kind=normal", "disorder.seed=7")
    settings = (word for each in words for word in ("--set", each))
    status, changed_by_words, _ = call("run", scene, *settings, "--json")
    assert status == 0
    assert json.loads(changed_by_words)["results"] == json.loads(plain)["results"]


def test_a_sweep_answers_every_combination_in_a_folder_of_its_own(scene, tmp_path, call):
    out = tmp_path / "out"
    words = ("--set", "packing.height=2,3,4", "--set", "disorder.seed=0,1", "--out", out)
    status, _, stderr = call("run", scene, *words, "--set", "load.kind=bulk")
    assert (status, stderr) == (0, "")
    assert sorted(folder.name for folder in out.iterdir()) == [
        f"packing.height={M},disorder.seed={seed}" for M in (2, 3, 4) for seed in (0, 1)
    ]
    for folder in out.iterdir():
        height = int(folder.name[len("packing.height=")])
        assert len(rows((folder / "profile.csv").read_text())) == 2 * height
    status, stdout, _ = call("run", scene, "--set", "packing.height=2,3")
    assert status == 0
    assert "# packing.height = 2\n" in stdout
    assert "# packing.height = 3\n" in stdout


def test_json_of_a_sweep_is_one_list(scene, call):
    status, stdout, _ = call("run", scene, "--set", "packing.height=2,3", "--json")
    assert status == 0
    for height, answer in zip((2, 3), json.loads(stdout), strict=True):
        _, alone, _ = call("run", scene, "--set", f"packing.height={height}", "--json")
        assert answer["results"] == json.loads(alone)["results"]
