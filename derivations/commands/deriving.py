"""The main job: prove what is asked for and what it rests on, and write it down."""

import json
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path

from force_diffusion.numeric.arithmetic.errors import printable

from ..export.terminal import outcomes_data
from ..formulas.lists import both
from ..framework.catalogue import Number, modules
from .cli import command_line
from .output import Output, OutputError
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

    Of a single one all steps and claims are printed, of several a line each. The folders are
    looked at before the first proof, so that a wrong one costs no time. ``article`` gets the
    article, which says what this run has proved.
    """
    from ..api.derived import derive as derived
    from ..export.document import DOCUMENT, MANIFEST, fragment_name

    folder = paper = None
    if out:
        folder = Output(out, [*map(fragment_name, modules()), DOCUMENT, MANIFEST], overwrite)
    if article:  # it needs more than the rest
        from ..export.article import names_of_files

        if out and out.absolute() == article.absolute():
            raise OutputError(f"'{article}' is that of --out, too. Give another folder.")
        paper = Output(article, names_of_files(), overwrite)
    in_full = numbers[0] if len(numbers) == 1 else None
    everything = len(numbers) == len(modules())
    watch = display(len(numbers) if everything else None, in_full, as_json=as_json)
    with watch.showing():
        found = derived(numbers, notice=watch.checking, finished=watch.finished)
    if paper:
        from ..export.article import article_and_figures

        with watch.showing():
            paper.write(article_and_figures(found.outcomes, command_line(), watch.checking))
    if folder:
        about = {"command": command_line(), "version": version("force-diffusion")}
        data = {**about, **outcomes_data(found.in_order, timed=False)}
        folder.write({**found.latex(columns), MANIFEST: json.dumps(data, indent=2) + "\n"})
    folders = [printable(str(one)) for one in (out, article) if one]
    watch.summary(f"{found.counts()}." + (f" Written to {both(folders)}." if folders else ""))
    if as_json:
        print(json.dumps(found.data(), indent=2), flush=True)
    return 0 if found.proved else 1
