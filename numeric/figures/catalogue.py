"""All figures by name: what makes their data, how they are drawn, and the files they become."""

import csv
import io
from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import partial
from operator import index
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol, SupportsIndex

from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.processes import Start
from ..scene.sections import SceneError
from . import (
    chains,
    comparison,
    diffusion,
    dimensions,
    directions,
    distribution,
    faces,
    layers,
    mean_forces,
    mean_response,
    neighbours,
    notation,
    response,
    sharing,
    spheres,
    stress,
)
from .library import KINDS, drawing
from .packings import PAPER, Medium, Notice, Row, planned

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHTS = (8, 32, 128)
LEAST_REALISATIONS = 16
MODELS = {"q-model": "3", "double-y": "4"}
"""What may be drawn beside which figure."""
OWN_SPACING, OWN_STD = ("2", "3", "4", "pf", "chains"), ("3", "4", "pf", "chains")
"""Figures of packings whose spacing, and σ/r but in figure 2, can be chosen."""
LEAST_STD, MOST_STD = 1e-9, 0.5


@dataclass(frozen=True)
class Options:
    """What can be chosen; ``realisations`` None is each figure's own default."""

    heights: Sequence[int] = HEIGHTS
    realisations: int | None = None
    seed: int = 1
    models: frozenset[str] = field(default_factory=frozenset)
    spacing: Fraction | None = None
    relative_std: float | None = None
    notice: Notice = lambda _: None

    def medium(self, usual: Medium = PAPER) -> Medium:
        """Give what was chosen, in place of what is usual for a figure."""
        return Medium(self.spacing or usual.spacing, self.relative_std or usual.std)


class Data(Protocol):
    """What a figure shows."""

    def tables(self) -> dict[str, list[Row]]:
        """Give the rows of each CSV file, by its name without the ending."""

    def facts(self) -> dict[str, Any]:
        """Give verdicts and parameters, as JSON can hold them."""

    def lines(self) -> list[str]:
        """Say the verdicts."""


class NoSuchFigureError(ForceDiffusionError, ValueError):
    """There is no such figure, or not so; the message says what is allowed."""


@dataclass(frozen=True)
class PaperFigure:
    """A finished figure; in a notebook it shows itself.

    Attributes:
        title: what it shows.
        files: PNG, SVG, PDF and CSV by file name; the CSV files hold what is drawn.
        facts: verdicts and parameters, as JSON can hold them.
        lines: the verdicts in words.
    """

    title: str
    files: dict[str, str | bytes]
    facts: dict[str, Any]
    lines: list[str]

    def _repr_png_(self) -> bytes:
        return next(bytes(f) for f in self.files.values() if isinstance(f, bytes))  # PNG is first

    def __repr__(self) -> str:
        return "\n".join([self.title, *(f"  {line}" for line in self.lines)])


class _Figure(NamedTuple):
    file: str
    title: str
    data: Callable[[Options], Data]
    draw: "Callable[[Any], Figure]"


def _draw_comparison(data: Any) -> "Figure":
    from . import comparison_drawing

    return comparison_drawing.draw(data)


def _draw_response(data: Any) -> "Figure":
    from . import response_drawing

    return response_drawing.draw(data)


