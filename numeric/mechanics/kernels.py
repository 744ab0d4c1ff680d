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
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic import compiling
from ..arithmetic.carried import CARRYING, Carried
from ..arithmetic.compiling import CODES, on_all_cores
from ..arithmetic.recording import STRIP, Code, module, positive_root
from ..arithmetic.systems import FLOAT64, Array, NumberSystem
from ..lattice.branch import per_direction
from ..lattice.layers import Layer, LazyRows, Region, whole
from . import local
from .local import RESOLUTION
from .sweep import Forces, Loads, Memory, SolvedPacking, straight_down

FINITE = "abs({0}) < inf"
POSITIVE = "{0} > 0) & ({0} < inf"


class Kernels(NamedTuple):
    """The compiled loops of one dimension, with or without errors."""

    deposit: Callable[..., bool]
    sweep_down: Callable[..., bool]
    gaps: Callable[..., float]


def source(dimension: int, *, carried: bool) -> str:
    """Put together the source of all kernels of one dimension."""
    names = f"D, PARTS, STRIP, RESOLUTION = {dimension}, {1 + carried}, {STRIP}, {RESOLUTION!r}"
    loops = Path(__file__).with_name("loops.py").read_text(encoding="utf-8")
    recorded = [
        _rest(dimension, carried=carried),
        _balance(dimension, carried=carried),
        _gap(dimension),
    ]
    imports = (
        "from math import inf, sqrt\nfrom force_diffusion.numeric.arithmetic.compiling import fma"
    )
    # what compiles them has no part in the text, but in what comes of it
    with_what = hashlib.sha256(Path(compiling.__file__).read_text(encoding="utf-8").encode())
    loops = f"{loops}\n# compiled as said in {with_what.hexdigest()[:24]}"
    return module(recorded, f"{loops}\n\n{imports}\n{names}")


LOADED: set[tuple[int, bool]] = set()
"""Dimensions, and whether errors are carried, whose loops are compiled in this process."""


@lru_cache(maxsize=8)
def kernels(dimension: int, *, carried: bool = False) -> Kernels:
    """Give the compiled loops; what an earlier run compiled is kept where that is possible."""
    text = source(dimension, carried=carried)
    name = f"force_diffusion_sweeps_{hashlib.sha256(text.encode()).hexdigest()[:24]}"
    found = ModuleType(name)
    found.__file__ = _kept(text, name)
    sys.modules[name] = found  # machine code that was kept asks for it
    LOADED.add((dimension, carried))
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
    """Names of the quantities of a strip, and of constants, that carry errors or not."""

    def __init__(self, name: str, count: int, constants: int, *, carried: bool) -> None:
        self.code, self.carried = Code(name), carried
        names: list[Any] = list(self.code.quantities(count))
        held: list[Any] = [self.code.constant() for _ in range(constants)]
        if carried:
            errors = self.code.quantities(count)
            names = [Carried(*pair) for pair in zip(names, errors, strict=True)]
            held = [Carried(one, self.code.constant()) for one in held]
        self._names, self.constants = iter(names), held

    def take(self, count: int) -> tuple[Any, ...]:
        """Give the next quantities."""
        return tuple(next(self._names) for _ in range(count))

    def gives(self, values: Sequence[Any]) -> Code:
        """Give the code of these outputs."""
        if self.carried:
            self.code.gives(*(v.value for v in values), *(v.error for v in values))
        else:
            self.code.gives(*values)
        return self.code

    def demand(self, value: Any, condition: str) -> None:
        """Let the code say False where a condition does not hold."""
        self.code.demand(value.value if self.carried else value, condition)


def _sqrt(value: Any) -> Any:
    return value.sqrt()


def _rest(d: int, *, carried: bool) -> Code:
    of = _Recording("rest", d * d + d + 1, 3, carried=carried)
    under, rho_under, (rho,) = [of.take(d) for _ in range(d)], of.take(d), of.take(1)
    found = local.rest(under, rho, rho_under, local.Metric(*of.constants), _sqrt, linear=False)
    of.demand(1 + rho, POSITIVE)
    for value in found.holds:
        of.demand(value, POSITIVE)
    return of.gives([*found.c, *(x for v in found.dn for x in v)])


