"""The main job: prove what is asked for and what it rests on, and write it down."""

import json
from collections.abc import Sequence
from pathlib import Path

from force_diffusion.numeric.arithmetic.errors import printable

from ..export.prose import both
from ..framework.catalogue import Number, modules
from ..framework.loading import load, with_premises
from .cli import command_line
from .output import output
from .progress import display


def derive(
    numbers: Sequence[Number],
    out: Path | None,
    as_json: bool,
    overwrite: bool = False,
    columns: int = 1,
    article: Path | None = None,
) -> int:
    """Derive these equations and their premises: 0 if all are proved, else 1.

    Of a single one all steps and claims are printed, of several a line each.

    The output folders are looked at before the first proof, so that a wrong one costs no time. The
    document in ``out`` is also about the equations that an earlier run has left there; the folder
    ``article`` gets the article, which says what this run has proved.
    """
    from ..api.derived import derive as derived
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
    derivations = with_premises(map(load, numbers))
    names = [*map(fragment_name, derivations), DOCUMENT]
    with (
        output(out, "derive", names, overwrite) as folder,
        output(article, "derive --article", in_article, overwrite) as paper,
    ):
        in_full = numbers[0] if len(numbers) == 1 else None
        watch = display(len(derivations), in_full, as_json=as_json)
        with watch.showing():
            found = derived(numbers, notice=watch.checking, finished=watch.finished)
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
    folders = [printable(str(one)) for one in (out, article) if one]
    watch.summary(f"{found.counts()}." + (f" Written to {both(folders)}." if folders else ""))
    if as_json:
        print(json.dumps(found.data(), indent=2), flush=True)
    return 0 if found.proved else 1
