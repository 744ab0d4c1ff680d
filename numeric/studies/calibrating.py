"""The short calibration: the engine itself on a few small plans, and coefficients fitted to that.

Each step of each plan is timed in every family of number systems, the quickest of a few runs, in
seconds of the processor, which other programs on the machine change less than those of the clock.
For each family and step the non-negative coefficients are fitted that make the relative misfits of
the measured times least.
"""

import importlib.util
import itertools
import math
import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from time import process_time

import numpy as np
from force_diffusion.numeric.accuracy.enclosed import Accuracy, of_balls, strings
from force_diffusion.numeric.accuracy.repeated import of_repeat
from force_diffusion.numeric.arithmetic.systems import (
    FLOAT64,
    LONGDOUBLE,
    Balls,
    BigFloat,
    NumberSystem,
)
from force_diffusion.numeric.disorder.radii import MeasuredRadii
from force_diffusion.numeric.lattice.layers import Array
from force_diffusion.numeric.mechanics.engine import batches, solve
from force_diffusion.numeric.mechanics.physicality import Physicality
from force_diffusion.numeric.mechanics.work import Work as Clocks
from force_diffusion.numeric.planning.budget import DEFAULT_BINS
from force_diffusion.numeric.planning.cost_model import (
    TERMS,
    Fitted,
    Model,
    defaults,
    gathering,
    last_work,
    pass_work,
)
from force_diffusion.numeric.planning.plan import Plan, Way
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.quantities.answers import GATHERERS
from force_diffusion.numeric.scene.sections import parse_scene
from force_diffusion.numeric.statistics import histogram
from force_diffusion.numeric.studies.cost.ways import solve_plainly

# A plan is run again, for a quiet run, until its runs have taken so many seconds together.
RUNS, MOST_RUNS, ENOUGH = 2, 6, 0.02
COMPILED_STEPS = ("deposit", "balance forces")
# Steps that the engine times by itself, under other names.
CLOCKS = {
    "radii": ("radii", "listed radii", "radii of lines"),
    "deposit": ("deposit", "plain deposit"),
    "line sums": ("line sums", "line sums of one"),
    "balance forces": ("balance forces", "plain balance forces", "balance to first order"),
}
Seconds = dict[str, float]
Samples = dict[str, list[tuple[Mapping[str, float], float]]]


def _plan(
    height: int, width: int, ask: str = 'quantity = "contact_forces"', geometry: str = "exact"
) -> Plan:
    text = (
        f"packing = {{height = {height}, width = {width}}}\n"
        f'effects = {{geometry = "{geometry}"}}\nask = {{{ask}}}\n'
        'disorder = {kind = "uniform", relative_std = 1e-6, seed = 1}\n'
    )
    return plan(parse_scene(text), memory_limit=10**18)


def _listed(made: Plan) -> Plan:
    """Give the plan with radii as if they had been read from a file."""
    sites = {
        (i, layer.j): Fraction(i + layer.j, 10**9)
        for layer in made.region.rows
        for i in layer.sites()
    }
    return replace(made, radii=MeasuredRadii(sites, made.region.width))


def _plans(small: int) -> Iterator[Plan]:
    """Plans of packings of ``small`` layers and of twice as many, for every step of the model."""
    first, contact = "first-order", 'quantity = "contact", at = [0, 0, "+"]'
    for height, width in ((small, 2 * small + 2), (2 * small, 8 * small)):
        yield _plan(height, width)
        yield _plan(height, width, 'quantity = "profile"', first)
    yield _plan(small, 2 * small + 2, 'quantity = "positions"', first)
    yield _plan(2 * small, 8 * small, 'quantity = "positions"', first)
    yield _plan(small, 2 * small + 2, 'quantity = "profile", realisations = 6')
    yield _plan(small, 2 * small + 2, contact + ", realisations = 12", first)
    yield _plan(16 * small, 17 * small, contact, first)
    yield _plan(30 * small, 31 * small, contact, first)
    yield _plan(small, 2 * small + 2, 'quantity = "histogram", bins = 50')
    yield _plan(small, 2 * small + 2, 'quantity = "histogram", bins = 500')
    yield _listed(_plan(small, 2 * small + 2))
    yield _listed(_plan(2 * small, 8 * small))


