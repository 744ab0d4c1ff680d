"""Measurements of each packing of an ensemble, and their sums over fixed blocks of packings.

A group holds n contacts that are alike: a layer and branch of a profile, one contact, or all. Of
their changes g from the ordered force, in float64, a packing gives a = Σ g/n and b = Σ g²/n. Blocks
depend on the scene alone, and are joined in their order: who solves them decides no bit.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, reduce
from itertools import pairwise, product
from operator import add
from typing import Any

import numpy as np

from ..arithmetic.errors import ArgumentError, quoted
from ..arithmetic.systems import FLOAT64, Array
from ..disorder.radii import BeadError
from ..mechanics import engine
from ..mechanics.problem import Problem, Route
from ..mechanics.sweep import Solved
from ..mechanics.work import Work
from ..planning.plan import Plan
from ..planning.planner import plan
from ..quantities.base import ContactQuantity, first_order_std
from ..scene.scene import CheckedScene, refuse
from ..scene.sections import SceneError
from ..statistics.confidence import looks
from ..statistics.moments import sums_of_products, unit_near

DEFAULT_BINS = 60
# Outer edges of a histogram, in units of the largest theoretical σ_f.
REACH = 6
# Beads, and packings, of a block: a second of work at most, of which a kill loses no more.
BEADS, PACKINGS = 8_000_000, 4096
# Means over groups that are kept of single packings, until they are summed up.
MEANS = 1_000_000

Block = tuple[int, int]
"""Realisations first … stop − 1."""


@dataclass(frozen=True)
class Measurement:
    """What is measured: the plan of one packing, and the edges of bins, float64."""

    plan: Plan
    edges: tuple[float, ...] = ()

    @property
    def problem(self) -> Problem:
        """What is solved."""
        return self.plan.problem

    @property
    def quantity(self) -> ContactQuantity:
        """What is asked of each packing."""
        assert isinstance(self.plan.quantity, ContactQuantity)
        return self.plan.quantity

    @property
    def counted(self) -> int:
        """B + 2: bins, and what lies outside; 0 where none are asked for."""
        return len(self.edges) + 1 if self.edges else 0

    @cached_property
    def unit(self) -> int:
        """The power of two in whose units changes are summed up (σ/r is near it)."""
        return math.frexp(unit_near(self.problem.radii.relative_std))[1] - 1

    @cached_property
    def labels(self) -> dict[str, list[Any]]:
        """Columns that name the groups, each of length ``groups``."""
        return self.quantity.labels(self.problem)

    @cached_property
    def groups(self) -> int:
        """How many groups there are."""
        return len(next(iter(self.labels.values()), [None]))

    @cached_property
    def members(self) -> int:
        """Contacts in a group."""
        return self.quantity.members(self.problem)

    def ordered(self) -> Array:
        """Give the ordered force of each group (of a group whose forces differ, their mean)."""
        ordered = replace(self.problem, route=Route.ORDERED)
        solved = engine.solve(ordered, [0], FLOAT64, Work())
        F, _ = self.quantity.changes(self.problem, solved, 1)
        return np.array([float(sum(map(Fraction, group)) / len(group)) for group in F.tolist()])

    def blocks(self, size: int) -> Iterator[Block]:
        """Cut realisations 0 … size − 1 where sums are looked at, and after so many packings."""
        beads = max(self.problem.region.beads, 1)
        most = 1 << max(min(PACKINGS, BEADS // beads), 1).bit_length() - 1
        for start, end in pairwise((0, *looks(size), size)):
            for first in range(start, end, most):
                yield first, min(first + most, end)


def measurement(scene: CheckedScene, *, reach: float | None = None) -> Measurement:
    """Say what is measured of an ensemble of a scene's packings.

    ``reach`` is the outer edge of a histogram, in units of force; by default six times the largest
    theoretical σ_f. Raises ``SceneError`` for what has no statistics over an ensemble.
    """
    ask = scene.ask
    refuse("ensemble", scene, reach=reach is not None)
    planned = plan(scene.asking(realisations=1))
    if planned.problem.route == Route.ORDERED:
        why = planned.skipped["disorder"]
        raise SceneError("disorder", None, f"every realisation would be the same: {why}")
    if planned.certified:
        raise SceneError("ask", None, f"an ensemble is solved in float64, but {planned.reason}")
    made = Measurement(planned)
    if not (made.groups and made.members):
        allowed = "bears on no contact that is asked for: there is nothing to gather"
        raise SceneError("load.kind", scene.load.kind, allowed)
    if ask.quantity != "histogram":
        return made
    reach = _usual_reach(made) if reach is None else reach / float(scene.load.magnitude)
    if not 0 < reach < 1e300:
        raise ArgumentError(
            f"reach = {quoted(reach)}: in units of the load, must lie between 0 and 1e300"
        )
    bins = ask.bins or DEFAULT_BINS
    edges = tuple(float(Fraction(reach) * (2 * k - bins) / bins) for k in range(bins + 1))
    if len(set(edges)) <= bins:
        raise SceneError("ask.bins", bins, "are more than float64 can tell apart here")
    return replace(made, edges=edges)


def _usual_reach(made: Measurement) -> float:
    """Give the outer edge that is taken where none is named."""
    contact, layers = made.problem.contact, made.plan.scene.ask.layers
    contacts = product(layers or range(made.problem.height), made.quantity.branches)
    theory = first_order_std(made.problem, [contact[1:]] if contact is not None else contacts)
    if theory is None:
        raise SceneError(
            "ask.quantity",
            "histogram",
            "no theory says how wide it will be here: give reach (--reach X), the outer edge "
            "of the bins in units of force",
        )
    return float(REACH * theory.max())


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums over packings, of G groups and B bins.

    ``packings`` are summed up, ``left_out`` can't be built, the first of them ``first_left_out``.
    ``tensile`` (G,) counts contacts that pull; ``bins`` (2, B + 2) are counts and, over packings,
    their squares. ``means`` (2, G) are those of a and b over packings, ``products`` (3, G) the sums
    of products of their deviations, aa, ab and bb; a is in units of 2^unit of the measurement.
    """

    packings: int
    left_out: int
    first_left_out: int
    tensile: Array
    bins: Array
    means: Array
    products: Array

    def __add__(self, other: "Sums") -> "Sums":
        """Join with later packings (Chan, Golub and LeVeque)."""
        together = self.packings + other.packings
        share = other.packings / max(together, 1)
        step = other.means - self.means
        return Sums(
            together,
            self.left_out + other.left_out,
            self.first_left_out if self.left_out else other.first_left_out,
            self.tensile + other.tensile,
            self.bins + other.bins,
            self.means + step * share,
            self.products + other.products + sums_of_products(step[None]) * (self.packings * share),
        )

    def to_bytes(self) -> bytes:
        """Write as bytes; equal sums give equal bytes."""
        head = np.array([self.packings, self.left_out, self.first_left_out])
        whole, real = (head, self.tensile, self.bins), (self.means, self.products)
        parts = [a.astype("<i8") for a in whole] + [a.astype("<f8") for a in real]
        return b"".join(part.tobytes() for part in parts)


