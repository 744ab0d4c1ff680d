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


def premises_first(numbers: Iterable[Number]) -> "list[Derivation]":
    """The derivations of these equations and of all that they rest on."""
    return with_premises(map(load, numbers))


def watched(numbers: Iterable[Number], watch: Silence, start: Start | None = None) -> "Derived":
    """Derive these equations under a display; ``start`` calls functions in another process."""
    from ..api.derived import derive_with

    with watch.showing():
        return derive_with(start, numbers, watch.checking, watch.finished)


def derive(
    numbers: Sequence[Number],
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

    in_article: Sequence[str] = ()
    if article:  # it needs more than the rest
        from ..export.article import names_of_files

        in_article = names_of_files()
    derivations = premises_first(numbers)
    names = [*map(fragment_name, derivations), DOCUMENT]
    with (
        output(out, "derive", names, overwrite) as folder,
        output(article, "derive --article", in_article, overwrite) as paper,
    ):
        watch = display(len(derivations), as_json=as_json)
        many = len(derivations) >= WORTH_ANOTHER_PROCESS
        with beside() if many else nullcontext() as start:
            found = watched(numbers, watch, start)
        if paper:
            from ..export.article import article_and_figures

            with watch.showing():
                paper.write(article_and_figures(found.outcomes, command_line(), watch.checking))
        if folder:
            parts = {
                earlier.number: (load(earlier.number), earlier)
                for earlier in (folder.manifest.equations if folder.manifest else ())
                if earlier.number in modules() and folder.holds(fragment_name(load(earlier.number)))
            }
            parts |= {
                one.derivation.number: (one.derivation, finding(one)) for one in found.outcomes
            }
            about = [parts[number] for number in modules() if number in parts]
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
