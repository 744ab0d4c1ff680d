"""The command line as a function, and equation files as programs."""

import sys
from importlib import import_module

from force_diffusion.numeric.arithmetic.errors import WRONG_INPUT

from ..framework.catalogue import Number
from .guard import guarded
from .shared import GIVEN


def run_alone(number: Number) -> int:
    """Run an equation's file as a program, which is ``derive`` of it with the same options."""
    return guarded(lambda: run(["derive", str(number), *sys.argv[1:]]))


def run(arguments: list[str] | None = None) -> int:
    """Run the command line and return its exit status."""
    given = sys.argv[1:] if arguments is None else arguments
    GIVEN.set(given)
    try:
        # by name, so that the equations, which run as programs, do not import all that imports them
        import_module(".application", __package__).app(args=given, prog_name="force-diffusion")
    except SystemExit as done:
        if isinstance(done.__context__, OSError):  # a broken pipe, which typer calls status 1
            raise done.__context__ from None
        if done.code and given and given[0].endswith("-completion"):
            print("Completion is for bash, zsh or fish: call it from one of them.", file=sys.stderr)
            return WRONG_INPUT
        return done.code if isinstance(done.code, int) else 1
    return 0
