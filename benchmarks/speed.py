"""How fast the sweeps are, and how exact, beside what one would otherwise write.

Run with ``python benchmarks/speed.py`` (needs ``pip install -e '.[bench]'``, and gcc for the part
"c"). Times are medians of rounds in which all competitors take turns, so that a busy machine
slows all alike; targets are ratios. ``--skip PART`` leaves parts out. Exit status 1 when a target
is missed.
"""

import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

import numpy as np
from force_diffusion.numeric import closed_forms
from force_diffusion.numeric.arithmetic.systems import FLOAT64, LONGDOUBLE, Balls, BigFloat
from force_diffusion.numeric.mechanics.problem import axes
from force_diffusion.numeric.planning.planner import initial_bits
from measuring import Line, in_turn, program
from peers import (
    CSweep,
    Problem,
    changes,
    directions,
    force_balance,
    stacked,
)

HEIGHT, WIDTH, BATCHES = 256, 512, (8,)


def forces() -> Iterator[Line]:
    """Exact forces of one packing, geometry included, against sparse solvers given the geometry."""
    from scipy.sparse import csc_matrix
    from scipy.sparse.linalg import spsolve

    problem = Problem(HEIGHT, WIDTH)
    numpy, compiled = problem.solver(), problem.compiled()
    batches = {f"batch of {size}": (size, problem.compiled(size)) for size in BATCHES}
    solved, found = numpy()
    n = axes(problem.n_x, FLOAT64)
    reference = stacked(problem.solver(LONGDOUBLE)()[1])

    def error(values: Any) -> float:
        return float(np.abs(values - reference).max() / np.abs(reference).max())

    def sparse(geometry: Any) -> tuple[Any, Any]:
        b = force_balance(geometry)
        size = len(b.right)
        return csc_matrix((b.values, (b.rows, b.columns)), shape=(size, size)), b.right

    A, right = sparse(directions(solved, n))

    def best() -> Any:
        return spsolve(A, right, permc_spec="NATURAL")

    def default() -> Any:
        return spsolve(A, right)

    together = {name: solve for name, (_, solve) in batches.items()}
    quick = in_turn({"numpy": numpy, "fast": compiled, **together, "best": best}, 15)
    slow = in_turn({"best": best, "default": default}, 5)
    peer = quick["best"]
    yield Line("spsolve, NATURAL ordering", 1e3 * peer, " ms")
    yield Line("spsolve, default ordering / NATURAL", slow["default"] / slow["best"])
    yield Line("NumPy sweep", 1e3 * quick["numpy"], " ms")
    yield Line("fast sweep", 1e3 * quick["fast"], " ms")
    yield Line("spsolve (NATURAL) / NumPy sweep", peer / quick["numpy"], "", ">", 2)
    yield Line("spsolve (NATURAL) / fast sweep", peer / quick["fast"], "", ">", 20)
    for name, (size, _) in batches.items():
        yield Line(f"fast sweep, each of a {name}", 1e3 * quick[name] / size, " ms")
        yield Line("spsolve (NATURAL) / that", size * peer / quick[name], "", ">", 35)
    ordered = 1 / (2 * n[1])
    own = error(stacked(found))
    yield Line("error of change, sweep (NumPy and fast alike)", own)
    assert np.array_equal(stacked(found), stacked(compiled()[1]))
    given = error(changes(best(), ordered, WIDTH))
    yield Line("error of spsolve (NATURAL), geometry given / sweep", given / own, "", ">", 1000)
    usual = error(changes(default(), ordered, WIDTH))
    yield Line("error of spsolve (default), geometry given / sweep", usual / own)


SIZES = {
    "like the packing above": ((70, 142), (223, 448), (706, 1414), (2235, 4474)),
    "layers of 512": ((19, 512), (194, 512), (1952, 512), (19530, 512)),
}

