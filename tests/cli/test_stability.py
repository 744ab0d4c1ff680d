"""The command ``stability`` as a user calls it, with few rows of its tables."""

import csv
import io
import json
import sys
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.studies import timing
from force_diffusion.numeric.studies.stability import stability as tables
from force_diffusion.numeric.studies.stability.enclosures import strips
from force_diffusion.numeric.studies.stability.floats import cases

from force_diffusion.__main__ import main

FILES = [
    "closed_forms.csv", "manifest.json", "stability.csv", "stability.json", "stability.pdf",
    "stability.png", "stability.svg", "stability_balls.csv",
]  # fmt: skip


@pytest.fixture(autouse=True)
def _few(monkeypatch: pytest.MonkeyPatch) -> None:
    some = [case for case in cases() if case.group == "disorder" and case.height == 16]
    balls = [strip for strip in strips() if strip.height <= 32]
    fallen = [strip for strip in strips() if strip.height == 512][-4:-3]
    monkeypatch.setattr(tables, "cases", lambda: iter(some[:4]))
    monkeypatch.setattr(timing, "ENOUGH_SECONDS", 0.0)
    monkeypatch.setattr(timing, "LEAST_RUNS", 1)
    monkeypatch.setattr(tables, "strips", lambda: iter(balls + fallen))


def call(capsys: pytest.CaptureFixture[str], *arguments: object) -> tuple[int, str, str]:
    status = main([str(a) for a in arguments])
    shown = capsys.readouterr()
    return status, shown.out, shown.err


@pytest.mark.long
def test_json_and_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out"
    status, printed, err = call(capsys, "stability", "--out", out, "--json")
    assert (status, err) == (0, "")
    found = json.loads(printed)
    assert json.loads((out / "stability.json").read_text()) == found
    assert [row["relative_std"] for row in found["rows"]] == [1e-2, 1e-3, 1e-4, 1e-6]
    assert all(row["seconds"] > 0 and row["plain_seconds"] > 0 for row in found["rows"])
    assert {row["form"] for row in found["enclosures"]} == {"positions", "line sums"}
    assert found["closed_forms"]
    assert sorted(path.name for path in out.iterdir()) == FILES
    for name, table in tables.TABLES.items():
        rows = list(csv.DictReader(io.StringIO((out / table.file).read_text())))
        assert len(rows) == len(found[name])
        assert rows[0]["command"] == found["command"]
    png = (out / "stability.png").read_bytes()
    assert png.startswith(b"\x89PNG")
    assert found["command"].encode() in png
    assert len(png) < 150_000  # a page that shows it loads it whole
    assert found["command"] in (out / "stability.svg").read_text()
    assert call(capsys, "stability", "--out", out)[0] == 0  # its own folder


def test_the_tables(capsys: pytest.CaptureFixture[str]) -> None:
    status, out, err = call(capsys, "stability")
    assert (status, err) == (0, "")
    for words in ("plain form", "positions ", "line sums ", "its supports are too far apart",
                  "surface_variance"):  # fmt: skip
        assert words in out


def test_without_matplotlib_only_the_figure_is_missing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.delitem(sys.modules, "force_diffusion.numeric.figures.style", raising=False)
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    out = tmp_path / "out"
    status, printed, err = call(capsys, "stability", "--out", out, "--json")
    assert status == 0
    assert json.loads(printed)["rows"]
    assert "force-diffusion[plots]" in err
    assert sorted(path.name for path in out.iterdir()) == [
        name for name in FILES if not name.endswith((".pdf", ".png", ".svg"))
    ]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["--out", ""], "names no folder"),
        (["--out"], "requires an argument"),
        (["scene.toml"], "scene.toml"),
        (["--markdown"], "--markdown"),
        (["--out", "FILE"], "is a file"),
        (["--out", "FOREIGN"], "stability.csv' is there"),
    ],
)
def test_wrong_usage(
    arguments: list[str], says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "FOREIGN").mkdir()
    (tmp_path / "FOREIGN" / "stability.csv").write_text("mine")
    (tmp_path / "FILE").write_text("mine")
    real = [str(tmp_path / a) if a in {"FILE", "FOREIGN"} else a for a in arguments]
    status, out, err = call(capsys, "stability", *real)
    assert (status, out) == (2, "")
    assert says in err
    assert "Traceback" not in err


def test_interrupted_it_leaves_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(tables, "enclose", interrupted)
    status, _, err = call(capsys, "stability", "--out", tmp_path / "out")
    assert status == 130
    assert "Traceback" not in err
    assert not (tmp_path / "out").exists()
