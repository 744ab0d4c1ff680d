"""The figures in the report; those of ensembles take as few packings as make them readable."""

from collections.abc import Callable

from force_diffusion.derivations.export.page.parts import Data, Figure, Part

REALISATIONS = {"3": 200, "4": 2000, "pf": 2000}
"""Packings in each ensemble of a figure that draws ensembles."""

_PACKINGS = {"1": "One packing.", "2": "No packing: closed forms.", "chains": "One packing."} | {
    name: f"{n} packings in each ensemble." for name, n in REALISATIONS.items()
}


def figures_part(notice: Callable[[str], None]) -> Part:
    """All figures, each with what it found, of how many packings, and its data."""
    from force_diffusion.numeric.figures.catalogue import FIGURES, Options, make

    figures = []
    for name in FIGURES:
        n = REALISATIONS.get(name)
        few = "" if n is None else f" --realisations {n}"
        command = f"force-diffusion figures {name}{few} --seed 1 --out figure"
        made = make(name, Options(realisations=n, notice=notice), command)
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
            "The paper’s four figures, drawn from exact packings, and two more. Those of ensembles "
            "are made here of fewer packings than the command makes by default.",
        ),
        figures=tuple(figures),
    )
