"""The command line: a table of commands. The module of a command is imported when it is called.

A new command needs a function in a module of ``derivations.commands``, whose ``STATUSES`` stand
below its help, and a line in ``COMMANDS``. It checks its arguments, calls what Python users call,
and prints or writes the answer (``output``). It never catches errors: ``guard`` reports them.
"""

import difflib
import shlex
import sys
from contextvars import ContextVar
from importlib import import_module
from typing import Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.errors import WRONG_INPUT, printable, rule
from typer.core import TyperGroup

from ..framework.catalogue import Number
from ..framework.lists import either
from .guard import guarded

# Name: (function, what --help says: the first paragraph of the command's docstring).
COMMANDS = {
    "derive": ("deriving.derive", "Prove equations and all that they rest on."),
    "certify": (
        "certify.certify",
        "Ask Coq, an independent proof assistant, whether it accepts the printed equations.",
    ),
    "show": ("equations.show", "Print equations without deriving them."),
    "list": ("equations.list_equations", "List the equations."),
    "examples": ("examples.examples", "Copy the example scenes into a new folder."),
    "run": ("scenes.run", "Solve the packing of a scene and answer its question."),
    "explain": ("scenes.explain", "Say what 'run' would do, and why."),
    "cost": (
        "scenes.cost",
        "Measure what accuracy costs: the error and time of one packing in each arithmetic.",
    ),
    "ensemble": (
        "ensemble.ensemble",
        "Gather statistics over many packings, on all cores, and save them in a file.",
    ),
    "ensemble-status": (
        "ensemble.ensemble_status",
        "Check the store of an ensemble, and say what it holds.",
    ),
    "figures": (
        "figures.figures",
        "Draw the paper's figures from new simulations of exact packings.",
    ),
}
STATUSES = (
    "Exit status: 0 all proved; 1 something refuted or undecided; 2 wrong usage or input; "
    "3 the disk or a pipe failed; 130 interrupted."
)

_GIVEN: ContextVar[list[str]] = ContextVar("given")


def command_line() -> str:
    """The command as one line for a shell; characters that no line may hold are spelled out."""
    return printable(shlex.join(["force-diffusion", *_GIVEN.get()])).replace("\n", r"\n")


def _application(**options: Any) -> typer.Typer:
    return typer.Typer(rich_markup_mode=None, pretty_exceptions_enable=False, **options)


_USAGE: Any = typer.BadParameter.__base__  # of all that is wrong with a command line


class _Commands(TyperGroup):
    """The commands of the table; ``--help`` builds none of them, a call only its own."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Names, in the order of the table."""
        return list(COMMANDS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Import and build one command."""
        if cmd_name not in COMMANDS:
            return None
        name, _, function = COMMANDS[cmd_name][0].partition(".")
        module = import_module(f"force_diffusion.derivations.commands.{name}")
        app = _application(add_completion=False)
        app.command(cmd_name, epilog=getattr(module, "STATUSES", None))(getattr(module, function))
        return typer.main.get_command(app)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        """Write the list of commands."""
        with formatter.section("Commands"):
            formatter.write_dl([(name, line) for name, (_, line) in COMMANDS.items()])

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command, or say which ones exist."""
        unknown = args and not args[0].startswith("-") and args[0] not in COMMANDS
        if unknown and not ctx.resilient_parsing:  # as a shell completes a line
            close = difflib.get_close_matches(args[0][:99], COMMANDS, n=1)
            hint = f"; did you mean {close[0]}?" if close else "."
            ctx.fail(
                f"There is no command '{printable(args[0])}'{hint} Use {either(list(COMMANDS))}."
            )
        return super().resolve_command(ctx, args)

    def invoke(self, ctx: Any) -> Any:
        """Run the command; a wrong value gets the same words as one in a scene."""
        try:
            return super().invoke(ctx)
        except _USAGE as error:
            if getattr(error, "option_name", "") == "--format" and error.ctx.info_name == "show":
                error.possibilities = ["--as"]
            if not isinstance(error, typer.BadParameter):
                raise
            from pydantic import ValidationError

            if isinstance(error.__cause__, ValidationError):
                first, error.message = error.__cause__.errors()[0], rule(error.__cause__)
                if first["type"] != "value_error":  # which names the value itself
                    error.message = f"{printable(str(first['input']))!r} {error.message}."
            raise


app = _application(
    cls=_Commands, no_args_is_help=True, context_settings={"help_option_names": ["--help", "-h"]}
)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"force-diffusion {version('force-diffusion')}")
        raise typer.Exit


@app.callback(epilog=STATUSES)
def _about(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Derive, prove and export the equations of force diffusion in packings of discs."""


def run_alone(number: Number) -> int:
    """Run an equation's file as a program, which is ``derive`` of it with the same options."""
    return guarded(lambda: run(["derive", str(number), *sys.argv[1:]]))


def run(arguments: list[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    _GIVEN.set(given)
    try:
        app(args=given, prog_name="force-diffusion")
    except SystemExit as done:
        if isinstance(done.__context__, OSError):  # a broken pipe, which typer calls status 1
            raise done.__context__ from None
        if done.code and given and given[0].endswith("-completion"):
            print("Completion is for bash, zsh or fish: call it from one of them.", file=sys.stderr)
            return WRONG_INPUT
        return done.code if isinstance(done.code, int) else 1
    return 0
