"""What stability costs: two tables and a figure, written into a folder, in about a minute.

    python benchmarks/stability.py FOLDER

Packings are strips under a surface load, s = 3 r, with uniform radii. The engine finds the changes
of their contact forces themselves, in line-sum coordinates (the deviation form). The plain form is
what one would write first: positions by circle intersection, forces by balance, the ordered forces
subtracted. Both are compared in float64, and in balls. Errors are relative to the largest change.
"""

import argparse
from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from math import ceil, log2, log10
from pathlib import Path
from time import process_time
from typing import Any

import flint
import numpy as np
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Balls, NumberSystem
from force_diffusion.numeric.figures import style
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.planner import plan
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from measuring import csv_text, in_turn

import force_diffusion as fd

GOAL = ceil(50 * log2(10))  # bits of 50 digits
POSITIONS, LINE_SUMS = "positions", "line sums"


def plain(delta: Any, system: NumberSystem) -> Any:
    """Changes of all contact forces by circles and balance, (M, 2, W): branch, upper bead.

    ``delta``: δr/r, (M + 1, W). Where a bead does not rest they are no numbers.
    """
    with system.active(), np.errstate(all="ignore"):
        delta, (nx,) = system.from_floats(delta), system.from_floats(np.array([0.75]))
        x, y, contacts = 4 * nx * np.arange(delta.shape[1]), 0 * delta[0], []
        for j in range(1, len(delta)):
            # supports of column q: columns q − 1 and q in even layers, q and q + 1 in odd ones
            left, right = 1 - j % 2, -(j % 2)
            a, b = (2 + delta[j] + np.roll(delta[j - 1], side) for side in (left, right))
            ax, bx = np.roll(x, left), np.roll(x, right)
            ay, by = np.roll(y, left), np.roll(y, right)
            ax[0] = ax[0] - left * 4 * nx * len(x)
            bx[-1] = bx[-1] - right * 4 * nx * len(x)
            dx, dy = bx - ax, by - ay
            square = dx * dx + dy * dy
            along = ((a * a - b * b) / square + 1) / 2
            high = np.sqrt(a * a / square - along * along)
            x, y = ax + along * dx - high * dy, ay + along * dy + high * dx
            contacts.append((left, right, (x - ax) / a, (y - ay) / a, (x - bx) / b, (y - by) / b))
        sx, sy, forces = 0 * x, 1 + 0 * x, []
        for left, right, px, py, qx, qy in reversed(contacts):
            determinant = px * qy - py * qx
            plus, minus = (sx * qy - sy * qx) / determinant, (sy * px - sx * py) / determinant
            sx = np.roll(plus * px, -left) + np.roll(minus * qx, -right)
            sy = np.roll(plus * py, -left) + np.roll(minus * qy, -right)
            forces.append((plus, minus))
        return np.array(forces[::-1]) - 1 / (2 * np.sqrt(1 - nx * nx))


def deviations(delta: Any) -> Callable[[NumberSystem], Any]:
    """Give what solves for the changes of all contact forces as the engine does, like ``plain``."""
    height, width = len(delta) - 1, len(delta[0])
    scene = fd.Scene(
        packing=fd.Packing(height=height, width=width, spacing=3, allow_images=True),
        disorder=fd.GivenRadii(delta_r=delta),
        ask=fd.Ask(quantity="contact_forces"),
    )
    problem = plan(scene).problem

    def solve(system: NumberSystem) -> Any:
        with system.active():
            return (
                engine.solve(problem, [0], system, Work())
                .g[0]
                .reshape(2, height, width)
                .swapaxes(0, 1)
            )

    return solve


def uniform(height: int, width: int, std: float) -> Any:
    """Draw δr/r, the same but for their scale at every σ/r."""
    draw = np.random.default_rng([height, width])
    return std * 3**0.5 * draw.uniform(-1, 1, (height + 1, width))


def largest(balls: Any) -> Any:
    """Bound all from above; infinite where one is not known."""
    bounds = [abs(ball).upper() for ball in balls.flat]
    return max(bounds) if all(bound.is_finite() for bound in bounds) else flint.arb("inf")


def floats() -> Iterator[dict[str, Any]]:
    """Measure errors and times of both forms in float64."""
    for height, exponent in product((16, 128), (2, 3, 4, 6, 8, 10, 12, 14, 16, 20, 30)):
        delta = uniform(height, 34, 10.0**-exponent)
        solve = deviations(delta)
        ways = {"": partial(solve, FLOAT64), "plain_": partial(plain, delta, FLOAT64)}
        times = in_turn(ways, 5, process_time)
        row = {"height": height, "relative_std": 10.0**-exponent}
        true = solve(Balls(512))
        with flint.ctx.workprec(512):
            for name, way in ways.items():
                away = largest(Balls(53).from_floats(way()) - true) / largest(true)
                row |= {f"{name}error": float(away), f"{name}seconds": times[name]}
        yield row


