"""Ways to answer a scene: any plan in any number system; what they take."""

import math
import tracemalloc
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any, TypeVar

from ..arithmetic.systems import FLOAT64, Balls, BigFloat, NumberSystem
from ..scene.scene import Scene
from .rows import Way
from .timing import seconds_of

T = TypeVar("T")
Notice = Callable[[str], None]
"""Called with the name of each way before it is measured."""

DIGITS = (20, 30, 50, 100, 300)


def systems() -> Iterator[NumberSystem]:
    """All arithmetics: float64, mpmath and balls by digits."""
    yield FLOAT64
    yield from (BigFloat(digits) for digits in DIGITS)
    yield from (Balls(math.ceil(digits * math.log2(10))) for digits in DIGITS)


def with_geometry(scene: Scene, geometry: str) -> Scene:
    """Give the scene with another ``effects.geometry``."""
    effects = scene.effects.model_copy(update={"geometry": geometry})
    return scene.model_copy(update={"effects": effects})


def measured(
    way: str,
    system: NumberSystem,
    work: Callable[[], T],
    judged: Callable[[T], dict[str, Any]],
    realisations: int | None = None,
) -> Way:
    """Run once, tracing memory, as a warm-up, and judge; then run several times by the clock."""
    tracemalloc.start()
    try:
        result = work()
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    errors = judged(result)
    seconds = seconds_of(work)
    return Way(
        way=way,
        arithmetic=system.name,
        realisations=realisations,
        **errors,
        seconds=median(seconds),
        seconds_min=min(seconds),
        seconds_max=max(seconds),
        runs=len(seconds),
        peak_bytes=peak,
        peak_is_bound=system is not FLOAT64,
    )
