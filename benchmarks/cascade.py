"""What one contact that barely pulls changes when it opens: two tables and a figure, in minutes.

    python benchmarks/cascade.py FOLDER [--heights 8 12 16] [--packings 16]

In each strip of width 2M, with uniform radii and s = 3 r, σ is raised, with the same deviates, to
where the first contact loses its force, and by a millionth more: exactly one contact then pulls, by
about a millionth of the load. Contacts become unilateral, and what has changed is counted. Packings
in which beads overlap before any contact pulls are left out, and those that do not come to rest.
"""

import argparse
from collections.abc import Iterator
from fractions import Fraction
from functools import partial
from itertools import count, groupby, islice, product
from pathlib import Path
from typing import Any

import numpy as np
from force_diffusion.numeric.figures import style
from matplotlib.figure import Figure
from measuring import csv_text

import force_diffusion as fd

JUST = Fraction(1, 10**6)
LOADS = {"surface": fd.SurfaceLoad(), "bulk": fd.BulkLoad()}
SHARES = {
    "forces_1": "forces changed by more than 1 % of the mean",
    "forces_10": "by more than 10 %",
    "moved": "beads moved by more than 0.001 r",
    "new": "contacts that are new",
}


def answer(
    load: str, height: int, seed: int, std: Fraction, quantity: Any, contacts: Any = "bilateral"
) -> fd.Outcome:
    """Solve a packing of the study."""
    return fd.Scene(
        packing=fd.Packing(height=height, width=2 * height),
        disorder=fd.Disorder(kind="uniform", relative_std=std, seed=seed),
        load=LOADS[load],
        effects=fd.Effects(contacts=contacts),
        ask=fd.Ask(quantity=quantity),
    ).run()


def first_tension(load: str, height: int, seed: int) -> Fraction:
    """Find σ/r at which exactly one contact pulls, and by how little."""
    low, high = Fraction(0), Fraction(1, 2)
    while high - low > JUST / 10 * high:
        middle = ((low + high) / 2).limit_denominator(10**12)
        try:
            physical = answer(load, height, seed, middle, "contact_forces").physical
        except fd.ForceDiffusionError:  # beads can't even be deposited
            physical = None
        if physical is not None and not physical.tensile:
            low = middle
        else:
            high = middle
    return high * (1 + JUST)


def opened(load: str, height: int, seed: int) -> dict[str, Any] | None:
    """Open the first contact that pulls, and compare; None where the packing is left out."""
    std = first_tension(load, height, seed)
    solve = partial(answer, load, height, seed, std)
    try:
        before, at_rest = solve("contact_forces"), solve("positions")
        after, moved = (solve(q, "unilateral") for q in ("contact_forces", "positions"))
    except fd.ForceDiffusionError:
        return None
    assert before.physical is not None
    if before.physical.overlaps:
        return None
    old = {(row["i"], row["j"], row["branch"]): float(row["force"]) for row in before.rows()}
    new = {
        (row["i"], row["j"], row["branch"] or (row["upper_i"], row["upper_j"])): float(row["force"])
        for row in after.rows()
    }
    mean = float(np.mean(list(old.values())))
    changes = np.array([abs(new.get(key, 0) - old.get(key, 0)) for key in old | new]) / mean
    bears = (moved.arrays["contacts"] > 0) & (moved.arrays["j"] > 0)
    away = [moved.arrays[name].astype(float) - at_rest.arrays[name] for name in ("dx", "dy")]
    return {
        "load": load, "height": height, "seed": seed, "relative_std": float(std),
        "of_critical": height * float(std) ** (2 / 3),
        "layer": min(old, key=lambda key: old[key])[1] / height,
        "forces_1": (changes > 0.01).mean(), "forces_10": (changes > 0.1).mean(),
        "moved": (np.hypot(*away)[bears] > 1e-3).mean(),
        "new": len(set(new) - set(old)) / len(new),
    }  # fmt: skip


def summary(rows: list[Any]) -> Iterator[dict[str, Any]]:
    """Give mean and standard error by load and height."""
    for (load, height), group in groupby(rows, lambda row: (row["load"], row["height"])):
        own = list(group)
        means: dict[str, Any] = {"load": load, "height": height, "packings": len(own)}
        for name in ("of_critical", "layer", *SHARES):
            values = np.array([row[name] for row in own])
            means |= {name: values.mean(), f"{name}_error": values.std(ddof=1) / len(own) ** 0.5}
        yield means


def drawn(means: list[Any]) -> Figure:
    """Draw one panel a load: shares over M, with bars of two standard errors."""
    figure, panels = style.panels("ab", style.PAGE, 2.9, sharey=True)
    for axes, load in zip(panels, LOADS, strict=True):
        rows = [row for row in means if row["load"] == load]
        heights = [row["height"] for row in rows]
        for number, (name, words) in enumerate(SHARES.items()):
            shares, bars = ([row[n] for row in rows] for n in (name, f"{name}_error"))
            axes.plot(heights, shares, color=f"C{number}", lw=0.8)
            style.points(axes, heights, shares, number, words, [2 * bar for bar in bars])
        axes.set(xlabel="height $M$", xticks=heights, ylim=(0, 1), title=f"{load} load")
    panels[0].set_ylabel("share")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=2)
    return figure


def main() -> None:
    """Write tables and figure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--heights", type=int, nargs="+", default=[8, 12, 16])
    parser.add_argument("--packings", type=int, default=16)
    asked = parser.parse_args()
    asked.folder.mkdir()
    rows: list[Any] = []
    for load, height in product(LOADS, asked.heights):
        cascades = filter(None, (opened(load, height, seed) for seed in count()))
        rows += islice(cascades, asked.packings)
    means = list(summary(rows))
    (asked.folder / "cascade.csv").write_text(csv_text(rows))
    (asked.folder / "summary.csv").write_text(csv_text(means))
    with style.house_style():
        figure = drawn(means)
    command = "python benchmarks/cascade.py"
    for name, content in style.images(figure, "cascade", "Cascades", command, ["png"]).items():
        (asked.folder / name).write_bytes(content)


if __name__ == "__main__":
    main()
