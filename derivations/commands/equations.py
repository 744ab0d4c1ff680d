"""The commands ``show`` and ``list``: a thin layer over ``Equation``."""

import json
from collections.abc import Iterable
from typing import TYPE_CHECKING, Annotated, Literal

import typer

import force_diffusion as fd

from ..framework.catalogue import modules, number_of

if TYPE_CHECKING:
    from ..api.equation import Equation


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
    written = []
    for equation in equations:
        written += _exact(equation, form, columns) if exact else [_written(equation, form, columns)]
    print("\n\n".join(written))


def _written(equation: "Equation", form: OutputForm, columns: int) -> str:
    match form:
        case "latex":
            return _displayed(equation.displays(columns))
        case "sympy":
            return equation.sympy_code()
        case "python":
            return equation.python_code()
        case "steps":
            return str(equation.steps())
    return str(equation)


def _exact(equation: "Equation", form: OutputForm, columns: int) -> list[str]:
    """The exact forms, each with its name. Raises ``NoSuchFormError`` where there are none."""
    from force_diffusion.symbolic.printing.code import sympy_source

    equation.exact()
    forms = {name: equation.exact(name) for name in equation.forms}
    match form:
        case "latex":
            return [_displayed(exact.displays(columns)) for exact in forms.values()]
        case "sympy":
            return [sympy_source(exact.expr) for exact in forms.values()]
        case "python":
            return [exact.python(f"{equation.name}_{name}") for name, exact in forms.items()]
    texts = {name: "\n".join(exact.lines()) for name, exact in forms.items()}
    return [f"Eq. {equation.number}, {name}: {text}" for name, text in texts.items()]


def _displayed(bodies: Iterable[str]) -> str:
    return "\n".join(f"\\begin{{equation}}\n{body}\n\\end{{equation}}" for body in bodies)


def list_equations() -> None:
    """List the equations."""
    for equation in map(fd.equation, modules()):
        print(f"{equation.number!s:>3}  {equation.name:<26}  {equation.title}")