FIGURES = {
    "1": _Figure(
        "figure1",
        "Notation, and a disordered packing over the ordered one",
        lambda o: notation.beads(o.seed, o.notice),
        notation.draw,
    ),
    "2": _Figure(
        "figure2",
        "Diffusion of geometry and of forces",
        lambda o: diffusion.widths(diffusion.HEIGHT, o.medium(), o.notice),
        diffusion.draw,
    ),
    "3": _Figure(
        "figure3",
        "Theory against exact simulation, surface load",
        lambda o: comparison.compare(
            o.heights,
            o.realisations or 400,
            o.seed,
            o.notice,
            q_model="q-model" in o.models,
            medium=o.medium(),
        ),
        _draw_comparison,
    ),
    "4": _Figure(
        "figure4",
        "Mean and fluctuation of the response to an isolated load",
        lambda o: response.respond(
            o.realisations or 4000,
            o.seed,
            o.notice,
            double_y="double-y" in o.models,
            medium=o.medium(response.MEDIUM),
        ),
        _draw_response,
    ),
    "pf": _Figure(
        "pf",
        "P(f) against the Gaussian",
        lambda o: distribution.samples(o.realisations or 4000, o.seed, o.notice, o.medium()),
        distribution.draw,
    ),
    "chains": _Figure(
        "chains",
        "Force chains",
        lambda o: chains.contacts(o.seed, o.notice, o.medium(chains.MEDIUM)),
        chains.draw,
    ),
    "B2": _Figure(
        "figureB2",
        "Fluctuation of the forces under a load at an angle",
        lambda o: directions.sweep(o.realisations or 400, o.seed, o.notice),
        directions.draw,
    ),
    "B5": _Figure(
        "figureB5",
        "Mean contact forces to second order, surface and bulk load",
        lambda o: mean_forces.simulate(o.realisations or 6000, o.seed, o.notice),
        mean_forces.draw,
    ),
    "B7": _Figure(
        "figureB7",
        "Fluctuation of the mean over N neighbours",
        lambda o: neighbours.simulate(o.realisations or 1000, o.seed, o.notice),
        neighbours.draw,
    ),
    "B9": _Figure(
        "figureB9",
        "Mean response to a point load at second order",
        lambda o: mean_response.respond(o.realisations or 20000, o.seed, o.notice),
        mean_response.draw,
    ),
    "B10": _Figure(
        "figureB10",
        "Mean stress ratio to second order",
        lambda o: stress.ratios(o.notice),
        stress.draw,
    ),
    "B11": _Figure(
        "figureB11",
        "Diffusion of forces in two, three and four dimensions",
        lambda o: dimensions.widths(o.notice),
        dimensions.draw,
    ),
    "B12": _Figure(
        "figureB12",
        "Covariance of forces along a diagonal",
        lambda o: layers.simulate(o.realisations or 1000, o.seed, o.notice),
        layers.draw,
    ),
    "B13": _Figure(
        "figureB13",
        "Diffusion of forces in packings of spheres",
        lambda o: spheres.simulate(o.realisations or 100, o.seed, o.notice),
        spheres.draw,
    ),
    "B15": _Figure(
        "figureB15",
        "What the load of either branch gives to a mean force",
        lambda o: sharing.shares(o.notice),
        sharing.draw,
    ),
    "B19": _Figure(
        "figureB19",
        "Fluctuations of the response to a point load on spheres",
        lambda o: faces.respond(o.realisations or 1000, o.seed, o.notice),
        faces.draw,
    ),
}


def figure(
    name: int | str,
    *,
    heights: Sequence[int] = HEIGHTS,
    realisations: int | None = None,
    seed: int = 1,
    beside: str | Collection[str] = (),
    spacing: Any = None,
    relative_std: Any = None,
    notice: Notice = lambda _: None,
    command: str | None = None,
) -> PaperFigure:
    """One of the paper's figures from exact packings, as files in memory.

    Needs matplotlib (the extra ``plots``). Takes a few seconds at the most.

    >>> import force_diffusion as fd
    >>> sorted(fd.figure("chains").files)
    ['chains.csv', 'chains.pdf', 'chains.png', 'chains.svg']
    >>> fd.figure(7)  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    ...
    force_diffusion...NoSuchFigureError: there is no figure 7: give 1, 2, 3, 4, 'pf', 'chains'...

    Args:
        name: 1 to 4 as in the paper, "pf" (density of the forces), "chains" (force chains), or the
            number of an equation beyond the paper that has a figure.
        heights: M of the packings of figure 3.
        realisations: packings of each ensemble of figures 3, 4, pf and of those beyond the paper;
            ≥ 16.
        seed: seed of all radii.
        beside: "q-model" (beside figure 3) or "double-y" (beside figure 4).
        spacing: s in units of r of figures 2, 3, 4, pf and chains, 2 < s < 2√3.
        relative_std: σ_δr/r of figures 3, 4, pf and chains.
        notice: told what is made next.
        command: what every file says that made it.

    Raises:
        NoSuchFigureError: there is no such figure or model.
        SceneError: heights, realisations, a seed, spacing or σ/r that can't be.
        UnbuildableError, NotStandingError: radii of such a height can't be built or stand.
        MissingLibraryError: there is no matplotlib.
    """
    return begun(
        name, heights=heights, realisations=realisations, seed=seed, beside=beside,
        spacing=spacing, relative_std=relative_std, notice=notice, command=command,
    )()  # fmt: skip


