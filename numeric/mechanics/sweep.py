"""Packings and their forces, swept layer by layer: discs or spheres, any number system.

The beads of a row are calculated with as arrays, by the one source in ``local``. Of discs in
float64 ``loops`` compiles that source, where numba is installed. Forces are in units of the load's
magnitude. A contact is indexed by its upper bead x, and has the lower bead x − e_a: in two
dimensions ``plus`` below (i, j) is the paper's f⁺_(i−1, j−1), ``minus`` is f⁻_(i+1, j−1).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import lru_cache, partial
from typing import Any

import numpy as np

from ..arithmetic.carried import CARRYING, NONE, Carried, Carrying, Sizes
from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import FLOAT64, Array, Float64, NumberSystem
from ..disorder.radii import BeadError, Radii, RadiusError
from ..lattice.layers import Layer, Region, Rows, columns_of, taken
from .loads import LoadSpec
from .local import balance, balance_linear, cosine, metric, nested, rest, rest_linear
from .loops import Loops, loops


class UnbuildableError(BeadError):
    """A bead can't rest on its supports; ``site`` names it."""


class NotStandingError(BeadError):
    """No forces can hold a bead, because its contacts lie in a line or plane; ``site`` names it."""


@dataclass(frozen=True)
class Solved:
    """Some packings, solved, in units of r; what the question does not need is None.

    Beads at rest lie row after row as ``region`` has them. ``rho``: δr/r, shape (packings, beads).
    ``block``, (packings, d + d², beads): c_a = n^a·δx/r of each direction, then of the contact
    below along each the components of δn = Σ_b dn_b n^b, those of the base 0. Directions are
    numbered from 0: + and −, or 1, 2 and 3.

    Contact forces are those below beads, by the upper bead, row after row of ``rows`` above the
    base. ``F``, (d, beads): of the ordered packing; ``g``, (packings, d, beads): f^a − F^a.

    ``single`` is the (force, change) of the one contact, or the (c⁺, c⁻) of the one bead, that
    line sums give alone. Where the sweep carried errors, all numbers are rounded only once, and
    ``sizes`` says how large errors were.
    """

    phi: Fraction
    system: NumberSystem
    region: Region
    rho: Any = None
    block: Any = None
    rows: Rows = field(default_factory=Rows)
    F: Any = None
    g: Any = None
    single: tuple[Any, Any] | None = None
    sizes: Sizes = NONE

    def c(self, a: int, j: int) -> Any:
        """Give c_a of row j, (packings, count)."""
        return self.block[:, a, self.region.row(j)]

    def dn(self, a: int, j: int) -> Any:
        """Give the components of δn of the contacts along n^a below row j, (d, packings, count)."""
        d = self.region.dimension
        return self.block[:, d + a * d : 2 * d + a * d, self.region.row(j)].swapaxes(0, 1)

    def ordered(self, a: int, j: int) -> Any:
        """Give F^a below row j > 0, (count,)."""
        return self.F[a, self.rows.above(j)]

    def change(self, a: int, j: int) -> Any:
        """Give g^a below row j > 0, (packings, count)."""
        return self.g[:, a, self.rows.above(j)]

    def realisation(self, number: int) -> "Solved":
        """Give the ``number``-th realisation of those that were solved together."""
        at = slice(number, number + 1)
        own: dict[str, Any] = {"rho": self.rho, "block": self.block, "g": self.g}
        parts: dict[str, Any] = {name: x[at] for name, x in own.items() if x is not None}
        return replace(self, **parts)


def rounded(solved: Solved) -> Solved:
    """Round numbers that carry their errors once, in place; say how large the errors were."""
    block, F, g = solved.block, solved.F, solved.g
    if solved.single is not None:
        most = max(abs(float(ball.error)) for ball in solved.single)
        force = max(abs(float(ball.value)) for ball in solved.single)
        single = solved.single[0].nearest, solved.single[1].nearest
        sizes = Sizes(most, 0.0, most, force)
        return replace(solved, system=FLOAT64, single=single, sizes=sizes)
    d = solved.region.dimension
    sizes = Sizes(_most(block.error[:, :d]), _most(block.error[:, d:]))
    block.value[...] += block.error
    if g is not None:
        sizes |= Sizes(changed=_most(g.error), force=_most(F.value) + _most(g.value))
        g.value[...] += g.error
        F, g = F.nearest, g.value
    rho = solved.rho.nearest
    return replace(solved, system=FLOAT64, rho=rho, block=block.value, F=F, g=g, sizes=sizes)


