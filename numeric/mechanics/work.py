"""What a run passes on from one pass to the next: a listener for its progress, and positions."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

Progress = Callable[[str, int], None]
"""Called with the kind of work and the number of beads just done."""


@dataclass
class Work:
    """A run under way; ``settled``: float64 positions at rest, from which more bits start."""

    progress: Progress | None = None
    settled: Any = None

    def did(self, kind: str, beads: int) -> None:
        """Report that beads were "deposited", "balanced", "summed" or "checked"."""
        if self.progress is not None:
            self.progress(kind, beads)


@contextmanager
def bar(what: str, total: int) -> Iterator[Callable[..., None]]:
    """Show a bar with the time left: rich draws it in a terminal or, by ipywidgets, in a notebook.

    Gives the function that updates it: by ``advance`` or ``completed``, and ``description``.
    """
    from rich.console import Console
    from rich.progress import Progress as Bar

    with Bar(console=Console(stderr=True), transient=True) as shown:
        yield partial(shown.update, shown.add_task(what, total=total))
