"""The commands for equations: a thin layer over ``deriving`` and ``Equation``."""

from collections.abc import Iterable
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import force_diffusion as fd

from ..framework.catalogue import (
    Number,
    allowed,
    cases_of,
    modules,
    number_of,
)
from .cli import STATUSES
from .output import Overwrite, folder_of, out_option

if TYPE_CHECKING:
    from ..api.equation import Equation
    from ..api.formula import Formula


class Form(StrEnum):
    """How ``show`` prints an equation."""

    TEXT = "text"
    LATEX = "latex"
    SYMPY = "sympy"
    PYTHON = "python"
    STEPS = "steps"


Columns = Annotated[
    int, typer.Option(min=1, max=2, help="Columns of the text that the LaTeX goes into.")
]


def equation_number(word: str) -> Number:
    """An equation's number or label from outside text, which is read and never evaluated."""
    number = number_of(word)
    if number is not None:
        return number
    several = " To derive, several have spaces between them, as derive 13 14." * ("," in word)
    raise typer.BadParameter(
        f"'{word}' is not an equation of this package. Give a number {allowed()} ('force-diffusion "
        f"list' names them).{several}",
        param_hint="N",
    )


def equations_of(word: str) -> list[Number]:
    """The number of an equation, or those of all cases of a theorem, such as "T4"."""
    return list(cases_of(word.upper())) or [equation_number(word)]


def wanted_of(words: Iterable[str]) -> list[Number]:
    """Numbers of equations, and of all cases of theorems."""
    return [number for word in words for number in equations_of(word)]


def derive(
    numbers: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="[N...]",
            help="Equations, or theorems such as T4; all equations by default.",
        ),
    ] = None,
    out: Annotated[Path | None, out_option("LaTeX and a manifest")] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the results as JSON and nothing else.")
    ] = False,
    columns: Columns = 1,
    article: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            parser=folder_of,
            help="Write the article about the equations beyond the paper into this folder, LaTeX "
            "and figures; it says which of them were proved. Needs matplotlib.",
        ),
    ] = None,
    overwrite: Overwrite = False,
) -> None:
    """Prove equations and all that they rest on.

    Of a single equation all steps and claims are printed, of several a line each.
    """
    from . import deriving

    wanted = wanted_of(numbers or ()) or list(modules())
    raise typer.Exit(deriving.derive(wanted, out, as_json, overwrite, columns, article))


def show(
    numbers: Annotated[
        list[str],
        typer.Argument(metavar="N", help="Numbers of equations, or a theorem's name."),
    ],
    form: Annotated[Form, typer.Option("--as", help="How to print it.")] = Form.TEXT,
    exact: Annotated[
        bool, typer.Option("--exact", help="The exact form at finite size, where there is one.")
    ] = False,
    at_j: Annotated[
        str | None,
        typer.Option(
            "--at-j",
            "--case",
            metavar="CASE",
            help="Which exact form. Eqs. 13 and 14: interior (2 ≤ j ≤ M − 2, the default), "
            "base (j = 0), base+1 (j = 1) or surface (j = M − 1). Eq. 15: surface-load (the "
            "default) or bulk-load. Eq. 16: bead (both upper contacts, the default), contact (one "
            "of them), leg (the contact on a leg of the cone) or leg-force (its magnitude). Beyond "
            "the paper, a case that is none of them is answered by a list of them.",
        ),
    ] = None,
    columns: Columns = 1,
) -> None:
    """Print equations, or all of a theorem, without deriving them."""
    wanted = wanted_of(numbers)
    if exact and len(wanted) > 1:
        names = ", ".join(map(str, wanted))
        raise typer.BadParameter(
            f"--exact goes with one, and {' '.join(numbers)} are several; name one: {names}.",
            param_hint="N",
        )
    if at_j is not None and not exact:
        raise typer.BadParameter("goes with --exact only; add it.", param_hint="--at-j")
    from ..api.equation import NoSuchFormError

    if exact and form is Form.STEPS:
        raise typer.BadParameter(
            "steps are not split by --exact; leave one of the two out.", param_hint="--as"
        )
    written = []
    for whole in map(fd.equation, wanted):
        try:
            shown = whole.exact(at_j) if exact else whole
        except NoSuchFormError as unknown:
            hint = "--exact" if unknown.hint == "exact" else "--at-j / --case"
            raise typer.BadParameter(str(unknown), param_hint=hint) from None
        written.append(_written(shown, whole, form, columns))
    print("\n\n".join(written))


def _written(shown: "Formula", whole: "Equation", form: Form, columns: int) -> str:
    match form:
        case Form.LATEX:
            return f"\\begin{{equation}}\n{shown.latex(columns)}\n\\end{{equation}}"
        case Form.SYMPY:
            return shown.sympy_code()
        case Form.PYTHON:
            return shown.python_code()
        case Form.STEPS:
            return str(whole.steps())
    return str(shown)


def list_equations() -> None:
    """List the equations.

    Beside each stands what Coq said of it when it was last asked.
    """
    for one in map(fd.equation, modules()):
        print(
            f"{one.number!s:>3}  {one.theorem or '':<2}  {one.name:<26}  {one.coq:<22}  {one.title}"
        )


def register(app: typer.Typer) -> None:
    """Add the commands to the command line."""
    app.command(epilog=STATUSES)(derive)
    app.command()(show)
    app.command("list")(list_equations)
