"""The sweep compiled: ``local`` recorded, and ``loops`` around it; bitwise that of ``sweep``.

The source that is compiled is put together when it is first needed, from what is recorded and from
``loops``, and lies in a file whose name is made from its content: so machine code that was kept of
an earlier run is taken only where nothing of what it was made from has changed. A packing out of
the ordinary (a bead that can't rest, a number that is not finite) is given back, and left to
``sweep``, whose errors name the bead.
"""

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from contextlib import suppress
from fractions import Fraction
from functools import cached_property, lru_cache, partial
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic import compiling
from ..arithmetic.carried import CARRYING, Carried
from ..arithmetic.compiling import CODES, on_all_cores
from ..arithmetic.recording import Code, module, positive_root
from ..arithmetic.systems import FLOAT64, Array
from ..disorder.radii import relative
from ..lattice.branch import per_direction
from ..lattice.layers import LazyRows, Region, Rows
from . import defects, local
from .local import RESOLUTION
from .sweep import SIGNS, Forces, Loads, Memory, SolvedPacking

FINITE = "abs({0}) < inf"
POSITIVE = "{0} > 0) & ({0} < inf"
# Zeros in memory, for beads that are not there: a run of such is no longer.
NONE = 32
# Numbers that are looked at together, in the nearest cache.
MOST = 512


class Kernels(NamedTuple):
    """The compiled loops of one dimension."""

    runs: Callable[..., int]
    deposit: Callable[..., bool]
    straight_down: Callable[..., None]
    sweep_down: Callable[..., bool]
    settle: Callable[..., None]
    gaps: Callable[..., float]
    relative: Callable[..., bool]
    relative_errors: Callable[..., bool]
    scaled: Callable[..., bool]
    scaled_errors: Callable[..., bool]


def source(dimension: int) -> str:
    """Put together the source of all kernels of one dimension."""
    names = f"D, NONE, RESOLUTION, TOGETHER = {dimension}, {NONE}, {RESOLUTION!r}, {MOST}"
    loops = Path(__file__).with_name("loops.py").read_text(encoding="utf-8")
    recorded = [
        _rest(dimension),
        _rest_errors(dimension),
        _balance(dimension),
        _balance_errors(dimension),
        _gap(dimension),
    ]
    for carried in (False, True):
        recorded += [_order(dimension, carried=carried), _relative(carried=carried)]
        recorded.append(_scaled(carried=carried))
    imports = (
        "from math import inf, sqrt\nfrom force_diffusion.numeric.arithmetic.compiling import "
        "alone, fma, pitch, placed, taken"
    )
    # what compiles them has no part in the text, but in what comes of it
    with_what = hashlib.sha256(Path(compiling.__file__).read_text(encoding="utf-8").encode())
    loops = f"{loops}\n# compiled as said in {with_what.hexdigest()[:24]}"
    return module(recorded, f"{loops}\n\n{imports}\n{names}", Kernels._fields)


LOADED: set[int] = set()
"""Dimensions whose loops are compiled in this process."""


@lru_cache(maxsize=4)
def kernels(dimension: int) -> Kernels:
    """Give the compiled loops; what an earlier run compiled is kept where that is possible."""
    text = source(dimension)
    name = f"force_diffusion_sweeps_{hashlib.sha256(text.encode()).hexdigest()[:24]}"
    found = ModuleType(name)
    found.__file__ = _kept(text, name)
    made = Path(found.__file__).parent.glob(f"__pycache__/{name}.sweep_down*")
    if not any(made) and sys.stderr is not None and sys.stderr.isatty():
        print("compiling the sweeps for this machine, once: about 4 s", file=sys.stderr, flush=True)
    sys.modules[name] = found  # machine code that was kept asks for it
    LOADED.add(dimension)
    exec(compile(text, found.__file__, "exec"), vars(found))
    return Kernels(*(vars(found)[field] for field in Kernels._fields))


def _kept(text: str, name: str) -> str:
    """Lay a source down where the compiler keeps what it made of it; give the file's name."""
    path = CODES / f"{name}.py"
    with suppress(OSError):
        if not path.exists():
            CODES.mkdir(parents=True, exist_ok=True)
            handle, made = tempfile.mkstemp(dir=CODES)
            with open(handle, "w", encoding="utf-8") as file:
                file.write(text)
            os.replace(made, path)
    return str(path)


