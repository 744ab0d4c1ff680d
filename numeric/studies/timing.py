"""Seconds of the processor, of the one thread there is: other programs don't count."""

import math
from collections.abc import Callable
from statistics import median
from time import process_time
from typing import Any, TypeVar

LEAST_RUNS, MOST_RUNS, ENOUGH_SECONDS = 3, 15, 0.2
# After so many seconds no further run is timed: long ones scatter little, and a study stays short.
LONG_SECONDS = 2.0
# Of a run in which the processor's clock did not tick; it is drawn as a power of ten.
TICK = 1e-6
T = TypeVar("T")


def in_turn(*works: Callable[[], Any]) -> list[list[float]]:
    """Give the seconds of several runs of each work; they take turns: a busy machine slows all."""
    found: list[list[float]] = [[] for _ in works]
    runs, spent = 0, 0.0
    while spent < LONG_SECONDS * len(works) and (
        runs < LEAST_RUNS or (runs < MOST_RUNS and spent < ENOUGH_SECONDS * len(works))
    ):
        for work, seconds in zip(works, found, strict=True):
            seconds.append(timed(work)[1])
        runs, spent = runs + 1, math.fsum(map(math.fsum, found))
    return found


def timed(work: Callable[[], T]) -> tuple[T, float]:
    """Give what a work gives, and the seconds of this one run."""
    start = process_time()
    result = work()
    return result, max(process_time() - start, TICK)


def usually(work: Callable[[], T]) -> tuple[T, float]:
    """Give what a work gives, and its seconds: the median of several runs, or of one long one."""
    result, seconds = timed(work)
    return result, seconds if seconds > ENOUGH_SECONDS else median(in_turn(work)[0])
