"""The commands for scenes, as a user calls them."""

import json
from pathlib import Path

import pytest

SCENES = Path(__file__).parents[2] / "scenes"


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
    assert status == 0
    assert json.loads(explained) == {key: data[key] for key in json.loads(explained)}


def test_of_positions_alone_it_is_open_whether_contacts_pull(call):
    status, stdout, _ = call("run", SCENES / "settled.toml")
    assert status == 0
    assert "no overlaps; whether contacts pull was not asked" in stdout


def test_text_output_says_what_was_done(call):
    status, stdout, _ = call("run", SCENES / "one_contact.toml")
    assert status == 0
    assert "certified" in stdout
    assert "physical" in stdout
    assert "skipped: other beads (only those that the answer depends on are solved)" in stdout
    status, stdout, _ = call("explain", SCENES / "one_contact.toml")
    assert status == 0
    assert "Skipped: other beads: only those that the answer depends on are solved" in stdout
