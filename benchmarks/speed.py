"""How fast the sweeps are, and how exact, beside what one would otherwise write.

Run with ``python benchmarks/speed.py`` (needs ``pip install -e '.[bench]'``). Times are medians of
rounds in which all competitors take turns, so that a busy machine slows all alike; targets are
ratios. ``--skip PART`` leaves parts out. Exit status 1 when a target is missed.
"""

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls, BigFloat, as_floats
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.loads import LoadSpec
from force_diffusion.numeric.mechanics.local import cosine
from force_diffusion.numeric.mechanics.problem import axes
from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down
from force_diffusion.numeric.planning.planner import initial_bits
from measuring import Line, in_turn, program
from peers import Problem, by_numpy, changes, directions, force_balance, stacked

import force_diffusion as fd

HEIGHT, WIDTH = 256, 512


def forces() -> Iterator[Line]:
    """Exact forces of one packing, geometry included, against sparse solvers given the geometry."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import spsolve

    problem = Problem(HEIGHT, WIDTH)
    compiled = problem.solver()
    numpy = by_numpy(compiled)
    solved = numpy()
    n = axes(problem.n_x, FLOAT64)
    reference = as_floats(stacked(problem.solver(Balls(106))()))

    def error(values: Any) -> float:
        return float(np.abs(values - reference).max() / np.abs(reference).max())

    b = force_balance(directions(solved, n))
    A = csc_matrix((b.values, (b.rows, b.columns)), shape=(len(b.right),) * 2)

    def best() -> Any:
        return spsolve(A, b.right, permc_spec="NATURAL")

    quick = in_turn({"numpy": numpy, "fast": compiled, "best": best}, 15)
    peer = quick["best"]
    yield Line("spsolve, NATURAL ordering", 1e3 * peer, " ms")
    yield Line("NumPy sweep", 1e3 * quick["numpy"], " ms")
    yield Line("fast sweep", 1e3 * quick["fast"], " ms")
    yield Line("spsolve (NATURAL) / NumPy sweep", peer / quick["numpy"], "", ">", 2)
    yield Line("spsolve (NATURAL) / fast sweep", peer / quick["fast"], "", ">", 20)
    own = error(stacked(solved))
    yield Line("error of change, sweep (NumPy and fast alike)", own)
    assert np.array_equal(stacked(solved), stacked(compiled()))
    times = error(changes(best(), 1 / (2 * n[1]), WIDTH)) / own
    yield Line("error of spsolve (NATURAL), geometry given / sweep", times, "", ">", 300)


LARGE = (5, 6, 7)


def large() -> Iterator[Line]:
    """Time and memory by the number of beads, each in a process of its own, and loops loaded."""
    per_bead = {}
    for power in LARGE:
        seconds, most = map(float, _probed(f"10^{power}").split())
        per_bead[power] = seconds / 10**power
        yield Line(f"profile of 10^{power} beads", 1e9 * per_bead[power], " ns per bead")
        yield Line("  memory, the interpreter included", most / 1e6, " MB")
    ratio = per_bead[LARGE[-1]] / per_bead[LARGE[0]]
    yield Line(f"10^{LARGE[-1]} beads / 10^{LARGE[0]}, time a bead", ratio, "", "<", 1.5)


def _probed(name: str, **environment: str) -> str:
    """Give what a probe prints, in a process of its own."""
    probe = [sys.executable, __file__, "--probe", name]
    done = subprocess.run(
        probe, check=True, capture_output=True, text=True, env=os.environ | environment
    )
    return done.stdout


def probe_large(power: int) -> str:
    """Seconds of the processor, and bytes, that a profile and the estimate of its error take."""
    width = round(10 ** (power / 2)) + 1
    scene = fd.Scene(
        packing=fd.Packing(height=10**power // width - 1, width=width),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-8, seed=1),
        ask=fd.Ask(quantity="profile"),
    )
    scene.model_copy(update={"packing": fd.Packing(height=5, width=9)}).run()
    start = process_time()
    scene.run()
    seconds = process_time() - start
    # what getrusage tells would be the parent's, too
    (most,) = re.findall(r"VmHWM:\s*(\d+) kB", Path("/proc/self/status").read_text())
    return f"{seconds} {1024 * int(most)}"


def digits() -> Iterator[Line]:
    """30 and 50 certified digits with balls, against mpmath."""
    radii = Problem(16, 34, Fraction(1, 10**4)).radii().reshape(17, 34)

    def certified() -> Any:
        return fd.solve(1 + radii, spacing=3, radius=1, tolerance=1e-30, certified=True).change

    spent = in_turn({"solve": certified}, 9, process_time, min)["solve"]
    yield Line("solve, 30 certified digits, 16 × 34", 1e3 * spent, " ms", "<", 30)
    problem = Problem(32, 66)
    bits = initial_bits(Fraction(1, 10**50), problem.height)
    balls, floats = Balls(bits), BigFloat(int(bits * 0.30103))
    solve = problem.solver(balls)
    with balls.active():
        values = stacked(solve()).reshape(-1)
        largest = max(abs(float(value)) for value in values)
        radius = max(float(value.rad()) for value in values)
    yield Line(
        "balls, 32 × 66: certified relative error of change", radius / largest, "", "<", 1e-50
    )
    both = in_turn({"balls": solve, "mpmath": problem.solver(floats)}, 3)
    yield Line("mpmath sweep / balls, 32 × 66", both["mpmath"] / both["balls"])


def spheres() -> Iterator[Line]:
    """Packings of spheres, deposited and balanced by NumPy."""
    for height, width in ((20, 10), (60, 64)):
        region = whole(width**2, height, 3)
        spec = LoadSpec("surface", height, width**2, dimension=3)
        F = spec.ordered(region.rows, spec.strength(Fraction(3, 4), FLOAT64), FLOAT64)
        rho = np.random.default_rng(1).uniform(-1e-6, 1e-6, (1, region.beads))

        def solve(region: Any = region, rho: Any = rho, F: Any = F) -> None:
            with FLOAT64.active():
                sweep_down(deposit(cosine(Fraction(3, 4)), region, rho, FLOAT64), region.rows, F)

        spent = in_turn({"NumPy": solve}, 5, process_time, min)["NumPy"]
        what = f"spheres, {height} × {width} × {width}"
        yield Line(what, 1e9 * spent / region.beads, " ns per bead")


SIZES = ((8, 16), (64, 128), (256, 512))


def solving() -> Iterator[Line]:
    """What a user calls, errors, gaps and arrays included, of new radii each time; and SuperLU.

    In a process of its own that has imported all, and called nothing yet.
    """
    for height, width in SIZES:
        first, solve, peer = map(float, _probed(f"{height} × {width}").split())
        yield Line(f"solve, {height} × {width}, the first call", 1e3 * first, " ms")
        target = ("<", 0.5) if height == 8 else ("", 0)
        yield Line("  later ones", 1e3 * solve, " ms", *target)
        target = (">", 5) if height == 256 else ("", 0)
        yield Line("  SuperLU / the first call", peer / first, "", *target)
        yield Line("  SuperLU / later ones", peer / solve)


def probe_solve(height: int, width: int) -> str:
    """Seconds of the first call of a process, of later ones, and of SuperLU on a ready matrix."""
    from scipy import sparse
    from scipy.sparse.linalg import splu

    solve, spent = fd.solve, []
    radii = np.random.default_rng(1).uniform(1 - 1e-4, 1 + 1e-4, (17, height + 1, width))
    for packing_radii in radii:
        start = process_time()
        solve(packing_radii, spacing=3).force  # noqa: B018 - an attribute that is calculated
        spent.append(process_time() - start)
    problem = Problem(height, width, Fraction(1, 10**4))
    packing = problem.solver()()
    system = force_balance(directions(packing, axes(problem.n_x, FLOAT64)))
    matrix = sparse.csc_matrix(
        (system.values, (system.rows, system.columns)), shape=(len(system.right),) * 2
    )
    start = process_time()
    for _ in range(3):
        splu(matrix, permc_spec="NATURAL").solve(system.right)
    return f"{spent[0]} {np.median(spent[1:])} {(process_time() - start) / 3}"


def first() -> Iterator[Line]:
    """The first call on a machine, which compiles."""
    with tempfile.TemporaryDirectory() as folder:
        seconds = float(_probed("8 × 16", XDG_CACHE_HOME=folder).split()[0])
    yield Line("first call on a machine: compiling", seconds, " s", "<", 15)


def running() -> Iterator[Line]:
    """Reading, planning, solving and writing a small scene."""
    from force_diffusion.derivations.export.answers import files_of

    text = (
        "packing = {height = 8, width = 20}\n"
        'disorder = {kind = "uniform", relative_std = 1e-6}\n'
        'ask = {quantity = "contact_forces"}\n'
    )
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(text, encoding="utf-8")

        def run() -> Any:
            return fd.read_scene(path).run()

        def written() -> Any:
            result = run()
            return files_of([result], result.data(rows=False), "csv")

        def planned() -> Any:
            return fd.read_scene(path).explain()

        tasks = {"run": run, "written": written, "planned": planned}
        spent = in_turn(tasks, 15, process_time, min)
    beside = spent["written"] - spent["run"] + spent["planned"]
    yield Line("a scene of 8 × 20, read, planned, solved, written", 1e3 * spent["written"], " ms")
    yield Line("  reading, planning and writing", 1e3 * beside, " ms", "<", 20)


PARTS: dict[str, Callable[[], Iterator[Line]]] = {
    "first call": first,
    "solve": solving,
    "run": running,
    "forces": forces,
    "large": large,
    "digits": digits,
    "spheres": spheres,
}


if __name__ == "__main__":
    raise SystemExit(
        program(
            __doc__,
            f"Forces of a packing of {HEIGHT} layers of {WIDTH} beads, σ/r = 1e-6, surface load;\n"
            "errors are relative to the largest |change|.",
            PARTS,
            {f"{m} × {w}": partial(probe_solve, m, w) for m, w in SIZES}
            | {f"10^{n}": partial(probe_large, n) for n in LARGE},
        )
    )
