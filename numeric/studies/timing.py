"""Seconds of the processor, of the one thread there is: other programs don't count."""

import math
from collections.abc import Callable
from time import process_time
from typing import Any

LEAST_RUNS, MOST_RUNS, ENOUGH_SECONDS = 3, 15, 0.2
# After so many seconds no further run is timed: long ones scatter little, and a study stays short.
LONG_SECONDS = 2.0
# Of a run in which the processor's clock did not tick; it is drawn as a power of ten.
TICK = 1e-6


def seconds_of(work: Callable[[], Any]) -> list[float]:
    """Give the seconds of several runs."""
    found: list[float] = []
    while (spent := math.fsum(found)) < LONG_SECONDS and (
        len(found) < LEAST_RUNS or (len(found) < MOST_RUNS and spent < ENOUGH_SECONDS)
    ):
        start = process_time()
        work()
        found.append(max(process_time() - start, TICK))
    return found
