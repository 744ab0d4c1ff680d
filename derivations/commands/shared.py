"""What several commands share: a line that tells how far they are, and plots if they can be."""

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from force_diffusion.derivations.commands.guard import tell


@contextmanager
def noticing() -> Iterator[Callable[[str], None]]:
    """Give a function that tells a terminal what is being measured, on one line of its own."""
    terminal = sys.stderr.isatty()

    def notice(words: str) -> None:
        if terminal:
            print(f"\r\x1b[K{words}", end="", file=sys.stderr, flush=True)

    try:
        yield notice
    finally:
        notice("")


def drawn(module: str, *arguments: Any) -> Mapping[str, str | bytes]:
    """Call ``plots`` of a module that needs matplotlib, or say what is missing and draw nothing."""
    try:
        plots = import_module(module).plots
    except ModuleNotFoundError as error:
        if (error.name or "").split(".")[0] != "matplotlib":
            raise
        tell("no plot: matplotlib is missing; pip install 'force-diffusion[plots]'")
        return {}
    found: Mapping[str, str | bytes] = plots(*arguments)
    return found


def images(name: str) -> list[str]:
    """Files of a plot."""
    return [f"{name}.{kind}" for kind in ("png", "svg", "pdf")]
