"""How fast many packings are: an ensemble beside drawing as many random numbers.

Run with ``python benchmarks/studies.py`` (needs the extra ``fast``). All times are of processors,
and come from the same run: targets are ratios. Each part takes the least of several rounds, in
which competitors take turns. Exit status 1 when a target is missed.
"""

import os
import subprocess
import sys
from collections.abc import Iterator
from functools import partial
from time import process_time, thread_time

import numpy as np
from measuring import Line, in_turn, program

import force_diffusion as fd

HEIGHT, WIDTH, FEWER, MORE = 256, 512, 200, 400
BEADS = (HEIGHT + 1) * WIDTH


def scene(quantity: str = "profile") -> fd.Scene:
    """Uniform radii under a surface load."""
    return fd.Scene(
        packing=fd.Packing(height=HEIGHT, width=WIDTH, spacing=3),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-6, seed=1),
        ask=fd.Ask(quantity=quantity),
    )


def ensemble() -> Iterator[Line]:
    """Marginal time of an ensemble: so many packings more, beside the draws."""
    more = MORE - FEWER
    generator = np.random.Generator(np.random.Philox(1))
    for quantity in ("profile", "histogram"):
        asked = scene(quantity)
        times = in_turn(
            {
                "fewer": partial(fd.ensemble, asked, FEWER),
                "more": partial(fd.ensemble, asked, MORE),
                "draws": lambda: [generator.random(BEADS) for _ in range(more)],
            },
            3,
            process_time,
            min,
        )
        marginal = (times["more"] - times["fewer"]) / more
        target = ("<", 6) if quantity == "profile" else ("", 0)
        yield Line(f"ensemble, {quantity}", 1e9 * marginal / BEADS, " ns per bead")
        draws = times["draws"] / more
        yield Line("  ensemble / as many doubles of NumPy's Philox", marginal / draws, "", *target)


def shared(packings: int) -> float:
    """Solve an ensemble; give this thread's processor time, and a core's share of the others'."""
    own, start, cores = thread_time(), process_time(), len(os.sched_getaffinity(0))
    fd.ensemble(scene(), packings, workers=cores)
    own = thread_time() - own
    return own + (process_time() - start - own) / cores


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
