"""A derivation runs on its own: as a script from anywhere, and as a module."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from force_diffusion.derivations.framework.catalogue import modules, paper
from force_diffusion.derivations.framework.record import load

FOLDER = Path(__file__).parents[2] / "derivations"
SCRIPT = FOLDER / "eq02_displacement.py"
MODULE = ["-m", "force_diffusion.derivations.eq02_displacement"]


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, *arguments]
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=600, check=False
    )


@pytest.mark.long(sample=1, share=4)
@pytest.mark.parametrize("number", paper())
def test_each_is_a_script_that_prints_its_steps_and_claims(number):
    done = run(FOLDER.parent, f"derivations/{modules()[number]}.py")
    assert (done.returncode, done.stderr) == (0, "")
    whole = " ".join(done.stdout.split())
    assert f"Eq. {number} is proved" in whole
    proof = load(number).proof
    for step in proof:
        assert f"{step.reason} " in whole
    for claim in proof.claims:
        assert re.search(f"- proved[^:]*: {re.escape(claim.reason)} \\(proof\\)", whole), claim
    for refutation in proof.refuted:
        assert f"- refuted: {refutation.reading} (refutation)" in whole


@pytest.mark.long
@pytest.mark.parametrize("how", [[str(SCRIPT)], MODULE])
def test_from_elsewhere(how, tmp_path):
    """Beside folders and files that have the names of the package's rooms."""
    (tmp_path / "numeric").mkdir()
    (tmp_path / "symbolic.py").write_text("raise SystemExit('this is not the package')")
    done = run(tmp_path, *how)
    assert (done.returncode, done.stderr) == (0, "")
    assert "Eq. 2 is proved" in done.stdout


@pytest.mark.long
def test_its_arguments_are_those_of_derive(tmp_path):
    done = run(tmp_path, str(FOLDER / "eq01_ordered_positions.py"), "--fast")
    assert done.returncode == 2
    assert "No such option: --fast" in done.stderr
    assert "Traceback" not in done.stderr
