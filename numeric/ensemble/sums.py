"""Sums over packings, joined in an order that nothing but the packings' numbers decides.

A packing says of each group of n contacts with changes g from the ordered force: a = Σ g/n and
b = Σ g²/n. Of several packings the means of these are kept, and sums of products of deviations from
the means. A block holds the packings k 2^l … (k + 1) 2^l − 1, and its sums are those of its two
halves joined: who solved which, in which order and how many at a time, decides no bit.
"""

from collections.abc import Generator, Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from functools import reduce
from operator import add
from typing import Any

import numpy as np

from ..arithmetic.systems import FLOAT64, Array
from ..disorder.radii import RadiusError
from ..mechanics import engine
from ..mechanics.problem import Problem, Route
from ..mechanics.sweep import NotStandingError, UnbuildableError
from ..statistics.moments import by_halves
from .measure import Measurement

# What is raised for a packing that is left out.
TROUBLE = (UnbuildableError, NotStandingError, RadiusError)
# Numbers that are joined at once: few enough for a cache.
AT_ONCE = 20_000
# Of no packing, where the lowest number of one is looked for.
NEVER = 2**62


_COUNTS = ("packings", "tensile", "bins")


@dataclass(frozen=True, eq=False)
class Sums:
    """Sums over packings, of G groups and B bins; a first axis may list several.

    ``first`` is the lowest number of a packing that is left out; ``packings`` (2,) counts those
    that are summed up, and left out; ``tensile`` (G,) contacts that pull. ``bins`` (3, B + 2):
    counts below, in and above the bins, their squares, and their products with all that a packing
    counts. ``means`` (2, G) are those of a and b over packings, ``products`` (3, G) the sums of
    products of deviations from them, row by row. a is in units of 2^unit of the measurement, b of
    its square.
    """

    first: Array
    packings: Array
    tensile: Array
    bins: Array
    means: Array
    products: Array

    @property
    def realisations(self) -> int:
        """N: packings that are summed up."""
        return int(self.packings[0])

    @property
    def unbuildable(self) -> int:
        """Packings that are left out: no forces can hold them, or a bead of them finds no rest."""
        return int(self.packings[1])

    @property
    def first_unbuildable(self) -> int | None:
        """The lowest number of one that is left out."""
        return int(self.first) if self.unbuildable else None

    @property
    def tried(self) -> int:
        """Packings that were summed up or left out."""
        return int(self.packings.sum())

    def _arrays(self) -> list[Array]:
        return [getattr(self, field.name) for field in fields(self)]

    def __getitem__(self, key: Any) -> "Sums":
        """Give some of several."""
        return Sums(*(array[key] for array in self._arrays()))

    @np.errstate(all="ignore")  # in a forged file numbers may be of any size
    def __add__(self, other: "Sums") -> "Sums":
        """Join with later packings (Chan, Golub and LeVeque)."""
        own, more = (one.packings[..., :1, None] for one in (self, other))
        share = more / np.maximum(own + more, 1)
        step, weight = other.means - self.means, own * share
        rows, columns = np.triu_indices(step.shape[-2])
        return replace(
            self,
            first=np.minimum(self.first, other.first),
            **{name: getattr(self, name) + getattr(other, name) for name in _COUNTS},
            means=self.means + step * share,
            products=self.products
            + other.products
            + step[..., rows, :] * step[..., columns, :] * weight,
        )

    def to_bytes(self) -> bytes:
        """Write as bytes; equal sums give equal bytes."""
        return b"".join(one.astype(f"<{one.dtype.kind}8").tobytes() for one in self._arrays())


def _shapes(m: Measurement) -> list[tuple[str, tuple[int, ...]]]:
    """Give kind and shape of each array."""
    G = m.groups
    whole = [(), (2,), (G,), (3, m.counted)]
    return [("i8", shape) for shape in whole] + [("f8", (2, G)), ("f8", (3, G))]


