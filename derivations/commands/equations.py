"""The commands ``show`` and ``list``: a thin layer over ``Equation``."""

import json
from collections.abc import Iterator
from typing import Annotated, Literal

import typer

import force_diffusion as fd

from ..framework.catalogue import modules, number_of

OutputForm = Literal["text", "latex", "sympy", "python", "steps", "json"]
"""How ``show`` prints an equation."""


def show(
    numbers: Annotated[list[str], typer.Argument(metavar="N", help="Numbers of equations.")],
    form: Annotated[OutputForm, typer.Option("--as", help="How to print it.")] = "text",
    exact: Annotated[
        bool,
        typer.Option("--exact", help="Print the exact forms at finite size, if there are any."),
    ] = False,
    columns: Annotated[
        int, typer.Option(min=1, max=2, help="Columns of the page that the LaTeX is for.")
    ] = 1,
) -> None:
    """Print equations without deriving them."""
    if exact and form == "steps":
        raise typer.BadParameter(
            "steps are not split by --exact; leave one of the two out.", param_hint="--as"
        )
    wanted = [*map(number_of, numbers)]  # before SymPy is imported
    equations = [*map(fd.equation, wanted)]
    if form == "json":
        print(json.dumps({"equations": [equation.data() for equation in equations]}, indent=2))
        return
    if exact:
        parts = [part for each in equations for part in _exact_forms(each, form, columns)]
    else:
        parts = [_printed(each, form, columns) for each in equations]
    print("\n\n".join(parts))


def _printed(equation: "fd.Equation", form: OutputForm, columns: int) -> str:
    """An equation as the paper has it, or its steps."""
    match form:
        case "latex":
            return _numbered(equation.displays(columns))
        case "sympy":
            return equation.sympy_code()
        case "python":
            return equation.python_code()
        case "steps":
            return str(equation.steps())
        case _:
            return str(equation)


def _exact_forms(equation: "fd.Equation", form: OutputForm, columns: int) -> Iterator[str]:
    """Its exact forms. Raises ``NoSuchFormError`` where there are none."""
    from force_diffusion.symbolic.printing.code import sympy_source

    equation.exact()
    for name in equation.forms:
        exact = equation.exact(name)
        match form:
            case "latex":
                yield _numbered(exact.displays(columns))
            case "sympy":
                yield sympy_source(exact.expr)
            case "python":
                yield exact.python(f"{equation.name}_{name}")
            case _:
                lines = "\n".join(exact.lines())
                yield f"Eq. {equation.number}, {name}: {lines}"


def _numbered(displays: list[str]) -> str:
    return "\n".join(f"\\begin{{equation}}\n{body}\n\\end{{equation}}" for body in displays)


def list_equations() -> None:
    """List the equations."""
    for equation in map(fd.equation, modules()):
        print(f"{equation.number!s:>3}  {equation.name:<26}  {equation.title}")
