"""Sums over realisations that merge exactly: in any order and grouping, the same to the bit.

Of every packing and group of n contacts with changes g: a = Σ g/n and b = Σ g²/n, each a float64
that only the packing decides. Kept are Σ g and Σ g² over all contacts, exact; and Σ a, Σ b, Σ a²,
Σ a b, Σ b² over packings, exact in a and b: their scatter from packing to packing gives standard
errors, since the contacts of one packing are correlated.
"""

import struct
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ..arithmetic.systems import FLOAT64, Array
from ..mechanics import engine
from ..mechanics.engine import packings as solved_packings
from ..mechanics.problem import Problem, Route
from ..mechanics.work import Work
from ..statistics.exact_sum import (
    ExactSum,
    digits,
    rows_and_squares,
    total,
    total_matrix,
    total_products,
)
from . import networks
from .measure import Measurement

if TYPE_CHECKING:
    from ..mechanics.kernels import Descent
    from ..statistics.compiled import Tally

# Packings whose a and b are cut into digits together.
AT_ONCE = 1024
_COUNTS = struct.Struct("<3q")


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums over ``realisations`` packings, with G groups, V variables and B bins.

    ``change`` and ``square`` (G,): Σ g, Σ g². ``means`` (2, G): Σ a, Σ b; ``products`` (3, G):
    Σ a², Σ ab, Σ b²; ``pairs`` (V (V + 1)/2,): Σ x_s x_t for s ≤ t, where x are the b of a profile
    and else the a. a is in units of 2^unit, b in 4^unit. ``tensile`` (G,): contacts that pull.
    ``bins`` (2, B + 2): counts, and their squares, which lie below, in and above the bins.
    ``unbuildable`` packings more were left out, since no forces can hold them or no bead rests;
    ``first_unbuildable`` is the lowest number of one, −1 where there is none.
    """

    realisations: int
    change: ExactSum
    square: ExactSum
    means: ExactSum
    products: ExactSum
    pairs: ExactSum
    tensile: Array
    bins: Array
    unbuildable: int = 0
    first_unbuildable: int = -1

    @property
    def tried(self) -> int:
        """Packings that were summed up or left out."""
        return self.realisations + self.unbuildable

    def __add__(self, other: "Sums") -> "Sums":
        """Merge the sums of other realisations."""
        return Sums(
            self.realisations + other.realisations,
            self.change + other.change,
            self.square + other.square,
            self.means + other.means,
            self.products + other.products,
            self.pairs + other.pairs,
            self.tensile + other.tensile,
            self.bins + other.bins,
            self.unbuildable + other.unbuildable,
            min(filter(lambda k: k >= 0, (self.first_unbuildable, other.first_unbuildable)),
                default=-1),
        )  # fmt: skip

    def to_bytes(self) -> bytes:
        """Write as bytes; equal sums give equal bytes."""
        counts = np.concatenate([self.tensile, self.bins.reshape(-1)]).astype("<i8")
        exact = (self.change, self.square, self.means, self.products, self.pairs)
        head = _COUNTS.pack(self.realisations, self.unbuildable, self.first_unbuildable)
        return b"".join([head, counts.tobytes(), *(s.to_bytes() for s in exact)])


def _shapes(m: Measurement) -> list[tuple[int, ...]]:
    G, V = m.groups, m.variables
    return [(G,), (G,), (2, G), (3, G), (V * (V + 1) // 2,)]


def _bins(m: Measurement) -> int:
    return len(m.edges) + 1 if m.edges else 0


class AnySums(Protocol):
    """What sums of all kinds can do."""

    @property
    def realisations(self) -> int:
        """Packings that were summed up."""

    @property
    def unbuildable(self) -> int:
        """Packings that were left out."""

    @property
    def first_unbuildable(self) -> int:
        """The lowest number of one, −1 where there is none."""

    @property
    def tried(self) -> int:
        """Packings that were summed up or left out."""

    def __add__(self, other: Any) -> "AnySums":
        """Merge the sums of other realisations."""

    def to_bytes(self) -> bytes:
        """Write as bytes; equal sums give equal bytes."""


def of_none(m: Measurement) -> AnySums:
    """Give the sums of no realisation."""
    return networks.none(m) if m.of_networks else none(m)


def left_out(m: Measurement, number: int) -> AnySums:
    """Give the sums of a realisation that can't be solved."""
    if m.of_networks:
        return networks.left_out(m, number)
    return replace(none(m), unbuildable=1, first_unbuildable=number)


