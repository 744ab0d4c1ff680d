"""Where beads are and what they are called: sites, layers, regions of the lattice, and names.

A bead sits at site (i, j) with i + j even; it rests on x − e₊ = (i − 1, j − 1) and
x − e₋ = (i + 1, j − 1). A layer of a periodic packing has ``width`` = W beads, and column
q of layer j is i = 2q + (j mod 2), 0 ≤ i < 2W. Lengths are in units of the mean radius r.

Beads and contacts are named (i, j) and a branch, or (p, q, j) and an axis. Columns of names have
one entry a bead, or a contact, row by row.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, overload

import numpy as np
from numpy.typing import NDArray

from .branch import Branch, bead_names, directions

Array = NDArray[Any]
_NONE = np.empty(0, dtype=np.int64)


@dataclass(frozen=True)
class Layer:
    """A row of neighbouring beads: sites (first, j), (first + 2, j), … , ``count`` of them."""

    j: int
    first: int
    count: int

    def sites(self) -> range:
        """All i of the row, from left to right."""
        return range(self.first, self.first + 2 * self.count, 2)


class Rows(Sequence[Layer]):
    """Rows of neighbouring beads, one a layer from layer ``lowest`` up.

    They are held as two whole numbers a row, ``firsts`` and ``counts``: there may be millions.

    >>> Rows.between([0, -1], [0, 1], None)[1]
    Layer(j=1, first=-1, count=2)
    """

    def __init__(self, first: Any = (), count: Any = (), lowest: int = 0) -> None:
        """``first``, ``count``: shape (rows,)."""
        self.firsts, self.counts = np.asarray(first, np.int64), np.asarray(count, np.int64)
        self.lowest = lowest

    @classmethod
    def between(cls, first: Any, last: Any, width: int | None) -> "Rows":
        """Give rows of layers 0, 1, … from ``first`` to ``last``, each empty where that lies left.

        Where a row would meet its image it is the whole layer.
        """
        first, last = np.asarray(first), np.asarray(last)
        count = np.maximum((last - first) // 2 + 1, 0)
        if width is not None:
            first = np.where(count >= width, np.arange(len(first)) % 2, first)
            count = np.minimum(count, width)
        return cls(first, count)

    @cached_property
    def beads(self) -> int:
        """How many there are."""
        return int(self.counts.sum())

    @cached_property
    def starts_above(self) -> Array:
        """The number of each row's first bead of those above the base, and of all; (rows + 1,)."""
        return np.concatenate(([0], np.cumsum(np.where(np.arange(len(self)), self.counts, 0))))

    def above(self, j: int) -> slice:
        """Say which of the beads above the base are those of row j."""
        return slice(self.starts_above[j], self.starts_above[j + 1])

    @property
    def sites(self) -> tuple[Array, Array]:
        """The columns i and j of all beads, row after row."""
        starts = np.cumsum(self.counts) - self.counts
        steps = np.arange(self.beads) - starts.repeat(self.counts)
        return self.firsts.repeat(self.counts) + 2 * steps, self.layers.repeat(self.counts)

    @cached_property
    def alike(self) -> int | None:
        """W, where each may be the whole layer of a periodic packing of so many beads a layer."""
        width = int(self.counts[0]) if len(self) else 0
        whole = (self.counts == width) & (self.firsts == self.layers % 2)
        return width if whole.all() else None

    @property
    def lasts(self) -> Array:
        """The largest i of each row."""
        return np.asarray(self.firsts + 2 * (self.counts - 1))

    @property
    def layers(self) -> Array:
        """The layer of each row."""
        return np.arange(self.lowest, self.lowest + len(self))

    def __len__(self) -> int:
        return len(self.firsts)

    def __iter__(self) -> Iterator[Layer]:
        layers = range(self.lowest, self.lowest + len(self))
        return map(Layer, layers, self.firsts.tolist(), self.counts.tolist())

    @overload
    def __getitem__(self, which: int) -> Layer: ...
    @overload
    def __getitem__(self, which: slice) -> "Rows": ...

    def __getitem__(self, which: int | slice) -> "Layer | Rows":
        if isinstance(which, slice):
            start, _, step = which.indices(len(self))
            if step != 1:
                raise ValueError("rows that are not neighbours are no rows")
            return Rows(self.firsts[which], self.counts[which], self.lowest + start)
        row = range(len(self))[which]
        return Layer(self.lowest + row, int(self.firsts[row]), int(self.counts[row]))