def begun(
    name: int | str,
    *,
    heights: Sequence[int] = HEIGHTS,
    realisations: int | None = None,
    seed: int = 1,
    beside: str | Collection[str] = (),
    spacing: Any = None,
    relative_std: Any = None,
    notice: Notice = lambda _: None,
    command: str | None = None,
    kinds: Sequence[str] = KINDS,
    start: Start = partial,
) -> Callable[[], PaperFigure]:
    """Make what ``figure`` shows, and ``start`` to draw it; give what waits for it."""
    if str(name) not in FIGURES:
        *names, last = (key if key.isdigit() else repr(key) for key in FIGURES)
        raise NoSuchFigureError(f"there is no figure {name}: give {', '.join(names)} or {last}")
    beside = (beside,) if isinstance(beside, str) else tuple(beside)
    for model in beside:
        if MODELS.get(model) != str(name):
            raise NoSuchFigureError(
                f"there is no model {model!r} beside figure {name}: give 'q-model' with figure 3 "
                "or 'double-y' with figure 4"
            )
    if realisations is not None and not (
        isinstance(realisations, SupportsIndex) and index(realisations) >= LEAST_REALISATIONS
    ):
        allowed = f"must be a whole number from {LEAST_REALISATIONS} on"
        raise SceneError("realisations", realisations, allowed)
    if not isinstance(heights, Iterable) or isinstance(heights, str):
        raise SceneError("heights", heights, "must be a list of whole numbers, such as [16, 32]")
    chosen = _chosen(str(name), spacing, relative_std)
    with drawing():  # or leave before anything is solved
        file, _, data_of, _ = FIGURES[str(name)]
        data = data_of(Options(heights, realisations, seed, frozenset(beside), *chosen, notice))
    notice(f"{file}: drawing")
    made_by = command or f"force_diffusion.figure({name!r}, seed={seed})"
    return start(_finished, str(name), data, made_by, kinds)


def _finished(name: str, data: Data, made_by: str, kinds: Sequence[str]) -> PaperFigure:
    file, title, _, draw = FIGURES[name]
    tables = data.tables().items()
    with drawing():
        from . import style

        files: dict[str, str | bytes] = {
            **style.images(lambda: draw(data), file, title, made_by, kinds),
            **{f"{table}.csv": csv_file(rows, title, made_by) for table, rows in tables},
        }
    return PaperFigure(title, files, data.facts(), data.lines())


def _chosen(name: str, spacing: Any, relative_std: Any) -> tuple[Fraction | None, float | None]:
    """Check spacing and σ/r, if they are given."""
    for key, value, own in (
        ("spacing", spacing, OWN_SPACING), ("relative_std", relative_std, OWN_STD),
    ):  # fmt: skip
        if value is not None and name not in own:
            raise SceneError(key, value, f"goes with figures {', '.join(own)} only")
    usual = PAPER.spacing if spacing is None else spacing
    std = PAPER.std if relative_std is None else relative_std
    scene = planned("profile", height=1, width=3, seed=0, spacing=usual, std=std).scene
    assert scene.disorder is not None
    std = float(scene.disorder.relative_std or 0)
    if not LEAST_STD <= std <= MOST_STD:
        allowed = f"must lie between {LEAST_STD:g} and {MOST_STD:g}"
        raise SceneError("relative_std", relative_std, allowed)
    return (
        None if spacing is None else scene.packing.s,
        None if relative_std is None else std,
    )


def csv_file(rows: list[Row], title: str, command: str) -> str:
    """Write rows as CSV below two lines of comment, which say what this is and what made it."""
    text = io.StringIO()
    text.write(f"# {title}\n# {command}\n")
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()
