"""The commands for scenes, as a user calls them."""

import json
from pathlib import Path

import pytest

SCENES = Path(__file__).parents[2] / "scenes"
ONLY = "only those that the answer depends on are solved"


@pytest.mark.long(sample=5)
@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda p: p.stem)
def test_the_examples_work(path, call):
    status, stdout, stderr = call("run", path, "--json")
    assert status == 0
    data = json.loads(stdout)
    assert stderr == "".join(f"force-diffusion: {path.name}: {note}\n" for note in data["notes"])
    assert bool(data["notes"]) == (path.stem == "beyond")
    (rows,) = data["results"].values()
    assert rows
    assert set(data["accuracy"]) >= {"error_bound", "certified", "arithmetic"}
    status, explained, _ = call("explain", path, "--json")
    expected = {key: data[key] for key in json.loads(explained)}
    assert (status, json.loads(explained)) == (0, expected)


@pytest.mark.parametrize(
    ("command", "scene", "says"),
    [
        ("run", "settled", "no overlaps; whether contacts pull was not asked"),
        ("run", "one_contact", "certified"),
        ("run", "one_contact", "physical"),
        ("run", "one_contact", f"skipped: other beads ({ONLY})"),
        ("explain", "one_contact", f"Skipped: other beads: {ONLY}"),
    ],
)
def test_text_output_says_what_was_done(command, scene, says, printed):
    """Whether contacts pull is open where positions alone are asked for."""
    assert says in printed(command, SCENES / f"{scene}.toml")
