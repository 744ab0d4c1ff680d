"""The commands about unilateral contacts as a user calls them."""

import json
from pathlib import Path

from tests.numeric.scenes import basic, toml


def asked(folder: Path, **effects: int) -> Path:
    sections = basic(6, 12)
    sections["disorder"] |= {"relative_std": "=0.03", "seed": 2}
    path = folder / "scene.toml"
    path.write_text(toml(sections | {"effects": {"contacts": "unilateral", **effects}}))
    return path


def test_run_says_what_is_proved(tmp_path, printed):
    out = tmp_path / "out"
    rest = "a strict local minimum in the coordinates of beads that contacts hold"
    assert f"the packing: {rest}; " in printed("run", asked(tmp_path), "--out", out)
    network = json.loads((out / "result.json").read_text())["network"]
    assert network["rest"] == rest
    assert network["contacts"] == 2 * (6 * 12 - network["rattlers"])
    assert network["programs"] > 0


def test_a_search_without_a_packing_ends_with_a_message_and_status_3(tmp_path, refused):
    says = "no packing was found, though one may exist: beads still slide after 1 linear"
    assert says in refused("run", asked(tmp_path, most_programs=1), status=3)