class _Recording:
    """Names of quantities of beads, and of constants, that carry errors or not.

    ``arrays`` says how many quantities each array has, whose errors lie behind them. Code of
    numbers that carry errors fills in these alone, once the values are there.
    """

    def __init__(self, name: str, arrays: dict[str, int], constants: int, *, carried: bool) -> None:
        name += "_errors" * carried
        self.code, self.carried, self.arrays = Code(name, list(arrays)), carried, arrays
        self.constants: list[Any] = [self.code.constant() for _ in range(constants)]
        if carried:
            self.constants = [Carried(one, self.code.constant()) for one in self.constants]

    def take(self, array: str, row: int, place: int) -> Any:
        """Give a quantity of the beads at a place of the run."""
        value = self.code.takes(array, row, place)
        if not self.carried:
            return value
        return Carried(value, self.code.takes(array, self.arrays[array] + row, place))

    def several(self, array: str, first: int, count: int, place: int) -> tuple[Any, ...]:
        """Give quantities that lie one behind the other."""
        return tuple(self.take(array, first + k, place) for k in range(count))

    def values(self, array: str, first: int, count: int, place: int) -> tuple[Any, ...]:
        """Give such quantities without their errors."""
        return tuple(self.code.takes(array, first + k, place) for k in range(count))

    def turns(self, d: int, place: int) -> list[tuple[Any, ...]]:
        """Give δn of the contacts below the beads at a place."""
        return [self.several("block", d + a * d, d, place) for a in range(d)]

    def give(self, array: str, first: int, place: int | None, found: Sequence[Any]) -> None:
        """Put quantities there, or their errors."""
        behind = self.arrays[array] if self.carried else 0
        for row, one in enumerate(found, first + behind):
            error = one.error if isinstance(one, Carried) else one
            self.code.gives(array, row, place, error)


def _sqrt(value: Any) -> Any:
    return value.sqrt()


def _supported(of: _Recording, d: int) -> tuple[Any, ...]:
    """Give what a bead rests on, as ``local.rest`` takes it."""
    own, *supports = range(1 + d)
    under = [of.several("block", 0, d, place) for place in supports]
    rho_under = tuple(of.take("rho", 0, place) for place in supports)
    return under, of.take("rho", 0, own), rho_under, local.Metric(*of.constants)


def _rest(d: int) -> Code:
    of = _Recording("rest", {"rho": 1, "block": d + d * d}, 3, carried=False)
    under, rho, rho_under, m = _supported(of, d)
    found = local.rest(under, rho, rho_under, m, _sqrt, linear=False)
    for value in (1 + rho, *found.holds):
        of.code.demand(value, POSITIVE)
    of.give("block", 0, 0, [*found.c, *(x for v in found.dn for x in v)])
    return of.code


def _rest_errors(d: int) -> Code:
    of = _Recording("rest", {"rho": 1, "block": d + d * d}, 3, carried=True)
    c, *dn = (of.values("block", row, d, 0) for row in range(0, d + d * d, d))
    moved, off = defects.rest_errors(c, dn, *_supported(of, d))
    of.give("block", 0, 0, [*moved, *(x for v in off for x in v)])
    return of.code


def _borne(of: _Recording, d: int) -> list[tuple[Any, ...]]:
    """Give what the contacts above a bead bear, and their δn."""
    ups = range(3, 3 * (d + 1), 3)
    turns = [of.several("block", d + a * d, d, up + 1) for a, up in enumerate(ups)]
    return [(of.take("F", a, up), of.take("g", a, up), turns[a]) for a, up in enumerate(ups)]


def _balance(d: int) -> Code:
    of = _Recording("balance", {"F": d, "block": d + d * d, "g": d, "lost": d}, 0, carried=False)
    own, here, new = range(3)
    above = [(*one, of.take("lost", a, 3 * a + 5)) for a, one in enumerate(_borne(of, d))]
    F, dn = of.several("F", 0, d, own), of.turns(d, here)
    found = local.balance(above, F, dn, linear=False, compensated=True)
    of.code.demand(found.det * found.det, POSITIVE)
    for value in found.g:
        of.code.demand(value, FINITE)
    of.give("g", 0, own, found.g)
    of.give("lost", 0, new, found.lost)
    return of.code


def _balance_errors(d: int) -> Code:
    of = _Recording("balance", {"F": d, "block": d + d * d, "g": d}, 0, carried=True)
    own, here = range(2)
    F, dn = of.several("F", 0, d, own), of.turns(d, here)
    of.give("g", 0, own, defects.balance_errors(of.values("g", 0, d, own), _borne(of, d), F, dn))
    return of.code


