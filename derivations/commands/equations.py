"""The commands ``show`` and ``list``: a thin layer over ``Equation``."""

import json
from collections.abc import Iterator
from typing import Annotated, Any, Literal

import typer

import force_diffusion as fd

from ..framework.catalogue import modules, number_of

OutputForm = Literal["text", "latex", "sympy", "python", "steps", "json"]
"""How ``show`` prints an equation."""
Columns = Annotated[
    int, typer.Option(min=1, max=2, help="Columns of the page that the LaTeX is for.")
]


def show(
    numbers: Annotated[list[str], typer.Argument(metavar="N", help="Numbers of equations.")],
    form: Annotated[OutputForm, typer.Option("--as", help="How to print it.")] = "text",
    exact: Annotated[
        bool,
        typer.Option("--exact", help="Print the exact forms at finite size, if there are any."),
    ] = False,
    columns: Columns = 1,
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
    print("\n\n".join(part for eq in equations for part in _written(eq, form, columns, exact)))


def _written(equation: "fd.Equation", form: OutputForm, columns: int, exact: bool) -> Iterator[str]:
    """An equation, or its exact forms. Raises ``NoSuchFormError`` where there are none."""
    from force_diffusion.symbolic.printing.code import sympy_source

    if exact:
        equation.exact()
    parts: dict[str, Any] = {name: equation.exact(name) for name in equation.forms if exact}
    for name, part in (parts or {"": equation}).items():
        match form:
            case "latex":
                displays = part.displays(columns)
                yield "\n".join(
                    f"\\begin{{equation}}\n{body}\n\\end{{equation}}" for body in displays
                )
            case "sympy":
                yield sympy_source(part.expr) if exact else part.sympy_code()
            case "python":
                yield part.python(f"{equation.name}_{name}") if exact else part.python_code()
            case "steps":
                yield str(equation.steps())
            case _:
                lines = "\n".join(part.lines()) if exact else ""
                yield f"Eq. {equation.number}, {name}: {lines}" if exact else str(equation)


def list_equations() -> None:
    """List the equations."""
    for equation in map(fd.equation, modules()):
        print(f"{equation.number!s:>3}  {equation.name:<26}  {equation.title}")
