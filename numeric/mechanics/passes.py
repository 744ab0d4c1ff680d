"""Packings deposited, and loads carried down, by compiled loops in memory that is used again."""

from collections.abc import Callable
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from typing import Any

import numpy as np

from ..arithmetic.carried import Carried
from ..arithmetic.compiling import on_all_cores
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import per_direction
from ..lattice.layers import LazyRows, Region, Rows
from .kernels import NONE, constants, kernels
from .runs import layers_of, links_of, memory, padded, pairs_of, runs_of, turns_of
from .sweep import SIGNS, Forces, Loads, Memory, SolvedPacking


# Packings of one shape are often solved one after the other: their tables stay.
@lru_cache(maxsize=4)
def _supports(region: Region) -> Array:
    """Give the runs of ``loops.deposit``. Raise ``LookupError`` where a support is lacking."""
    steps = [region.step(a, -1) for a in range(region.dimension)]
    found = pairs_of(region, steps, max(region.widest, 1))
    before = np.append(0, np.cumsum(found[:, -1]))
    held = np.diff(before[np.searchsorted(found[:, 0], region.starts[1:])])
    lacking = held != region.rows.counts[1:]
    if lacking.any():
        j = int(np.argmax(lacking)) + 1
        raise LookupError(f"layer {j - 1} lacks supports of layer {j}")
    return found


class Deposition:
    """Deposits packings of one region, in memory that is used again for the next ones."""

    def __init__(self, phi: Fraction, region: Region, *, carried: bool = False) -> None:
        """``carried``: numbers carry their errors."""
        self.region, self.carried = region, carried
        d = region.dimension
        self.constants = constants(d, phi, carried=carried)
        self.runs = _supports(region)
        self.counts = region.rows.counts
        self.quantities = d + d * d
        self.block: Array = np.empty((0, 0, 0))
        self.most: Array = np.empty((0, 0))

    def __call__(self, rho: Array) -> Array | None:
        """Deposit packings of δr/r, (packings, parts, beads); None where not all rest.

        Gives the ``block`` of ``loops.deposit``. What was given before is overwritten. ``most``
        says how large each quantity is, (packings, quantities).
        """
        batch, (parts, beads) = len(rho), rho.shape[1:]
        lowest = 1 + rho[:, 0, : self.counts[0]]
        if not ((lowest > 0) & (lowest < np.inf)).all():
            return None
        if len(self.block) < batch:
            self.block = memory(batch, parts * self.quantities, beads)
        d, block = self.region.dimension, self.block[:batch]
        loop = kernels(d)
        self.most = np.zeros((batch, parts * self.quantities))
        for k in range(parts):
            own = slice(k * self.quantities, k * self.quantities + d)
            block[:, own, : self.counts[0]] = 0
        words, most = block.view(np.int64), self.most.view(np.int64)

        def part(of: slice) -> bool:
            return loop.deposit(rho[of], block[of], self.runs, self.constants, words[of], most[of])

        return block if on_all_cores(part, batch) else None


