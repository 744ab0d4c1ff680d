"""The main job: prove what is asked for and what it rests on, and write it down."""

import json
from collections.abc import Iterable, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import TYPE_CHECKING

from force_diffusion.numeric.arithmetic.errors import printable
from force_diffusion.numeric.arithmetic.processes import Start, beside

from ..export.prose import both
from ..export.terminal import tried_counts, tried_text
from ..framework.catalogue import Number, modules
from ..framework.loading import load, with_premises
from .cli import command_line
from .output import output
from .progress import Silence, display

if TYPE_CHECKING:
    from ..api.derived import Derived
    from ..framework.record import Derivation

WORTH_ANOTHER_PROCESS = 16
"""Equations from which on another process, which has to load SymPy, repays itself."""


def premises_first(numbers: "Iterable[Number | Derivation]") -> "list[Derivation]":
    """The derivations of these equations and of all that they rest on."""
    return with_premises(load(one) if isinstance(one, int | str) else one for one in numbers)


def watched(
    numbers: "Iterable[Number | Derivation]", watch: Silence, start: Start | None = None
) -> "Derived":
    """Derive these equations under a display; ``start`` calls functions in another process."""
    from ..api.derived import derive_with

    with watch.showing():
        return derive_with(start, numbers, watch.checking, watch.finished)


def article_files() -> list[str]:
    """Names of what the article is made of. Raises ``MissingLibraryError``: it has figures."""
    from force_diffusion.numeric.figures.library import drawing
    from force_diffusion.numeric.figures.names import FIGURES

    from ..export.article import ARTICLE, figures_of, source

    with drawing():
        pass
    return [ARTICLE, *(f"{FIGURES[name].file}.pdf" for name in figures_of(source()))]


def written_article(found: "Derived", watch: Silence) -> dict[str, str | bytes]:
    """The article and its figures, by file name; it says what was found."""
    from force_diffusion.numeric.figures.catalogue import begun

    from ..export.article import ARTICLE, Plate, article, figures_of, source, verdicts

    markdown, command = source(), command_line()
    files: dict[str, str | bytes] = {}
    plates = {}
    with watch.showing():
        for name in figures_of(markdown):
            made = begun(name, command=command, kinds=("pdf",), notice=watch.checking)()
            (file,) = (own for own in made.files if own.endswith(".pdf"))
            files[file] = made.files[file]
            plates[name] = Plate(file, made.wide, tuple(made.lines))
    return {ARTICLE: article(markdown, plates, verdicts(found.outcomes, found.counts())), **files}


def derive(
    numbers: "Sequence[Number | Derivation]",
    out: Path | None,
    as_json: bool,
    overwrite: bool = False,
    columns: int = 1,
    article: Path | None = None,
) -> int:
    """Derive these equations and their premises: 0 if all are proved, else 1.

    The output folders are looked at before the first proof, so that a wrong one costs no time. The
    document in ``out`` is also about the equations that an earlier run has left there; the folder
    ``article`` gets the article, which says what this run has proved.
    """
    from ..export.document import (
        DOCUMENT,
        document,
        finding,
        fragment_name,
    )

    derivations = premises_first(numbers)
    names = [*map(fragment_name, derivations), DOCUMENT]
    with (
        output(out, "derive", names, overwrite) as folder,
        output(article, "derive --article", article_files() if article else (), overwrite) as paper,
    ):
        watch = display(len(derivations), as_json=as_json)
        many = len(derivations) >= WORTH_ANOTHER_PROCESS
        with beside() if many else nullcontext() as start:
            found = watched(numbers, watch, start)
        if paper:
            paper.write(written_article(found, watch))
        if folder:
            parts = {
                earlier.number: (load(earlier.number), earlier)
                for earlier in (folder.manifest.equations if folder.manifest else ())
                if earlier.number in modules() and folder.holds(fragment_name(load(earlier.number)))
            }
            parts |= {
                one.derivation.number: (one.derivation, finding(one)) for one in found.outcomes
            }
            places = [*modules(), *(number for number in parts if number not in modules())]
            about = [parts[number] for number in places if number in parts]
            folder.write(
                {**found.fragments(columns), DOCUMENT: document(about)}, [one for _, one in about]
            )
    if on := tried_text(tried_counts(found.outcomes)):
        watch.summary(on)
    folders = [printable(str(one)) for one in (out, article) if one]
    watch.summary(f"{found.counts()}." + (f" Written to {both(folders)}." if folders else ""))
    if as_json:
        print(json.dumps(found.data(), indent=2), flush=True)
    return 0 if found.proved else 1
