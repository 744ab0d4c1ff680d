"""LAMMPS as a witness: stiff bonds, minimised, give the forces of the sweep as they stiffen."""

from tests.lammps import said_by


def error_of_change(stiffness: float) -> float:
    size = ("--height", "5", "--width", "9")
    return float(said_by("against_lammps.py", *size, "--error-at", str(stiffness)))


def test_lammps_approaches_the_sweep_as_its_bonds_stiffen() -> None:
    soft, stiff = error_of_change(1e4), error_of_change(1e6)
    # The bonds give way by force/stiffness: the error falls in proportion.
    assert 80 < soft / stiff < 120
    assert stiff < 1e-3
