"""The application: a table of commands.

A new command needs a function in a module of ``derivations.commands``, and a line in ``COMMANDS``.
It checks its arguments, calls what Python users call, and prints or writes the answer (``output``).
It never catches errors: ``guard`` reports them. Its module imports neither SymPy nor NumPy, which
``--help`` would wait for: functions do.
"""

from collections.abc import Callable
from typing import Annotated, Any

import typer
from force_diffusion.numeric.arithmetic.errors import printable, rule, suggestion
from typer.core import TyperGroup

from ..framework.lists import either
from . import certify, deriving, ensemble, equations, figures, scenes
from .shared import ANSWERED, PROVED

COMMANDS: dict[str, tuple[Callable[..., None], str | None]] = {
    "derive": (deriving.derive, PROVED),
    "certify": (certify.certify, certify.STATUSES),
    "show": (equations.show, None),
    "list": (equations.list_equations, None),
    "examples": (scenes.examples, scenes.COPIED),
    "run": (scenes.run, ANSWERED),
    "explain": (scenes.explain, ANSWERED),
    "cost": (scenes.cost, ANSWERED),
    "ensemble": (ensemble.ensemble, ANSWERED),
    "ensemble-status": (ensemble.ensemble_status, ANSWERED),
    "figures": (figures.figures, figures.STATUSES),
}
"""By name: the function, and the exit statuses that its help explains."""

_USAGE: Any = typer.BadParameter.__base__  # of all that is wrong with a command line


class _Commands(TyperGroup):
    """The commands, with errors that say what is allowed."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Find the command, or say which ones exist."""
        unknown = args and not args[0].startswith("-") and args[0] not in COMMANDS
        if unknown and not ctx.resilient_parsing:  # as a shell completes a line
            allowed = f"{suggestion(args[0], COMMANDS).capitalize()}Use {either(list(COMMANDS))}."
            ctx.fail(f"There is no command '{printable(args[0])}'. {allowed}")
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


app = typer.Typer(
    cls=_Commands,
    no_args_is_help=True,
    context_settings={"help_option_names": ["--help", "-h"]},
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)
for _name, (_function, _statuses) in COMMANDS.items():
    _summary = " ".join((_function.__doc__ or "").partition("\n\n")[0].split())
    app.command(_name, short_help=_summary, epilog=_statuses)(_function)


def _print_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        print(f"force-diffusion {version('force-diffusion')}")
        raise typer.Exit


@app.callback(epilog=PROVED)
def _about(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Derive, prove and export the equations of force diffusion in packings of discs."""
