"""What several commands share: a line that tells how far they are, and plots if they can be."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from force_diffusion.derivations.commands.guard import tell

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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


def drawn(plot: "Callable[[], Figure]", name: str, title: str, command: str) -> dict[str, bytes]:
    """Give the files of a plot, which hold the command; or say what is missing, and none."""
    from force_diffusion.numeric.figures.library import MissingLibraryError, drawing

    try:
        with drawing():
            from force_diffusion.numeric.figures import style

            return style.images(plot, name, title, command)
    except MissingLibraryError as error:
        tell(f"no plot: {error}")
        return {}


def images(name: str) -> list[str]:
    """Files of a plot."""
    return [f"{name}.{kind}" for kind in ("png", "svg", "pdf")]
