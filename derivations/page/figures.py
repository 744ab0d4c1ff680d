"""The figures in the report; those of ensembles take as few packings as make them readable."""

from collections.abc import Callable

from derivations.page.parts import Data, Figure, Part

REALISATIONS = 400
_ENSEMBLE = f"{REALISATIONS} packings in each ensemble."
_PACKINGS = {
    "1": "One packing.",
    "2": "No packing: closed forms.",
    "3": _ENSEMBLE,
    "4": _ENSEMBLE,
    "pf": _ENSEMBLE,
    "chains": "One packing.",
}


def figures_part(notice: Callable[[str], None]) -> Part:
    """All figures, each with what it found, of how many packings, and its data."""
    from numeric.figures.catalogue import FIGURES, Options, make

    command = f"force-diffusion figures --realisations {REALISATIONS} --seed 1 --out figures"
    options = Options(realisations=REALISATIONS, notice=notice)
    figures = []
    for name in FIGURES:
        made = make(name, options, command)
        drawing = next(content for file, content in made.files.items() if file.endswith(".svg"))
        assert isinstance(drawing, bytes)
        told = f"{made.title}: {'; '.join(made.lines)}. {_PACKINGS[name]}"
        data = [
            Data(file, text)
            for file, text in made.files.items()
            if file.endswith(".csv") and isinstance(text, str)
        ]
        figures.append(Figure(drawing, alt=told, caption=told, data=data))
    return Part(
        id="figures",
        title="The figures",
        words=(
            "The paper’s four figures, drawn from exact packings, and two more. Those of ensembles "
            "are made here of fewer packings than the command makes by default.",
        ),
        command=command,
        figures=tuple(figures),
    )
