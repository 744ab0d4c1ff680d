"""All figures by name: made, drawn, and the files they become."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from importlib import import_module
from typing import Any

from ..arithmetic.errors import ForceDiffusionError, WrongTypeError, checked, is_whole, quoted
from ..scene.sections import MOST_REALISATIONS, SceneError
from ..tables import csv_bytes
from .names import FIGURES, HEIGHTS, KINDS, LEAST_REALISATIONS, MODELS, OWN_SPACING, OWN_STD
from .packings import PAPER, Made, Medium, Notice, Options, Table, planned

LEAST_STD, MOST_STD = 1e-9, 0.5


class NoSuchFigureError(ForceDiffusionError, ValueError):
    """There is no such figure, or it can't be drawn with these options."""


@dataclass(frozen=True)
class PaperFigure:
    """A finished figure; in a notebook it shows itself.

    Attributes:
        title: what it shows.
        files: PNG, SVG, PDF and CSV by file name; the CSV files hold what is drawn.
        facts: the findings and parameters, as data for JSON.
        lines: the findings in words.
        wide: as wide as a page of a journal, not as a column.
    """

    title: str
    files: dict[str, str | bytes]
    facts: dict[str, Any]
    lines: list[str]
    wide: bool = False

    def _repr_png_(self) -> bytes:
        return next(bytes(f) for f in self.files.values() if isinstance(f, bytes))  # PNG is first

    def __repr__(self) -> str:
        return "\n".join([self.title, *(f"  {line}" for line in self.lines)])


@checked
def figure(
    name: int | str,
    *,
    heights: Sequence[int] = HEIGHTS,
    realisations: int | None = None,
    seed: int = 1,
    beside: str | Collection[str] = (),
    spacing: float | Fraction | Decimal | None = None,
    relative_std: float | Fraction | Decimal | None = None,
    notice: Notice = lambda _: None,
    command: str | None = None,
    kinds: Sequence[str] = KINDS,
) -> PaperFigure:
    """Draw a figure of the paper, or one beyond it, from exact packings, as files in memory.

    Needs matplotlib (the extra ``plots``). Takes a few seconds.

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
        heights: M of the packings in figure 3.
        realisations: how many packings each ensemble has, at least 16; for figures 3, 4, pf and
            those beyond the paper.
        seed: seed of all radii.
        beside: a simpler model: "q-model" in figure 3, "double-y" in figure 4.
        spacing: s in units of r, 2 < s < 2√3; for figures 2, 3, 4, pf and chains.
        relative_std: σ_δr/r; for figures 3, 4, pf and chains.
        notice: called with the title of what is made next.
        command: the command that the files name as the one that made them.
        kinds: kinds of images: "png", "svg", "pdf".

    Raises:
        NoSuchFigureError: there is no such figure or model.
        SceneError: an argument is not allowed.
        UnbuildableError, NotStandingError: a packing with such radii can't be built.
        MissingLibraryError: matplotlib is missing.
    """
    if not isinstance(name, int | str):
        drawn = "the answer of a scene is drawn by scene.run().plot()"
        raise WrongTypeError(f"figure takes a name, not {type(name).__name__}; {drawn}")
    name = name if isinstance(name, str) else quoted(name)
    if name not in FIGURES:
        *names, last = (key if key.isdigit() else repr(key) for key in FIGURES)
        shown = quoted(name).strip("'")
        raise NoSuchFigureError(f"there is no figure {shown}: give {', '.join(names)} or {last}")
    kinds = (kinds,) if isinstance(kinds, str) else kinds
    for kind in kinds:
        if kind not in KINDS:
            raise SceneError("kinds", kind, f"must be one of {', '.join(KINDS)}")
    beside = (beside,) if isinstance(beside, str) else tuple(beside)
    for model in beside:
        if MODELS.get(model) != name:
            raise NoSuchFigureError(
                f"there is no model {quoted(model)} beside figure {name}: give 'q-model' with "
                "figure 3 or 'double-y' with figure 4"
            )
    least, most = LEAST_REALISATIONS, MOST_REALISATIONS
    if realisations is not None and not is_whole(realisations, least, most):
        allowed = f"must be a whole number from {least} to {most}"
        raise SceneError("realisations", realisations, allowed)
    listed = isinstance(heights, Iterable) and not isinstance(heights, str)
    layers = tuple(heights) if listed else ()
    if not 0 < len(layers) == len(set(layers)):
        allowed = "must be a list of different whole numbers, such as [16, 32]"
        raise SceneError("heights", heights, allowed)
    if name != "3" and layers != HEIGHTS:
        raise SceneError("heights", heights, "goes with figure 3 only")
    chosen = _chosen(name, spacing, relative_std)
    file, title, module, usual = FIGURES[name]
    made_by = command or f"force_diffusion.figure({name!r}, seed={seed})"
    from .style import COLUMN, house_style, images  # or leave before anything is solved

    options = Options(layers, realisations or usual, seed, frozenset(beside), *chosen, notice)
    with house_style():
        made: Made = import_module(f".{module}", __package__).figure(options)
    notice(f"{file}: drawing")
    files: dict[str, str | bytes] = {
        **images(made.figure, file, title, made_by, kinds),
        **{f"{own}.csv": csv_file(table, title, made_by) for own, table in made.tables.items()},
    }
    wide = made.figure.get_figwidth() > COLUMN
    return PaperFigure(title, files, dict(made.facts), list(made.lines), wide)


def _chosen(name: str, spacing: Any, relative_std: Any) -> tuple[Fraction | None, float | None]:
    """Check spacing and σ/r, if they are given."""
    for key, value, own in (
        ("spacing", spacing, OWN_SPACING), ("relative_std", relative_std, OWN_STD),
    ):  # fmt: skip
        if value is not None and name not in own:
            raise SceneError(key, value, f"goes with figures {', '.join(own)} only")
    usual = PAPER.spacing if spacing is None else spacing
    medium = Medium(usual, PAPER.std if relative_std is None else relative_std)
    scene = planned("profile", Options(), medium, height=1, width=3).scene
    assert scene.disorder is not None
    std = float(scene.disorder.relative_std or 0)
    if not LEAST_STD <= std <= MOST_STD:
        allowed = f"must lie between {LEAST_STD:g} and {MOST_STD:g}"
        raise SceneError("relative_std", relative_std, allowed)
    return (None if spacing is None else scene.packing.s, None if relative_std is None else std)


def csv_file(table: Table, title: str, command: str) -> str:
    """Write columns as CSV below two lines of comment, which say what this is and what made it."""
    columns = {name: list(map(str, column)) for name, column in table.items()}
    return f"# {title}\n# {command}\n" + csv_bytes(columns).decode()
