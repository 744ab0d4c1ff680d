"""The rows of a cost study: what is measured of each way to answer, and which none other beats."""

import math
import tracemalloc
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from decimal import Decimal
from statistics import median
from time import process_time
from typing import TypeVar

from ...arithmetic.systems import FLOAT64, LONGDOUBLE

LEAST_RUNS, MOST_RUNS, ENOUGH_SECONDS = 3, 15, 0.2
# After so many seconds no further run is timed: slow rows scatter little, and a study stays short.
LONG_SECONDS = 2.0
# Of a run in which the processor's clock did not tick; it is drawn as a power of ten.
TICK = 1e-6
T = TypeVar("T")
Notice = Callable[[str], None]
"""Called with the name of each way before it is measured."""


@dataclass(frozen=True)
class Way:
    """One way to the answer. Errors are relative to the largest |change|; None: does not apply.

    ``error`` is measured against the reference, the radius of a certified one added. Of its parts
    ``model_error`` is that of what is computed, ``rounding_error`` that of the arithmetic,
    ``sampling_error`` that of a finite ensemble. ``certified_bound`` is what the way itself
    certifies of its error (balls only). ``seconds``, of the processor, is the median of ``runs``
    runs, a warm-up not counted. ``peak_bytes``: what Python and NumPy allocate, by tracemalloc, in
    a run of its own; where ``peak_is_bound``, it is a lower bound: the limbs of big numbers, which
    flint and GMP allocate, are not in it. ``pareto``: no other row has a smaller measured error and
    least time.
    """

    way: str
    arithmetic: str
    realisations: int | None
    error: Decimal
    model_error: Decimal | None
    rounding_error: Decimal | None
    sampling_error: Decimal | None
    certified_bound: Decimal | None
    seconds: float
    seconds_min: float
    seconds_max: float
    runs: int
    peak_bytes: int
    peak_is_bound: bool
    pareto: bool = False


@dataclass(frozen=True)
class Reference:
    """What errors are measured against; ``radius`` is its own error, relative as theirs.

    ``kind`` is "certified" (then the radius is a bound) or "estimated" (a standard error).
    """

    kind: str
    what: str
    arithmetic: str
    radius: Decimal


def measured(work: Callable[[], T]) -> tuple[T, list[float], int]:
    """Run once, tracing memory, as a warm-up; then several times by the processor's clock.

    Gives the result, the seconds of each timed run and the peak of traced memory in bytes.
    """
    tracemalloc.start()
    try:
        result = work()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    seconds: list[float] = []
    while math.fsum(seconds) < LONG_SECONDS and (
        len(seconds) < LEAST_RUNS
        or (len(seconds) < MOST_RUNS and math.fsum(seconds) < ENOUGH_SECONDS)
    ):
        start = process_time()
        work()
        seconds.append(max(process_time() - start, TICK))
    return result, seconds, peak


def row(
    way: str,
    arithmetic: str,
    seconds: Sequence[float],
    peak: int,
    error: Decimal,
    parts: tuple[Decimal | None, Decimal | None, Decimal | None],
    bound: Decimal | None = None,
    realisations: int | None = None,
) -> Way:
    """Make a row; ``parts`` are model, rounding and sampling error."""
    return Way(
        way, arithmetic, realisations, error, *parts, bound,
        median(seconds), min(seconds), max(seconds), len(seconds), peak,
        arithmetic not in {FLOAT64.name, LONGDOUBLE.name},
    )  # fmt: skip


def marked(rows: Sequence[Way]) -> tuple[Way, ...]:
    """Mark the Pareto front of error and least time; sort by error, the largest first."""
    front = pareto([(r.seconds_min, r.error) for r in rows])
    done = [replace(r, pareto=best) for r, best in zip(rows, front, strict=True)]
    return tuple(sorted(done, key=lambda r: -r.error))


def pareto(points: Sequence[tuple[float, Decimal]]) -> list[bool]:
    """Tell which (seconds, error) no other point beats in one without losing in the other.

    >>> pareto([(1, Decimal(3)), (2, Decimal(1)), (2, Decimal(2)), (3, Decimal(1))])
    [True, True, False, False]
    """
    return [
        not any(s <= seconds and e <= error and (s, e) != (seconds, error) for s, e in points)
        for seconds, error in points
    ]