def families() -> dict[str, list[tuple[NumberSystem, list[Plan]]]]:
    """Give the number systems that are timed, with their plans."""
    middle = list(_plans(8))
    large = [_plan(h, w, 'quantity = "profile"') for h, w in ((40, 200), (12, 3000))]
    large.append(_plan(40, 200))
    # What many digits cost needs no more than a small packing.
    small = list(_plans(3))
    few = [small[k] for k in (0, 1, 4, 8, 10)]
    plainly = [replace(made, way=Way(Balls(53), plain=True)) for made in (small[0], small[2])]
    found: dict[str, list[tuple[NumberSystem, list[Plan]]]] = {
        "float64": [(FLOAT64, middle + large)],
        "mpmath": [(BigFloat(d), small if d == 30 else few) for d in (30, 200, 800)],
        "balls": [
            (Balls(bits), [*(small if bits == 100 else few), *plainly])
            for bits in (100, 400, 1500, 5000)
        ],
    }
    if LONGDOUBLE.bits > FLOAT64.bits:
        found["longdouble"] = [(LONGDOUBLE, middle)]
    return found


def timed(made: Plan, system: NumberSystem) -> Seconds:
    """Run a plan's steps once; give the seconds of each step of ``cost_model``."""
    spent: Seconds = defaultdict(float)

    @contextmanager
    def clock(step: str) -> Iterator[None]:
        start = process_time()
        yield
        spent[step] += process_time() - start

    n = made.realisations
    clocks, physical = Clocks(), Physicality()
    gather = gathering(made)
    solver = solve_plainly if made.way.plain else solve
    with system.active():
        gatherer = GATHERERS[made.scene.ask.quantity](made, system)
        for chunk in batches(made, range(n), system):
            solved = solver(made, chunk, system, clocks)
            if made.route == "exact" and solved.packing is not None:
                with clock("check"):
                    physical.look_at_gaps(solved.packing)
                    if solved.forces is not None:
                        physical.look_at_forces(solved.forces)
            with clock(gather):
                gatherer.add(solved, chunk)
        with clock(gather):
            table = gatherer.table()
        accuracy = Accuracy(1e-15, False, system.name, 0.0)
        if isinstance(system, Balls):
            with clock("certify"):
                accuracy = of_balls(table, system, Fraction(1))
        if made.scene.ask.quantity == "histogram":
            with clock("bins"):
                values, bins = table.numbers["change"], made.scene.ask.bins or DEFAULT_BINS
                histogram.printed(histogram.histogram(values, bins, system))
        else:
            with clock("print"):
                strings(table, accuracy, system)
        with clock("compare"):
            of_repeat(table, table, table, replace(made, way=Way(system, system, n)))
    work = pass_work(made, system, n, again=False)
    for name, steps in CLOCKS.items():
        for step in steps:
            if step in work:
                spent[step] += clocks.seconds.get(name, 0.0)
    return spent


def calibrate(notice: Callable[[str], None] = lambda _: None, *, compiled: bool = False) -> Model:
    """Time everything and fit; takes a few seconds.

    ``compiled`` times the compiled sweeps, too, which may have to be compiled first; otherwise
    their coefficients are the defaults.
    """
    fitted: dict[str, dict[str, Fitted]] = {}
    for family, systems in families().items():
        notice(family)
        samples: Samples = defaultdict(list)
        for system, plans in systems:
            for made in plans:
                runs = _runs(made, system)
                work = pass_work(made, system, made.realisations, again=False)
                work |= last_work(made, system, made.realisations)
                for step, amounts in work.items():
                    if step in runs[0]:
                        samples[step].append((amounts, min(run[step] for run in runs)))
        fitted[family] = {step: _fit(found) for step, found in samples.items()}
    fitted.setdefault("longdouble", fitted["float64"])  # where it is no longer, it is as fast
    load, quick = defaults().load_seconds, defaults().families["compiled"]
    if compiled and importlib.util.find_spec("numba") is not None:
        notice("compiled")
        load, quick = _compiled()
    fitted["compiled"] = {**fitted["float64"], **{k: quick[k] for k in COMPILED_STEPS}}
    return Model(source="calibrated on this machine", load_seconds=load, families=fitted)


