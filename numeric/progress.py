"""A bar with the time left, in a terminal or in a notebook."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def bar(what: str, total: int) -> Iterator[Callable[[int, str], None]]:
    """Give a function that takes how many of ``total`` are done, and words to show beside it.

    In a notebook rich draws it, by ipywidgets.
    """
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    done_of_all, time = MofNCompleteColumn(), TimeRemainingColumn()
    columns = what, BarColumn(), done_of_all, time, "left {task.description}"
    shown = Progress(*columns, console=Console(stderr=True), transient=True)
    task = shown.add_task("", total=total)
    with shown:
        yield lambda done, words: shown.update(task, completed=done, description=words)
