"""The commands for ensembles, as a user calls them."""

import json
import os
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

import pytest
from force_diffusion.numeric.ensemble import ensemble as module

ROOT = Path(__file__).parents[2]
SCENE = ROOT / "scenes" / "ensemble.toml"
ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT)}
SMALL = """
packing = {height = 3, width = 5}
disorder = {kind = "uniform", relative_std = 1e-4, seed = 1}
ask = {quantity = "profile", realisations = 40}
"""


def program(*arguments: object) -> list[str]:
    return [sys.executable, "-m", "force_diffusion", "ensemble", *map(str, arguments)]


@pytest.fixture
def small(tmp_path: Path) -> Path:
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


def test_an_ensemble_is_stored_and_written_out(small, tmp_path, call):
    store, out = tmp_path / "ensemble.fd", tmp_path / "out"
    arguments = [small, "--store", store, "--out", out, "--json"]
    status, stdout, stderr = call("ensemble", *arguments)
    assert (status, stderr) == (0, "")
    data = json.loads(stdout)
    assert data["ensemble"]["realisations"] == 40
    assert len(data["results"]["profile"]) == 6
    assert (out / "result.json").read_text() == stdout
    lines = (out / "profile.csv").read_text().splitlines()
    assert lines[0].startswith("j,branch,samples,first_order_std,tensile,mean,mean_change,")
    first = (out / "result.json").read_bytes()
    assert call("ensemble", *arguments, "--overwrite")[0] == 0  # again, from the file alone
    assert (out / "result.json").read_bytes() == first
    status, stdout, _ = call("ensemble-status", store)
    assert status == 0
    assert ("sound, 40 realisations" in stdout, "[]" in stdout) == (True, False)
    assert f"version: force-diffusion = {version('force-diffusion')}\n" in stdout
    contents = json.loads(call("ensemble-status", store, "--json")[1])
    assert contents["ranges"] == [[0, 40]]
    assert contents["ensemble"]["disorder"]["seed"] == 1


def test_realisations_are_added_and_a_rule_stops_early(small, tmp_path, call):
    store = tmp_path / "ensemble.fd"
    assert call("ensemble", small, "--store", store)[0] == 0
    status, stdout, _ = call(
        "ensemble", small, "--store", store, "--realisations", 5000, "--until", "0.15", "--json"
    )
    assert status == 0
    data = json.loads(stdout)
    assert 40 < data["ensemble"]["realisations"] < 5000
    assert data["confidence"]["reached"] is True
    assert data["confidence"]["largest_relative_half_width"] <= 0.15
    alone = json.loads(
        call("ensemble", small, "--realisations", 5000, "--until", "0.15", "--json")[1]
    )
    assert alone == data
    status, _, stderr = call("ensemble", small, "--until", "0.001", "--confidence", "0.99")
    assert (status, "realisations may be enough" in stderr) == (3, True)


def test_scenes_without_an_ensemble(tmp_path, call):
    for name, says in (
        ("measured", "must be left out in an ensemble"),
        ("settled", 'ask.quantity = "positions"'),
        ("none", "no such file"),
    ):
        status, _, stderr = call("ensemble", ROOT / "scenes" / f"{name}.toml")
        assert (status, says in stderr) == (2, True)
    path = tmp_path / "wild.toml"
    path.write_text(SMALL.replace('"uniform", relative_std = 1e-4', '"normal", relative_std = 9'))
    status, _, stderr = call("ensemble", path)
    assert status == 2
    assert "wild.toml: 40 of 40 packings are left out" in stderr
    assert "realisation 0: bead (" in stderr
    path.write_text(SMALL.replace('"uniform", relative_std = 1e-4', '"normal", relative_std = 0.2'))
    status, stdout, _ = call("ensemble", path)
    assert status == 0
    assert "can't be built and are left out, the first of them realisation" in stdout
    assert call("ensemble-status", tmp_path / "none")[0] == 2


def test_without_dask_it_says_what_to_install(small, monkeypatch, call):
    monkeypatch.setitem(sys.modules, "distributed", None)
    status, _, stderr = call("ensemble", small, "--scheduler", "tcp://x:1")
    assert status == 2
    assert "pip install 'force-diffusion[cluster]'" in stderr


LOADING = """
import os, sys, time
sys.modules["numba"] = None
if "--multiprocessing-fork" in sys.argv:
    os.write(2, b"loading\\n")  # at once: lines of two workers do not mix
    time.sleep(5)
"""


def test_an_interrupt_while_workers_load(tmp_path):
    """As a terminal does, it comes to all of them."""
    (tmp_path / "sitecustomize.py").write_text(LOADING)
    with subprocess.Popen(
        program(SCENE, "--realisations", 100_000, "--workers", 2),
        env={**ENVIRONMENT, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
        stderr=subprocess.PIPE, text=True, start_new_session=True,
    ) as run:  # fmt: skip
        assert run.stderr is not None
        assert [run.stderr.readline() for _ in range(2)] == ["loading\n"] * 2
        os.killpg(run.pid, signal.SIGINT)
        try:
            _, err = run.communicate(timeout=600)
        finally:
            run.kill()
    assert run.returncode == 130
    assert err.splitlines() == [
        "force-diffusion: nothing was saved; with --store FILE it would have been.",
        "force-diffusion: interrupted; no half-written file is left.",
    ]


def test_an_interrupt_says_how_to_go_on(small, tmp_path, call, monkeypatch):
    def interrupted(m: Any, first: int, stop: int) -> Any:
        if first:
            raise KeyboardInterrupt
        return solve(m, first, stop)

    solve = module.solve_block
    monkeypatch.setattr(module, "solve_block", interrupted)
    status, _, stderr = call("ensemble", small, "--store", tmp_path / "ensemble.fd")
    assert status == 130
    assert "holds 32 realisations; the same command goes on" in stderr