# Bytes of a bead between memory and cores. Read: radii, F, δn; written: c, δn, F, g, whose cache
# lines are fetched first.
_MOVED = 8 * (1 + 2 + 4 + 2 * 10)


def bandwidth_of_one_core() -> float:
    """Gigabytes a second that NumPy moves in a = b + c, lines of a fetched before being written."""
    a, b, c = np.ones((3, 20_000_000))  # zeros would all be one page
    seconds = in_turn({"": lambda: np.add(b, c, out=a)}, 9, process_time)[""]
    return 32 * len(a) / seconds / 1e9


def size() -> Iterator[Line]:
    """Time per bead from 1e4 to 1e7 beads, and memory."""
    bandwidth = bandwidth_of_one_core()
    yield Line("memory bandwidth of one core (a = b + c)", bandwidth, " GB/s")
    for shape, sizes in SIZES.items():
        fresh: dict[int, float] = {}
        again: dict[int, float] = {}
        for height, width in sizes:
            problem = Problem(height, width)
            beads, rounds = (height + 1) * width, 5 if height * width > 1e6 else 31
            for found, task in (
                (
                    again,
                    problem.compiled(again=True),
                ),  # one after the other, as an ensemble has them
                (fresh, problem.compiled()),
            ):
                seconds = in_turn({"": task}, rounds, process_time)[""]
                found[beads] = 1e9 * seconds / beads
            yield Line(f"fast, {height} × {width}, memory that stays", again[beads], " ns per bead")
            yield Line("  in fresh memory", fresh[beads], " ns per bead")
        for name, each in (("memory that stays", again), ("fresh memory", fresh)):
            flat = max(each.values()) / min(each.values())
            target = ("<", 1.5) if each is again else ("", 0)
            yield Line(f"slowest / fastest of these, {shape}, {name}", flat, "", *target)
        share = _MOVED / again[max(again)] / bandwidth
        yield Line("the largest of these: share of that bandwidth", 100 * share, " %")
    probe = [sys.executable, __file__, "--probe", "memory"]
    done = subprocess.run(probe, check=True, capture_output=True, text=True)
    yield Line("memory / arrays of the answer, 4e6 beads", float(done.stdout), "", "<", 1.5)


def resident(name: str) -> int:
    """Bytes in memory: "VmRSS" now, "VmHWM" at the most. (Linux; maxrss is the parent's, too.)"""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(name):
            return int(line.split()[1]) * 1024
    raise SystemExit("the memory of a process can be read on Linux only")


def probe_memory() -> float:
    """Peak memory of one solution beyond what was there before, over the arrays that it gives."""
    Problem(3, 4).compiled()()
    solve = Problem(1414, 2828).compiled()
    before = resident("VmRSS")
    packing, forces = solve()
    peak = resident("VmHWM")
    # The ordered forces are windows on one row, here: they are not counted.
    answer = [packing.c.plus, packing.c.minus, forces.change.plus, forces.change.minus]
    answer += [*zip(*packing.dn.plus, strict=True), *zip(*packing.dn.minus, strict=True)]
    return (peak - before) / sum(layer.nbytes for block in answer for layer in block)


