"""Runs: neighbouring beads of a row whose supports, or whose upper beads, are neighbours, too.

Beads are numbered row after row, and a table of runs says once for all packings of a region which
bead bears on which: a loop over a run only counts upwards. Tables have one line a run.
"""

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np

from ..arithmetic.systems import Array
from .layers import Layer, Region, starts

# Kinds of rows that have the same runs: their runs, and the layers of that kind.
_Kinds = list[tuple[Array, Array]]


def of_supports(region: Region) -> Array:
    """Give the runs from the base up: first bead, its left and its right support, beads.

    Raises ``LookupError`` where the region lacks a support.
    """
    rows, width = region.rows, region.width

    def runs(j: int) -> Array:
        row, under = rows[j], rows[j - 1]
        left, right = (
            _places(Layer(j - 1, row.first + side, row.count), under, width) for side in (-1, 1)
        )
        if min(left.min(), right.min()) < 0:
            raise LookupError(f"layer {under.j} lacks supports of layer {row.j}")
        return np.array([(q, left[q], right[q], n) for q, n in _cuts(left, right)])

    def kind(j: int) -> tuple[int, ...]:
        row, under = rows[j], rows[j - 1]
        return row.first - under.first, row.count, under.count

    at = region.starts
    layers = range(1, region.top + 1)
    found = []
    for table, j in _kinds(layers, kind, runs, alike=region.is_whole):
        offsets = np.stack([at[j], at[j - 1], at[j - 1], 0 * j], axis=-1)
        found.append((j, table + offsets[:, None]))
    return _ordered(found, 4, downwards=False)


def of_loads(
    rows: Sequence[Layer], region: Region, F: tuple[Array, ...], missing: tuple[int, int]
) -> Array:
    """Give the runs of ``rows`` from the highest layer down, in a packing of ``region``.

    Columns: the first bead, the upper beads of the contacts to its right and left, beads; the three
    among the beads of the region; F⁺ of the bead and to its right, F⁻ of it and to its left; and
    the three in three rows of the widest, which layers take in turns, the last for nothing. ``F``
    says where F^± of a row begin. For what is not there, there is a row of nothing beyond the last
    bead, and in F one at ``missing``.
    """
    width, top = region.width, len(rows) - 1
    whole, packed = region.has_whole(rows), region.starts
    at = packed[: top + 2] if whole else starts(rows)
    size = region.widest if whole else max((row.count for row in rows), default=0)
    lowest = 0 if whole else next((j for j in range(top, 0, -1) if not rows[j].count), 0)

    def beside(j: int) -> tuple[Layer, Layer, Layer]:
        above = rows[j + 1] if j < top else Layer(j + 1, rows[j].first + 1, 0)
        over = region.rows[j + 1] if j < region.top else Layer(j + 1, rows[j].first + 1, 0)
        return region.rows[j], above, over

    def runs(j: int) -> Array:
        row = rows[j]
        own, above, over = beside(j)
        right, left = (Layer(j + 1, row.first + side, row.count) for side in (1, -1))
        here = _places(row, own, width)
        b, a = _places(right, above, width), _places(left, above, width)
        to_b, to_a = _places(right, over, width), _places(left, over, width)
        return np.array(
            [
                (q, b[q], a[q], n, here[q], to_b[q], to_a[q], q, b[q], q, a[q], q, b[q], a[q])
                for q, n in _cuts(here, b, a, to_b, to_a)
            ]
        )

    def kind(j: int) -> tuple[int, ...]:
        row = rows[j]
        return tuple(n for one in beside(j) for n in (row.first - one.first, one.count, row.count))

    plus, minus = F
    nowhere = np.array(
        [-1, at[-1], at[-1], -1, -1, packed[-1], packed[-1], -1, missing[0], -1, missing[1],
         -1, 2 * size, 2 * size]
    )  # fmt: skip
    found = []
    for table, j in _kinds(range(top, lowest, -1), kind, runs, alike=whole):
        up = np.minimum(j + 1, region.top)  # above that there is nothing
        new, old = j % 2 * size, (j + 1) % 2 * size
        offsets = np.stack(
            [at[j], at[j + 1], at[j + 1], 0 * j, packed[j], packed[up], packed[up],
             plus[j], plus[j + 1], minus[j], minus[j + 1], new, old, old],
            axis=-1,
        )  # fmt: skip
        found.append((j, np.where(table < 0, nowhere, table + offsets[:, None])))
    return _ordered(found, len(nowhere), downwards=True)


