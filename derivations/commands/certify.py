"""The command ``certify``: a thin layer over ``fd.certify``."""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import force_diffusion as fd

from ..framework.catalogue import number_of
from .output import Output, Overwrite, out_option
from .shared import Json, noticing

if TYPE_CHECKING:
    from ..coq.record import Certificate

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
        print(*map(_line, certification.equations), sep="\n")
        accepted = sum(certificate.accepted for certificate in certification.equations)
        print(f"{accepted} of {len(certification.equations)} accepted.")
    raise typer.Exit(0 if certification.passed else 1)


def _line(certificate: "Certificate") -> str:
    """One line about an equation, and below it what it is about and what is wrong with it."""
    about = (re.sub(r"^\((.*)\)%Z$", r"\1", words) for words in certificate.about)
    shown = ", ".join(about).replace(">=", "≥").replace("<=", "≤")
    title = fd.equation(certificate.number).title
    line = f"Eq. {certificate.number!s:>2}  {certificate!s:<24}  {title}\n    for {shown}"
    return f"{line}\n    {certificate.note}" if certificate.note else line
