"""Which beads may meet beside the nearest ones: bounded by how far beads are from their sites.

Beads steps s = (s_1, …, s_d) of the base vectors apart lie L(s) = 2|Σ s_a n^a| apart in the ordered
packing, and L(s) − |Δδx| at least in this one. Images are sites like others, so that own images and
several images of one bead are among them. All lengths are in units of r.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product
from math import inf, isfinite, sqrt

from ..arithmetic.systems import Array

Steps = tuple[int, ...]
# Roundings of these bounds, of lengths up to a million.
ROOM = 1e-9
# Kinds of pairs that are tried at most.
MOST = 1e6


@dataclass(frozen=True)
class Extent:
    """Bounds of some beads: ``low`` and ``high`` of n^a·δx, d numbers each, and the largest δr."""

    low: tuple[float, ...]
    high: tuple[float, ...]
    largest: float

    def joined(self, other: "Extent") -> "Extent":
        """Bound both."""
        low = tuple(map(min, self.low, other.low))
        return Extent(low, tuple(map(max, self.high, other.high)), max(self.largest, other.largest))

    def apart(self, other: "Extent", phi: float) -> float:
        """Bound |δx_b − δx_a| of a bead of this one and a bead of the ``other``."""
        sides = zip(self.low, self.high, other.low, other.high, strict=True)
        t = [max(b_high - low, high - b_low) for low, high, b_low, b_high in sides]
        if min(t) < 0:
            return -inf  # there are no beads
        own, cross = _inverse(phi, len(t))
        # |v|² = own Σ v_a² + cross (Σ v_a)², of components v_a = n^a·v
        return sqrt(own * sum(v * v for v in t) + max(cross, 0) * sum(t) * sum(t))


def extent(c: Sequence[Array], rho: Array) -> Extent:
    """Bound beads: n^a·δx for each a, and δr."""
    low, high = (
        tuple(float(v.min(initial=inf)) for v in c),
        tuple(float(v.max(initial=-inf)) for v in c),
    )
    return Extent(low, high, float(rho.max(initial=-1)))


def _inverse(phi: float, dimension: int) -> tuple[float, float]:
    """Give ``own`` and ``cross`` of the inverse Gram matrix, own δ_ab + cross."""
    return 1 / (1 - phi), -phi / ((1 - phi) * (1 + (dimension - 1) * phi))


def _distance(phi: float, steps: Steps) -> float:
    """Give L."""
    return 2 * sqrt(sum(s * s for s in steps) * (1 - phi) + sum(steps) ** 2 * phi)


def _rise(phi: float, dimension: int) -> float:
    """Give the height of a layer."""
    return 2 * sqrt((1 + (dimension - 1) * phi) / dimension)


def _within(phi: float, dimension: int, reach: float, top: int) -> Iterator[Steps]:
    """Give the steps with L ≤ ``reach``, up to ``top`` layers up, or to later beads of the layer.

    Raises ``OverflowError`` where these are too many to be looked at.
    """
    own, cross = _inverse(phi, dimension)
    most = reach / 2 * sqrt(own + cross) * (1 + ROOM)
    layers = min(reach / _rise(phi, dimension) * (1 + ROOM), top)
    if not (2 * most + 1) ** (dimension - 1) * (layers + 1) < MOST:
        raise OverflowError
    every = range(-int(most), int(most) + 1)
    for up, free in product(range(int(layers) + 1), product(every, repeat=dimension - 1)):
        steps = *free, up - sum(free)
        if (up or steps > (0,) * dimension) and _distance(phi, steps) <= reach:
            yield steps


@cache
def _nearest(phi: float, known: frozenset[Steps]) -> float:
    """Give the smallest L of all steps but the ``known`` ones and contacts."""
    dimension = len(next(iter(known)))
    every = _within(phi, dimension, 5, 9)  # of two steps along an axis L is 4
    return min(_distance(phi, steps) for steps in every if _new(steps, known))


def _new(steps: Steps, known: frozenset[Steps]) -> bool:
    return steps not in known and not (sum(steps) == 1 == sum(map(abs, steps)))


def further(
    phi: float,
    known: frozenset[Steps],
    least: float | None,
    all_beads: Extent,
    rows: Callable[[int], Extent],
    layers: range,
    top: int,
) -> list[Steps]:
    """Give the steps beside ``known`` and contacts at which a gap may be below ``least`` or 0.

    ``layers``: of the lower beads; ``rows`` bounds those of a layer up to ``top``, and
    ``all_beads`` bounds all of them. Raises ``OverflowError`` where these are no numbers, or beads
    so far from their sites that too many may meet.
    """
    touch = (2 + 2 * all_beads.largest + max(least or 0.0, 0.0)) * (1 + ROOM)
    reach = touch + all_beads.apart(all_beads, phi)
    if not isfinite(reach):
        raise OverflowError
    if reach < _nearest(phi, known):
        return []
    bounds = cache(rows)

    @cache
    def apart(dj: int) -> float:
        lower = range(layers.start, min(layers.stop, top + 1 - dj))
        return max((bounds(j).apart(bounds(j + dj), phi) for j in lower), default=-inf)

    return sorted(
        (
            steps
            for steps in _within(phi, len(all_beads.low), reach, top)
            if _new(steps, known) and _distance(phi, steps) <= touch + apart(sum(steps))
        ),
        key=lambda steps: (sum(steps), steps),
    )


def may_meet(phi: float, lower: Extent, above: Extent, layers: int) -> bool:
    """Say whether beads may overlap others that lie ``layers`` or more above them.

    Whole layers lie so far apart as their height says.
    """
    height = layers * _rise(phi, len(lower.low))
    touch = 2 + lower.largest + above.largest
    return not height - lower.apart(above, phi) > touch * (1 + ROOM)