def from_bytes(content: bytes, m: Measurement) -> Sums:
    """Read what ``to_bytes`` wrote. Raises ``ValueError`` where it is nothing of the kind."""
    at, arrays, shapes = 0, list[Array](), _shapes(m)
    if len(content) != 8 * sum(int(np.prod(shape)) for _, shape in shapes):
        raise ValueError("sums are shorter or longer than they should be")
    for kind, shape in shapes:
        count = int(np.prod(shape))
        array = np.frombuffer(content, f"<{kind}", count, at).astype(kind).reshape(shape)
        if not np.isfinite(array).all() or (kind == "i8" and (array < 0).any()):
            raise ValueError("sums are no numbers, or count less than nothing")
        arrays.append(array)
        at += 8 * count
    return Sums(*arrays)


def nothing(m: Measurement, packings: int) -> Sums:
    """Give the sums of no packing, so many times; products can't be written to."""
    *small, (_, products) = _shapes(m)
    arrays = [np.zeros((packings, *shape), kind) for kind, shape in small]
    arrays[0] += NEVER
    arrays.append(np.broadcast_to(np.zeros(products), (packings, *products)))
    return Sums(*arrays)


@dataclass(frozen=True, eq=False)
class Block:
    """Sums over realisations first … stop − 1."""

    first: int
    stop: int
    sums: Sums

    def joins(self, other: "Block") -> bool:
        """Whether this and the block behind it are the halves of one."""
        size = self.stop - self.first
        alike = self.stop == other.first and other.stop - other.first == size
        return alike and size & (size - 1) == 0 and self.first % (2 * size) == 0


def ranges(first: int, stop: int, most: int) -> Iterator[tuple[int, int]]:
    """Cut realisations into the largest blocks of up to ``most``, a power of two.

    >>> list(ranges(5, 16, 4))
    [(5, 6), (6, 8), (8, 12), (12, 16)]
    """
    while first < stop:
        size = min(most, first & -first or most)
        while first + size > stop:
            size //= 2
        yield first, first + size
        first += size


def joined(blocks: Iterable[Block], apart: Sequence[int] = ()) -> list[Block]:
    """Join halves to blocks, and these again, but not where a range has to begin or end."""
    found: list[Block] = []
    for block in blocks:
        found.append(block)
        while len(found) > 1 and found[-2].joins(found[-1]) and found[-1].first not in apart:
            first, second = found[-2:]
            found[-2:] = [Block(first.first, second.stop, first.sums + second.sums)]
    return found


def total(m: Measurement, blocks: Iterable[Block]) -> Sums:
    """Join blocks in their order, the largest that there are."""
    return reduce(add, (block.sums for block in joined(blocks)), nothing(m, 1)[0])


def measured(m: Measurement, first: int, stop: int) -> list[Block]:
    """Solve realisations first … stop − 1, and sum them up block by block.

    Those that can't be built are left out, and counted.
    """
    found = nothing(m, stop - first)
    with FLOAT64.active():
        _solve(m, range(first, stop), first, found)
        return blocks_of(found, first)


def why_left_out(m: Measurement, number: int) -> Exception | None:
    """Give what is raised for a realisation."""
    try:
        with FLOAT64.active():
            list(_each(m, [number]))
    except TROUBLE as error:
        return error
    return None


def blocks_of(packings: Sums, first: int) -> list[Block]:
    """Join single packings, which are listed from number ``first`` on, to blocks."""
    stop = first + len(packings.first)
    cut = ranges(first, stop, 1 << stop.bit_length())
    return [Block(a, b, _join(packings[a - first : b - first])) for a, b in cut]


