"""What the report draws and measures: the figures, what accuracy costs, and how stable it is."""

from collections.abc import Callable, Sequence
from decimal import Decimal
from pathlib import Path
from typing import Any

from .html import plain_number
from .parts import Data, Figure, Part, Table, csv_data

SCENE = Path(__file__).with_name("small.toml")
Notice = Callable[[str], None]
"""Told what is measured next."""

REALISATIONS = {
    "3": 200,
    "4": 2000,
    "pf": 2000,
    "B2": 200,
    "B5": 2000,
    "B7": 200,
    "B9": 2000,
    "B12": 200,
    "B13": 100,
    "B19": 100,
}
"""Packings in each ensemble of a figure that draws ensembles."""

_PACKINGS = {
    "1": "One packing.",
    "2": "No packing: closed forms.",
    "chains": "One packing.",
    "B10": "Exact Taylor coefficients.",
    "B11": "Exact weights.",
    "B15": "Exact Taylor coefficients.",
} | {name: f"{n} packings in each ensemble." for name, n in REALISATIONS.items()}


def figures_part(notice: Notice) -> Part:
    """All figures, each with what it found, of how many packings, and its data."""
    from force_diffusion.numeric.figures.catalogue import begun
    from force_diffusion.numeric.figures.names import FIGURES

    figures = []
    for name in FIGURES:
        n = REALISATIONS.get(name)
        few = "" if n is None else f" --realisations {n}"
        command = f"force-diffusion figures {name}{few} --seed 1 --out figure"
        made = begun(name, realisations=n, notice=notice, command=command, kinds=("svg",))()
        drawing = next(content for file, content in made.files.items() if file.endswith(".svg"))
        assert isinstance(drawing, bytes)
        told = f"{made.title}: {'; '.join(made.lines)}. {_PACKINGS[name]}"
        data = [
            Data(file, text)
            for file, text in made.files.items()
            if file.endswith(".csv") and isinstance(text, str)
        ]
        figures.append(Figure(drawing, alt=told, caption=told, data=data, command=command))
    return Part(
        id="figures",
        title="The figures",
        words=(
            "The paper’s four figures, drawn from exact packings, and more. Those of ensembles "
            "are made here of fewer packings than the command makes by default.",
        ),
        figures=tuple(figures),
    )


def cost_part(notice: Notice = lambda _: None) -> Part:
    """Every way to answer the small scene, its error beside its time."""
    from force_diffusion.numeric.figures import style
    from force_diffusion.numeric.run import read_scene
    from force_diffusion.numeric.studies.cost.cost import cost
    from force_diffusion.numeric.studies.cost.table import csv_rows

    command = f"force-diffusion cost {SCENE.name} --out cost"
    found = cost(read_scene(SCENE), lambda way: notice(f"cost: {way}"))
    data = found.data()
    title = f"Cost of accuracy: {SCENE.stem}"
    (svg,) = style.images(lambda: found.plot(SCENE.stem), "cost", title, command, ("svg",)).values()
    reference = data["reference"]
    ways = [row for row in data["rows"] if row["pareto"]]
    least = min(ways, key=lambda row: Decimal(row["error"]))
    return Part(
        id="cost",
        title="What accuracy costs",
        words=(
            "Every way to answer the question of one small scene: all contact forces of a packing "
            "of 16 layers of 34 beads, σ/r = 10⁻⁶, under a surface load. Errors are measured, "
            "relative to the largest change of a force, against a reference that is "
            f"{reference['kind']} to {plain_number(Decimal(reference['radius']))}; times are "
            "medians of the machine that made this page. A star marks the Pareto front: no other "
            "way is both more accurate and faster.",
        ),
        command=command,
        figures=(
            Figure(
                svg,
                alt=(
                    "Error against time, both logarithmic, for each way to the answer. On the "
                    f"Pareto front there are {len(ways)} ways; the most accurate of them is "
                    f"“{least['way']}” with {least['arithmetic']}, error {least['error']} after "
                    f"{least['seconds']:.2g} seconds."
                ),
                caption="Error beside time, for every way to the answer.",
            ),
        ),
        tables=(
            Table(
                "Ways to the answer, from the largest error to the smallest",
                ("", "way", "arithmetic", "error", "certified bound", "median ms", "peak kB"),
                tuple(
                    (
                        "★" if row["pareto"] else "",
                        row["way"],
                        row["arithmetic"],
                        Decimal(row["error"]),
                        _decimal(row["certified_bound"]),
                        1000 * row["seconds"],
                        round(row["peak_bytes"] / 1000),
                    )
                    for row in data["rows"]
                ),
                csv_data("cost.csv", csv_rows(data, command)),
            ),
        ),
        files=(Data(SCENE.name, SCENE.read_text(encoding="utf-8"), "text/plain"),),
    )