def _most(values: Array) -> float:
    """Give the largest absolute value."""
    return float(max(values.max(initial=0), -values.min(initial=0)))


def swept(
    n_x: Fraction,
    radii: Radii,
    load: LoadSpec | None,
    region: Region,
    rows: Rows,
    realisations: Sequence[int],
    system: NumberSystem,
    *,
    linear: bool = False,
    carried: bool = False,
) -> Solved:
    """Give packings at rest, and the forces on the beads of ``rows`` under a load, if there is one.

    To first order only if ``linear``. The caller activates ``system``. Raises ``RadiusError``, and
    what ``deposit`` and ``sweep_down`` raise.
    """
    own: Any = CARRYING if carried else system
    try:
        rho = radii.of(region.rows, realisations, own)
    except RadiusError as error:
        i, j = error.site  # in its row
        raise RadiusError(region.naming.bead((i, j)), error.reason, error.place) from None
    solved = deposit(cosine(n_x), region, rho, own, linear=linear)
    if load is not None:
        F = load.ordered(rows, load.strength(n_x, own), own)
        solved = sweep_down(solved, rows, F, linear=linear)
    return rounded(solved) if carried else solved


def deposit(
    phi: Fraction, region: Region, rho: Any, system: NumberSystem, *, linear: bool = False
) -> Solved:
    """Deposit beads layer by layer on the ordered base; to first order only if ``linear``.

    ``phi`` is the dot product of any two base vectors, ``rho`` (packings, beads) holds δr/r. The
    caller activates ``system``. Raises ``UnbuildableError``, naming the bead, where a radius is not
    positive (or no number) or the supports are too far apart or too steep, and ``UndecidedError``
    where balls are too wide to tell.
    """
    block = None if linear else _compiled_deposit(phi, region, rho, system)
    if block is not None:
        return Solved(phi, system, region, rho, block)
    d, at = region.dimension, region.starts.tolist()
    m = metric(d, phi, system.number)
    block = system.zeros(len(rho), d + d * d, region.beads)
    layers, down = tuple(region.rows), [region.step(a, -1) for a in range(d)]
    for j, layer in enumerate(layers):
        own, below = slice(at[j], at[j + 1]), slice(at[j - 1], at[j])
        radii = rho[:, own]
        bad = np.zeros(0) if linear else system.signs(1 + radii)[1]
        if bad.any():
            why = "its radius is not a positive number"
            raise _named(UnbuildableError, bad, layer, region, why)
        if not j:
            continue
        columns = [region.columns(layers[j - 1], layer, steps) for steps in down]
        under = tuple(tuple(taken(block[:, b, below], x) for b in range(d)) for x in columns)
        rho_under = tuple(taken(rho[:, below], x) for x in columns)
        rested = (rest_linear if linear else rest)(under, radii, rho_under, m)
        _check_rest(rested.holds, layer, region, system, partial(nested, under, rho_under, m))
        for k, x in enumerate([*rested.c, *(x for of in rested.dn for x in of)]):
            block[:, k, own] = x
    return Solved(phi, system, region, rho, block)