def balls() -> Iterator[dict[str, Any]]:
    """Find the bits that balls lose in both forms, and the time of 50 digits."""
    for form, exponents in ((POSITIONS, (2, 4, 8)), (LINE_SUMS, (2, 3, 4, 8))):
        for exponent, height in product(exponents, (4, 8, 16, 32, 64, 128, 256, 512, 1024)):
            delta = uniform(height, 16, 10.0**-exponent)
            solve = partial(plain, delta) if form == POSITIONS else deviations(delta)
            lost = bits_lost(solve)
            if lost is not None:
                work = partial(solve, Balls(GOAL + ceil(lost)))
                times = in_turn({form: work}, 5, process_time)
                row = {"form": form, "height": height, "relative_std": 10.0**-exponent}
                yield {**row, "bits_lost": round(lost, 1), "seconds": times[form]}


def bits_lost(solve: Callable[[NumberSystem], Any]) -> float | None:
    """Give the bits lost where 50 digits are left; None: it does not stand, or 8192 are too few."""
    for bits in (256, 512, 1024, 2048, 4096, 8192):
        try:
            changes = solve(Balls(bits))
        except fd.ForceDiffusionError:
            continue
        radius = largest(np.array([ball.rad() for ball in changes.flat])) / largest(changes)
        if radius < flint.arb(2) ** -GOAL:
            return bits + float(radius.log_base(2))
    return None


def drawn(rows: list[Any], enclosed: list[Any]) -> Figure:
    """Draw errors in float64 on the left, lost bits of balls on the right."""
    figure, (errors, lost) = style.panels("ab", style.PAGE, 3.2)
    errors.axhline(0, color="0.6", ls=":", lw=0.7, label="no digit is left above")
    forms = (("plain_error", "plain form", 1, "--"), ("error", "deviation form", 0, "-"))
    for (key, form, series, dashes), height in product(forms, (16, 128)):
        own = [row for row in rows if row["height"] == height]
        x, y = ([log10(row[name]) for row in own] for name in ("relative_std", key))
        errors.plot(x, y, color=f"C{series}", ls=dashes)
        face = f"C{series}" if height > 16 else "white"
        style.points(errors, x, y, series, f"{form}, $M={height}$", mfc=face)
    for series, dashes, form in ((1, "--", POSITIONS), (0, "-", LINE_SUMS)):
        for std in sorted({row["relative_std"] for row in enclosed if row["form"] == form}):
            own = [row for row in enclosed if (row["form"], row["relative_std"]) == (form, std)]
            x, y = ([row[name] for row in own] for name in ("height", "bits_lost"))
            lost.plot(x, y, color=f"C{series}", ls=dashes)
            style.points(lost, x, y, series, form if std == 1e-8 else "")
            if form == LINE_SUMS:
                words, last = f"  σ/r = 1e{log10(std):.0f}", (x[-1], y[-1])
                lost.annotate(words, last, va="center", color=f"C{series}", fontsize=7.5)
    errors.set(xlabel="σ/r", ylabel="error / largest |change|", ylim=(-18.8, 14.8))
    errors.set_title("float64: largest error of the contact forces")
    for axis in (errors.xaxis, errors.yaxis):  # along which lie logarithms
        axis.set_major_locator(MaxNLocator(8, integer=True, steps=(1, 2, 5, 10)))
        axis.set_major_formatter(lambda power, _: f"$10^{{{power:g}}}$")
    lost.set(xscale="log", yscale="log", xlim=(3.4, 4100), ylabel="bits lost", ylim=(4, None))
    lost.set(xlabel="layers $M$ (strips of 16 beads a layer)", title="balls: precision lost")
    errors.legend()
    lost.legend()
    return figure


def main() -> None:
    """Write tables and figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args().folder
    folder.mkdir(parents=True, exist_ok=True)
    rows, enclosed = list(floats()), list(balls())
    (folder / "stability.csv").write_text(csv_text(rows))
    (folder / "stability_balls.csv").write_text(csv_text(enclosed))
    with style.house_style():
        figure = drawn(rows, enclosed)
    command = "python benchmarks/stability.py"
    for name, content in style.images(figure, "stability", "Stability", command, ["png"]).items():
        (folder / name).write_bytes(content)


if __name__ == "__main__":
    main()
