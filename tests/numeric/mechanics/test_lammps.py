"""LAMMPS as a witness: stiff bonds, minimised, give the forces of the sweep as they stiffen."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
PROGRAM = ROOT / "benchmarks" / "against_lammps.py"
MISSING = 77


def error_of_change(stiffness: float) -> float:
    arguments = ["--height", "5", "--width", "9", "--error-at", str(stiffness)]
    done = subprocess.run(
        [sys.executable, str(PROGRAM), *arguments],
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == MISSING and os.environ.get("FORCE_DIFFUSION_TEST_LAMMPS") != "required":
        pytest.skip("LAMMPS can't be loaded")
    assert done.returncode == 0, done.stderr
    return float(done.stdout)


def test_lammps_approaches_the_sweep_as_its_bonds_stiffen() -> None:
    soft, stiff = error_of_change(1e4), error_of_change(1e6)
    # The bonds give way by force/stiffness: the error falls in proportion.
    assert 80 < soft / stiff < 120
    assert stiff < 1e-3