def _order(d: int, *, carried: bool) -> Code:
    """Loads go straight down: ordered forces, of the same runs as ``_balance``."""
    of = _Recording("order", {"F": d, "shares": d}, 0, carried=carried)
    of.give("F", 0, 0, [of.take("F", a, 3 * (a + 1)) + of.take("shares", a, 0) for a in range(d)])
    return of.code


def _gap(d: int) -> Code:
    of = _Recording("gap", {"rho": 1, "block": d, "gaps": 1}, 5 + d, carried=False)
    here, there = (of.several("block", 0, d, place) for place in range(2))
    rho, other = (of.take("rho", 0, place) for place in range(2))
    phi, own, cross, *steps, square, excess = of.constants
    found = local.gap(steps, square, excess, local.less(there, here), rho + other,
                      local.Metric(phi, own, cross), positive_root)  # fmt: skip
    of.give("gaps", 0, None, [found])
    return of.code


def _relative(*, carried: bool) -> Code:
    of = _Recording("relative", {"radii": 1, "rho": 1}, 2, carried=carried)
    radii = of.code.takes("radii", 0, 0)
    of.give("rho", 0, 0, [relative(Carried(radii) if carried else radii, *of.constants)])
    return of.code


def _scaled(*, carried: bool) -> Code:
    of = _Recording("scaled", {"radii": 1, "rho": 1}, 1, carried=carried)
    deviates = of.code.takes("radii", 0, 0)
    of.give("rho", 0, 0, [(Carried(deviates) if carried else deviates) * of.constants[0]])
    return of.code


@lru_cache(maxsize=4)
def constants(dimension: int, phi: Fraction, *, carried: bool) -> Array:
    """Give what the ordered packing decides, as kernels take it."""
    m = local.metric(dimension, phi, (CARRYING if carried else FLOAT64).scalar)
    return numbers(m, carried=carried)


