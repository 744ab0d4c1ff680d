"""Time and memory over the number of beads of one packing, and over the number of packings.

Run with ``python benchmarks/scale.py`` (needs the extra ``fast``; ``--most 9`` goes to 10⁹ beads,
which takes minutes, and ``--figure scale.png`` draws the table, which needs the extra ``plots``).
Each line is a process of its own: seconds are of the processor, estimating the error included;
memory is that process's most, the interpreter included. Packings of more than ``--memory`` bytes
are swept by segments.
"""

import argparse
import json
import resource
import subprocess
import sys
from time import process_time
from typing import Any

from force_diffusion.numeric.planning.planner import plan

import force_diffusion as fd

# Layers and beads a layer of packings of an ensemble, and the powers of ten of both tables.
HEIGHT, WIDTH = 64, 130
BEADS, PACKINGS = range(4, 8), range(2, 6)


def scene(height: int, width: int) -> fd.Scene:
    """Uniform radii under a surface load, asked for the profile."""
    return fd.Scene(
        packing=fd.Packing(height=height, width=width, spacing=3),
        disorder=fd.Disorder(kind="uniform", relative_std=1e-8, seed=1),
        ask=fd.Ask(quantity="profile"),
    )


def measured(what: str, power: int, memory: int) -> dict[str, Any]:
    """Solve one packing of 10^power beads, or so many packings; after a small one of its kind."""
    size = 10**power
    if what == "beads":
        width = round(size**0.5) + 1
        planned = plan(scene(size // width - 1, width), memory_limit=memory)
        beads, start = planned.problem.region.beads, process_time()
        fd.run(planned)  # and a second time, or of a narrow one, to estimate the error
        seconds = process_time() - start
        way = "segments" if planned.problem.segment else "in memory"
    else:
        fd.ensemble(scene(HEIGHT, WIDTH), 300)  # loads the compiled loops
        beads, start, way = (HEIGHT + 1) * WIDTH * size, process_time(), "ensemble"
        fd.ensemble(scene(HEIGHT, WIDTH), size)
        seconds = process_time() - start
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return {
        "what": what,
        "size": size,
        "beads": beads,
        "seconds": seconds,
        "bytes": most,
        "way": way,
    }


def drawn(found: list[dict[str, Any]], path: str) -> None:
    """Draw nanoseconds a bead, and memory, over beads."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7, 3), layout="constrained")
    times, memory = figure.subplots(1, 2)
    for what, label in (("beads", "one packing"), ("packings", f"packings of {HEIGHT} × {WIDTH}")):
        lines = [one for one in found if one["what"] == what]
        beads = [one["beads"] for one in lines]
        times.loglog(
            beads, [1e9 * one["seconds"] / one["beads"] for one in lines], "o-", label=label
        )
        memory.loglog(beads, [one["bytes"] / 1e6 for one in lines], "o-", label=label)
    times.set(xlabel="beads in all", ylabel="processor time, ns a bead")
    memory.set(xlabel="beads in all", ylabel="memory, MB")
    times.legend()
    figure.savefig(path)


def main() -> int:
    """Measure each size in a process of its own, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=BEADS[-1], help="power of ten of the beads")
    parser.add_argument("--memory", type=int, default=2 * 10**9, help="bytes that may be used")
    parser.add_argument("--figure", metavar="FILE")
    parser.add_argument("--one", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measured(options.one[0], int(options.one[1]), options.memory)))
        return 0
    sizes = [("beads", power) for power in range(BEADS[0], options.most + 1)]
    sizes += [("packings", power) for power in PACKINGS]
    print("| size | way | seconds | ns a bead | memory |\n|---|---|---:|---:|---:|")
    found = []
    for what, power in sizes:
        command = [sys.executable, __file__, "--memory", str(options.memory)]
        done = subprocess.run(
            [*command, "--one", what, str(power)], check=True, capture_output=True, text=True
        )
        one = json.loads(done.stdout)
        each = 1e9 * one["seconds"] / one["beads"]
        print(
            f"| 10^{power} {what} | {one['way']} | {one['seconds']:.3g} | {each:.3g} | "
            f"{one['bytes'] / 1e6:.0f} MB |",
            flush=True,
        )
        found.append(one)
    if options.figure:
        drawn(found, options.figure)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
