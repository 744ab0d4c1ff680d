"""The command ``certify``: a thin layer over ``fd.certify``."""

import json
import re
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import force_diffusion as fd

from .equations import equation_number
from .output import Overwrite, out_option, output
from .shared import noticing

if TYPE_CHECKING:
    from ..coq.record import Certificate

STATUSES = (
    "Takes about two minutes, the first time. Exit status: 0 all accepted, 1 something is not, or "
    "Coq is absent, 2 wrong usage, 3 the disk or a pipe failed, 130 interrupted."
)


def certify(
    numbers: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[N...]",
            help="Equations to ask about; by default all that are stated.",
        ),
    ] = None,
    mutants: Annotated[
        bool,
        typer.Option(
            "--mutants",
            help="Ask also about every printed equation with one change: whether it is false, and "
            "accepted is none that 'derive' refutes. Takes several minutes.",
        ),
    ] = False,
    out: Annotated[
        Path | None, out_option("the theory, the statements and the verdicts as JSON")
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON and nothing else.")] = False,
    overwrite: Overwrite = False,
) -> None:
    """Ask Coq, an independent proof assistant, whether it accepts the printed equations."""
    from ..api.certificates import stated
    from ..coq.files import files_of, sha256, theory
    from ..coq.record import RECORD

    wanted = [equation_number(word) for word in numbers] if numbers else None
    files = theory() | files_of(stated(wanted))
    with output(out, "certify", [*files, RECORD], overwrite) as folder:
        told: dict[object, Certificate] = {}
        with noticing() as notice:

            def tell(one: "Certificate") -> None:
                told[one.number] = one
                notice("")
                if not as_json:
                    print(_line(one), flush=True)

            found = fd.certify(wanted, mutants=mutants, notice=notice, told=tell)
        data = {**found.data(), "files": {name: sha256(text) for name, text in files.items()}}
        if folder:
            folder.write({**files, RECORD: json.dumps(data, indent=2) + "\n"})
    if as_json:
        print(json.dumps(data, indent=2))
    else:
        for one in (*found.equations, *found.packings):
            if one != told[one.number]:  # coqchk took it back, or there were mutants
                print(_line(one))
        counts = Counter(str(one) for one in found.equations)
        print(", ".join(f"{count} {verdict}" for verdict, count in counts.items()) + ".")
    raise typer.Exit(0 if found.passed else 1)


def _line(one: "Certificate") -> str:
    """One line about an equation or a packing, and what is wrong with it."""
    from ..framework.loading import load
    from ..framework.runner import SEEDS

    name, title = str(one.number), "an exact packing's Taylor coefficients, as fractions"
    if one.number not in SEEDS:
        name, title = f"Eq. {one.number!s:>2}", load(one.number).title
    said = f"{name:<6}  {one!s:<24}  {title}"
    if one.about:
        shown = ", ".join(re.sub(r"^\((.*)\)%Z$", r"\1", words) for words in one.about)
        said += f"\n    for {shown.replace('>=', '≥').replace('<=', '≤')}"
    if one.note:
        said += f"\n    {one.note}"
    if one.changes:
        said += (
            f"\n    of {one.changes.made} mutants {one.changes.stated} stated, "
            f"{one.changes.refuted} proved false, {len(one.changes.accepted)} accepted"
        )
    return said + "".join(
        f"\n    accepted, and not equivalent: part {change.part + 1}, {change.change}"
        for change in one.wrong
    )


def register(app: typer.Typer) -> None:
    """Add the command to the command line."""
    app.command(epilog=STATUSES)(certify)