def _decimal(shown: str | None) -> Decimal | None:
    return None if shown is None else Decimal(shown)


def stability_part(notice: Notice = lambda _: None) -> Part:
    """How accurate the engine is where it is hard to be, and what that costs."""
    from force_diffusion.numeric.figures import style
    from force_diffusion.numeric.studies.stability.stability import (
        CLOSED_FORMS,
        ENCLOSURES,
        FILES,
        FLOATS,
        csv_rows,
        stability,
    )

    command = "force-diffusion stability --out stability"
    found = stability(notice)
    data = found.data()
    files = csv_rows(data, command)
    (svg,) = style.images(
        found.plot, "stability", "The cost of stability", command, ("svg",)
    ).values()
    floats, balls = data[FLOATS], data[ENCLOSURES]
    worst = max(row["error"] for row in floats if row["error"] is not None)
    return Part(
        id="stability",
        title="What stability costs",
        words=(
            "Contact forces in float64, in the deviation form that the engine uses and in the "
            "plain form that subtracts ordered forces in the end, against balls, which enclose "
            "the exact forces. Errors are measured, relative to the largest change of a force. "
            f"The largest error of the deviation form in these tables is {plain_number(worst)}.",
            "Beyond M* the packing itself is unstable: the bits that balls lose there measure it.",
        ),
        command=command,
        figures=(
            Figure(
                svg,
                alt=(
                    "Four panels. Errors of both forms in float64 against the disorder: the "
                    f"deviation form nowhere exceeds {plain_number(worst)}, the plain form loses "
                    "digits as the disorder shrinks. Bits that balls lose against the height: "
                    "in positions many at every layer, in line sums few up to M*. Below, "
                    "the times."
                ),
                caption="Errors and lost bits, and the times that they cost.",
            ),
        ),
        tables=(
            Table(
                "Both forms in float64; each packing is a periodic strip of its own",
                (
                    "group", "M", "W", "σ/r", "s/r", "deviation form", "plain form", "bits lost",
                    "of", "pulling", "overlaps", "note",
                ),
                tuple(
                    (
                        row["group"], row["height"], row["width"], row["relative_std"],
                        Decimal(row["spacing"]), row["error"], row["plain_error"],
                        row["ball_bits_lost"], row["ball_bits"], row["tensile"],
                        row["overlaps"], row["note"],
                    )
                    for row in floats
                ),
                csv_data(FILES[FLOATS], files[FILES[FLOATS]]),
            ),
            Table(
                "Balls in positions and in line-sum coordinates, at the precision that leaves 50 "
                "digits",
                ("balls in", "M", "W", "σ/r", "M*", "bits lost", "of", "error", "ms", "note"),
                tuple(
                    (
                        row["form"], row["height"], row["width"], row["relative_std"],
                        row["critical_height"], row["bits_lost"], row["bits"], row["error"],
                        None if row["seconds"] is None else 1000 * row["seconds"], row["note"],
                    )
                    for row in balls
                ),
                csv_data(FILES[ENCLOSURES], files[FILES[ENCLOSURES]]),
            ),
            Table(
                "Closed forms of Eqs. 13 and 14 in float64, against exact rationals: the layer "
                "with the largest error",
                ("form", "M", "j", "relative error"),
                tuple(
                    (row["form"], row["height"], row["j"], row["relative_error"])
                    for row in _largest(data[CLOSED_FORMS])
                ),
                csv_data(FILES[CLOSED_FORMS], files[FILES[CLOSED_FORMS]]),
            ),
        ),
    )  # fmt: skip


def _largest(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Of every form and height, the row with the largest error."""
    found: dict[tuple[str, int], dict[str, Any]] = {}
    for row in rows:
        key = row["form"], row["height"]
        if key not in found or row["relative_error"] > found[key]["relative_error"]:
            found[key] = row
    return list(found.values())
