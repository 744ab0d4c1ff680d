"""The command ``certify``: a thin layer over ``fd.certify``."""

import json
from pathlib import Path
from typing import Annotated

import typer

import force_diffusion as fd

from ..framework.catalogue import number_of
from .output import Output, Overwrite, out_option
from .shared import Json, noticing

STATUSES = (
    "Takes about two minutes. Exit status: 0 all accepted; 1 something not accepted; 2 wrong "
    "usage; 3 Coq is missing, or the disk or a pipe failed; 130 interrupted."
)


def certify(
    numbers: Annotated[
        list[str] | None,
        typer.Argument(metavar="[N...]", help="Numbers of the paper's equations, by default all."),
    ] = None,
    out: Annotated[
        Path | None, out_option("the theory, the statements and, as JSON, the verdicts")
    ] = None,
    as_json: Json = False,
    overwrite: Overwrite = False,
) -> None:
    """Ask Coq, an independent proof assistant, whether it accepts the printed equations."""
    from ..api.certificates import coq_statements, sources
    from ..coq.record import RECORD
    from ..export.terminal import certificate_text

    wanted = [number_of(word) for word in numbers] if numbers else None
    files = sources(coq_statements(wanted))
    folder = Output(out, [*files, RECORD], overwrite) if out else None
    with noticing() as notice:
        certification = fd.certify(wanted, notice=notice)
    data = json.dumps(certification.data(), indent=2)
    if folder:
        folder.write({**files, RECORD: f"{data}\n"})
    if as_json:
        print(data)
    else:
        print(*map(certificate_text, certification.equations), sep="\n")
        accepted = sum(certificate.accepted for certificate in certification.equations)
        print(f"{accepted} of {len(certification.equations)} accepted.")
    raise typer.Exit(0 if certification.passed else 1)
