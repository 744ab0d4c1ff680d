"""How fast many packings are: an ensemble beside what its beads take at least.

Run with ``python benchmarks/studies.py`` (needs the extra ``fast``). All times are of processors,
and come from the same run: targets are ratios. Each part takes the least of
several rounds, in which competitors take turns. Exit status 1 when a target is missed.
"""

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import partial
from time import process_time, thread_time
from typing import Any

import numpy as np
from force_diffusion.numeric.arithmetic.systems import FLOAT64
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.planning.planner import plan
from measuring import Line, in_turn, program

import force_diffusion as fd

HEIGHT, WIDTH, FEWER, MORE = 256, 512, 200, 400
BEADS = (HEIGHT + 1) * WIDTH


def scene(quantity: str = "profile", **asked: Any) -> fd.Scene:
    """Uniform radii under a surface load."""
    return fd.Scene(
        packing=fd.Packing(height=HEIGHT, width=WIDTH, spacing=3),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-6, seed=1),
        ask=fd.Ask(quantity=quantity, **asked),
    )


def both_sweeps(packings: int) -> Callable[[], None]:
    """Deposit and balance a packing again and again, in memory that stays."""
    from force_diffusion.numeric.mechanics.sweeps import Sweeps

    problem = plan(scene()).problem
    sweeps = Sweeps(problem)
    rho = sweeps.radii(range(1))
    strength = problem.load.strength(problem.n_x, FLOAT64)
    loads = problem.load.on(problem.force_rows, strength, FLOAT64)

    def solve() -> None:
        for _ in range(packings):
            block = sweeps.deposit(rho)
            assert block is not None
            sweeps.descent(problem.force_rows, loads)(block)

    return solve


def numpy_alone(packings: int, most: int = engine.MOST) -> Callable[[], None]:
    """Solve and sum up as without the extra ``fast``, ``most`` beads at a time."""
    from force_diffusion.numeric.ensemble.measure import measurement
    from force_diffusion.numeric.ensemble.sums import measured

    made = measurement(scene())

    def solve() -> None:
        before = engine.COMPILED_FROM, engine.MOST
        engine.COMPILED_FROM, engine.MOST = 1 << 62, most
        try:
            measured(made, 0, packings)
        finally:
            engine.COMPILED_FROM, engine.MOST = before

    return solve


def ensemble() -> Iterator[Line]:
    """Marginal time of an ensemble: so many packings more, beside the sweeps and the draws."""
    more = MORE - FEWER
    generator = np.random.Generator(np.random.Philox(1))
    for quantity, most in (("profile", 2.1), ("histogram", 3)):
        asked = scene(quantity)
        found = in_turn(
            {
                "fewer": partial(fd.ensemble, asked, FEWER),
                "more": partial(fd.ensemble, asked, MORE),
                "sweeps": both_sweeps(more // 10),
                "draws": lambda: [generator.random(BEADS) for _ in range(more // 10)],
                "numpy": numpy_alone(8),
                "one by one": numpy_alone(8, BEADS),
            },
            3,
            process_time,
            min,
        )
        marginal = (found["more"] - found["fewer"]) / more
        sweeps, draws = (found[name] / (more // 10) for name in ("sweeps", "draws"))
        yield Line(f"ensemble, {quantity}", 1e9 * marginal / BEADS, " ns per bead")
        yield Line("  deposit + balance, compiled", 1e9 * sweeps / BEADS, " ns per bead")
        yield Line("  ensemble / that", marginal / sweeps, "", "<", most)
        yield Line("  ensemble / as many doubles of NumPy's Philox", marginal / draws, "", "<", 10)
        yield Line("  NumPy alone / ensemble", found["numpy"] / 8 / marginal)
        gain = found["one by one"] / found["numpy"]
        yield Line("  NumPy alone, a packing at a time / eight", gain, "", ">", 2)


def shared(packings: int) -> float:
    """Solve an ensemble; give this thread's processor time, and a core's share of the others'."""
    own, start = thread_time(), process_time()
    fd.ensemble(scene(), packings)
    own = thread_time() - own
    return own + (process_time() - start - own) / len(os.sched_getaffinity(0))


def probe() -> float:
    """Seconds that so many packings more take, here."""
    size = 4 * MORE
    least = {n: min(shared(n) for _ in range(3)) for n in (FEWER, size)}
    return least[size] - least[FEWER]


def cores() -> Iterator[Line]:
    """Two cores against one, by the clock of threads, which other programs do not disturb.

    Threads take blocks in turns, and this process's own does all that is done by one alone: with
    free cores, the clock on the wall goes with that and a core's share of the rest.
    """
    both = sorted(os.sched_getaffinity(0))[:2]
    seconds = []
    for allowed in (both[:1], both):
        done = subprocess.run(
            [sys.executable, __file__, "--probe", "cores"],
            check=True,
            capture_output=True,
            text=True,
            preexec_fn=partial(os.sched_setaffinity, 0, allowed),
        )
        seconds.append(float(done.stdout))
    ratio = seconds[0] / seconds[1]
    yield Line("one core / two, processor time, shared by the cores", ratio, "", ">", 1.8)


PARTS = {"ensemble": ensemble, "cores": cores}


if __name__ == "__main__":
    head = f"Packings of {HEIGHT} layers of {WIDTH} beads, σ/r = 1e-6, surface load"
    raise SystemExit(program(__doc__, head, PARTS, {"cores": probe}))
