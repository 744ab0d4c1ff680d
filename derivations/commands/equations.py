"""The commands ``show`` and ``list``: a thin layer over ``Equation``."""

import json
from collections.abc import Iterable
from enum import StrEnum
from typing import TYPE_CHECKING, Annotated

import typer

import force_diffusion as fd

from ..framework.catalogue import Number, allowed, modules, number_of

if TYPE_CHECKING:
    from ..api.equation import Equation


class OutputForm(StrEnum):
    """How ``show`` prints an equation."""

    TEXT = "text"
    LATEX = "latex"
    SYMPY = "sympy"
    PYTHON = "python"
    STEPS = "steps"
    JSON = "json"


Columns = Annotated[
    int, typer.Option(min=1, max=2, help="Columns of the page that the LaTeX is for.")
]


def equation_number(word: str) -> Number:
    """An equation's number or label from outside text, which is read and never evaluated."""
    number = number_of(word)
    if number is not None:
        return number
    several = " Put spaces between several, as in derive 13 14." * ("," in word)
    raise typer.BadParameter(
        f"'{word}' is not an equation of this package. Give a number {allowed()} ('force-diffusion "
        f"list' names them).{several}",
        param_hint="N",
    )


def show(
    numbers: Annotated[list[str], typer.Argument(metavar="N", help="Numbers of equations.")],
    form: Annotated[OutputForm, typer.Option("--as", help="How to print it.")] = OutputForm.TEXT,
    exact: Annotated[
        bool,
        typer.Option("--exact", help="Print the exact forms at finite size, if there are any."),
    ] = False,
    columns: Columns = 1,
) -> None:
    """Print equations without deriving them."""
    if exact and form is OutputForm.STEPS:
        raise typer.BadParameter(
            "steps are not split by --exact; leave one of the two out.", param_hint="--as"
        )
    wanted = [*map(equation_number, numbers)]  # before SymPy is imported
    equations = [*map(fd.equation, wanted)]
    if form is OutputForm.JSON:
        print(json.dumps({"equations": [equation.data() for equation in equations]}, indent=2))
        return
    written = []
    for equation in equations:
        written += _exact(equation, form, columns) if exact else [_written(equation, form, columns)]
    print("\n\n".join(written))


def _written(equation: "Equation", form: OutputForm, columns: int) -> str:
    match form:
        case OutputForm.LATEX:
            return _displayed(equation.displays(columns))
        case OutputForm.SYMPY:
            return equation.sympy_code()
        case OutputForm.PYTHON:
            return equation.python_code()
        case OutputForm.STEPS:
            return str(equation.steps())
    return str(equation)


def _exact(equation: "Equation", form: OutputForm, columns: int) -> list[str]:
    """The exact forms, each with its name."""
    from force_diffusion.symbolic.printing.code import sympy_source

    from ..api.equation import NoSuchFormError

    try:
        equation.exact()
    except NoSuchFormError as unknown:
        raise typer.BadParameter(str(unknown), param_hint="--exact") from None
    forms = {name: equation.exact(name) for name in equation.forms}
    match form:
        case OutputForm.LATEX:
            return [_displayed(exact.displays(columns)) for exact in forms.values()]
        case OutputForm.SYMPY:
            return [sympy_source(exact.expr) for exact in forms.values()]
        case OutputForm.PYTHON:
            return [exact.python(f"{equation.name}_{name}") for name, exact in forms.items()]
    texts = {name: "\n".join(exact.lines()) for name, exact in forms.items()}
    return [f"Eq. {equation.number}, {name}: {text}" for name, text in texts.items()]


def _displayed(bodies: Iterable[str]) -> str:
    return "\n".join(f"\\begin{{equation}}\n{body}\n\\end{{equation}}" for body in bodies)


def list_equations() -> None:
    """List the equations.

    With what Coq said about each when it was last asked.
    """
    for equation in map(fd.equation, modules()):
        print(f"{equation.number!s:>3}  {equation.name:<26}  {equation.coq:<22}  {equation.title}")