def from_bytes(content: bytes, m: Measurement) -> Sums:
    """Read what ``to_bytes`` wrote. Raises ``ValueError`` where it is of another length."""
    G, B = m.groups, m.counted
    counts, real = np.split(np.frombuffer(content, "<i8"), [3 + G + 2 * B])
    head, tensile, bins = np.split(counts.astype(np.int64), [3, 3 + G])
    packings, left_out, first = head.tolist()
    means, products = np.split(real.view("<f8").astype(np.float64).reshape(5, G), [2])
    return Sums(packings, left_out, first, tensile, bins.reshape(2, B), means, products)


def solve_block(m: Measurement, first: int, stop: int) -> Sums:
    """Solve realisations first … stop − 1, and sum them up; some may be left out."""
    step = max(1, MEANS // m.groups)
    with FLOAT64.active():
        cuts = (range(k, min(k + step, stop)) for k in range(first, stop, step))
        return reduce(add, (summed(m, numbers) for numbers in cuts))


# Of packings by their numbers: means (packings, 2, G), and counts of contacts that pull, then of
# changes in bins (packings, G + B + 2).
_Solved = tuple[Sequence[int], Array, Array]


def summed(m: Measurement, numbers: Sequence[int]) -> Sums:
    """Solve packings and sum them up, if they can be built."""
    G, B = m.groups, m.counted
    nothing: _Solved = (), np.zeros((0, 2, G)), np.zeros((0, G + B), np.int64)
    parts = [nothing, *_solved(m, numbers)]
    lost = sorted(set(numbers).difference(*(some for some, *_ in parts)))
    means, counts = map(np.concatenate, list(zip(*parts, strict=True))[1:])
    tensile, binned = np.split(counts, [G], axis=1)
    bins = np.stack([binned.sum(axis=0), (binned**2).sum(axis=0)])
    mean, first = means.sum(axis=0) / max(len(means), 1), lost[0] if lost else 0
    products = sums_of_products(means - mean)
    return Sums(len(means), len(lost), first, tensile.sum(axis=0), bins, mean, products)


def _solved(m: Measurement, numbers: Sequence[int]) -> Iterator[_Solved]:
    """Solve packings; those that can't be built are found by halving."""
    problem = replace(m.problem, realisations=len(numbers))
    try:
        packings = engine.packings(problem, numbers, FLOAT64)
        yield from [_measured(m, solved, some) for solved, some in packings]
    except BeadError:
        if len(numbers) > 1:
            half = len(numbers) // 2
            yield from _solved(m, numbers[:half])
            yield from _solved(m, numbers[half:])


def _measured(m: Measurement, solved: Solved, some: Sequence[int]) -> _Solved:
    F, g = m.quantity.changes(m.problem, solved, len(some))
    # rows of a layout that does not depend on how many packings there are: nor does any bit
    scaled = np.ascontiguousarray(g) * 2.0**-m.unit
    means = np.stack([scaled.sum(axis=2), (scaled * scaled).sum(axis=2)]) / m.members
    if not np.isfinite(means).all():
        raise ArithmeticError("a change, or its square, is not finite")
    counts = np.zeros((len(some), m.groups + m.counted), np.int64)
    tensile, binned = np.split(counts, [m.groups], axis=1)
    if F.min() + g.min() < 0:
        tensile[:] = np.count_nonzero(F[:, None] + g < 0, axis=2).T
    if m.edges:
        for row, values in zip(binned, g[0], strict=True):
            places = np.searchsorted(m.edges, values, side="right")
            row[:] = np.bincount(places, minlength=m.counted)
    return some, np.moveaxis(means, 2, 0), counts


def why_left_out(m: Measurement, number: int) -> Exception | None:
    """Give what is raised for a realisation."""
    try:
        with FLOAT64.active():
            list(engine.packings(m.problem, [number], FLOAT64))
    except BeadError as error:
        return error
    return None