def _balance(d: int, *, carried: bool) -> Code:
    of = _Recording("balance", d * (d + 3) + d + d * d, 0, carried=carried)
    above = []
    for _ in range(d):
        (F, g), dn, (lost,) = of.take(2), of.take(d), of.take(1)
        above.append((F, g, dn, lost))
    ordered, below = of.take(d), [of.take(d) for _ in range(d)]
    found = local.balance(above, ordered, below, linear=False, compensated=True)
    of.demand(found.det * found.det, POSITIVE)
    for value in found.g:
        of.demand(value, FINITE)
    return of.gives([*found.g, *found.lost])


def _gap(d: int) -> Code:
    of = _Recording("gap", 2 * d + 2, 5 + d, carried=False)
    here, there, (rho, other) = of.take(d), of.take(d), of.take(2)
    phi, own, cross, *steps, square, excess = of.constants
    found = local.gap(steps, square, excess, local.less(there, here), rho + other,
                      local.Metric(phi, own, cross), positive_root)  # fmt: skip
    return of.gives([found])


@lru_cache(maxsize=4)
def constants(dimension: int, phi: Fraction, *, carried: bool) -> Array:
    """Give what the ordered packing decides, as kernels take it."""
    m = local.metric(dimension, phi, (CARRYING if carried else FLOAT64).scalar)
    numbers = [one.value for one in m] + [one.error for one in m] if carried else list(m)
    return np.array(numbers, dtype=np.float64)


def memory(batch: int, quantities: int, size: int) -> Array:
    """Give memory, (batch, quantities, size and more).

    It is one piece, since the system hands out big pieces faster. Quantities at distances that are
    multiples of 4096 bytes would compete for the same places of the cache.
    """
    return np.empty((batch, *padded(quantities, size)))


def padded(quantities: int, size: int) -> tuple[int, int]:
    """Give the shape of ``memory`` of one packing."""
    return quantities, size + (72 - size) % 512


def layers_of(region: Region, rows: Sequence[Layer], starts: Array) -> Array:
    """Give each layer's first bead, beads, and beads in a row."""
    side = region.side if region.dimension == 3 else 0
    return np.array(
        [
            (start, row.count, side or max(row.count, 1))
            for start, row in zip(starts[: len(rows)], rows, strict=True)
        ],
        dtype=np.int64,
    ).reshape(-1, 3)


def turns_of(region: Region, steps: tuple[int, ...]) -> Array:
    """Say for each row of a layer in which one the beads lie that are so many steps on."""
    if region.dimension == 2:
        return np.zeros(1, np.int64)
    return (np.arange(region.side) + steps[0]) % region.side


def links_of(
    region: Region,
    rows: Sequence[Layer],
    sources: Sequence[Layer],
    starts: Array,
    steps: tuple[int, ...],
) -> Array:
    """Say where the beads lie that are so many steps on from each row of beads, (layers, 4).

    ``sources`` are the rows they lie in, whose first beads are ``starts``; see ``loops``.
    """
    on = sum(steps)
    found = np.zeros((len(rows), 4), np.int64)
    for j, row in enumerate(rows):
        if not 0 <= j + on < len(sources) or not row.count:
            continue  # no row is there: its length stays 0
        source = sources[j + on]
        if region.dimension == 3:
            found[j] = starts[j + on], region.side, steps[1], region.side
        else:
            first = row.first + steps[0] - steps[1]
            shift = (first - source.first) // 2
            found[j] = starts[j + on], source.count, shift, region.width or 0
    return found


def rows_of(values: Array, starts: Array, counts: Sequence[int], lowest: int = 0) -> LazyRows[Any]:
    """Give the rows of (…, beads), of which those below ``lowest`` have nothing to say."""

    def row(j: int) -> Array:
        return values[..., starts[j] : starts[j] + counts[j]] if j >= lowest else np.empty(0)

    return LazyRows(len(counts), row)


