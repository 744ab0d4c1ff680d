"""Programs of ``benchmarks/`` that ask LAMMPS, as witnesses."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MISSING = 77


def said_by(program: str, *arguments: str) -> str:
    """Give what ``program`` prints; the test is skipped where LAMMPS can't be loaded."""
    done = subprocess.run(
        [sys.executable, str(ROOT / "benchmarks" / program), *arguments],
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path])},
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode == MISSING and os.environ.get("FORCE_DIFFUSION_TEST_LAMMPS") != "required":
        pytest.skip("LAMMPS can't be loaded")
    assert done.returncode == 0, done.stderr
    return done.stdout