@dataclass(frozen=True)
class Region:
    """Rows of beads, one a layer from the base (``rows[0]``) up; ``width`` None: infinite slab.

    In three dimensions a row is a whole layer of W² beads, and ``width`` their number: a step along
    e_1 (e_2) is one of p (q), and one along e_3 keeps both.
    """

    width: int | None
    rows: Rows
    dimension: int = 2

    @cached_property
    def top(self) -> int:
        """The highest layer."""
        return len(self.rows) - 1

    @cached_property
    def beads(self) -> int:
        """How many beads the region holds."""
        return int(self.starts[-1])

    @property
    def side(self) -> int:
        """W, in three dimensions."""
        return math.isqrt(self.width or 0)

    def bead(self, layer: Layer, column: int) -> tuple[int, ...]:
        """Name a bead of a row: (i, j), or (p, q, j)."""
        return self.naming.bead((layer.first + 2 * column, layer.j))

    @property
    def naming(self) -> "Naming":
        """How its beads and contacts are named."""
        return Naming(self.dimension, self.width if self.dimension == 2 else self.side)

    def step(self, axis: int, count: int) -> tuple[int, ...]:
        """Give so many steps along one base vector."""
        return tuple(count if a == axis else 0 for a in range(self.dimension))

    def columns(self, source: Layer, layer: Layer, steps: tuple[int, ...]) -> "Columns":
        """Say where in row ``source`` the beads x + Σ steps_a e_a are, for each x of ``layer``."""
        if self.dimension == 2:
            first = layer.first + steps[0] - steps[1]
            wanted = Layer(layer.j + sum(steps), first, layer.count)
            return columns_of(source, wanted, self.width)
        return _columns_of_square(self.side, steps[:-1])

    @cached_property
    def starts(self) -> Array:
        """The number of each row's first bead, and that of all beads; shape (rows + 1,)."""
        return np.concatenate(([0], np.cumsum(self.rows.counts)))

    def row(self, j: int) -> slice:
        """Say which of the beads are those of row j."""
        return slice(self.starts[j], self.starts[j + 1])

    def numbers(self, beads: Array) -> Array:
        """Number beads, columns of their names; −1 where the region lacks them."""
        i, j = self.naming.site(beads)
        there, j = j <= self.top, np.minimum(j, self.top)
        column = (i - self.rows.firsts[j]) // 2
        if self.width is not None:
            column %= self.width
        there &= (column >= 0) & (column < self.rows.counts[j])
        return np.where(there, self.starts[j] + column, -1)

    @cached_property
    def widest(self) -> int:
        """The beads of the longest row."""
        return int(self.rows.counts.max(initial=0))

    @cached_property
    def is_whole(self) -> bool:
        """Whether it is all of a periodic packing, up to its highest layer."""
        return self.width is not None and self.rows.alike == self.width


@lru_cache(maxsize=4)
def whole(width: int, height: int, dimension: int = 2) -> Region:
    """Give all beads of a periodic packing, (M + 1) rows of ``width``."""
    layers = np.arange(height + 1)
    return Region(width, Rows(layers % 2, np.full(height + 1, width)), dimension)


def standing_on_base(rows: Rows, width: int | None) -> Region:
    """Close ``rows`` (one for each layer 0, 1, …) downwards: every bead's supports are added."""
    if width is not None and rows[-1].count == width:
        return whole(width, len(rows) - 1)
    return Region(width, closed_below(rows.layers, rows.firsts, rows.lasts, width))


def closed_below(j: Array, first: Array, last: Array, width: int | None) -> Rows:
    """Give the rows of all beads from ``first`` to ``last`` of each layer, with what supports them.

    In layers whose beads all follow from those above, ``last`` lies left of ``first``.
    """
    empty = last < first
    far = np.iinfo(np.int64).max // 4
    left, right = np.where(empty, far, first - j), np.where(empty, -far, last + j)
    left, right = np.minimum.accumulate(left[::-1]), np.maximum.accumulate(right[::-1])
    return Rows.between(left[::-1] + j, right[::-1] - j, width)


class Columns(NamedTuple):
    """Columns of a row: a slice, or an array where they have gaps or jump.

    ``lacking`` marks those that the row lacks; None where it has all.
    """

    at: slice | Array
    lacking: Array | None = None


def columns_of(source: Layer, wanted: Layer, width: int | None) -> Columns:
    """Say in which columns of row ``source`` the beads of ``wanted`` are."""
    start = (wanted.first - source.first) // 2
    if width is not None:
        start %= width
    if 0 <= start <= source.count - wanted.count:
        return Columns(slice(start, start + wanted.count))
    return _scattered(start, wanted.count, source.count, width)


@lru_cache(maxsize=4)  # of a periodic packing each second layer is alike
def _scattered(start: int, count: int, there: int, width: int | None) -> Columns:
    """Give ``count`` columns from ``start`` on, around the period, of a row of ``there`` beads."""
    columns = start + np.arange(count)
    if width is not None:
        columns %= width
    lacking = (columns < 0) | (columns >= there)
    return Columns(np.where(lacking, -1, columns), lacking if lacking.any() else None)


@lru_cache(maxsize=4)
def _columns_of_square(side: int, steps: tuple[int, ...]) -> Columns:
    """Give the columns of a layer of spheres so many steps on, around the period."""
    if not any(steps):
        return Columns(slice(None))
    numbers = np.arange(side**2).reshape(side, side)
    return Columns(np.roll(numbers, [-step for step in steps], (0, 1)).ravel())