def of_pairs(region: Region, layers: range, offsets: Sequence[tuple[int, int]]) -> Array:
    """Give the runs of beads and of those at lattice distance (di, dj), as many as there are.

    Columns: first bead, first of the others, beads, which of the ``offsets``, row. The lower beads
    lie in the rows ``layers``, which come in order; smaller dj come first.
    """
    rows, width, at = region.rows, region.width, region.starts
    found = []
    for dj in sorted({dj for _, dj in offsets}):
        which = [k for k, offset in enumerate(offsets) if offset[1] == dj]
        js = range(layers.start, min(layers.stop, region.top + 1 - dj))

        def kind(j: int, dj: int = dj) -> tuple[int, ...]:
            return rows[j].first - rows[j + dj].first, rows[j].count, rows[j + dj].count

        def runs(j: int, dj: int = dj, which: Sequence[int] = which) -> Array:
            lines = []
            for k in which:
                wanted = Layer(j + dj, rows[j].first + offsets[k][0], rows[j].count)
                other = _places(wanted, rows[j + dj], width)
                lines += [(q, other[q], n, k, 0) for q, n in _cuts(other) if other[q] >= 0]
            return np.array(lines, dtype=np.int64).reshape(-1, 5)

        tables = []
        for table, j in _kinds(js, kind, runs, alike=region.is_whole):
            offset = np.stack([at[j], at[j + dj], 0 * j, 0 * j, j], axis=-1)
            tables.append((j, table + offset[:, None]))
        found.append(_ordered(tables, 5, downwards=False))
    return np.concatenate([np.empty((0, 5), dtype=np.int64), *found])


def of_steps(width: int, layers: int, steps: Sequence[tuple[int, ...]]) -> Array:
    """Give the same table for the beads of whole layers of W × W, and those so many steps on."""
    index = np.arange(width**2).reshape(width, width)
    found = []
    for k, (p, q, third) in enumerate(steps):
        other = np.roll(index, (-p, -q), (0, 1)).reshape(-1)
        above = p + q + third
        j = np.arange(max(layers - above, 0))
        table = np.array([(at, other[at], n, k, 0) for at, n in _cuts(other)])
        offset = np.stack([j * index.size, (j + above) * index.size, 0 * j, 0 * j, j], axis=-1)
        found.append((j, table + offset[:, None]))
    return _ordered(found, 5, downwards=False)


def _places(wanted: Layer, source: Layer, width: int | None) -> Array:
    """Give the places in row ``source`` of the sites of ``wanted``; −1 where it lacks one."""
    index = np.arange(wanted.count) + (wanted.first - source.first) // 2
    if width is not None:
        index %= width
    return np.where((index < 0) | (index >= source.count), -1, index)


def _cuts(*places: Array) -> list[tuple[int, int]]:
    """Split a row where places stop to be neighbours (or all missing): (first bead, beads)."""
    cut = np.zeros(len(places[0]) - 1, dtype=bool)
    for index in places:
        there = index >= 0
        cut |= (there[1:] != there[:-1]) | (there[1:] & (np.diff(index) != 1))
    first = [0, *(np.flatnonzero(cut) + 1).tolist(), len(places[0])]
    return [(q, end - q) for q, end in pairwise(first)]


def _kinds(
    layers: range,
    kind: Callable[[int], tuple[int, ...]],
    runs: Callable[[int], Array],
    *,
    alike: bool,
) -> _Kinds:
    """Sort layers by kind; ``alike``: they differ by parity alone, but for the first of them."""
    found: dict[tuple[int, ...], list[int]] = {}
    if alike and layers:
        found = {(0,): [layers[0]], (1,): [*layers[1::2]], (2,): [*layers[2::2]]}
    else:
        for j in layers:
            found.setdefault(kind(j), []).append(j)
    return [(runs(of[0]), np.array(of)) for of in found.values() if of]


def _ordered(found: list[tuple[Array, Array]], columns: int, *, downwards: bool) -> Array:
    """Put tables (layers, runs, columns) of several kinds into the order of their layers."""
    if not found:
        return np.empty((0, columns), dtype=np.int64)
    layer = np.concatenate([np.repeat(j, table.shape[1]) for j, table in found])
    lines = np.concatenate([table.reshape(-1, columns) for _, table in found])
    order = np.argsort(-layer if downwards else layer, kind="stable")
    return np.ascontiguousarray(lines[order], dtype=np.int64)