def sweep_down(packing: Solved, rows: Rows, F: Any, *, linear: bool = False) -> Solved:
    """Carry loads down from the highest of ``rows`` through the beads of ``rows``.

    Exactly; or, with ``linear``, to first order: then forces are sums along the base vectors, and
    there is nothing to invert (Eqs. 6–11, for a packing that was deposited so).

    ``rows[j]`` for j = 0 … top lie within the packing's region; ``F`` (d, beads) are the ordered
    forces below them (``LoadSpec.ordered``). Beads above or beside the rows pass no force on to
    them. The caller activates the number system. Raises ``NotStandingError`` where contacts are
    parallel within the arithmetic.
    """
    g = None if linear else _compiled_balance(packing, rows, F)
    if g is not None:
        return replace(packing, rows=rows, F=F, g=g)
    region, system, block = packing.region, packing.system, packing.block
    d, top = region.dimension, len(rows) - 1
    at, beads = rows.starts_above.tolist(), region.starts.tolist()
    g = system.zeros(len(block), d, at[-1])
    zero = 0.0 if isinstance(system, Carrying) else system.zeros(1)[0]
    layers, deposited = tuple(rows), tuple(region.rows)
    for j in range(top, 0, -1):
        layer, own, here = layers[j], slice(at[j], at[j + 1]), slice(beads[j], beads[j + 1])
        if not layer.count:
            break
        none = system.zeros(1, layer.count)
        above = [(none[0], none, (none,) * d) for _ in range(d)]
        for a in range(d if j < top else 0):
            force, bead = slice(at[j + 1], at[j + 2]), slice(beads[j + 1], beads[j + 2])
            up = region.step(a, 1)
            bearing = region.columns(layers[j + 1], layer, up)
            resting = region.columns(deposited[j + 1], layer, up)
            turns = (block[:, d + a * d + b, bead] for b in range(d))
            above[a] = (
                taken(F[a, force], bearing, zero),
                taken(g[:, a, force], bearing, zero),
                tuple(taken(x, resting, zero) for x in turns),
            )
        place = columns_of(deposited[j], layer, region.width)
        dn = tuple(
            tuple(taken(block[:, d + a * d + b, here], place) for b in range(d)) for a in range(d)
        )
        F_here = tuple(F[a, own] for a in range(d))
        rule: Any = balance_linear if linear else balance
        balanced = rule(*zip(*above, strict=True), F_here, dn)
        if not linear:
            check_standing(balanced.det, layer, region, system)
        for a, change in enumerate(balanced.g):
            g[:, a, own] = change
    return replace(packing, rows=rows, F=F, g=g)


def spread(system: NumberSystem, *shape: int) -> Any:
    """Give memory for float64, with or without errors; its last axis is not contiguous.

    Quantities at distances that are multiples of 4096 bytes would compete for the same places of
    the cache.
    """

    def made() -> Array:
        *others, size = shape
        end = size + (72 - size) % (512 if size > 512 else 64)
        return np.empty((*others, end))[..., :size]

    return Carried(made(), made()) if isinstance(system, Carrying) else made()