def _join(packings: Sums) -> Sums:
    count = len(packings.first)
    if count > 1 and count * packings.means[0].size > AT_ONCE:
        return _join(packings[: count // 2]) + _join(packings[count // 2 :])
    while len(packings.first) > 1:
        packings = packings[0::2] + packings[1::2]
    return packings[0]


def _solve(m: Measurement, numbers: Sequence[int], first: int, found: Sums) -> None:
    """Fill in single packings; those that can't be built are found by halving."""
    try:
        for some, means, tensile, counts in _each(m, numbers):
            at = np.asarray(some) - first
            found.packings[at] = 1, 0
            found.means[at], found.tensile[at] = means, tensile
            whole = counts.sum(axis=1, keepdims=True)
            found.bins[at] = np.stack([counts, counts**2, counts * whole], axis=1)
    except TROUBLE:
        if len(numbers) == 1:
            found.packings[numbers[0] - first], found.first[numbers[0] - first] = (0, 1), numbers[0]
            return
        half = len(numbers) // 2
        for part in numbers[:half], numbers[half:]:
            _solve(m, part, first, found)


# Numbers of packings, their means (packings, 2, G), contacts that pull (packings, G), and counts of
# bins (packings, B + 2).
_Solved = tuple[Sequence[int] | Array, Array, Array, Array]


def _each(m: Measurement, numbers: Sequence[int]) -> Iterator[_Solved]:
    quantity, problem = m.quantity, m.many
    if m.expected < len(numbers):
        problem = replace(problem, realisations=len(numbers))
    if problem.route == Route.EXACT and engine.compiles(problem, FLOAT64):
        numbers = yield from _compiled(m, problem, numbers)
    for solved, some in engine.packings(problem, numbers, FLOAT64, any_number=True, copied=True):
        F, g = quantity.changes(problem, solved, len(some))
        parts = np.split(g * 2.0**-m.unit, np.cumsum(m.sizes)[:-1], axis=2)
        sums = np.stack([[by_halves(x) for x in (part, part * part)] for part in parts], axis=-1)
        tensile = np.zeros((len(some), m.groups), np.int64)
        if F.min() + g.min() < 0:  # else no sum below can be negative
            tensile[:] = np.count_nonzero(F[:, None] + g < 0, axis=2).T
        yield some, _means(m, np.moveaxis(sums, 2, 0)), tensile, _counted(m, g[0])


def _means(m: Measurement, sums: Array) -> Array:
    """Give means from sums of g and of g², (packings, 2, groups, blocks)."""
    means = by_halves(sums) / m.members
    if not np.isfinite(means).all():
        raise ArithmeticError("a change, or its square, is not finite")
    return np.asarray(means)


def _counted(m: Measurement, values: Array) -> Array:
    """Count numbers (packings, members) by bin."""
    packings = len(values)
    if not m.counted:
        return np.zeros((packings, 0), np.int64)
    places = np.searchsorted(np.array(m.edges), values, side="right")
    places += m.counted * np.arange(packings)[:, None]
    counts = np.bincount(places.reshape(-1), minlength=m.counted * packings)
    return counts.reshape(packings, m.counted)


def _compiled(
    m: Measurement, problem: Problem, numbers: Sequence[int]
) -> Generator[_Solved, None, Sequence[int]]:
    """Solve and sum up by compiled loops, bitwise the same; give numbers that are left to others.

    Those are of packings out of the ordinary, and all where groups are no whole rows of contacts.
    """
    sweeps, loads = engine.ready(problem, FLOAT64)
    assert sweeps is not None
    assert loads is not None
    if m.runs is None:
        engine.keep(problem, sweeps, loads)
        return numbers
    from ..statistics.tally import tally

    descent, edges = sweeps.descent(problem.force_rows, loads), np.array(m.edges)
    count, runs = len(numbers), len(m.runs)
    sums, negative = np.empty((count, 2, runs)), np.empty((count, runs), np.int64)
    counts, good = np.zeros((count, m.counted), np.int64), np.ones(count, bool)
    step = engine.at_once(problem)
    for some in (slice(at, at + step) for at in range(0, count, step)):
        g = sweeps.changes(numbers[some], descent)
        if g is None:
            good[some] = False
        else:
            own = sums[some], negative[some], counts[some]
            tally(g, descent.F, m.runs, 2.0**-m.unit, edges, *own)
    engine.keep(problem, sweeps, loads)
    shape = m.groups, runs // m.groups
    means = _means(m, sums[good].reshape(good.sum(), 2, *shape))
    tensile = negative[good].reshape(good.sum(), *shape).sum(axis=-1)
    yield np.array(numbers)[good], means, tensile, counts[good]
    return [number for number, one in zip(numbers, good, strict=True) if not one]