def none(m: Measurement) -> Sums:
    """Give the sums of no realisation of packings on the lattice."""
    change, square, means, products, pairs = (ExactSum.zero(*shape) for shape in _shapes(m))
    tensile, bins = np.zeros(m.groups, np.int64), np.zeros((2, _bins(m)), np.int64)
    return Sums(0, change, square, means, products, pairs, tensile, bins)


def from_bytes(content: bytes, m: Measurement) -> AnySums:
    """Read what ``to_bytes`` wrote. Raises ``ValueError`` where it is nothing of the kind."""
    if m.of_networks:
        return networks.from_bytes(content, m)
    counts = m.groups + 2 * _bins(m)
    at = _COUNTS.size + 8 * counts
    if len(content) < at:
        raise ValueError("sums end early")
    realisations, unbuildable, first = _COUNTS.unpack_from(content)
    whole = np.frombuffer(content[_COUNTS.size : at], "<i8").astype(np.int64)
    if realisations < 0 or unbuildable < 0 or (first < 0) != (not unbuildable) or (whole < 0).any():
        raise ValueError("sums count less than nothing")
    exact = []
    view = memoryview(content)
    for shape in _shapes(m):
        one, used = ExactSum.from_bytes(view[at:], shape)
        exact.append(one)
        at += used
    if at != len(content):
        raise ValueError("sums go on after their end")
    change, square, means, products, pairs = exact
    tensile, bins = whole[: m.groups], whole[m.groups :].reshape(2, -1)
    return Sums(
        realisations, change, square, means, products, pairs, tensile, bins, unbuildable, first
    )


def measured(m: Measurement, realisations: Sequence[int], work: Work | None = None) -> AnySums:
    """Solve realisations and sum them up; what the sweeps raise is passed on.

    Who sums up decides no bit: exact sums have but one value.
    """
    if m.of_networks:
        parts = [networks.measured(m, number) for number in realisations]
        return reduce(add, parts, networks.none(m))
    work = Work() if work is None else work
    problem = m.many
    if m.expected < len(realisations):
        problem = replace(problem, realisations=len(realisations))
    over_contacts, packings, left = [none(m)], list[Array](), realisations
    with FLOAT64.active():
        if problem.route == Route.EXACT and m.pieces is not None:
            summed, packings, left = _compiled(m, problem, realisations, work)
            over_contacts.append(summed)
        each = solved_packings(problem, left, FLOAT64, work, any_number=True, copied=True)
        for solved, chunk in each:
            with work.timed("statistics"):
                summed, means = _over_contacts(m, *m.changes(solved, len(chunk)))
            over_contacts.append(summed)
            packings.append(means)
    with work.timed("statistics"):
        summed = replace(reduce(add, over_contacts), realisations=len(realisations))
        return _over_packings(m, summed, packings)


def _compiled(
    m: Measurement, problem: Problem, realisations: Sequence[int], work: Work
) -> tuple[Sums, list[Array], Sequence[int]]:
    """Sum up by compiled loops, if they are taken, a packing or a few at a time.

    Gives also the a, b of packings, and realisations that are out of the ordinary.
    """
    if not engine.compiles(problem, FLOAT64):
        return none(m), [], realisations
    sweeps, loads = engine.ready(problem, FLOAT64)
    assert sweeps is not None
    assert loads is not None
    descent = sweeps.descent(problem.force_rows, loads)
    tally, packings, left = _tally(m, descent), list[Array](), list[int]()
    beads, step = problem.region.beads, engine.at_once(problem)
    for at in range(0, len(realisations), step):
        some = realisations[at : at + step]
        g = sweeps.changes(some, descent)
        means = None if g is None else tally.add(g)
        if means is None:
            left += some
        else:
            packings.append(means)
        work.did_rows("balanced", problem.region.rows, beads * len(some))
    engine.keep(problem, sweeps, loads)
    change, square = tally.sums()
    summed = replace(none(m), change=change, square=square, tensile=tally.tensile, bins=tally.bins)
    return summed, packings, left