class Deposition:
    """Deposits packings of one region, in memory that is used again for the next ones."""

    def __init__(self, phi: Fraction, region: Region, *, carried: bool = False) -> None:
        """``carried``: numbers carry their errors."""
        self.region, self.carried = region, carried
        d = region.dimension
        self.constants = constants(d, phi, carried=carried)
        steps = [region.step(a, -1) for a in range(d)]
        self.layers = layers_of(region, region.rows, region.starts)
        self.links = np.stack(
            [links_of(region, region.rows, region.rows, region.starts, one) for one in steps], 1
        )
        self.turns = np.stack([turns_of(region, one) for one in steps])
        self.counts = [row.count for row in region.rows]
        self.quantities = d + d * d
        self.block = np.empty((0, 0, 0))
        self._check()

    @property
    def shape(self) -> tuple[int, int]:
        """Quantities, and the numbers of each, in memory."""
        return padded((1 + self.carried) * self.quantities, self.region.beads)

    def _check(self) -> None:
        """Raise ``LookupError`` where the region lacks a support."""
        if self.region.dimension == 3 or self.region.is_whole:
            return
        shift, count, period = self.links[1:, :, 2], self.links[1:, :, 1], self.links[1:, :, 3]
        own = self.layers[1:, 1, None]
        whole = (period > 0) & (count == period)
        first = np.where(period > 0, shift % np.maximum(period, 1), shift)
        lacking = ~whole & (own > 0) & ((first < 0) | (first + own > count))
        if lacking.any():
            j = int(np.argwhere(lacking)[0][0]) + 1
            raise LookupError(f"layer {j - 1} lacks supports of layer {j}")

    def __call__(self, rho: Array, base: Array | None = None) -> Array | None:
        """Deposit packings of δr/r, (packings, parts, beads); None where not all rest.

        Gives the ``block`` of ``loops.deposit``. ``base`` holds c of the lowest row, if it is not
        the ordered base. What was given before is overwritten.
        """
        batch, (parts, beads) = len(rho), rho.shape[1:]
        lowest = 1 + rho[:, 0, : self.counts[0]]
        if not ((lowest > 0) & (lowest < np.inf)).all():
            return None
        if base is None:
            base = np.zeros((parts * self.region.dimension, self.counts[0]))
        if len(self.block) < batch:
            self.block = memory(batch, parts * self.quantities, beads)
        block, loop = self.block[:batch], kernels(self.region.dimension, carried=self.carried)

        def part(of: slice) -> bool:
            return loop.deposit(
                rho[of], block[of], base, self.links, self.turns, self.layers, self.constants
            )

        return block if on_all_cores(part, batch) else None


def told(phi: Fraction, region: Region, rho: Array, block: Array) -> SolvedPacking:
    """Tell a ``block`` of values row by row; ``rho`` is (packings, beads)."""
    d, starts, counts = region.dimension, region.starts, [row.count for row in region.rows]

    def rows(values: Array, lowest: int = 0) -> LazyRows[Any]:
        return rows_of(values[0] if len(values) == 1 else values, starts, counts, lowest)

    def turned(a: int) -> LazyRows[tuple[Array, ...]]:
        parts = [rows(block[:, d + a * d + b], 1) for b in range(d)]
        return LazyRows(len(counts), lambda j: tuple(part[j] for part in parts))

    return SolvedPacking(
        phi,
        FLOAT64,
        region,
        rows(rho),
        per_direction([rows(block[:, a]) for a in range(d)]),
        per_direction([turned(a) for a in range(d)]),
        Memory(rho, block),
    )


def _one_of_all(load: Any) -> Any:
    """Give the load of one bead of a row whose beads are loaded alike; False where they are not."""
    parts: tuple[Array, ...] = () if load is None else (load,)
    if isinstance(load, Carried):
        parts = load.value, load.error
    if any(part.size and part.min() != part.max() for part in parts):
        return False
    ends = [part[:1] for part in parts]
    return Carried(*ends) if isinstance(load, Carried) else ends[0] if ends else None


