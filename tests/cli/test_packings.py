"""The commands about unilateral contacts as a user calls them."""

import json
import os
from pathlib import Path

import pytest

from force_diffusion.__main__ import main

SCENE = """
[packing]
height = 6
width = 12
[disorder]
kind = "uniform"
relative_std = 0.03
seed = 2
[effects]
contacts = "unilateral"
[ask]
quantity = "contact_forces"
"""


def test_run_writes_packings_that_are_proved_again(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(SCENE)
    assert main(["run", str(scene), "--out", str(out)]) == 0
    data = json.loads((out / "result.json").read_text())
    assert data["networks"][0]["rest"] == (
        "a strict local minimum in the coordinates of beads that contacts hold"
    )
    capsys.readouterr()
    assert main(["check-packings", str(out / "packings.json")]) == 0
    assert capsys.readouterr().out.startswith("packing 0: proved")
    packings = json.loads((out / "packings.json").read_text())
    packings["packings"][0]["radii"][30] = "1.2"
    (out / "packings.json").write_text(json.dumps(packings))
    assert main(["check-packings", str(out / "packings.json"), "--json"]) == 3
    (verdict,) = json.loads(capsys.readouterr().out)
    assert not verdict["proved"]


@pytest.mark.long(sample=4)
@pytest.mark.parametrize("quantity", ["contact_forces", "positions", "profile", "histogram"])
def test_figures_of_a_scene(quantity: str, tmp_path: Path) -> None:
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(SCENE.replace("contact_forces", quantity))
    assert main(["figures", str(scene), "--out", str(out)]) == 0
    assert {path.suffix for path in out.iterdir()} == {".csv", ".json", ".pdf", ".png", ".svg"}


def test_check_packings_of_something_else(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for content in ("", "{}", SCENE):
        path = tmp_path / "packings.json"
        path.write_text(content)
        assert main(["check-packings", str(path)]) == 2
        assert "packings.json" in capsys.readouterr().err
    assert main(["check-packings", str(tmp_path / "none.json")]) == 2


def test_check_packings_says_what_is_no_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "packings.json").write_text("{}")
    os.mkfifo(tmp_path / "pipe")
    for name, says in {
        "nowhere.json": "there is no such file",
        ".": "is a folder; give a packings.json in it",
        "pipe": "must be an ordinary file",
    }.items():
        assert main(["check-packings", str(tmp_path / name)]) == 2
        assert says in capsys.readouterr().err