def against_c() -> Iterator[Line]:
    """The fast sweep against the same arithmetic in C, and both against memory."""
    problem = Problem(HEIGHT, WIDTH)
    solve, again = problem.compiled(), problem.compiled(again=True)
    with tempfile.TemporaryDirectory() as folder:
        alike = CSweep(problem, Path(folder), "-ffp-contract=off")
        fused = CSweep(problem, Path(folder), "-ffp-contract=fast")
        blocks = alike()
        packing, forces = solve()
        pairs = [
            (np.stack(packing.c.plus), blocks[0]),
            (np.stack(packing.c.minus), blocks[1]),
            (np.stack(forces.change.plus[1:]), blocks[8][1:]),
            (np.stack(forces.change.minus[1:]), blocks[9][1:]),
        ]
        apart = max(float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)
        yield Line("C, written out by hand, differs by (relative)", apart, "", "<", 1e-13)
        tasks = {"fast": solve, "again": again, "alike": alike, "fused": fused}
        quick = in_turn(tasks, 31, process_time)
        c = min(quick["alike"], quick["fused"])
        yield Line("C, gcc -O3 -march=native, memory at hand", 1e3 * c, " ms")
        yield Line("fast sweep, memory that stays / C", quick["again"] / c, "", "<", 1.7)
        yield Line("  in fresh memory, tables and all / C", quick["fast"] / c)
        large = Problem(2235, 4474)
        many = in_turn({"fast": large.compiled(), "memory": alike.bandwidth()}, 5)
    bandwidth = 32 * 20e6 / many["memory"]
    moved = _MOVED * (large.height + 1) * large.width
    yield Line("memory bandwidth of one core (a = b + c)", bandwidth / 1e9, " GB/s")
    yield Line("fast sweep of 1e7 beads, share of it", 100 * moved / many["fast"] / bandwidth, " %")


def digits() -> Iterator[Line]:
    """50 certified digits with balls, against mpmath."""
    tolerance = Fraction(1, 10**50)

    def pair(problem: Problem) -> tuple[Balls, BigFloat]:
        bits = initial_bits(tolerance, problem.height)
        return Balls(bits), BigFloat(int(bits * 0.30103))

    problem = Problem(32, 66)
    balls, floats = pair(problem)
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

    small = Problem(8, 9)
    balls, floats = pair(small)
    context = floats.context
    laid, forces = small.solver(floats)()
    n = axes(small.n_x, floats)
    b = force_balance(directions(laid, n), context.mpf(1))
    A = context.zeros(len(b.right))
    for row, column, value in zip(b.rows.tolist(), b.columns.tolist(), b.values, strict=True):
        A[row, column] = value
    right = context.matrix(b.right.tolist())
    spent = in_turn({"balls": small.solver(balls), "lu": lambda: context.lu_solve(A, right)}, 3)
    unknowns = np.array(list(context.lu_solve(A, right)), dtype=object)
    off = changes(unknowns, 1 / (2 * n[1]), small.width) - stacked(forces)
    assert max(abs(value) for value in off.reshape(-1)) < 1e-55, "they solve the same system"
    yield Line("mpmath.lu_solve, geometry given / balls, 8 × 9", spent["lu"] / spent["balls"])


def profile() -> Iterator[Line]:
    """The exact profile of σ_f in closed form against Monte Carlo, surface load."""
    problem, realisations = Problem(64, 130), 256
    phi, std = 1 - 2 * problem.n_x**2, problem.relative_std

    def closed(number: Any = float) -> list[Any]:
        parameters = (number(phi), number(std), 1)
        return [
            closed_forms.surface_variance(problem.height, j, *parameters)
            for j in range(problem.height)
        ]

    def simulated() -> Any:
        _, found = problem.compiled(realisations)()
        squares = [
            np.mean(np.square([p, m]))
            for p, m in zip(found.change.plus[1:], found.change.minus[1:], strict=True)
        ]
        return np.sqrt(squares) / float(found.ordered.plus[1][0])

    spent = in_turn({"closed": closed, "simulated": simulated}, 3)
    exact = np.sqrt(np.array(closed()))
    error = float(np.sqrt(np.mean((simulated() / exact - 1) ** 2)))
    fractions = closed(Fraction)
    rounding = max(
        abs(float(Fraction(a) / b - 1)) for a, b in zip(closed(), fractions, strict=True)
    )
    yield Line("closed form, 64 layers", 1e3 * spent["closed"], " ms")
    yield Line("  its rounding error of σ_f² (against fractions)", rounding)
    yield Line(f"Monte Carlo (fast), {realisations} realisations", spent["simulated"], " s")
    yield Line("  its error of σ_f, root mean square over layers", error)
    yield Line("  seconds, Monte Carlo / closed form", spent["simulated"] / spent["closed"])
    for goal in (1e-3, rounding or 1e-16):
        times = (error / goal) ** 2
        name = f"to an error of {goal:.1g} (by 1/√N)"
        yield Line(f"realisations {name}, closed form: none", realisations * times)
        yield Line(
            f"  seconds, Monte Carlo / closed form, {name}",
            times * spent["simulated"] / spent["closed"],
        )


