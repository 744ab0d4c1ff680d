"""Sums over realisations that merge exactly: in any order and grouping, the same to the bit.

Of every packing and group of n contacts with changes g: a = Σ g/n and b = Σ g²/n, each a float64
that only the packing decides. Kept are Σ g and Σ g² over all contacts, exact; and Σ a, Σ b, Σ a²,
Σ a b, Σ b² over packings, exact in a and b: their scatter from packing to packing gives standard
errors, since the contacts of one packing are correlated.
"""

import math
import struct
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from numeric.budget import chunk_size
from numeric.engine import solve
from numeric.ensemble.exact_sum import ExactSum, digits, total, total_matrix, total_products
from numeric.ensemble.measure import Measurement
from numeric.lattice import Array
from numeric.systems import FLOAT64
from numeric.work import Work

# Numbers that are summed up together, few enough for a processor's cache.
PIECE = 1 << 15
_COUNT = struct.Struct("<q")


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums over ``realisations`` packings, with G groups, V variables and B bins.

    ``change`` and ``square`` (G,): Σ g, Σ g². ``means`` (2, G): Σ a, Σ b; ``products`` (3, G):
    Σ a², Σ ab, Σ b²; ``pairs`` (V (V + 1)/2,): Σ x_s x_t for s ≤ t, where x are the b of a profile
    and else the a. a is in units of 2^unit, b in 4^unit. ``tensile`` (G,): contacts that pull.
    ``bins`` (2, B + 2): counts, and their squares, which lie below, in and above the bins.
    """

    realisations: int
    change: ExactSum
    square: ExactSum
    means: ExactSum
    products: ExactSum
    pairs: ExactSum
    tensile: Array
    bins: Array

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
        )

    def to_bytes(self) -> bytes:
        """Write as bytes; equal sums give equal bytes."""
        counts = np.concatenate([self.tensile, self.bins.reshape(-1)]).astype("<i8")
        exact = (self.change, self.square, self.means, self.products, self.pairs)
        parts = [_COUNT.pack(self.realisations), counts.tobytes(), *(s.to_bytes() for s in exact)]
        return b"".join(parts)


def _shapes(m: Measurement) -> list[tuple[int, ...]]:
    G, V = m.groups, m.variables
    return [(G,), (G,), (2, G), (3, G), (V * (V + 1) // 2,)]


def _bins(m: Measurement) -> int:
    return len(m.edges) + 1 if m.edges else 0


def none(m: Measurement) -> Sums:
    """Give the sums of no realisation."""
    exact = [ExactSum.zero(*shape) for shape in _shapes(m)]
    return Sums(
        0,
        *exact,
        tensile=np.zeros(m.groups, np.int64),
        bins=np.zeros((2, _bins(m)), np.int64),
    )


def from_bytes(content: bytes, m: Measurement) -> Sums:
    """Read what ``to_bytes`` wrote. Raises ``ValueError`` where it is nothing of the kind."""
    counts = m.groups + 2 * _bins(m)
    at = _COUNT.size + 8 * counts
    if len(content) < at:
        raise ValueError("sums end early")
    (realisations,) = _COUNT.unpack_from(content)
    whole = np.frombuffer(content[_COUNT.size : at], "<i8").astype(np.int64)
    if realisations < 0 or (whole < 0).any():
        raise ValueError("sums count less than nothing")
    exact = []
    view = memoryview(content)
    for shape in _shapes(m):
        one, used = ExactSum.from_bytes(view[at:], shape)
        exact.append(one)
        at += used
    if at != len(content):
        raise ValueError("sums go on after their end")
    tensile, bins = whole[: m.groups], whole[m.groups :].reshape(2, -1)
    return Sums(realisations, *exact, tensile=tensile, bins=bins)


def measured(m: Measurement, realisations: Sequence[int], work: Work | None = None) -> Sums:
    """Solve realisations and sum them up; what the sweeps raise is passed on."""
    work = Work() if work is None else work
    summed = none(m)
    plan = replace(m.plan, realisations=len(realisations))  # decides who sweeps, never the bits
    size = 1 if plan.route == "line sums" else chunk_size(plan.region, FLOAT64, plan.scene)
    for at in range(0, len(realisations), size):
        chunk = realisations[at : at + size]
        with FLOAT64.active():
            solved = solve(plan, chunk, FLOAT64, work)
            with work.timed("statistics"):
                summed = summed + _summed(m, *m.changes(solved, len(chunk)))
    return summed


def _summed(m: Measurement, ordered: Array, changes: Array) -> Sums:
    """Sum up changes, (groups, realisations, members)."""
    groups, realisations, members = changes.shape
    parts = list(_pieces(groups, realisations * members))
    change, square, mean, mean_square, tensile = [], [], [], [], []
    for part in parts:
        g = changes[part]
        cut, shape = digits(g), g.shape[:2]
        first, second = total(cut, shape), total_products(cut, cut, shape)
        mean.append(first.rounded(-m.unit) / members)
        mean_square.append(second.rounded(-2 * m.unit) / members)
        change.append(first.over(1))
        square.append(second.over(1))
        tensile.append((ordered[part][:, None] + g < 0).sum(axis=(1, 2)))
    a, b = np.concatenate(mean), np.concatenate(mean_square)
    both = digits(np.stack([a, b]))
    of_a, of_b = [(k, q[0]) for k, q in both], [(k, q[1]) for k, q in both]
    chosen = of_b if m.quantity == "profile" else of_a
    products = [
        total_products(of_a, of_a, (groups,)),
        total_products(of_a, of_b, (groups,)),
        total_products(of_b, of_b, (groups,)),
    ]
    return Sums(
        realisations,
        _joined(change),
        _joined(square),
        total(both, (2, groups)),
        _stacked(products),
        total_matrix(chosen, groups) if m.covariance else ExactSum.zero(0),
        np.concatenate(tensile).astype(np.int64),
        _counted(m, changes),
    )


def _pieces(groups: int, each: int) -> Iterator[slice]:
    step = max(1, PIECE // max(each, 1))
    for at in range(0, groups, step):
        yield slice(at, min(at + step, groups))


def _joined(parts: list[ExactSum]) -> ExactSum:
    """Put arrays of sums one after the other, along their first axis."""
    low = min((p.low for p in parts if len(p.limbs)), default=0)
    high = max((p.low + len(p.limbs) for p in parts if len(p.limbs)), default=0)
    size = sum(p.shape[0] for p in parts)
    limbs = np.zeros((high - low, size, *parts[0].shape[1:]), dtype=np.int64)
    at = 0
    for p in parts:
        limbs[p.low - low : p.low - low + len(p.limbs), at : at + p.shape[0]] = p.limbs
        at += p.shape[0]
    return ExactSum(low, limbs)


def _stacked(parts: list[ExactSum]) -> ExactSum:
    return _joined([ExactSum(p.low, p.limbs[:, None]) for p in parts])


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
