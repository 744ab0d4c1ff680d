"""How a run is followed: a live bar on a terminal, plain lines in a pipe, or not at all."""

import sys
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, TextIO

from force_diffusion.symbolic.kernel.decisions import Verdict

from ..export.terminal import summary_line, trouble_lines
from ..framework.record import Outcome

if TYPE_CHECKING:
    from rich.console import Console

_STYLES = {
    Verdict.PROVED: "green",
    Verdict.ASSUMING: "green",
    Verdict.REFUTED: "bold red",
    Verdict.UNDECIDED: "yellow",
}


class Silence:
    """Follow nothing."""

    def showing(self) -> AbstractContextManager[object]:
        """While the run lasts."""
        return nullcontext()

    def checking(self, check: str) -> None:
        """A check is about to start."""

    def finished(self, outcome: Outcome) -> None:
        """An equation has been dealt with."""

    def summary(self, words: str) -> None:
        """The last word."""


class PlainLines(Silence):
    """One line per equation, as soon as it is known."""

    def finished(self, outcome: Outcome) -> None:
        """Its verdict and counts, and below them whatever went wrong."""
        for line in (summary_line(outcome), *trouble_lines(outcome)):
            print(line)
        sys.stdout.flush()

    def summary(self, words: str) -> None:
        """The last line."""
        print(words, flush=True)


class LiveBar(Silence):
    """A bar that names the check at work; finished equations stand above it."""

    def __init__(self, console: "Console", total: int, *, lines: bool) -> None:
        """Make the bar; ``lines`` says whether the console may also have lines of text."""
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
        from rich.table import Column

        self._console = console
        self._lines = lines
        self._bar = Progress(
            BarColumn(bar_width=24),
            MofNCompleteColumn(),
            TextColumn(
                "{task.description}",
                markup=False,
                table_column=Column(no_wrap=True, overflow="ellipsis"),
            ),
            console=console,
            transient=True,
        )
        self._task = self._bar.add_task("", total=total)

    def showing(self) -> AbstractContextManager[object]:
        """While the run lasts."""
        return self._bar

    def checking(self, check: str) -> None:
        """Name the check at work."""
        self._bar.update(self._task, description=check)

    def finished(self, outcome: Outcome) -> None:
        """One more done."""
        self._bar.advance(self._task)
        if self._lines:
            from rich.text import Text

            line = Text(summary_line(outcome))
            line.highlight_words([str(outcome.verdict)], _STYLES[outcome.verdict])
            self._console.print(line, *trouble_lines(outcome), sep="\n", markup=False)

    def summary(self, words: str) -> None:
        """The last line."""
        if self._lines:
            self._console.print(words, markup=False, highlight=False, soft_wrap=True)


def display(total: int, *, as_json: bool) -> Silence:
    """The display that suits where the output goes; with JSON only standard error is free."""
    stream: TextIO = sys.stderr if as_json else sys.stdout
    if stream.isatty():
        from rich.console import Console

        console = Console(file=stream)
        if not console.is_dumb_terminal:
            return LiveBar(console, total, lines=not as_json)
    return Silence() if as_json else PlainLines()