def told(
    phi: Fraction,
    region: Region,
    rho: Array,
    block: Array,
    most: Array,
    of_both: Callable[[Array, Array], Any] | None = None,
) -> SolvedPacking:
    """Tell row by row what loops have filled: ``rho`` (packings, parts, beads), and a ``block``.

    ``of_both`` makes of values and their errors what is told; without it these are values alone.
    """
    d, starts, counts = region.dimension, region.starts, region.rows.counts
    each = d + d * d

    def row(values: Array, quantity: int, j: int, lowest: int = 0) -> Any:
        own = values[0] if len(values) == 1 else values.swapaxes(0, 1)
        of = slice(starts[j], starts[j] + counts[j] * (j >= lowest))
        near = own[quantity, ..., of]
        return near if of_both is None else of_both(near, own[quantity + len(own) // 2, ..., of])

    def turned(a: int, j: int) -> tuple[Any, ...]:
        return tuple(row(block, d + a * d + b, j, 1) for b in range(d))

    def rows(of: Callable[..., Any], *which: Any) -> LazyRows[Any]:
        return LazyRows(len(counts), partial(of, *which))

    return SolvedPacking(
        phi,
        FLOAT64,
        region,
        rows(row, rho, 0),
        per_direction([rows(row, block, a) for a in range(d)]),
        per_direction([rows(turned, a) for a in range(d)]),
        Memory(rho[:, 0], block[:, :each], most[:, :each]),
    )


@lru_cache(maxsize=4)
def _loads(region: Region, own: Region, lowest: int) -> Array:
    """Give the runs of ``loops.sweep_down`` for the beads ``own`` of a region, above ``lowest``."""
    rows, d, starts, wide = own.rows, region.dimension, own.starts, own.widest
    turn = np.arange(len(rows)) % 2 * wide  # where a layer loses
    links, turns = [], []
    for one in [(0,) * d, *(region.step(a, 1) for a in range(d))]:
        forces = links_of(region, rows, rows, starts, one)
        lose = forces.copy()
        lose[:, 0] = (turn + sum(one) * wide) % (2 * max(wide, 1))
        links += [forces, links_of(region, rows, region.rows, region.starts, one), lose]
        turns += [turns_of(region, one)] * 3
    ends = [padded(1, size)[1] - NONE for size in (own.beads, region.beads)]
    nothing, layers = [*ends, 2 * wide] * (1 + d), layers_of(region, rows, starts)
    found = runs_of(d, layers, links, turns, nothing, max(wide, 1))
    first = np.searchsorted(found[:, 0], starts[lowest])
    return np.ascontiguousarray(found[first:][::-1])


class Descent:
    """Carries loads down through packings of one region, in memory that is used again."""

    def __init__(self, region: Region, rows: Rows, loads: Loads, *, carried: bool = False) -> None:
        """``rows``: those that are balanced, of these ``loads``."""
        d, self.carried = region.dimension, carried
        self.region, self.rows = region, rows
        own = Region(region.width, rows, d)
        own = region if own == region else own
        self.counts, self.starts, self.widest = own.rows.counts, own.starts, own.widest
        empty = np.flatnonzero(self.counts[1:] == 0)
        self.lowest = int(empty[-1]) + 2 if len(empty) else 1
        self.beads = int(self.starts[-1] - self.starts[1])  # that pass forces on
        self.runs = _loads(region, own, self.lowest)
        self.g = memory(1, (1 + carried) * d, int(self.starts[-1]))
        self.set(loads)

    @cached_property
    def nearest(self) -> Array:
        """The ordered forces below beads, (d, …), rounded once."""
        d, F = self.region.dimension, self.F[:, self.beads_below]
        return np.asarray(F[:d] + F[d:]) if self.carried else F

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """The smallest of all ordered forces below beads, and the largest absolute value."""
        F = self.F[: self.region.dimension, self.beads_below]
        least, most = float(F.min(initial=np.inf)), float(F.max(initial=-np.inf))
        return least, max(most, -least, 0.0)

    def set(self, loads: Loads) -> None:
        """Take other loads."""
        d, self.loads = self.region.dimension, loads
        self.F: Array = np.zeros_like(self.g[0])
        shares = self.g[0]  # whose changes are not there yet
        shares[:] = 0
        for a, (_, rows) in enumerate(loads):
            for j in range(self.lowest, len(self.rows)):
                of, share = slice(self.starts[j], self.starts[j + 1]), rows[j]
                if isinstance(share, Carried):
                    shares[a, of], shares[d + a, of] = share.value, share.error
                elif share is not None:
                    shares[a, of] = share
        kernels(d).straight_down(self.F, shares, self.runs, np.empty(0))

    def settle(self, g: Array) -> tuple[float, float]:
        """Round changes that carry errors once, in place; give the largest change, and error."""
        d, of = self.region.dimension, self.beads_below
        most = np.zeros(2 * d)
        loop, words = kernels(d).settle, g.view(np.int64)
        loop(g, words, of.start, of.stop - of.start, most.view(np.int64))
        return float(most[:d].max()), float(most[d:].max())

    def __call__(self, block: Array) -> Array | None:
        """Balance the forces of packings whose ``block`` that is; None where not all is in order.

        Gives ``g`` of ``loops.sweep_down``.
        """
        batch, rows = len(block), self.F.shape[0]
        if len(self.g) < batch:
            self.g = memory(batch, rows, int(self.starts[-1]))
        g, loop = self.g[:batch], kernels(self.region.dimension)

        def part(of: slice) -> bool:
            lost = np.zeros((rows, 2 * self.widest + NONE))
            good: bool = loop.sweep_down(self.F, block[of], g[of], lost, self.runs, np.empty(0))
            return good

        return g if on_all_cores(part, batch) else None

    @property
    def beads_below(self) -> slice:
        """Which of all numbers belong to beads that bear something."""
        return slice(self.starts[self.lowest], self.starts[-1])

    def told(self, g: Array, most: float | None) -> Forces:
        """Tell ``beads_below`` row by row, of changes ``g`` (packings, d, …).

        ``most``: the largest change, if that is known.
        """
        d, F = self.region.dimension, self.nearest
        starts = self.starts - self.starts[self.lowest]

        def row(values: Array, j: int) -> Array:
            there = self.counts[j] if j >= self.lowest else 0
            return values[..., starts[j] : starts[j] + there]

        def rows(values: Array) -> LazyRows[Array]:
            return LazyRows(len(self.counts), partial(row, values))

        changes = [g[0, a] if len(g) == 1 else g[:, a] for a in range(d)]
        return Forces(
            FLOAT64,
            self.region,
            self.rows,
            per_direction([rows(F[a]) for a in range(d)]),
            per_direction([rows(one) for one in changes]),
            F=F,
            g=g,
            hold=most is not None and self.bounds[0] - most > 2 * SIGNS * most,
        )