def _runs(made: Plan, system: NumberSystem) -> list[Seconds]:
    """Time a plan a few times: the sooner it is done, the more often."""
    start, runs = process_time(), [timed(made, system)]
    while len(runs) < RUNS or (len(runs) < MOST_RUNS and process_time() - start < ENOUGH):
        runs.append(timed(made, system))
    return runs


def _compiled() -> tuple[float, dict[str, Fitted]]:
    """Time the compiled sweeps, and loading them in a fresh process."""
    samples: Samples = defaultdict(list)
    sweep_compiled()
    for height, width in ((8, 20), (20, 5000), (100, 10_000)):
        made = _plan(height, width)
        runs = [sweep_compiled(made) for _ in range(MOST_RUNS)]
        best = [min(seconds) for seconds in zip(*runs, strict=True)]
        work = pass_work(made, FLOAT64, 1, again=False)
        for step, seconds in zip(COMPILED_STEPS, best, strict=True):
            samples[step].append((work[step], seconds))
    program = (
        "from time import process_time; import force_diffusion.numeric.run; "
        "start = process_time(); import force_diffusion.numeric.studies.calibrating as c; "
        "c.sweep_compiled(); print(process_time() - start)"
    )
    done = subprocess.run(
        [sys.executable, "-P", "-c", program], capture_output=True, text=True, check=False
    )
    load = float(done.stdout) if not done.returncode else defaults().load_seconds
    return load, {step: _fit(found) for step, found in samples.items()}


def sweep_compiled(made: Plan | None = None) -> tuple[float, float]:
    """Give the seconds of both compiled sweeps of a packing (by default, a small one)."""
    from force_diffusion.numeric.mechanics import compiled as fast

    made = _plan(2, 6) if made is None else made
    n_x, rows = made.scene.n_x, made.region.rows
    with FLOAT64.active():
        rho = tuple(made.radii.row(layer, [0], FLOAT64) for layer in rows)
        loads = made.load.on(rows, made.load.strength(n_x, FLOAT64), FLOAT64)
        start = process_time()
        solved = fast.deposit(n_x, made.region, rho, FLOAT64)
        between = process_time()
        fast.sweep_down(solved, rows, loads)
        return between - start, process_time() - between


def _fit(samples: Sequence[tuple[Mapping[str, float], float]]) -> Fitted:
    """Fit non-negative coefficients to (amounts, seconds), least squares of relative misfits."""
    terms = [t for t in TERMS if any(amounts.get(t) for amounts, _ in samples)]
    rows = np.array([[amounts.get(t, 0.0) / s for t in terms] for amounts, s in samples])
    found = non_negative(rows)
    fits = rows @ found
    misfit = max(max(f, 1 / f) if f > 0 else math.inf for f in fits.tolist())
    return Fitted(
        seconds={t: float(f"{c:.4g}") for t, c in zip(terms, found.tolist(), strict=True) if c},
        misfit=float(f"{min(misfit, 1e9):.3g}"),
    )


def non_negative(rows: Array) -> Array:
    """Solve rows · x ≈ 1 for x ≥ 0 in least squares, by trying every set of terms that may be 0.

    >>> non_negative(np.array([[1.0, 2.0], [1.0, 4.0]])).round(6).tolist()
    [1.0, 0.0]
    """
    count = rows.shape[1]
    best, least = np.zeros(count), math.inf
    for chosen in itertools.product([False, True], repeat=count):
        if not any(chosen):
            continue
        part = rows[:, chosen]
        solution = np.linalg.lstsq(part, np.ones(len(rows)), rcond=None)[0]
        if (solution < 0).any():
            continue
        misfit = float(((part @ solution - 1) ** 2).sum())
        if misfit < least * (1 - 1e-9):
            best, least = np.zeros(count), misfit
            best[list(chosen)] = solution
    return best
