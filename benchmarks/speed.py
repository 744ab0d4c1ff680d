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
from force_diffusion.numeric.mechanics.problem import axes
from force_diffusion.numeric.planning.planner import initial_bits
from measuring import Line, in_turn, program
from peers import Problem, changes, directions, force_balance, stacked

import force_diffusion as fd

HEIGHT, WIDTH = 256, 512


def forces() -> Iterator[Line]:
    """Exact forces of one packing, geometry included, against sparse solvers given the geometry."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import spsolve

    problem = Problem(HEIGHT, WIDTH)
    numpy, compiled = problem.solver(), problem.compiled()
    solved, found = numpy()
    n = axes(problem.n_x, FLOAT64)
    reference = as_floats(stacked(problem.solver(Balls(106))()[1]))

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
    own = error(stacked(found))
    yield Line("error of change, sweep (NumPy and fast alike)", own)
    assert np.array_equal(stacked(found), stacked(compiled()[1]))
    times = error(changes(best(), 1 / (2 * n[1]), WIDTH)) / own
    yield Line("error of spsolve (NATURAL), geometry given / sweep", times, "", ">", 1000)


LARGE = (5, 6, 7)


def large() -> Iterator[Line]:
    """Time and memory by the number of beads, each in a process of its own."""
    for power in LARGE:
        probe = [sys.executable, __file__, "--probe", f"10^{power}"]
        done = subprocess.run(probe, check=True, capture_output=True, text=True)
        seconds, most = map(float, done.stdout.split())
        yield Line(f"profile of 10^{power} beads", 1e9 * seconds / 10**power, " ns per bead")
        yield Line("  memory, the interpreter included", most / 1e6, " MB")


def probe_large(power: int) -> str:
    """Seconds of the processor, and bytes, that a profile and the estimate of its error take."""
    width = round(10 ** (power / 2)) + 1
    scene = fd.Scene(
        packing=fd.Packing(height=10**power // width - 1, width=width),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-8, seed=1),
        ask=fd.Ask(quantity="profile"),
    )
    start = process_time()
    scene.run()
    seconds = process_time() - start
    # what getrusage tells would be the parent's, too
    (most,) = re.findall(r"VmHWM:\s*(\d+) kB", Path("/proc/self/status").read_text())
    return f"{seconds} {1024 * int(most)}"


def digits() -> Iterator[Line]:
    """50 certified digits with balls, against mpmath."""
    problem = Problem(32, 66)
    bits = initial_bits(Fraction(1, 10**50), problem.height)
    balls, floats = Balls(bits), BigFloat(int(bits * 0.30103))
    solve = problem.solver(balls)
    with balls.active():
        found = stacked(solve()[1]).reshape(-1)
        largest = max(abs(float(value)) for value in found)
        radius = max(float(value.rad()) for value in found)
    yield Line(
        "balls, 32 × 66: certified relative error of change", radius / largest, "", "<", 1e-50
    )
    spent = in_turn({"balls": solve, "mpmath": problem.solver(floats)}, 3)
    yield Line("mpmath sweep / balls, 32 × 66", spent["mpmath"] / spent["balls"])


def _sphere_tasks(height: int, width: int) -> tuple[int, dict[str, Callable[[], Any]]]:
    """Give the beads of a packing of spheres, and who deposits and balances it."""
    from force_diffusion.numeric.mechanics.passes import Deposition, Descent
    from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down

    scene = fd.Scene(
        packing=fd.Packing(height=height, width=width, dimension=3, allow_images=True),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-6, seed=1),
        ask=fd.Ask(quantity="profile"),
    )
    problem = scene.explain().problem
    region, rows = problem.region, problem.region.rows
    loads = problem.load.on(rows, problem.load.strength(problem.n_x, FLOAT64), FLOAT64)
    radii = [problem.radii.row(row, [0], FLOAT64) for row in rows]
    deposition, descent = Deposition(problem.phi, region), Descent(region, rows, loads)
    rho = np.concatenate(radii)[None, None]

    def numpy() -> Any:
        with FLOAT64.active():
            packing = deposit(problem.phi, region, radii, FLOAT64)
            return sweep_down(packing, rows, loads)

    def fast() -> Any:
        block = deposition(rho)
        assert block is not None
        return descent(block)

    return region.beads, {"NumPy": numpy, "fast": fast}


def spheres() -> Iterator[Line]:
    """Packings of spheres, deposited and balanced: by NumPy, and compiled in memory that stays."""
    for height, width in ((20, 10), (60, 64), (30, 200)):
        beads, tasks = _sphere_tasks(height, width)
        spent = in_turn(tasks, 9, process_time, min)
        for name, seconds in spent.items():
            target = ("<", 50) if name == "fast" and height > 20 else ("", 0)
            what = f"{name}, {height} × {width} × {width}"
            yield Line(what, 1e9 * seconds / beads, " ns per bead", *target)
        yield Line("  NumPy / fast", spent["NumPy"] / spent["fast"], "", ">", 3)


def solving() -> Iterator[Line]:
    """What a user calls, errors, gaps and arrays included, against parts of it and SuperLU."""
    from scipy import sparse
    from scipy.sparse.linalg import splu

    for height, width in ((8, 16), (64, 128), (256, 512)):
        problem = Problem(height, width, Fraction(1, 10**4))
        radii = 1 + np.stack(problem.radii())
        packing, _ = problem.solver()()
        n = axes(problem.n_x, FLOAT64)
        system = force_balance(directions(packing, n))
        matrix = sparse.csc_matrix(
            (system.values, (system.rows, system.columns)), shape=(len(system.right),) * 2
        )
        tasks: dict[str, Callable[[], Any]] = {
            "solve": lambda radii=radii: fd.solve(radii, spacing=3, radius=1).force,
            "sweep": problem.compiled(again=True),
            "sweep with errors": problem.compiled(again=True, carried=True),
            "SuperLU": lambda matrix=matrix, system=system: splu(
                matrix, permc_spec="NATURAL"
            ).solve(system.right),
        }
        peer = tasks.pop("SuperLU")
        spent = in_turn(tasks, 31, process_time, min)
        # each right after the other, which empties the caches
        cold = in_turn({"solve": tasks["solve"], "SuperLU": peer}, 7, process_time, min)
        for name, seconds in spent.items():
            yield Line(f"{name}, {height} × {width}", 1e3 * seconds, " ms")
        over = spent["solve"] - spent["sweep"]
        if height == 8:
            yield Line("  solve less sweep", 1e3 * over, " ms", "<", 0.5)
        else:
            yield Line("  solve / sweep", spent["solve"] / spent["sweep"], "", "<", 6)
        target = (">", 5) if height == 256 else ("", 0)
        yield Line(f"SuperLU, {height} × {width}", 1e3 * cold["SuperLU"], " ms")
        yield Line("  solve after it, caches emptied", 1e3 * cold["solve"], " ms")
        yield Line("  SuperLU / that", cold["SuperLU"] / cold["solve"], "", *target)


def first() -> Iterator[Line]:
    """The first call on a machine, which compiles, and the first of a process."""
    probe = [sys.executable, __file__, "--probe", "first call"]
    with tempfile.TemporaryDirectory() as folder:
        environment = os.environ | {"XDG_CACHE_HOME": folder}
        for name, target in (("on a machine: compiling", 3), ("of a process: loading", 0.7)):
            done = subprocess.run(
                probe, check=True, capture_output=True, text=True, env=environment
            )
            yield Line(f"first call {name}", float(done.stdout), " s", "<", target)


def probe_first() -> float:
    """Seconds of the processor of the first call that takes compiled loops, less the second."""
    radii = 1 + np.random.default_rng(1).uniform(-1e-4, 1e-4, (401, 600))
    spent = []
    for _ in range(2):
        start = process_time()
        fd.solve(radii, spacing=3, radius=1)
        spent.append(process_time() - start)
    return spent[0] - spent[1]


def running() -> Iterator[Line]:
    """Reading, planning, solving and writing a small scene."""
    from force_diffusion.derivations.export.answers import Format, files_of

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
            found = run()
            return files_of(found, found.data(rows=False), Format.CSV)

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
            {"first call": probe_first} | {f"10^{n}": partial(probe_large, n) for n in LARGE},
        )
    )
