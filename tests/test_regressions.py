"""The comparing part of ``benchmarks/regressions.py``; nothing here is measured."""

import importlib.util
import json
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

FOLDER = Path(__file__).parents[1] / "benchmarks"
VERSIONS = {"python": "3.11.7", "numpy": "2.2", "numba": "0.63", "valgrind": "3.19"}
SWEEP, FAST = "NumPy sweep, 32 × 66", "fast sweep / NumPy arithmetic, 256 × 512"


@pytest.fixture
def program(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> ModuleType:
    """The program as a module, its baseline in a folder of the test's own."""
    monkeypatch.syspath_prepend(str(FOLDER))
    spec = importlib.util.spec_from_file_location("regressions", FOLDER / "regressions.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    monkeypatch.setitem(sys.modules, "regressions", module)
    spec.loader.exec_module(module)
    monkeypatch.setattr(module, "BASELINE", tmp_path / "baseline.json")
    monkeypatch.setattr(module, "versions_now", lambda: dict(VERSIONS))
    monkeypatch.setattr(module.shutil, "which", lambda _: "/somewhere/valgrind")
    return module


def baseline(**paths: tuple[str, float]) -> dict[str, Any]:
    stored = {name: {"kind": kind, "value": value} for name, (kind, value) in paths.items()}
    return {"versions": dict(VERSIONS), "paths": stored}


def measured(program: ModuleType, monkeypatch: pytest.MonkeyPatch, **values: float) -> None:
    kinds = {FAST: "ratio"}
    found = {n: program.Measured(kinds.get(n, "instructions"), v) for n, v in values.items()}
    monkeypatch.setattr(program, "measure", lambda names: iter(found.items()))


def called(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    *arguments: str,
) -> tuple[int, str, str]:  # fmt: skip
    monkeypatch.setattr(sys, "argv", ["regressions.py", *arguments])
    try:
        status = program.main()
    except SystemExit as done:
        status = int(done.code or 0)
    shown = capsys.readouterr()
    return status, shown.out, shown.err


@pytest.mark.parametrize(
    ("kind", "now", "verdict", "status"),
    [
        ("instructions", 1_000_000, "same", 0),
        ("instructions", 1_049_999, "same", 0),
        ("instructions", 1_050_001, "SLOWER", 1),
        ("instructions", 952_000, "faster", 0),
        ("ratio", 1_499_999, "same", 0),
        ("ratio", 1_500_001, "SLOWER", 1),
        ("ratio", 666_000, "faster", 0),
    ],
)
def test_the_limits(program: ModuleType, kind: str, now: float, verdict: str, status: int) -> None:
    found = {"a": program.Measured(kind, now)}
    compared = program.compare(baseline(a=(kind, 1_000_000)), VERSIONS, found)
    assert [one.verdict for one in compared] == [verdict]
    assert compared[0].ratio == now / 1_000_000
    assert program.status(compared) == status


def test_other_versions_are_not_compared(program: ModuleType) -> None:
    stored = baseline(a=("instructions", 1.0), b=("ratio", 1.0))
    found = {"a": program.Measured("instructions", 9.0), "b": program.Measured("ratio", 9.0)}
    compared = program.compare(stored, VERSIONS | {"numpy": "2.3"}, found)
    assert [one.ratio for one in compared] == [None, None]
    assert program.status(compared) == 3
    # Compiled code knows nothing of valgrind, nor a count of the compiler.
    a, b = program.compare(stored, VERSIONS | {"valgrind": "3.20"}, found)
    assert (a.ratio, b.ratio) == (None, 9.0)
    a, b = program.compare(stored, VERSIONS | {"numba": "0.64"}, found)
    assert (a.ratio, b.ratio) == (9.0, None)
    assert program.status([a]) == 1
    # On another processor counts hold, and the ratio of times doesn't: no failure by itself.
    found["a"] = program.Measured("instructions", 1.0)
    both = program.compare(stored, VERSIONS | {"processor": "another"}, found)
    assert [one.ratio for one in both] == [1.0, None]
    assert program.status(both) == 0
    assert program.status(both[1:]) == 3


def test_a_regression_outweighs_what_can_not_be_compared(program: ModuleType) -> None:
    stored = baseline(a=("instructions", 1.0), b=("ratio", 1.0))
    found = {"a": program.Measured("instructions", 9.0), "b": program.Measured("ratio", 9.0)}
    assert program.status(program.compare(stored, VERSIONS | {"numba": "0.64"}, found)) == 1


def test_a_new_path_is_no_regression(program: ModuleType) -> None:
    found = {"b": program.Measured("instructions", 9.0)}
    (one,) = program.compare(baseline(a=("instructions", 1.0)), VERSIONS, found)
    assert one.verdict.startswith("new")
    assert program.status([one]) == 0


def test_the_program_compares_with_what_it_has_written(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    measured(program, monkeypatch, **{SWEEP: 1e6, FAST: 1.0})
    assert called(program, monkeypatch, capsys, "--update")[0] == 0
    status, out, err = called(program, monkeypatch, capsys)
    assert (status, err) == (0, "")
    assert out.count("| same |") == 2
    measured(program, monkeypatch, **{SWEEP: 1.2e6, FAST: 1.0})
    status, out, _ = called(program, monkeypatch, capsys)
    assert status == 1
    assert f"| {SWEEP} | 1.00 M | 1.20 M | 1.2000 | SLOWER |" in out


def test_an_update_of_one_path_leaves_the_others(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    measured(program, monkeypatch, **{SWEEP: 1e6, FAST: 1.0})
    called(program, monkeypatch, capsys, "--update")
    measured(program, monkeypatch, **{SWEEP: 2e6})
    assert called(program, monkeypatch, capsys, "--update", "NumPy sweep")[0] == 0
    stored = json.loads(program.BASELINE.read_text())["paths"]
    assert {name: one["value"] for name, one in stored.items()} == {SWEEP: 2e6, FAST: 1.0}
    monkeypatch.setattr(program, "versions_now", lambda: VERSIONS | {"numpy": "3"})
    status, _, err = called(program, monkeypatch, capsys, "--update", "NumPy sweep")
    assert status == 2  # one file, one set of versions
    assert "no PATH" in err
    assert json.loads(program.BASELINE.read_text())["paths"] == stored


def test_versions_that_differ_are_named(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    measured(program, monkeypatch, **{SWEEP: 1e6})
    called(program, monkeypatch, capsys, "--update")
    monkeypatch.setattr(program, "versions_now", lambda: VERSIONS | {"numpy": "3"})
    status, out, _ = called(program, monkeypatch, capsys)
    assert status == 3
    assert "numpy: 2.2, now 3" in out


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (None, "--update"),
        ("{", "damaged"),
        ("[]", "no baseline"),
        ("{}", "no baseline"),
        ('{"versions": {}, "paths": {"a": {"kind": "seconds", "value": 1}}}', "no baseline"),
        ('{"versions": {}, "paths": {"a": {"kind": "ratio", "value": "x"}}}', "no baseline"),
        ('{"versions": {}, "paths": {"a": {"kind": "ratio", "value": 0}}}', "no baseline"),
        ('{"versions": {}, "paths": {"a": 3}}', "no baseline"),
    ],
)
def test_a_wrong_baseline(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    text: str | None, says: str,
) -> None:  # fmt: skip
    if text is not None:
        program.BASELINE.write_text(text)
    status, out, err = called(program, monkeypatch, capsys)
    assert (status, out) == (2, "")
    assert says in err


@pytest.mark.parametrize("arguments", [["nothing like it"], ["--updat e"], ["--update", "x²"]])
def test_wrong_usage(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str],
    arguments: list[str],
) -> None:  # fmt: skip
    status, out, err = called(program, monkeypatch, capsys, *arguments)
    assert (status, out) == (2, "")
    assert err


def test_without_valgrind_it_says_what_to_do(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(program.shutil, "which", lambda _: None)
    status, _, err = called(program, monkeypatch, capsys, "--update")
    assert status == 3
    assert "install" in err
    assert not program.BASELINE.exists()


def test_a_path_that_fails_leaves_the_baseline(
    program: ModuleType, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    measured(program, monkeypatch, **{SWEEP: 1e6})
    called(program, monkeypatch, capsys, "--update")
    before = program.BASELINE.read_text()

    def failing(_: object) -> Any:
        raise program.UnusableError("a path failed with status 1: no luck")

    monkeypatch.setattr(program, "measure", failing)
    status, _, err = called(program, monkeypatch, capsys, "--update")
    assert status == 3
    assert "no luck" in err
    assert program.BASELINE.read_text() == before


def test_the_stored_baseline_knows_every_path(program: ModuleType) -> None:
    stored = program.read_baseline(FOLDER / "baseline.json")
    assert list(stored["paths"]) == program.ALL


@pytest.mark.long
def test_every_counted_path_runs(program: ModuleType) -> None:
    """Without valgrind, in a process of its own: names and imports are those of the package."""
    command = [sys.executable, str(FOLDER / "main_paths.py"), *program.COUNTED]
    environment = {**program.ENVIRONMENT}
    done = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
