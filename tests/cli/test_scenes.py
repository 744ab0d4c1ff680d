"""The commands for scenes, as a user calls them."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.accuracy import ToleranceError

import force_diffusion as fd
from tests.cli.conftest import Call

SCENES = Path(__file__).parents[2] / "scenes"


@pytest.mark.long(sample=5)
@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda p: p.stem)
def test_the_examples_work(path: Path, call: Call) -> None:
    status, out, err = call("run", path, "--json")
    assert status == 0
    data = json.loads(out)
    assert err == "".join(f"force-diffusion: {path.name}: {note}\n" for note in data["notes"])
    assert bool(data["notes"]) == (path.stem == "beyond")
    (rows,) = data["results"].values()
    assert rows
    assert set(data["accuracy"]) >= {"error_bound", "certified", "arithmetic"}
    status, explained, _ = call("explain", path, "--json")
    assert status == 0
    assert json.loads(explained) == {key: data[key] for key in json.loads(explained)}


def test_text_output_says_what_was_done(call: Call) -> None:
    status, out, _ = call("run", SCENES / "one_contact.toml")
    assert status == 0
    assert "certified" in out
    assert "physical" in out
    assert "skipped: other beads (only those that the answer depends on are solved)" in out
    status, out, _ = call("explain", SCENES / "one_contact.toml")
    assert status == 0
    assert "Skipped: other beads: only those that the answer depends on are solved" in out


def test_a_tolerance_can_be_given(call: Call) -> None:
    _, out, _ = call("run", SCENES / "one_contact.toml", "--json", "--tolerance", "1e-60")
    accuracy = json.loads(out)["accuracy"]
    assert accuracy["certified"]
    assert accuracy["error_bound"] <= 1e-60


def test_out_writes_the_rows_that_are_printed(tmp_path: Path, call: Call) -> None:
    out = tmp_path / "out"
    for more in ((), ("--overwrite",)):
        words = ("run", SCENES / "measured.toml", "--out", out, "--json", *more)
        status, shown, _ = call(*words)
        assert status == 0
    assert sorted(p.name for p in out.iterdir()) == ["contact_forces.csv", "result.json"]
    assert json.loads((out / "result.json").read_text())["results"] == json.loads(shown)["results"]
    lines = (out / "contact_forces.csv").read_text().splitlines()
    assert lines[0] == "i,j,branch,x,y,upper_x,upper_y,wraps,force,change"
    assert len(lines) == 1 + 2 * 6 * 4


def test_out_of_reach_is_status_three(monkeypatch: pytest.MonkeyPatch, call: Call) -> None:
    def fail(*_: Any, **__: Any) -> None:
        raise ToleranceError("the tolerance can't be reached: the reason")

    monkeypatch.setattr(fd, "run", fail)
    status, out, err = call("run", SCENES / "one_contact.toml", "--json")
    assert (status, out) == (3, "")
    assert "the reason" in err


@pytest.mark.long(sample=1)
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="asks Linux for the peak")
@pytest.mark.parametrize("tolerance", ["", "tolerance = 1e-30"])
def test_memory_stays_within_what_was_announced(tolerance: str, tmp_path: Path) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(
        "[packing]\nheight = 60\nwidth = 122\n[disorder]\nkind = 'uniform'\n"
        f"relative_std = 1e-5\n[ask]\nquantity = 'contact_forces'\n{tolerance}\n",
    )
    program = (
        "import sys; from force_diffusion.__main__ import main; "
        "status = main(['run', sys.argv[1], '--json']); "
        "lines = open('/proc/self/status').read().splitlines(); "
        "print(*[line.split()[1] for line in lines if line.startswith('VmHWM')], file=sys.stderr); "
        "raise SystemExit(status)"
    )
    for _ in range(2):  # the first run may have to compile the loops
        done = subprocess.run(
            [sys.executable, "-c", program, str(scene)], capture_output=True, text=True, check=True
        )
    kilobytes = int(done.stderr.split()[-1])
    assert kilobytes * 1024 <= json.loads(done.stdout)["plan"]["memory_bytes"]
