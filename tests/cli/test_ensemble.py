"""The commands for ensembles, as a user calls them."""

import json
import os
import signal
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path
from typing import Any

from force_diffusion.numeric.ensemble import ensemble as module

from tests.cli.conftest import SCENE

ROOT = Path(__file__).parents[2]


def test_an_ensemble_is_stored_and_written_out(scene, tmp_path, printed):
    store, out = tmp_path / "ensemble.fd", tmp_path / "out"
    command = ["ensemble", scene, "--store", store, "--out", out, "--json"]
    stdout = printed(*command)
    data = json.loads(stdout)
    assert data["ensemble"]["realisations"] == 40
    assert len(data["results"]["profile"]) == 6
    assert (out / "result.json").read_text() == stdout
    lines = (out / "profile.csv").read_text().splitlines()
    assert lines[0].startswith("j,branch,samples,first_order_std,tensile,mean,mean_change,")
    printed(*command, "--overwrite")  # again, from the file alone
    assert (out / "result.json").read_text() == stdout
    told = printed("ensemble-status", store)
    assert ("sound, 40 realisations" in told, "[]" in told) == (True, False)
    assert f"version: force-diffusion = {version('force-diffusion')}\n" in told
    contents = json.loads(printed("ensemble-status", store, "--json"))
    assert contents["ranges"] == [[0, 40]]
    assert contents["ensemble"]["disorder"]["seed"] == 1


def test_realisations_are_added_and_a_rule_stops_early(scene, tmp_path, printed, call):
    stored = "--store", tmp_path / "ensemble.fd"
    printed("ensemble", scene, *stored)
    until = ["ensemble", scene, "--realisations", 5000, "--until", "0.15", "--json"]
    data = json.loads(printed(*until, *stored))
    assert 40 < data["ensemble"]["realisations"] < 5000
    assert data["confidence"]["reached"] is True
    assert data["confidence"]["largest_relative_half_width"] <= 0.15
    assert json.loads(printed(*until)) == data
    status, _, stderr = call("ensemble", scene, "--until", "0.001", "--confidence", "0.99")
    assert (status, "realisations may be enough" in stderr) == (3, True)


def test_scenes_without_an_ensemble(scene, tmp_path, call, refused):
    for name, says in (
        ("measured", "must be left out in an ensemble"),
        ("settled", 'ask.quantity = "positions"'),
        ("none", "no such file"),
    ):
        assert says in refused("ensemble", ROOT / "scenes" / f"{name}.toml")
    normal = SCENE.replace("uniform", "normal")
    scene.write_text(normal.replace("1e-4", "9"))
    message = refused("ensemble", scene)
    assert "scene.toml: 40 of 40 packings are left out" in message
    assert "realisation 0: bead (" in message
    scene.write_text(normal.replace("1e-4", "0.2"))
    says = "can't be built and are left out, the first of them realisation"
    status, stdout, _ = call("ensemble", scene)
    assert (status, says in stdout) == (0, True)
    refused("ensemble-status", tmp_path / "none")


def test_without_dask_it_says_what_to_install(scene, monkeypatch, refused):
    monkeypatch.setitem(sys.modules, "distributed", None)
    says = "pip install 'force-diffusion[cluster]'"
    assert says in refused("ensemble", scene, "--scheduler", "tcp://x:1")


LOADING = """
import os, sys, time
sys.modules["numba"] = None
if "--multiprocessing-fork" in sys.argv:
    os.write(2, b"loading\\n")  # at once: lines of two workers do not mix
    time.sleep(5)
"""


def test_an_interrupt_while_workers_load(scene, tmp_path):
    """As a terminal does, it comes to all of them."""
    (tmp_path / "sitecustomize.py").write_text(LOADING)
    words = ["ensemble", str(scene), "--realisations", "100000", "--workers", "2"]
    with subprocess.Popen(
        [sys.executable, "-m", "force_diffusion", *words],
        env={**os.environ, "PYTHONPATH": f"{tmp_path}{os.pathsep}{ROOT}"},
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


def test_an_interrupt_says_how_to_go_on(scene, tmp_path, refused, monkeypatch):
    def interrupted(m: Any, first: int, stop: int) -> Any:
        if first:
            raise KeyboardInterrupt
        return solve(m, first, stop)

    solve = module.solve_block
    monkeypatch.setattr(module, "solve_block", interrupted)
    message = refused("ensemble", scene, "--store", tmp_path / "ensemble.fd", status=130)
    assert "holds 32 realisations; the same command goes on" in message
