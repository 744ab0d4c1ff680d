"""Time and memory over the number of beads of one packing, and over the number of packings.

Run with ``python benchmarks/scale.py`` (needs the extra ``fast``; ``--packings 6`` goes to 10⁶
packings, which takes minutes; ``--figure scale.png`` draws the table, which needs the extra
``plots``).
Each line is a process of its own: seconds are of the processor, estimating the error included;
memory is that process's most, the interpreter included.
"""

import argparse
import json
import resource
import subprocess
import sys
from pathlib import Path
from time import process_time
from typing import Any

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


def measured(what: str, power: int) -> dict[str, Any]:
    """Solve one packing of 10^power beads, or so many packings; after a small one of its kind."""
    size = 10**power
    if what == "beads":
        width = round(size**0.5) + 1
        planned = scene(size // width - 1, width).explain()
        beads, start = planned.problem.region.beads, process_time()
        fd.run(planned)
        seconds = process_time() - start
    else:
        fd.ensemble(scene(HEIGHT, WIDTH), 300)  # loads the compiled loops
        beads, start = (HEIGHT + 1) * WIDTH * size, process_time()
        fd.ensemble(scene(HEIGHT, WIDTH), size)
        seconds = process_time() - start
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    return {
        "what": what,
        "size": size,
        "beads": beads,
        "seconds": seconds,
        "bytes": most,
    }


def drawn(found: list[dict[str, Any]], path: Path) -> None:
    """Draw nanoseconds a bead, and memory, over beads."""
    from force_diffusion.numeric.figures import style

    def draw() -> Any:
        figure = style.figure(style.PAGE, 2.6)
        panels = figure.subplots(1, 2)
        labels = {"beads": "one packing", "packings": f"packings of {HEIGHT} × {WIDTH}"}
        for place, (what, label) in enumerate(labels.items()):
            lines = [one for one in found if one["what"] == what]
            beads = [one["beads"] for one in lines]
            colour, marker = style.series(place)
            look = {"color": colour, "marker": marker, "mfc": "white", "ms": 3.5, "label": label}
            panels[0].loglog(beads, [1e9 * one["seconds"] / one["beads"] for one in lines], **look)
            panels[1].loglog(beads, [one["bytes"] / 1e6 for one in lines], **look)
        panels[0].set_ylabel("processor time (ns per bead)")
        panels[1].set_ylabel("memory (MB)")
        panels[1].set_ylim(10, 10_000)
        for axes in panels:
            axes.set_xlabel("beads in all")
        panels[0].legend(loc="upper right")
        style.letter(list(panels))
        return figure

    command = " ".join(["python", "benchmarks/scale.py", *sys.argv[1:]])
    for name, content in style.images(draw, path.stem, "Time and memory", command, ["png"]).items():
        path.with_name(name).write_bytes(content)


def main() -> int:
    """Measure each size in a process of its own, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--most", type=int, default=BEADS[-1], help="power of ten of the beads")
    parser.add_argument("--packings", type=int, default=PACKINGS[-1], help="likewise, of packings")
    parser.add_argument("--figure", type=Path, metavar="FILE.png")
    parser.add_argument("--one", nargs=2, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measured(options.one[0], int(options.one[1]))))
        return 0
    sizes = [("beads", power) for power in range(BEADS[0], options.most + 1)]
    sizes += [("packings", power) for power in range(PACKINGS[0], options.packings + 1)]
    print("| size | seconds | ns per bead | memory |\n|---|---:|---:|---:|")
    found = []
    for what, power in sizes:
        command = [sys.executable, __file__, "--one", what, str(power)]
        done = subprocess.run(command, check=True, capture_output=True, text=True)
        one = json.loads(done.stdout)
        each = 1e9 * one["seconds"] / one["beads"]
        print(
            f"| 10^{power} {what} | {one['seconds']:.3g} | {each:.3g} | "
            f"{one['bytes'] / 1e6:.0f} MB |",
            flush=True,
        )
        found.append(one)
    if options.figure is not None:
        drawn(found, options.figure)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
