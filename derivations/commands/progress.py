"""How a run is followed: a live bar on a terminal, plain lines in a pipe, or not at all."""

import sys
from collections.abc import Collection
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING, TextIO

from force_diffusion.symbolic.kernel.decisions import Verdict

from ..export.terminal import outcome_text, summary_line, trouble_lines
from ..framework.catalogue import Number
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
    """One line per equation, as soon as it is known, or all of it.

    Args:
        in_full: numbers of the equations of which all is printed.
    """

    def __init__(self, in_full: Collection[Number] = ()):
        self._in_full = in_full

    def finished(self, outcome: Outcome) -> None:
        """Its line, and below it whatever went wrong; or all that was found."""
        if outcome.derivation.number in self._in_full:
            self.summary(f"\n{outcome_text(outcome)}")
            return
        print(summary_line(outcome), *trouble_lines(outcome), sep="\n", flush=True)

    def summary(self, words: str) -> None:
        """The last line."""
        print(words, flush=True)


class LiveBar(Silence):
    """A bar that names the check at work; finished equations stand above it.

    Args:
        console: where it is drawn.
        total: how many equations there are, if that is known.
        in_full: numbers of the equations of which all is printed.
        lines: whether the console may also have lines of text.
    """

    def __init__(
        self, console: "Console", total: int | None, in_full: Collection[Number], *, lines: bool
    ) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn
        from rich.table import Column

        self._console, self._in_full, self._lines = console, in_full, lines
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
        if outcome.derivation.number in self._in_full:
            self.summary(f"\n{outcome_text(outcome)}")
        elif self._lines:
            from rich.text import Text

            line = Text(summary_line(outcome))
            line.highlight_words([str(outcome.verdict)], _STYLES[outcome.verdict])
            self._console.print(line, *trouble_lines(outcome), sep="\n", markup=False)

    def summary(self, words: str) -> None:
        """Text as it is."""
        if self._lines:
            self._console.print(words, markup=False, highlight=False, soft_wrap=True)


def display(total: int | None, in_full: Collection[Number], *, as_json: bool) -> Silence:
    """The display that suits where the output goes; with JSON only standard error is free.

    Args:
        total: how many equations there are, if that is known.
        in_full: numbers of the equations of which all is printed.
        as_json: whether standard output is for JSON.
    """
    stream: TextIO = sys.stderr if as_json else sys.stdout
    if stream.isatty():
        from rich.console import Console

        console = Console(file=stream)
        if not console.is_dumb_terminal:
            return LiveBar(console, total, in_full, lines=not as_json)
    return Silence() if as_json else PlainLines(in_full)
