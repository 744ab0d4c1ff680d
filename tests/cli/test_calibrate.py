"""The calibration of a machine: measured, stored, recognised, redone."""

import json
import os
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.planning import cost_model, stored_costs
from force_diffusion.numeric.planning.cost_model import Model
from force_diffusion.numeric.planning.stored_costs import StaleError
from force_diffusion.numeric.studies import calibrating

from force_diffusion.__main__ import main

SCENES = Path(__file__).parents[2] / "scenes"


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A place of its own for the calibration."""
    path = tmp_path / "cache" / "calibration.json"
    monkeypatch.setattr(stored_costs, "location", lambda: path)
    return path


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Calibrating that takes no time; counts how often it was done."""
    done: list[str] = []

    def calibrate(*_: Any, **__: Any) -> Model:
        done.append("calibrated")
        return cost_model.defaults().model_copy(update={"source": "calibrated quickly"})

    monkeypatch.setattr(calibrating, "calibrate", calibrate)
    return done


def call(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    status = main([str(a) for a in arguments])
    shown = capsys.readouterr()
    return status, shown.out, shown.err


def test_a_calibration_measures_every_step(
    own_cache: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(calibrating, "RUNS", 1)
    monkeypatch.setattr(calibrating, "ENOUGH", 0)
    measure = calibrating.calibrate
    monkeypatch.setattr(
        calibrating, "calibrate", lambda notice, compiled: measure(notice, compiled=False)
    )
    status, out, err = call(capsys, "calibrate", "--json")
    assert (status, err) == (0, "")
    model = Model.model_validate(json.loads(out))
    assert stored_costs.load() == model
    for family, steps in cost_model.defaults().families.items():
        assert set(model.families[family]) == set(steps)
        for step in steps:
            fitted = model.families[family][step]
            assert fitted.seconds
            assert all(seconds > 0 for seconds in fitted.seconds.values())


def test_a_stored_calibration_is_used_and_not_made_again(
    own_cache: Path, quick: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    for again in (False, True):
        status, out, err = call(capsys, "explain", SCENES / "measured.toml")
        assert status == 0
        assert ("calibrating" in err) is not again
        assert err.count("\n") == (not again)
        assert "calibrated quickly" in out
    assert quick == ["calibrated"]
    assert [path.name for path in own_cache.parent.iterdir()] == ["calibration.json"]


def test_without_a_tolerance_nothing_is_calibrated(
    own_cache: Path, quick: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = call(capsys, "explain", SCENES / "figure3.toml", "--json")
    assert (status, err, quick) == (0, "", [])
    assert json.loads(out)["choice"] is None
    assert not own_cache.exists()


def changed(**changes: Any) -> str:
    data = json.loads(stored_costs.location().read_text())
    for key, value in changes.items():
        data[key] = value
    return json.dumps(data)


DAMAGE = {
    "empty": lambda: "",
    "cut off": lambda: stored_costs.location().read_text()[:-40],
    "another file": lambda: '{"program": "another"}',
    "nested": lambda: "[" * 100_000,
    "no text": lambda: "\udcff\udcfe",
    "another schema": lambda: changed(schema_version=99),
    "another python": lambda: changed(versions={**stored_costs.versions(), "python": "3.0.0"}),
    "another flint": lambda: changed(versions={**stored_costs.versions(), "python-flint": "0"}),
    "another machine": lambda: changed(machine={**stored_costs.machine(), "processor": "abacus"}),
    "extra key": lambda: changed(surprise=1),
    "no families": lambda: changed(model={"source": "x", "load_seconds": 0, "families": {}}),
    "huge": lambda: " " * (stored_costs.LARGEST_FILE + 1),
    "not a number": lambda: stored_costs.location().read_text().replace(
        '"load_seconds":', '"load_seconds":NaN,"x":'
    ),
    "negative": lambda: stored_costs.location().read_text().replace('"calls": ', '"calls": -'),
    "infinite": lambda: stored_costs.location().read_text().replace('"beads": ', '"beads": 1e999'),
}  # fmt: skip


@pytest.mark.parametrize("damage", DAMAGE)
def test_what_does_not_hold_here_is_recognised_and_redone(
    damage: str, own_cache: Path, quick: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    stored_costs.store(cost_model.defaults())
    text = DAMAGE[damage]()
    own_cache.write_bytes(text.encode("utf-8", "surrogateescape"))
    with pytest.raises(StaleError, match=r"calibration\.json"):
        stored_costs.load()
    status, _, err = call(capsys, "explain", SCENES / "measured.toml")
    assert (status, quick) == (0, ["calibrated"])
    assert err.count("\n") == 1
    assert "Traceback" not in err
    assert stored_costs.load().source == "calibrated quickly"


def test_a_folder_in_its_place_is_no_calibration(
    own_cache: Path, quick: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    own_cache.mkdir(parents=True)
    status, _, err = call(capsys, "explain", SCENES / "measured.toml")
    assert status == 0
    assert "no ordinary file" in err
    assert "can't be stored" in err
    assert [path.name for path in own_cache.parent.iterdir()] == ["calibration.json"]


def test_a_full_disk_stops_no_run(
    own_cache: Path,
    quick: list[str],
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    status, out, err = call(capsys, "run", SCENES / "measured.toml", "--json")
    assert status == 0
    assert json.loads(out)["results"]
    assert "No space left on device" in err
    assert not list(own_cache.parent.iterdir())
    status, _, err = call(capsys, "calibrate")
    assert status == 3
    assert "No space left on device" in err


def test_explain_shows_what_was_weighed_and_what_digits_cost(
    capsys: pytest.CaptureFixture[str],
) -> None:
    arguments = ("explain", SCENES / "measured.toml", "--tolerance", "1e-9")
    status, out, _ = call(capsys, *arguments, "--json")
    assert status == 0
    choice = json.loads(out)["choice"]
    assert choice["chosen"] == choice["candidates"][0]
    assert (choice["digit_more"]["tolerance"], choice["digit_less"]["tolerance"]) == (
        "1e-10", "1e-08"
    )  # fmt: skip
    assert {"float64", "longdouble"} <= {way["arithmetic"] for way in choice["candidates"]}
    for way in choice["candidates"]:
        assert way["out"] or (way["seconds"] > 0 and float(way["expected_error"]) <= 1e-9)
    status, out, _ = call(capsys, *arguments)
    assert "One digit more, 1e-10" in out
    status, out, _ = call(capsys, "run", *arguments[1:])
    assert "Predicted" in out
    assert status == 0


def test_certified_can_be_insisted_on(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ("run", SCENES / "measured.toml", "--tolerance", "1e-3", "--certified", "--json")
    status, out, _ = call(capsys, *arguments)
    assert status == 0
    assert json.loads(out)["accuracy"]["certified"]
    status, out, err = call(capsys, "run", SCENES / "figure3.toml", "--certified")
    assert (status, out) == (2, "")
    assert "--certified needs a tolerance" in err