def taken(values: Any, columns: Columns, zero: Any = None) -> Any:
    """Take ``values`` of a row, (…, beads), at ``columns``; ``zero`` where the row lacks one.

    Without a ``zero`` that raises ``LookupError``. The result may share memory with ``values``.
    """
    picked = values[..., columns.at]
    if columns.lacking is not None:
        if zero is None:
            raise LookupError("a row lacks beads that are asked for")
        picked[..., columns.lacking] = zero
    return picked


class Block(NamedTuple):
    """Contacts of one branch below a row of upper beads."""

    branch: Branch
    row: Layer


class Naming(NamedTuple):
    """Names of a packing of layers of W (None: the slab), or in three dimensions W², beads."""

    dimension: int
    side: int | None

    @property
    def branches(self) -> tuple[Branch, ...]:
        """Along which contacts lead up."""
        return directions(self.dimension)

    @property
    def row(self) -> int | None:
        """How many beads a layer has."""
        return None if self.side is None else self.side ** (self.dimension - 1)

    @property
    def vectors(self) -> Array:
        """How the numbers that name a bead change along each direction, (directions, names)."""
        flat = [[1, 1], [-1, 1]]
        return np.array(flat if self.dimension == 2 else [[1, 0, 1], [0, 1, 1], [0, 0, 1]])

    def folded(self, beads: Array) -> Array:
        """Give beads, columns of their names, within the period."""
        if self.side is not None:
            beads[:-1] %= 2 * self.side if self.dimension == 2 else self.side
        return beads

    def site(self, bead: Any) -> tuple[Any, Any]:
        """Give the site, in the row of its layer, of a bead that is named as a scene does.

        Or give columns i and j, of columns of names. In three dimensions q neighbours q + 1.

        >>> Naming(3, 5).site((2, 1, 3)), Naming(3, 5).bead((23, 3))
        ((23, 3), (2, 1, 3))
        """
        if self.dimension == 2:
            i, j = bead
            return i, j
        assert self.side is not None
        p, q, j = bead
        return 2 * (p % self.side * self.side + q % self.side) + j % 2, j

    def bead(self, site: tuple[Any, Any]) -> tuple[Any, ...]:
        """Name a bead as a scene does; or give columns of names, of columns i and j."""
        if self.dimension == 2:
            return site
        assert self.side is not None
        i, j = site
        number = (i - j % 2) // 2
        return number // self.side, number % self.side, j

    def beyond(self, bead: Sequence[int], steps: Sequence[int]) -> tuple[int, ...]:
        """Name the bead so many steps along each base vector on, within the period."""
        return tuple(self.folded(np.array(bead) + np.array(steps) @ self.vectors).tolist())

    def contact(self, at: Sequence[Any]) -> Block:
        """Give the contact that a scene names by its lower bead and its branch."""
        *below, name = at
        branch = Branch(name)
        steps = [int(axis == branch.number) for axis in range(self.dimension)]
        i, j = self.site(self.beyond([*map(int, below)], steps))
        return Block(branch, Layer(j, i, 1))

    def above(self, lower: Array, number: Array) -> tuple[Array, Array]:
        """Give the upper beads of contacts, and which of them are images beside the lower ones.

        Beads are columns of their names; ``number`` is that of the direction.
        """
        beside = lower + self.vectors[number].T
        upper = self.folded(beside.copy())
        return upper, (upper != beside).any(axis=0)

    def beads(self, rows: Sequence[Layer]) -> dict[str, Array]:
        """Give the columns i and j, or p, q and j, of beads."""
        j = np.repeat([row.j for row in rows] or _NONE, [row.count for row in rows] or _NONE)
        i = np.concatenate([_NONE, *(row.first + 2 * np.arange(row.count) for row in rows)])
        return self._named(self.folded(np.stack(self.bead((i, j)))))

    def contacts(self, blocks: Sequence[Block]) -> dict[str, Array]:
        """Give the columns of the lower beads, and branch, of contacts."""
        counts = [row.count for _, row in blocks] or _NONE
        number = np.repeat([branch.number for branch, _ in blocks] or _NONE, counts)
        upper = np.stack([*self.beads([row for _, row in blocks]).values()])
        lower = self._named(self.folded(upper - self.vectors[number].T))
        return lower | {"branch": np.array(self.branches)[number]}

    def _named(self, numbers: Array) -> dict[str, Array]:
        return dict(zip(bead_names(self.dimension), numbers, strict=True))


def contacts_of(region: Region) -> tuple[Array, Array, Array]:
    """Number the lower and upper beads of a whole packing's contacts, (n, 2).

    Gives their directions and which of them cross the seam, too, (n,). They are in the order of
    the lower beads.
    """
    beads = np.stack([*region.naming.beads(region.rows[:-1]).values()])
    lower = beads.repeat(region.dimension, axis=1)
    number = np.tile(np.arange(region.dimension), beads.shape[1])
    upper, wraps = region.naming.above(lower, number)
    return np.stack([region.numbers(lower), region.numbers(upper)], axis=-1), number, wraps
