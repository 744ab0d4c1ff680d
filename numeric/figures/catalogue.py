"""All figures by name: what makes their data, how they are drawn, and the files they become."""

import csv
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from . import (
    chains,
    comparison,
    diffusion,
    distribution,
    notation,
    response,
)
from .packings import Notice, Row

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHTS = (8, 32, 128)


@dataclass(frozen=True)
class Options:
    """What can be chosen; ``realisations`` None is each figure's own default."""

    heights: Sequence[int] = HEIGHTS
    realisations: int | None = None
    seed: int = 1
    models: frozenset[str] = field(default_factory=frozenset)
    notice: Notice = lambda _: None


class Data(Protocol):
    """What a figure shows."""

    def tables(self) -> dict[str, list[Row]]:
        """Give the rows of each CSV file, by its name without the ending."""

    def facts(self) -> dict[str, Any]:
        """Give verdicts and parameters, as JSON can hold them."""

    def lines(self) -> list[str]:
        """Say the verdicts."""


class Made(NamedTuple):
    """A finished figure: its files by name, and what was found."""

    title: str
    files: dict[str, str | bytes]
    facts: dict[str, Any]
    lines: list[str]


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
        lambda o: diffusion.widths(diffusion.HEIGHT, o.notice),
        diffusion.draw,
    ),
    "3": _Figure(
        "figure3",
        "Theory against exact simulation, surface load",
        lambda o: comparison.compare(
            o.heights, o.realisations or 400, o.seed, o.notice, q_model="q-model" in o.models
        ),
        _draw_comparison,
    ),
    "4": _Figure(
        "figure4",
        "Mean and fluctuation of the response to an isolated load",
        lambda o: response.respond(
            o.realisations or 4000, o.seed, o.notice, double_y="double-y" in o.models
        ),
        _draw_response,
    ),
    "pf": _Figure(
        "pf",
        "P(f) against the Gaussian",
        lambda o: distribution.samples(o.realisations or 4000, o.seed, o.notice),
        distribution.draw,
    ),
    "chains": _Figure(
        "chains", "Force chains", lambda o: chains.contacts(o.seed, o.notice), chains.draw
    ),
}


def make(name: str, options: Options, command: str) -> Made:
    """Make one figure: PNG, SVG, PDF and CSV, all of which hold the command.

    ``name`` is a key of ``FIGURES``. Needs matplotlib (the extra ``plots``). Raises
    ``SceneError``, ``UnbuildableError`` and ``NotStandingError`` where heights can't be built.
    """
    from . import style

    file, title, data_of, draw = FIGURES[name]
    data = data_of(options)
    options.notice(f"{file}: drawing")
    files: dict[str, str | bytes] = {
        **style.images(lambda: draw(data), file, title, command),
        **{f"{table}.csv": csv_file(rows, title, command) for table, rows in data.tables().items()},
    }
    return Made(title, files, data.facts(), data.lines())


def csv_file(rows: list[Row], title: str, command: str) -> str:
    """Write rows as CSV below two lines of comment, which say what this is and what made it."""
    text = io.StringIO()
    text.write(f"# {title}\n# {command}\n")
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()
