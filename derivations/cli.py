"""The command line: a thin layer over ``deriving`` and ``shown``."""

from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from derivations import calibrate_command, scene_commands
from derivations.catalogue import modules
from derivations.publishing import out_option

STATUSES = (
    "Exit status: 0 all proved, 1 something refuted or undecided, 2 wrong usage or input, "
    "3 the disk or a pipe failed, 130 interrupted."
)


class Form(StrEnum):
    """How ``show`` prints an equation."""

    TEXT = "text"
    LATEX = "latex"
    SYMPY = "sympy"
    PYTHON = "python"
    STEPS = "steps"


class Place(StrEnum):
    """Which layers an exact form is for."""

    INTERIOR = "interior"
    BASE = "base"
    NEXT = "base+1"
    SURFACE = "surface"


class _Commands(TyperGroup):
    """Names the commands there are."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command, or say which ones exist."""
        if args and not args[0].startswith("-") and args[0] not in self.commands:
            ctx.fail(f"There is no command '{args[0]}'. Use {_either(list(self.commands))}.")
        return super().resolve_command(ctx, args)


app = typer.Typer(
    cls=_Commands,
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


@app.callback(epilog=STATUSES)
def _about() -> None:
    """Derive, prove and export the equations of force diffusion in packings of discs."""


def _either(words: list[str]) -> str:
    return ", ".join(words[:-1]) + f" or {words[-1]}" if len(words) > 1 else words[0]


def _number(word: str) -> int:
    """An equation's number from outside text, which is read and never evaluated."""
    known = modules()
    if word.isascii() and word.isdigit() and len(word) < 5 and int(word) in known:
        return int(word)
    raise typer.BadParameter(
        f"'{word}' is not an equation of this package. Give a number from {min(known)} to "
        f"{max(known)}; 'force-diffusion list' names them.",
        param_hint="N",
    )


@app.command(epilog=STATUSES)
def derive(
    numbers: Annotated[
        list[str] | None,
        typer.Argument(metavar="[N...]", help="Equations to derive; all of them by default."),
    ] = None,
    out: Annotated[Path | None, out_option("LaTeX and a manifest")] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print the results as JSON and nothing else.")
    ] = False,
) -> None:
    """Prove equations, and the ones that they rest on, and check them."""
    from derivations.folder import NotOurFolderError

    wanted = [_number(word) for word in numbers] if numbers else list(modules())
    if out is not None and out.exists() and not out.is_dir():
        raise typer.BadParameter(
            f"'{out}' is a file. Give a new folder, an empty one, or one that an earlier "
            "'derive --out' wrote.",
            param_hint="--out",
        )
    try:
        from derivations import deriving

        status = deriving.derive(wanted, out, as_json)
    except NotOurFolderError as foreign:
        raise typer.BadParameter(
            f"'{out}' holds files that this program did not write ({foreign}). Give a new "
            "folder, an empty one, or one that an earlier 'derive --out' wrote.",
            param_hint="--out",
        ) from None
    raise typer.Exit(status)


@app.command()
def show(
    number: Annotated[str, typer.Argument(metavar="N", help="Number of the equation.")],
    form: Annotated[Form, typer.Option("--as", help="How to print it.")] = Form.TEXT,
    exact: Annotated[
        bool, typer.Option("--exact", help="The exact form at finite M (Eqs. 13 and 14).")
    ] = False,
    at_j: Annotated[
        Place | None,
        typer.Option(
            help="Where the exact form holds: interior (2 ≤ j ≤ M − 2, the default), "
            "base (j = 0), base+1 (j = 1) or surface (j = M − 1)."
        ),
    ] = None,
) -> None:
    """Print one equation, without deriving it."""
    from derivations import shown

    equation = _number(number)
    if not exact:
        if at_j is not None:
            raise typer.BadParameter("goes with --exact only; add it.", param_hint="--at-j")
        print(shown.view(equation, form))
        return
    having = shown.exact_numbers()
    if equation not in having:
        raise typer.BadParameter(
            f"Eq. {equation} has no exact form at finite M of its own; "
            f"{_either([str(one) for one in having])} has.",
            param_hint="--exact",
        )
    if form is Form.STEPS:
        raise typer.BadParameter(
            "steps are not split by --exact; leave one of the two out.", param_hint="--as"
        )
    print(shown.exact_view(equation, at_j or Place.INTERIOR, form))


@app.command("list")
def list_equations() -> None:
    """List the equations."""
    from derivations import shown

    for number, (name, title) in shown.titles().items():
        print(f"{number:3}  {name:<20}  {title}")


scene_commands.register(app)
calibrate_command.register(app)


def run(arguments: list[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    try:
        app(args=arguments, prog_name="force-diffusion")
    except SystemExit as done:
        if isinstance(done.__context__, OSError):  # a broken pipe, which typer calls status 1
            raise done.__context__ from None
        return done.code if isinstance(done.code, int) else 1
    return 0
