"""The list of figures, and the options of each."""

from typing import NamedTuple


class Entry(NamedTuple):
    """A figure: its files, what it shows, the module that makes it.

    ``realisations``: packings of each ensemble by default; 0 where it draws none.
    """

    file: str
    title: str
    module: str
    realisations: int = 0


FIGURES = {
    "1": Entry("figure1", "Notation, and a disordered packing over the ordered one", "notation"),
    "2": Entry("figure2", "Diffusion of geometry and of forces", "diffusion"),
    "3": Entry("figure3", "Theory against exact simulation, surface load", "comparison", 400),
    "4": Entry(
        "figure4", "Mean and fluctuation of the response to an isolated load", "point_load", 4000
    ),
    "pf": Entry("pf", "P(f) against the Gaussian", "distribution", 4000),
    "chains": Entry("chains", "Force chains", "chains"),
    "B2": Entry(
        "figureB2", "Fluctuation of the forces under a load at an angle", "directions", 400
    ),
    "B5": Entry(
        "figureB5", "Mean contact forces to second order, surface and bulk load", "mean_forces",
        6000,
    ),
    "B7": Entry("figureB7", "Fluctuation of the mean over N neighbours", "neighbours", 1000),
    "B9": Entry(
        "figureB9", "Mean response to a point load at second order", "mean_response", 300_000
    ),
    "B13": Entry("figureB13", "Diffusion of forces in packings of spheres", "spheres", 100),
}  # fmt: skip

KINDS = ("png", "svg", "pdf")
"""What figures are written as."""
OF_ENSEMBLES = tuple(name for name, entry in FIGURES.items() if entry.realisations)
HEIGHTS = (8, 32, 128)
"""Of figure 3."""
LEAST_REALISATIONS = 16
MODELS = {"q-model": "3", "double-y": "4"}
"""What may be drawn beside which figure."""
OF_MODELS = {"q-model": "figure3_q_model", "double-y": "figure4_double_y"}
"""Their own CSV files."""
OWN_SPACING, OWN_STD = ("2", "3", "4", "pf", "chains"), ("3", "4", "pf", "chains")
"""Figures of packings whose spacing, and σ/r but in figure 2, can be chosen."""