def writing() -> Iterator[Line]:
    """A million contact forces as files, against the whole run that solves them; processor time."""
    from force_diffusion.derivations.export.answers import Format, files_of

    import force_diffusion as fd

    scene = fd.Scene(
        packing=fd.Packing(height=500, width=1000),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-5, seed=1),
        ask=fd.Ask(quantity="contact_forces"),
    )

    def spent(task: Callable[[], Any]) -> float:
        start = process_time()
        task()
        return process_time() - start

    def written(found: fd.Outcome, form: Format) -> float:
        for name in ("text", "arrays"):  # made once, and kept
            found.__dict__.pop(name, None)
        return spent(lambda: files_of(found, found.data(rows=False), form))

    plan, found = scene.explain(), scene.run()
    solving = median(spent(lambda: fd.run(plan)) for _ in range(3))
    yield Line("run of 1e6 contact forces, its estimate of the error included", solving, " s")
    for form in Format:
        times = median(written(found, form) for _ in range(3))
        yield Line(f"writing as {form} / that", times / solving, "", "<", 1)


def _sphere_tasks(height: int, width: int) -> tuple[int, dict[str, Callable[[], Any]]]:
    """Give the beads of a packing of spheres, and who deposits and balances it."""
    from force_diffusion.numeric.mechanics.passes import Deposition, Descent
    from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down

    import force_diffusion as fd

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
            change = sweep_down(packing, rows, loads).change
            return np.stack([np.concatenate(of[1:]) for _, of in change])

    def fast() -> Any:
        block = deposition(rho)
        assert block is not None
        g = descent(block)
        assert g is not None
        return g[0, :, descent.starts[1] : descent.starts[-1]]

    return region.beads, {"NumPy": numpy, "fast": fast}


def spheres() -> Iterator[Line]:
    """Packings of spheres, deposited and balanced: by NumPy, and compiled in memory that stays."""
    for height, width in ((20, 10), (60, 64), (30, 200)):
        beads, tasks = _sphere_tasks(height, width)
        usual, quick = (task() for task in tasks.values())
        same = np.array_equal(usual, quick)
        spent = in_turn(tasks, 9, process_time, min)
        for name, seconds in spent.items():
            target = ("<", 50) if name == "fast" and height > 20 else ("", 0)
            what = f"{name}, {height} × {width} × {width}"
            yield Line(what, 1e9 * seconds / beads, " ns per bead", *target)
        yield Line("  NumPy / fast", spent["NumPy"] / spent["fast"], "", ">", 3)
        yield Line("  the same bits (1: yes)", float(same), "", ">", 1)


def solving() -> Iterator[Line]:
    """What a user calls, errors, gaps and arrays included, against parts of it and SuperLU."""
    from scipy import sparse
    from scipy.sparse.linalg import splu

    import force_diffusion as fd

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
    import force_diffusion as fd

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

    import force_diffusion as fd

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
    "size": size,
    "c": against_c,
    "digits": digits,
    "profile": profile,
    "writing": writing,
    "spheres": spheres,
}


if __name__ == "__main__":
    raise SystemExit(
        program(
            __doc__,
            f"Forces of a packing of {HEIGHT} layers of {WIDTH} beads, σ/r = 1e-6, surface load;\n"
            "errors are relative to the largest |change|.",
            PARTS,
            {"memory": probe_memory, "first call": probe_first},
        )
    )
