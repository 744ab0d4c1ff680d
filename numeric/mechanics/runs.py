"""Beads in memory as compiled loops take them: rows one after the other, and tables of runs.

A run is as many neighbouring beads as have their neighbours side by side, too (see ``loops``).
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..lattice.layers import Region, Rows
from .kernels import NONE, kernels


def memory(batch: int, quantities: int, size: int) -> Array:
    """Give memory, (batch, quantities, size and more).

    It is one piece, since the system hands out big pieces faster. Quantities at distances that are
    multiples of 4096 bytes would compete for the same places of the cache. The last ``NONE`` of
    each are zeros.
    """
    block = np.empty((batch, *padded(quantities, size)))
    block[..., -NONE:] = 0.0
    return block


def padded(quantities: int, size: int) -> tuple[int, int]:
    """Give the shape of ``memory`` of one packing."""
    end = size + NONE
    return quantities, end + (72 - end) % (512 if end > 512 else 64)


def layers_of(region: Region, rows: Rows, starts: Array) -> Array:
    """Give each layer's first bead, beads, and beads in a row."""
    counts = rows.counts
    own = np.maximum(counts, 1) if region.dimension == 2 else np.full_like(counts, region.side)
    return np.stack((starts[: len(rows)], counts, own), 1)


def turns_of(region: Region, steps: tuple[int, ...]) -> Array:
    """Say for each row of a layer in which one the beads lie that are so many steps on."""
    if region.dimension == 2:
        return np.zeros(1, np.int64)
    return np.roll(np.arange(region.side), -steps[0])


def links_of(
    region: Region, rows: Rows, sources: Rows, starts: Array, steps: tuple[int, ...]
) -> Array:
    """Say where the beads lie that are so many steps on from each row of beads, (layers, 4).

    ``starts`` are the first beads of the ``sources`` in which they lie. See ``loops``.
    Where no row is there, its length is 0.
    """
    on = np.arange(len(rows)) + sum(steps)
    there = (on >= 0) & (on < len(sources)) & (rows.counts > 0)
    on = np.where(there, on, 0)
    numbers: tuple[Any, ...]
    if region.dimension == 2:
        shift = (rows.firsts + steps[0] - steps[1] - sources.firsts[on]) // 2
        numbers = starts[on], sources.counts[on], shift, region.width or 0
    else:
        numbers = starts[on], region.side, steps[-2], region.side
    return np.stack(np.broadcast_arrays(*numbers), 1) * there[:, None]


def runs_of(
    dimension: int, layers: Array, links: Sequence[Array], turns: Sequence[Array],
    nothing: Sequence[int], most: int,
) -> Array:  # fmt: skip
    """Give the table ``loops.runs``, the lowest layer first; ``links`` and ``turns`` by place."""
    cut = kernels(dimension).runs
    own = np.stack(links, 1), np.stack(turns), np.array(nothing)
    count, found = 3 * len(layers) * turns[0].size, np.empty((0, 0), np.int64)
    while len(found) <= count:
        found = np.empty((count + 1, len(links) + 1), np.int64)
        count = cut(layers, *own, most, found)
    return found[:count]


def pairs_of(region: Region, steps: Sequence[tuple[int, ...]], most: int) -> Array:
    """Give runs of beads and of those that lie so many steps on, where all of them are there."""
    d, rows = region.dimension, region.rows
    both = [(0,) * d, *steps]
    links = [links_of(region, rows, rows, region.starts, one) for one in both]
    turns = [turns_of(region, one) for one in both]
    layers, nothing = layers_of(region, rows, region.starts), [-1] * len(both)
    return runs_of(d, layers, links, turns, nothing, most)
