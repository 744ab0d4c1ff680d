"""What the report draws and measures: the figures, what accuracy costs, and how stable it is."""

from collections.abc import Callable
from pathlib import Path

from ..tables import with_command
from .html import number
from .parts import Data, Figure, Part, Table, csv_data

SCENE = Path(__file__).with_name("small.toml")
Notice = Callable[[str], None]
"""Told what is measured next."""
# Of a figure's packings the report draws one in so many, and no fewer than these.
SHARE, FEWEST = 10, 100
# Columns of tables that paper has no room for; they are in the CSV.
LEFT_OUT = {"plain_seconds", "ball_error", "ball_seconds"}


def figures_part(notice: Notice) -> Part:
    """All figures, each with what it found, of how many packings, and its data."""
    from force_diffusion.numeric.figures.catalogue import begun
    from force_diffusion.numeric.figures.names import FIGURES

    figures = []
    for name, entry in FIGURES.items():
        n = max(FEWEST, entry.realisations // SHARE) if entry.realisations else None
        few = "" if n is None else f" --realisations {n}"
        command = f"force-diffusion figures {name}{few} --seed 1 --out figure"
        made = begun(name, realisations=n, notice=notice, command=command, kinds=("svg",))()
        drawing = next(content for file, content in made.files.items() if file.endswith(".svg"))
        assert isinstance(drawing, bytes)
        told = f"{made.title}: {'; '.join(made.lines)}."
        if n is not None:
            told += f" {n} packings in each ensemble."
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

    command = f"force-diffusion cost {SCENE.name} --out cost"
    found = cost(read_scene(SCENE), lambda way: notice(f"cost: {way}"))
    title = f"Cost of accuracy: {SCENE.stem}"
    (svg,) = style.images(lambda: found.plot(SCENE.stem), "cost", title, command, ("svg",)).values()
    front = [way for way in found.ways if way.pareto]
    least = min(front, key=lambda way: way.error)
    shown = "way", "arithmetic", "error", "certified_bound", "seconds", "peak_bytes"
    rows = [
        {"": "★" if row["pareto"] else "", **{name: row[name] for name in shown}}
        for row in found.rows()
    ]
    return Part(
        id="cost",
        title="What accuracy costs",
        words=(
            "Every way to answer the question of one small scene: all contact forces of a packing "
            "of 16 layers of 34 beads, σ/r = 10⁻⁶, under a surface load. Errors are measured, "
            "relative to the largest change of a force, against a reference that is "
            f"{found.reference.kind} to {number(found.reference.radius)}; times are "
            "medians of the machine that made this page. A star marks the Pareto front: no other "
            "way is both more accurate and faster.",
        ),
        command=command,
        figures=(
            Figure(
                svg,
                alt=(
                    "Error against time, both logarithmic, for each way to the answer. On the "
                    f"Pareto front there are {len(front)} ways; the most accurate of them is "
                    f"“{least.way}” with {least.arithmetic}, error {least.error:.2e} after "
                    f"{least.seconds:.2g} seconds."
                ),
                caption="Error beside time, for every way to the answer.",
            ),
        ),
        tables=(
            Table(
                "Ways to the answer, from the largest error to the smallest",
                rows,
                csv_data("cost.csv", with_command(found.files()["cost.csv"], command)),
            ),
        ),
        files=(Data(SCENE.name, SCENE.read_text(encoding="utf-8"), "text/plain"),),
    )


def stability_part(notice: Notice = lambda _: None) -> Part:
    """How accurate the engine is where it is hard to be, and what that costs."""
    from force_diffusion.numeric.figures import style
    from force_diffusion.numeric.studies.stability.stability import (
        FLOATS,
        TABLES,
        stability,
    )

    command = "force-diffusion stability --out stability"
    found = stability(notice)
    files = found.files()
    title = "The cost of stability"
    (svg,) = style.images(found.plot, "stability", title, command, ("svg",)).values()
    worst = max(row["error"] for row in found.rows(FLOATS) if row["error"] is not None)
    return Part(
        id="stability",
        title="What stability costs",
        words=(
            "Contact forces in float64, in the deviation form that the engine uses and in the "
            "plain form that subtracts ordered forces in the end, against balls, which enclose "
            "the exact forces. Errors are measured, relative to the largest change of a force. "
            f"The largest error of the deviation form in these tables is {number(worst)}.",
            "Beyond M* the packing itself is unstable: the bits that balls lose there measure it.",
        ),
        command=command,
        figures=(
            Figure(
                svg,
                alt=(
                    "Four panels. Errors of both forms in float64 against the disorder: the "
                    f"deviation form nowhere exceeds {number(worst)}, the plain form loses "
                    "digits as the disorder shrinks. Bits that balls lose against the height: "
                    "in positions many at every layer, in line sums few up to M*. Below, "
                    "the times."
                ),
                caption="Errors and lost bits, and the times that they cost.",
            ),
        ),
        tables=tuple(
            Table(
                table.title,
                [
                    {key: value for key, value in row.items() if key not in LEFT_OUT}
                    for row in table.shown(found.rows(name))
                ],
                csv_data(table.file, with_command(files[table.file], command)),
            )
            for name, table in TABLES.items()
        ),
    )
