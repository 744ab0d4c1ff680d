"""The command ``derive``: prove equations and all that they rest on, and write LaTeX."""

import json
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from force_diffusion.numeric.arithmetic.errors import printable

import force_diffusion as fd

from ..framework.catalogue import modules, number_of
from ..framework.lists import both
from .output import Output, OutputError, Overwrite, folder_of, out_option
from .shared import Json, command_line, noticing

if TYPE_CHECKING:
    from ..framework.record import ProofOutcome


def derive(
    numbers: Annotated[
        list[str] | None,
        typer.Argument(metavar="[N...]", help="Numbers of equations, by default all."),
    ] = None,
    out: Annotated[Path | None, out_option("LaTeX and a manifest")] = None,
    as_json: Json = False,
    article: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=folder_of,
            help="Write the article about the equations beyond the paper into this folder: LaTeX, "
            "figures, and a supplement that says which were proved. Needs matplotlib.",
        ),
    ] = None,
    overwrite: Overwrite = False,
) -> None:
    """Prove equations and all that they rest on.

    For one equation it prints all steps and claims, for several a line for each.
    """
    wanted = [number_of(word) for word in numbers or ()] or list(modules())
    from ..export.document import DOCUMENT, MANIFEST, fragment_name
    from ..export.terminal import outcome_text, outcomes_data, summary_text

    # the folders are looked at before the first proof, so that a wrong one costs no time
    folder = paper = None
    if out:
        folder = Output(out, [*map(fragment_name, modules()), DOCUMENT, MANIFEST], overwrite)
    if article:  # it needs more than the rest
        from ..export.article import names_of_files

        if out and out.absolute() == article.absolute():
            raise OutputError(f"'{article}' is also the folder of --out. Give another one.")
        paper = Output(article, names_of_files(), overwrite)

    def finished(outcome: "ProofOutcome") -> None:
        notice("")
        if not as_json and wanted == [outcome.derivation.number]:
            print(f"\n{outcome_text(outcome)}", flush=True)
        elif not as_json:
            print(summary_text(outcome), flush=True)

    with noticing() as notice:
        derived = fd.derive(wanted, notice=notice, finished=finished)
        if paper:
            from ..export.article import article_and_figures

            paper.write(article_and_figures(derived.outcomes, command_line(), notice))
    if folder:
        about = {"command": command_line(), "version": version("force-diffusion")}
        data = {**about, **outcomes_data(derived.in_order, timed=False)}
        folder.write({**derived.latex(), MANIFEST: json.dumps(data, indent=2) + "\n"})
    folders = [printable(str(path)) for path in (out, article) if path]
    if as_json:
        print(json.dumps(derived.data(), indent=2), flush=True)
    else:
        written = f" Written to {both(folders)}." if folders else ""
        print(f"{derived.counts()}.{written}", flush=True)
    raise typer.Exit(0 if derived.proved else 1)