def _tally(m: Measurement, descent: "Descent") -> "Tally":
    """Give compiled sums, the same numbers, of groups of many contacts."""
    from ..statistics.compiled import Tally

    assert m.pieces is not None
    pieces = []
    for group, branch, j in m.pieces:
        if descent.lowest <= j < len(descent.rows):  # some load reaches it
            side = branch.number
            start = descent.starts[j]
            pieces.append((group, side, start, start, descent.rows[j].count))
    table = np.array(pieces).reshape(-1, 5)
    return Tally(table, tuple(descent.F), m.groups, m.members, m.unit, m.edges)


def _over_contacts(m: Measurement, ordered: Array, changes: Array) -> tuple[Sums, Array]:
    """Sum up changes (groups, realisations, members); give also the a, b of each packing.

    Shape of the latter: (2, groups, realisations).
    """
    groups, realisations, members = changes.shape
    sums = rows_and_squares(changes.reshape(-1, members))
    by_packing = [one.reshaped(groups, realisations) for one in sums]
    summed = replace(
        none(m),
        realisations=realisations,
        change=by_packing[0].over(1),
        square=by_packing[1].over(1),
        tensile=_pulling(ordered, changes),
        bins=_counted(m, changes),
    )
    means = [one.rounded(-n * m.unit) / members for n, one in enumerate(by_packing, 1)]
    return summed, np.stack(means)


def _pulling(ordered: Array, changes: Array) -> Array:
    """Count negative forces in each group."""
    if ordered.min() + changes.min() >= 0:  # then no sum below can be negative
        return np.zeros(len(changes), np.int64)
    return np.asarray(np.count_nonzero(ordered[:, None] + changes < 0, axis=(1, 2)))


def _over_packings(m: Measurement, summed: Sums, packings: list[Array]) -> Sums:
    """Add the sums over the a, b of packings, arrays of shape (2, groups, realisations)."""
    values = np.concatenate(packings, axis=2)
    means, products, pairs = summed.means, summed.products, summed.pairs
    for at in range(0, values.shape[2], AT_ONCE):
        cut = digits(values[:, :, at : at + AT_ONCE])
        a, b = [(k, q[0]) for k, q in cut], [(k, q[1]) for k, q in cut]
        shape = (m.groups,)
        means += total(cut, (2, m.groups))
        products += _stacked([total_products(x, y, shape) for x, y in ((a, a), (a, b), (b, b))])
        if m.covariance:
            pairs += total_matrix(b if m.squares else a, m.groups)
    return replace(summed, means=means, products=products, pairs=pairs)


def _stacked(parts: list[ExactSum]) -> ExactSum:
    """Put sums of equal shapes into one array, along a new first axis."""
    shape = (len(parts), *parts[0].shape)
    planes = []
    for row, part in enumerate(parts):
        for k, limb in enumerate(part.limbs):
            plane = np.zeros(shape, dtype=np.int64)
            plane[row] = limb
            planes.append((part.low + k, plane))
    return ExactSum.of(planes, shape)


def _counted(m: Measurement, changes: Array) -> Array:
    """Count changes by bin, and add up squares of each packing's counts; (2, B + 2)."""
    if not m.edges:
        return np.zeros((2, 0), np.int64)
    size, realisations = len(m.edges) + 1, changes.shape[1]
    places = np.searchsorted(np.array(m.edges), changes, side="right")
    number = np.arange(realisations)[None, :, None]
    counts = np.bincount((places + size * number).reshape(-1), minlength=size * realisations)
    by_packing = counts.reshape(realisations, size)
    return np.asarray([by_packing.sum(axis=0), (by_packing**2).sum(axis=0)], dtype=np.int64)
