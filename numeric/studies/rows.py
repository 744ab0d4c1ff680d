"""The rows of a cost study: what is measured of each way to answer, and which none other beats."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from decimal import Decimal


@dataclass(frozen=True, kw_only=True)
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
    realisations: int | None = None
    error: Decimal
    model_error: Decimal
    rounding_error: Decimal
    sampling_error: Decimal | None = None
    certified_bound: Decimal | None = None
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