def _address(values: Any) -> tuple[int, tuple[int, ...]]:
    """Give where numbers lie in memory, and how far behind them their errors, as loops take it."""
    if not isinstance(values, Carried):
        return values.ctypes.data, ()
    address = values.value.ctypes.data
    return address, ((values.error.ctypes.data - address) // 8,)


@lru_cache(maxsize=4)
def metric_array(phi: Fraction, system: NumberSystem) -> Array:
    """Give what φ decides of discs, as ``loops`` takes it: errors behind the numbers."""
    m = metric(2, phi, system.number)
    if isinstance(system, Carrying):
        return np.array([number.value for number in m] + [number.error for number in m])
    return np.array(m)


def shift_of(rows: Rows, sources: Rows, steps: tuple[int, ...]) -> Array:
    """Say in which column of the row of ``sources`` so many steps on each row of discs begins.

    Where there is none it is 0.
    """
    rise = sum(steps)
    firsts = np.zeros(len(rows), np.int64)
    here = np.arange(max(-rise, 0), min(len(rows), len(sources) - rise))
    firsts[here] = rows.firsts[here] + steps[0] - steps[1] - sources.firsts[here + rise]
    return firsts // 2


@lru_cache(maxsize=4)
def _supports(region: Region) -> Array:
    """Give the rows of ``loops.deposit``. Raise ``LookupError`` where a support is lacking."""
    rows, width = region.rows, region.width
    shift = shift_of(rows, rows, (-1, 0))
    counts, first = rows.counts, shift if width is None else shift % width
    end = first[1:] + counts[1:] + 1
    whole = counts[:-1] == (width or -1)
    lacking = (counts[1:] > 0) & ~whole & ((first[1:] < 0) | (end > counts[:-1]))
    if lacking.any():
        j = int(np.argmax(lacking)) + 1
        raise LookupError(f"layer {j - 1} lacks supports of layer {j}")
    return np.stack([region.starts[:-1], counts, shift], axis=1)


def _loops_of(region: Region, system: NumberSystem) -> Loops | None:
    """Give the compiled loops for discs in float64, with or without errors, where numba is."""
    return loops() if region.dimension == 2 and isinstance(system, Float64) else None


def _compiled_deposit(phi: Fraction, region: Region, rho: Any, system: NumberSystem) -> Any:
    """Give the block of a packing of discs; None where not all beads rest, or nothing compiles."""
    if (made := _loops_of(region, system)) is None:
        return None
    rows, m = _supports(region), metric_array(phi, system)
    block = spread(system, len(rho), 6, region.beads)
    (radii, e), (where, f) = _address(rho), _address(block)
    pitch = (block.value if f else block).strides[1] // 8
    sizes = len(rho), len(rows), region.width or 0, region.beads, pitch
    loop = made.deposit_carried if f else made.deposit
    good = loop(radii, where, rows.ctypes.data, m.ctypes.data, *sizes, *e, *f)
    return block if good else None


@lru_cache(maxsize=4)
def _reached(region: Region, rows: Rows) -> Array:
    """Give the rows of ``loops.sweep_down``."""
    deposited, first = region.rows[: len(rows)], region.starts[: len(rows)]
    places = (deposited, (0, 0)), (rows, (1, 0)), (deposited, (1, 0))
    shifts = (shift_of(rows, sources, steps) for sources, steps in places)
    columns = [rows.starts_above[:-1], rows.counts, first, deposited.counts, *shifts]
    return np.stack(columns, axis=1)


def _compiled_balance(packing: Solved, rows: Rows, F: Any) -> Any:
    """Give the changes of forces; None where not all is in order, or nothing compiles."""
    region, system, block = packing.region, packing.system, packing.block
    if (made := _loops_of(region, system)) is None:
        return None
    table, beads, widest = _reached(region, rows), F.shape[1], int(rows.counts.max(initial=0))
    ordered, g = (spread(system, *n, 2, beads + widest) for n in ((), (len(block),)))
    ordered[:, :beads], ordered[:, beads:], g[..., beads:] = F, 0.0, 0.0
    (forces, e), (where, f), (changes, h) = map(_address, (ordered, block, g))
    size, pitch = ((x.value if f else x).strides[-2] // 8 for x in (g, block))
    sizes = len(block), len(rows), region.width or 0, beads, size, pitch
    loop = made.sweep_down_carried if f else made.sweep_down
    good = loop(forces, where, changes, table.ctypes.data, *sizes, *e, *f, *h)
    return g[..., :beads] if good else None


# What is wrong where one of the measures of ``local.rest`` is not positive.
REMEDY = "; less disorder or fewer layers would help"
APART = (
    "its supports are too far apart to hold it; less disorder, fewer layers or a smaller spacing "
    "would help"
)
NESTED = (
    "its supports are too close to hold it up, and one is much larger than the other; less "
    "disorder or a larger spacing would help"
)
STEEP = f"the line through its supports is steeper than n⁺ or n⁻{REMEDY}"
STEEP_PLANE = (
    f"the plane through its supports is steeper than a base vector, or they lie crosswise{REMEDY}"
)


def _check_rest(
    holds: Sequence[Any],
    layer: Layer,
    region: Region,
    system: NumberSystem,
    close: Callable[[], Sequence[Any]],
) -> None:
    """Raise ``UnbuildableError`` or ``UndecidedError`` unless every bead surely rests.

    ``close`` gives what is positive where two supports are too close.
    """
    open_question = False
    for number, values in enumerate(holds):
        good, bad = system.signs(values)
        if bad.any():
            why, first = STEEP if region.dimension == 2 else STEEP_PLANE, tuple(np.argwhere(bad)[0])
            if not number:
                why = NESTED if any(system.signs(value)[0][first] for value in close()) else APART
            raise _named(UnbuildableError, bad, layer, region, why)
        open_question |= not good.all()
    if open_question:
        raise UndecidedError(
            f"layer {layer.j}: the enclosures are too wide to tell whether beads rest"
        )


def check_standing(det: Any, layer: Layer, region: Region, system: NumberSystem) -> None:
    """Raise ``NotStandingError`` where contacts are parallel; ``det`` is that of their N."""
    good, bad = system.signs(det * det)
    if not good.all():
        wrong = ~good if not bad.any() else bad
        why = "the contacts below it lie in one plane"
        if region.dimension == 2:
            why = "the two contacts below it are parallel"
        raise _named(NotStandingError, wrong, layer, region, why)


def _named(kind: type[BeadError], bad: Array, layer: Layer, region: Region, why: str) -> BeadError:
    """Make the error that names the first bead of a layer that is ``bad``, (packings, count)."""
    place, column = np.argwhere(bad)[0].tolist()
    return kind(region.bead(layer, column), why, place)
