"""LAMMPS as a witness: stiff repulsive discs rest where rigid ones are proved to."""

import json
from pathlib import Path
from typing import Any

import pytest

import force_diffusion as fd
from tests.lammps import said_by


def by_lammps(folder: Path, seed: int, *options: str) -> tuple[dict[str, Any], fd.Verdict]:
    """Minimise 84 discs; give what was said, and the verdict on the packing as LAMMPS sees it."""
    out = folder / f"{seed}.json"
    packing = ("--height", "6", "--width", "12", "--relative-std", "0.03", "--seed", str(seed))
    said = said_by("tensionless_lammps.py", *packing, "--out", str(out), *options)
    (verdict,) = fd.check_packings(out)
    return json.loads(said), verdict


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 3])
def test_our_packing_is_one_for_lammps(tmp_path: Path, seed: int) -> None:
    """Discs give way by force/stiffness: the same contacts, and forces that approach ours."""
    stiff, verdict = by_lammps(tmp_path, seed, "--ours", "--stiffness", "1e5")
    assert verdict.proved, verdict
    assert stiff["shared"] == stiff["contacts"] == stiff["own_contacts"]
    soft, _ = by_lammps(tmp_path, seed, "--ours", "--stiffness", "1e4")
    assert 8 < soft["error"] / stiff["error"] < 12.5  # in proportion to the stiffness
    assert stiff["error"] < 2e-3


@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 3])
def test_where_lammps_comes_to_rest_by_itself_is_proved(tmp_path: Path, seed: int) -> None:
    """It starts from the deposited packing: one of many minima, which need not be ours."""
    found, verdict = by_lammps(tmp_path, seed)
    assert verdict.proved, verdict
    assert found["energy_fall"]["lammps"] > 0
