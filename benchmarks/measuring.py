"""What benchmarks share: tasks that take turns, lines with targets, and the program around them."""

import argparse
import csv
import io
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from time import perf_counter
from typing import Any


@dataclass(frozen=True)
class Line:
    """A line of the table; ``target`` is a bound from below (">") or above ("<"), or none."""

    what: str
    value: float
    unit: str = ""
    sense: str = ""
    target: float = 0

    @property
    def met(self) -> bool:
        """Whether the target holds; always, where there is none."""
        if not self.sense:
            return True
        return self.value >= self.target if self.sense == ">" else self.value <= self.target

    def __str__(self) -> str:
        """Give the line in Markdown."""
        sign = {">": "at least", "<": "at most", "": ""}[self.sense]
        target = f"{sign} {self.target:g}" if self.sense else ""
        verdict = ("met" if self.met else "MISSED") if self.sense else ""
        return f"| {self.what} | {self.value:.3g}{self.unit} | {target} | {verdict} |"


def in_turn(
    tasks: Mapping[str, Callable[[], Any]],
    rounds: int,
    clock: Callable[[], float] = perf_counter,
    of: Callable[[Sequence[float]], float] = median,
) -> dict[str, float]:
    """Seconds of each task, the median; each is warmed up once, then they take turns."""
    spent: dict[str, list[float]] = {name: [] for name in tasks}
    for task in tasks.values():
        task()
    for _ in range(rounds):
        for name, task in tasks.items():
            start = clock()
            task()
            spent[name].append(clock() - start)
    return {name: of(times) for name, times in spent.items()}


def program(
    about: str | None,
    head: str,
    parts: Mapping[str, Callable[[], Iterator[Line]]],
    probes: Mapping[str, Callable[[], object]],
) -> int:
    """Measure the parts, print the table, and compare with the targets; or probe in this process.

    Gives the exit status: 1 where a target is missed.
    """
    parser = argparse.ArgumentParser(description=about)
    parser.add_argument("--skip", nargs="*", choices=list(parts), default=[])
    parser.add_argument("--probe", choices=list(probes), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.probe:
        print(probes[options.probe]())
        return 0
    print(head + "\n")
    print("| measured | value | target | |")
    print("|---|---:|---|---|")
    failures = 0
    for name, part in parts.items():
        if name in options.skip:
            continue
        print(f"| **{name}** | | | |")
        for line in part():
            print(line, flush=True)
            failures += not line.met
    return 1 if failures else 0


def csv_text(rows: Sequence[Mapping[str, Any]]) -> str:
    """Write rows as CSV, under the keys of the first."""
    text = io.StringIO()
    if rows:
        writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    return text.getvalue()
