"""The commands about unilateral contacts as a user calls them."""

import json
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


def test_run_says_what_is_proved(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene, out = tmp_path / "scene.toml", tmp_path / "out"
    scene.write_text(SCENE)
    assert main(["run", str(scene), "--out", str(out)]) == 0
    rest = "a strict local minimum in the coordinates of beads that contacts hold"
    assert f"the packing: {rest}; " in capsys.readouterr().out
    found = json.loads((out / "result.json").read_text())["network"]
    assert found["rest"] == rest
    assert found["contacts"] == 2 * (6 * 12 - found["rattlers"])
    assert found["programs"] > 0


def test_no_packing_ends_in_words_with_status_3(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE.replace("[ask]", "most_programs = 1\n[ask]"))
    assert main(["run", str(scene)]) == 3
    said = capsys.readouterr().err
    assert "no packing was found, though one may exist: beads still slide after 1 linear" in said