def numbers(of: Sequence[Any], *, carried: bool) -> Array:
    """Give numbers as kernels take them, their errors behind all values."""
    flat = [one.value for one in of] + [one.error for one in of] if carried else list(of)
    return np.array(flat, dtype=np.float64)


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
    side, others = region.side, region.dimension - 2
    rows = np.arange(side**others).reshape((side,) * others)
    return np.roll(rows, tuple(-step for step in steps[:others]), range(others)).ravel()


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

    def __init__(
        self, phi: Fraction, region: Region, *, carried: bool = False, block: Array | None = None
    ) -> None:
        """``carried``: numbers carry their errors; ``block``: memory of the last ones."""
        self.region, self.carried = region, carried
        d = region.dimension
        self.constants = constants(d, phi, carried=carried)
        self.runs = _supports(region)
        self.counts = region.rows.counts
        self.quantities = d + d * d
        fits = block is not None and block.shape[1:] == self.shape
        self.block = block if block is not None and fits else np.empty((0, 0, 0))
        self.most = np.empty((0, 0))

    @property
    def shape(self) -> tuple[int, int]:
        """Quantities, and the numbers of each, in memory."""
        return padded((1 + self.carried) * self.quantities, self.region.beads)

    def __call__(self, rho: Array, base: Array | None = None) -> Array | None:
        """Deposit packings of δr/r, (packings, parts, beads); None where not all rest.

        Gives the ``block`` of ``loops.deposit``. ``base`` holds c of the lowest row, if it is not
        the ordered base. What was given before is overwritten. ``most`` says how large each
        quantity is, (packings, quantities).
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
            block[:, own, : self.counts[0]] = 0 if base is None else base[k * d : (k + 1) * d]
            if base is not None:
                self.most[:, own] = np.abs(base[k * d : (k + 1) * d]).max(axis=1, initial=0)
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

    def __init__(
        self, region: Region, rows: Rows, loads: Loads, *, carried: bool = False,
        g: Array | None = None,
    ) -> None:  # fmt: skip
        """``rows``: those that are balanced, of these ``loads``; ``g``: memory of the last ones."""
        d, self.carried = region.dimension, carried
        self.region, self.rows = region, rows
        own = Region(region.width, rows, d)
        own = region if own == region else own
        self.counts, self.starts, self.widest = own.rows.counts, own.starts, own.widest
        empty = np.flatnonzero(self.counts[1:] == 0)
        self.lowest = int(empty[-1]) + 2 if len(empty) else 1
        self.beads = int(self.starts[-1] - self.starts[1])  # that pass forces on
        self.runs = _loads(region, own, self.lowest)
        self.lost = np.empty((0, 0))
        fits = g is not None and g.shape[1:] == self.shape
        self.g = g if g is not None and fits else memory(1, self.shape[0], int(self.starts[-1]))
        self.set(loads)

    @cached_property
    def nearest(self) -> tuple[Array, Array]:
        """The ordered forces below beads, (d, …), rounded once, and what that leaves."""
        d, F = self.region.dimension, self.F[:, self.beads_below]
        return Carried(F[:d], F[d:]).nearest

    @cached_property
    def bounds(self) -> tuple[float, float]:
        """The smallest of all ordered forces below beads, and the largest absolute value."""
        F = self.F[: self.region.dimension, self.beads_below]
        least, most = float(F.min(initial=np.inf)), float(F.max(initial=-np.inf))
        return least, max(most, -least, 0.0)

    @property
    def shape(self) -> tuple[int, int]:
        """Quantities, and the numbers of each, in memory."""
        return padded((1 + self.carried) * self.region.dimension, int(self.starts[-1]))

    def set(self, loads: Loads) -> None:
        """Take other loads."""
        d, self.loads = self.region.dimension, loads
        self.F, shares = np.zeros(self.shape), self.g[0]  # whose changes are not there yet
        shares[:] = 0
        for a, (_, rows) in enumerate(loads):
            for j in range(self.lowest, len(self.rows)):
                of, share = slice(self.starts[j], self.starts[j + 1]), rows[j]
                if isinstance(share, Carried):
                    shares[a, of], shares[d + a, of] = share.value, share.error
                elif share is not None:
                    shares[a, of] = share
        kernels(d).straight_down(self.F, shares, self.runs, np.empty(0))

    def settled(self, g: Array) -> tuple[float, float, float]:
        """Round changes that carry errors once, in place; rests take the place of errors.

        Give the largest change, the largest error of one, and the largest rest.
        """
        d, of = self.region.dimension, self.beads_below
        most = np.zeros(2 * d + 1)
        loop, words = kernels(d).settle, g.view(np.int64)
        loop(g, words, of.start, of.stop - of.start, most.view(np.int64))
        return float(most[:d].max()), float(most[d : 2 * d].max()), float(most[-1])

    def __call__(self, block: Array, above: Array | None = None) -> Array | None:
        """Balance the forces of packings whose ``block`` that is; None where not all is in order.

        Gives ``g`` of ``loops.sweep_down``. ``above`` holds what ``row`` gave of the highest row,
        if that is balanced already.
        """
        batch, rows, top = len(block), self.F.shape[0], len(self.rows) - 1
        if len(self.g) < batch:
            self.g = memory(batch, rows, int(self.starts[-1]))
        g, runs = self.g[:batch], self.runs
        loop = kernels(self.region.dimension)
        if above is not None:
            runs = runs[runs[:, 0] < self.starts[top]]

        def part(of: slice) -> bool:
            lost = np.zeros((rows, 2 * self.widest + NONE))
            if above is not None:
                g[of, :, self.starts[top] : self.starts[top + 1]] = above[0]
                lost[:, top % 2 * self.widest :][:, : self.counts[top]] = above[1]
            good = loop.sweep_down(self.F, block[of], g[of], lost, runs, np.empty(0))
            if batch == 1:
                self.lost = lost
            return good

        return g if on_all_cores(part, batch) else None

    def row(self, j: int) -> Array:
        """Give g and what was lost of the lowest row but one that was balanced, (2, …, beads)."""
        turn = j % 2 * self.widest
        lost = self.lost[:, turn : turn + self.counts[j]]
        return np.stack([self.g[0, :, self.starts[j] : self.starts[j + 1]], lost])

    @property
    def beads_below(self) -> slice:
        """Which of all numbers belong to beads that bear something."""
        return slice(self.starts[self.lowest], self.starts[-1])

    def told(
        self, F: Array, g: Array, most: float | None = None, left: float | None = None
    ) -> Forces:
        """Tell ``beads_below`` row by row: ordered forces (d, …), changes (packings, d, …).

        ``most``: the largest change, if that is known; ``left``: as ``Forces`` have it.
        """
        d = self.region.dimension

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
            left=left,
        )