class Descent:
    """Carries loads down through packings of one region, in memory that is used again."""

    def __init__(
        self, region: Region, rows: tuple[Layer, ...], loads: Loads, *, carried: bool = False
    ) -> None:
        """``rows`` are those whose forces are balanced, ``loads`` belong to them."""
        d, self.carried = region.dimension, carried
        self.region, self.rows = region, rows
        self.counts = [row.count for row in rows]
        self.starts = np.cumsum([0, *self.counts])
        self.lowest = next((j + 1 for j in range(len(rows) - 1, 0, -1) if not rows[j].count), 1)
        self.beads = int(self.starts[-1] - self.starts[1])  # that pass forces on
        self.layers = layers_of(region, rows, self.starts)
        steps = [region.step(a, 1) for a in range(d)]

        def links(sources: Sequence[Layer], starts: Array, one: tuple[int, ...]) -> Array:
            return links_of(region, rows, sources, starts, one)

        self.above = np.stack([links(rows, self.starts, one) for one in steps], 1)
        self.over = np.stack([links(region.rows, region.starts, one) for one in steps], 1)
        self.here = links(region.rows, region.starts, (0,) * d)
        self.turns = np.stack([turns_of(region, one) for one in steps])
        self.g = self.lost = np.empty((0, 0, 0))
        self.set(loads)

    @property
    def shape(self) -> tuple[int, int]:
        """Quantities, and the numbers of each, in memory."""
        return padded((1 + self.carried) * self.region.dimension, int(self.starts[-1]))

    def set(self, loads: Loads) -> None:
        """Take other loads."""
        d, parts = self.region.dimension, 1 + self.carried
        self.loads = loads
        self.F = np.zeros((parts * d, self.starts[-1]))
        system: NumberSystem = CARRYING if self.carried else FLOAT64
        rows, region = self.rows, self.region
        alike = region.has_whole(rows)
        if alike:  # of a whole packing where beads of a layer are loaded alike, one bead tells all
            first = per_direction([tuple(map(_one_of_all, of)) for _, of in loads])
            alike = all(one is not False for _, of in first for one in of)
        if alike:
            bead = whole(1, len(rows) - 1, d)
            rows, region, loads = bead.rows, bead, first
        ordered = straight_down(rows, region, loads, system)
        for j in range(self.lowest, len(self.rows)):
            of = slice(self.starts[j], self.starts[j + 1])
            for a, F in enumerate(ordered[j]):
                self.F[a, of] = F.value if self.carried else F
                if self.carried:
                    self.F[d + a, of] = F.error

    def __call__(self, block: Array, above: Array | None = None) -> Array | None:
        """Balance the forces of packings whose ``block`` that is; None where not all is in order.

        Gives ``g`` of ``loops.sweep_down``. ``above`` holds what ``row`` gave of the highest row,
        if that is balanced already.
        """
        batch, rows, top = len(block), self.F.shape[0], len(self.rows) - 1
        widest = max(self.counts, default=0)
        if len(self.g) < batch:
            self.g, self.lost = memory(batch, rows, int(self.starts[-1])), np.empty((rows, 0))
        g, layers = self.g[:batch], self.layers
        loop = kernels(self.region.dimension, carried=self.carried)

        def part(of: slice) -> bool:
            lost = np.empty((rows, 2 * widest))
            own = layers
            if above is not None:
                own = layers[:top]
                g[of, :, self.starts[top] : self.starts[top + 1]] = above[0]
                lost[:, top % 2 * widest :][:, : self.counts[top]] = above[1]
            good = loop.sweep_down(
                self.F, block[of], g[of], lost, self.above, self.over, self.here, self.turns, own,
                np.empty(0),
            )  # fmt: skip
            if batch == 1:
                self.lost = lost
            return good

        return g if on_all_cores(part, batch) else None

    def row(self, j: int) -> Array:
        """Give g and what was lost of the lowest row but one that was balanced, (2, …, beads)."""
        turn = j % 2 * (self.lost.shape[1] // 2)
        lost = self.lost[:, turn : turn + self.counts[j]]
        return np.stack([self.g[0, :, self.starts[j] : self.starts[j + 1]], lost])

    def told(self, F: Array, g: Array) -> Forces:
        """Tell forces row by row: ordered (d, …) and changes (packings, d, …)."""
        d = self.region.dimension

        def rows(values: Array) -> LazyRows[Any]:
            return rows_of(values, self.starts, self.counts, self.lowest)

        changes = [g[0, a] if len(g) == 1 else g[:, a] for a in range(d)]
        return Forces(
            FLOAT64,
            self.region,
            self.rows,
            per_direction([rows(F[a]) for a in range(d)]),
            per_direction([rows(one) for one in changes]),
            F=F[:, self.starts[self.lowest] :],
            g=g[..., self.starts[self.lowest] : self.starts[-1]],
        )
