"""The float64 sweeps of whole periodic packings, compiled: bitwise the numbers of the NumPy ones.

The same operations as in ``packing.place`` and ``forces.sweep_down``, in the same order and each
rounded by itself: no fast-math, and LLVM is not given leave to fuse a product with a sum. So every
result is the NumPy sweep's, bit for bit; whatever is out of the ordinary (a bead that can't rest,
a number that is not finite) is left to the NumPy sweep, whose errors name the bead.

Only ``engine`` imports this file, and only for work that repays loading the compiler.
"""

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import sqrt
from typing import Any, TypeVar, cast

import llvmlite.binding
import numba
import numpy as np

from ..arithmetic.machine import cores
from ..arithmetic.systems import FLOAT64, Array, NumberSystem
from ..lattice.branch import PerBranch
from ..lattice.layers import Layer, LazyRows, Region, Stack
from . import forces, packing
from .forces import Forces, Loads
from .packing import SolvedPacking
from .work import Work

Function = TypeVar("Function", bound=Callable[..., Any])

# Rows never overlap, but LLVM has to check; it gives up vectorising at 8 comparisons by default.
llvmlite.binding.set_option("force-diffusion", "--runtime-memory-check-threshold=512")


def _compiled(function: Function) -> Function:
    """Compile at the first call; keep the machine code on disk where a folder can be written."""
    options: dict[str, Any] = {"error_model": "numpy", "nogil": True}
    try:
        return cast(Function, numba.njit(cache=True, **options)(function))
    except RuntimeError:  # no place to write to
        return cast(Function, numba.njit(**options)(function))


@_compiled
def _place(
    below: tuple[Array, Array, Array, Array],
    radii: tuple[Array, Array, Array],
    c: tuple[Array, Array],
    plus: tuple[Array, Array],
    minus: tuple[Array, Array],
    phi: float,
    inverse: float,
) -> bool:
    """Rest a run of beads on their supports (``packing.place``); say whether all of them rest.

    All arrays are (beads,): ``below`` (c⁺_A, c⁻_A, c⁺_B, c⁻_B), ``radii`` δr/r of the beads, of A
    and of B; filled are ``c`` and the δn of the contacts below, ``plus`` and ``minus``.
    """
    aps, ams, bps, bms = below
    own, radii_a, radii_b = radii
    c_plus, c_minus = c
    plus_a, plus_b = plus
    minus_a, minus_b = minus
    good = True
    for q in range(own.size):
        ap, am = aps[q], ams[q]
        rho_plus, rho_minus = own[q] + radii_a[q], own[q] + radii_b[q]
        up, um = ap - bps[q], am - bms[q]
        bm = bms[q]
        Up, Um = (up - phi * um) * inverse, (um - phi * up) * inverse
        r_plus = rho_plus + rho_plus * rho_plus / 4
        r_minus = rho_minus + rho_minus * rho_minus / 4
        guess = r_minus - um
        tilt_plus, tilt_minus = 1 - Up / 2, 1 + Um / 2
        gap = ((r_plus + up / 2) * Up + (guess + um / 2) * Um) / 2
        lift = gap / tilt_minus
        pm0 = guess - lift
        e = tilt_plus / tilt_minus
        Ep, Em = (1 - phi * e) * inverse, (e - phi) * inverse
        Pp, Pm = (r_plus - phi * pm0) * inverse, (pm0 - phi * r_plus) * inverse
        size = r_plus * Pp + pm0 * Pm
        b = 1 + (r_plus * Ep + pm0 * Em) / 2
        discriminant = b * b - (Ep + e * Em) * size / 4
        A = size / (b + sqrt(discriminant)) / 2
        B = A * e + lift
        c_plus[q] = ap + (r_plus - A)
        c_minus[q] = bm + (r_minus - B)
        length = 2 + rho_plus
        along = (rho_plus * rho_plus / 4 - A) / length
        across = (pm0 - A * e - phi * rho_plus) / length
        plus_a[q] = (along - phi * across) * inverse
        plus_b[q] = (across - phi * along) * inverse
        length = 2 + rho_minus
        along = (rho_minus * rho_minus / 4 - B) / length
        across = (r_plus - A + up - phi * rho_minus) / length
        minus_b[q] = (along - phi * across) * inverse
        minus_a[q] = (across - phi * along) * inverse
        good &= (
            (discriminant > 0)
            & (discriminant < np.inf)
            & (tilt_plus > 0)
            & (tilt_plus < np.inf)
            & (tilt_minus > 0)
            & (tilt_minus < np.inf)
            & (1 + own[q] > 0)
            & (own[q] < np.inf)
        )
    return good


@_compiled
def _runs(j: int, width: int) -> tuple[tuple[int, int, int, int], tuple[int, int, int, int]]:
    """Split layer j where its beads' neighbours are at both ends of their layer.

    Bead q has the neighbours q − 1 + j % 2, to the left, and q + j % 2 in the layer below and in
    the layer above. Gives (first bead, its left and its right neighbour, beads) of two runs.
    """
    if j % 2:
        return (0, 0, 1, width - 1), (width - 1, width - 1, 0, 1)
    return (1, 0, 1, width - 1), (0, width - 1, 0, 1)


@_compiled
def _deposit(rho: Array, block: Array, phi: float, inverse: float) -> bool:
    """Deposit a packing; say whether every bead rests.

    ``rho`` is (layers, W); filled is ``block``, (6, …): c⁺, c⁻, the δn of plus, of minus, of all
    beads in order; the δn of layer 0 are not touched.
    """
    layers, width = rho.shape
    c_plus, c_minus = block[0], block[1]
    plus_a, plus_b, minus_a, minus_b = block[2], block[3], block[4], block[5]
    good = True
    for q in range(width):
        c_plus[q] = c_minus[q] = 0.0
        good &= (1 + rho[0, q] > 0) & (rho[0, q] < np.inf)
    for j in range(1, layers):
        under = (j - 1) * width
        for q, a, b, n in _runs(j, width):
            own = slice(under + width + q, under + width + q + n)
            at_a, at_b = slice(under + a, under + a + n), slice(under + b, under + b + n)
            good &= _place(
                (c_plus[at_a], c_minus[at_a], c_plus[at_b], c_minus[at_b]),
                (rho[j, q : q + n], rho[j - 1, a : a + n], rho[j - 1, b : b + n]),
                (c_plus[own], c_minus[own]),
                (plus_a[own], plus_b[own]),
                (minus_a[own], minus_b[own]),
                phi,
                inverse,
            )
    return good


@_compiled
def _balance(
    F: tuple[Array, Array],
    from_right: tuple[Array, Array, Array, Array, Array],
    from_left: tuple[Array, Array, Array, Array, Array],
    plus: tuple[Array, Array],
    minus: tuple[Array, Array],
    g: tuple[Array, Array],
    lost: tuple[Array, Array],
) -> bool:
    """Balance a run of beads (one layer of ``forces.sweep_down``); say whether all is in order.

    All arrays are (beads,): ``F`` the ordered forces below, ``from_right`` (``from_left``) F, g,
    the two components of δn and what the sum of g has lost, of the contacts above, ``plus`` and
    ``minus`` the δn below; ``g`` and ``lost`` are filled.
    """
    F_plus, F_minus = F
    F_right, g_right, right_a, right_b, lost_right = from_right
    F_left, g_left, left_a, left_b, lost_left = from_left
    plus_a, plus_b = plus
    minus_a, minus_b = minus
    g_plus, g_minus = g
    lost_plus, lost_minus = lost
    good = True
    for q in range(F_plus.size):
        Fp, Fm = F_plus[q], F_minus[q]
        pa, pb, ma, mb = plus_a[q], plus_b[q], minus_a[q], minus_b[q]
        gp, gm = g_right[q], g_left[q]
        fp, fm = F_right[q] + gp, F_left[q] + gm
        turn_plus = fp * right_a[q] + fm * left_a[q] + lost_right[q] - Fp * pa - Fm * ma
        turn_minus = fp * right_b[q] + fm * left_b[q] + lost_left[q] - Fp * pb - Fm * mb
        minor = pa * mb - ma * pb
        det = 1 + (pa + mb + minor)
        sp, sm = gp + turn_plus, gm + turn_minus
        turn_plus = turn_plus - (sp * (pa + minor) + sm * ma) / det
        turn_minus = turn_minus - (sm * (mb + minor) + sp * pb) / det
        below_plus, below_minus = gp + turn_plus, gm + turn_minus
        part_plus, part_minus = below_plus - gp, below_minus - gm
        lost_plus[q] = (gp - (below_plus - part_plus)) + (turn_plus - part_plus)
        lost_minus[q] = (gm - (below_minus - part_minus)) + (turn_minus - part_minus)
        g_plus[q], g_minus[q] = below_plus, below_minus
        good &= (
            (det * det > 0)
            & (det * det < np.inf)
            & (abs(below_plus) < np.inf)
            & (abs(below_minus) < np.inf)
        )
    return good


@_compiled
def _order(own: Array, loads: Array, width: int, side: int) -> tuple[Array, Array]:
    """Give the ordered forces of one branch: numbers, and where each layer's W of them begin.

    ``own`` says which row of ``loads`` a layer carries, −1 for none; ``side`` is 0 for plus, 1 for
    minus. Below a load, the forces go straight down the diagonals: these layers are all windows
    on one row, which is there twice, since a layer has no ends. The first such row is that of a
    layer above the highest, where there is nothing to bear.
    """
    layers = own.size
    start = np.zeros(layers + 1, np.int64)
    base, size = 0, 2 * width
    for j in range(layers - 1, 0, -1):
        if own[j] >= 0:
            start[j] = base = size
            size += width if j == 1 or own[j - 1] >= 0 else 2 * width
        else:  # from a bead to the one above that loads it are j % 2 − side columns
            start[j] = base + (start[j + 1] - base + j % 2 - side) % width
    F = np.empty(size)
    F[: 2 * width] = 0.0
    for j in range(layers - 1, 0, -1):
        if own[j] >= 0:
            here, above = start[j], start[j + 1]
            for q in range(width):
                F[here + q] = F[above + (q + j % 2 - side) % width] + loads[own[j], q]
            if j > 1 and own[j - 1] < 0:
                F[here + width : here + 2 * width] = F[here : here + width]
    return F, start


@_compiled
def _sweep_down(
    F: tuple[Array, Array], start: tuple[Array, Array], block: Array, g: Array, width: int
) -> bool:
    """Sweep a packing from the highest layer down; say if all is in order.

    ``F`` and where its layers ``start`` are those of ``_order``, ``block`` is that of ``_deposit``;
    filled is ``g``, (2, …), all but layer 0, and with a layer of zeros above the highest.
    """
    (F_plus, F_minus), (start_plus, start_minus) = F, start
    g_plus, g_minus = g[0], g[1]
    plus_a, plus_b, minus_a, minus_b = block[2], block[3], block[4], block[5]
    # What the sums of a layer and the one above have lost, which take turns; see ``_block``.
    lost = np.zeros((2, 2, width + (72 - width) % 512))
    good = True
    top = len(start_plus) - 2
    for q in range((top + 1) * width, (top + 2) * width):
        g_plus[q] = g_minus[q] = 0.0
    for j in range(top, 0, -1):
        here, over = j * width, (j + 1) * width
        turns = min(over, top * width)  # above the highest layer no force is there to be turned
        new, old = j % 2, (j + 1) % 2
        F_over_plus, F_over_minus = start_plus[j + 1], start_minus[j + 1]
        F_plus_here, F_minus_here = start_plus[j], start_minus[j]
        for q, a, b, n in _runs(j, width):
            good &= _balance(
                (
                    F_plus[F_plus_here + q : F_plus_here + q + n],
                    F_minus[F_minus_here + q : F_minus_here + q + n],
                ),
                (
                    F_plus[F_over_plus + b : F_over_plus + b + n],
                    g_plus[over + b : over + b + n],
                    plus_a[turns + b : turns + b + n],
                    plus_b[turns + b : turns + b + n],
                    lost[old, 0, b : b + n],
                ),
                (
                    F_minus[F_over_minus + a : F_over_minus + a + n],
                    g_minus[over + a : over + a + n],
                    minus_a[turns + a : turns + a + n],
                    minus_b[turns + a : turns + a + n],
                    lost[old, 1, a : a + n],
                ),
                (plus_a[here + q : here + q + n], plus_b[here + q : here + q + n]),
                (minus_a[here + q : here + q + n], minus_b[here + q : here + q + n]),
                (g_plus[here + q : here + q + n], g_minus[here + q : here + q + n]),
                (lost[new, 0, q : q + n], lost[new, 1, q : q + n]),
            )
    return good


@dataclass(frozen=True)
class CompiledPacking(SolvedPacking):
    """A packing that lies in ``block``, (batch, 6, …): c⁺, c⁻, the δn of plus, of minus."""

    block: Array


def _block(batch: int, quantities: int, layers: int, width: int) -> tuple[Array, Array]:
    """Give memory, (batch, quantities, …), and how it reads: (batch, quantities, layers, W).

    It is one piece, since the system hands out big pieces faster. Quantities at distances that are
    multiples of 4096 bytes would compete for the same places of the cache.
    """
    beads = layers * width
    memory = np.empty((batch, quantities, beads + (72 - beads) % 512))
    return memory, memory[:, :, :beads].reshape(batch, quantities, layers, width)


def _all(function: Callable[[int], bool], batch: int) -> bool:
    """Call ``function`` for every packing of a batch, on all cores that may be used."""
    if batch == 1:
        return function(0)
    with ThreadPoolExecutor(min(batch, cores())) as pool:
        return all(pool.map(function, range(batch)))


def _above_base(block: Array) -> LazyRows[Array]:
    """Give the layers of a block, (…, layers, W), of which the lowest has nothing to say."""
    return LazyRows(block.shape[-2], lambda j: block[..., j, :] if j else np.empty(0))


@lru_cache(maxsize=1)
def _metric(n_x: Fraction) -> tuple[float, float]:
    """Give φ and 1/(1 − φ²): all packings of an ensemble have the same."""
    m = packing.metric(n_x, FLOAT64)
    return float(m.phi), float(m.inverse_det)


def deposit(
    n_x: Fraction,
    region: Region,
    rho: Sequence[Array],
    system: NumberSystem,
    work: Work | None = None,
) -> SolvedPacking:
    """Do what ``packing.deposit`` does, and to the bit; compiled for whole packings in float64."""
    shape = rho[0].shape
    if system is not FLOAT64 or len(shape) > 2 or not region.is_whole:
        return packing.deposit(n_x, region, rho, system, work)
    phi, inverse = _metric(n_x)
    # Each packing of a batch lies in one piece: cores that write next to each other are slow.
    if isinstance(rho, Stack):
        radii = rho.block.reshape(-1, len(rho), shape[-1])
    elif len(shape) == 1:
        radii = np.concatenate(rho).reshape(1, len(rho), shape[-1])
    else:
        radii = np.stack(rho, axis=1)
    batch, layers, width = radii.shape
    block, found = _block(batch, 6, layers, width)

    def one(k: int) -> bool:
        return _deposit(radii[k], block[k], phi, inverse)

    if not _all(one, batch):
        return packing.deposit(n_x, region, rho, system, work)  # which names the bead
    if work is not None:
        for layer in region.rows:
            work.did("deposited", layer, batch)
    found = found[0] if len(shape) == 1 else found.swapaxes(0, 1)
    return CompiledPacking(
        n_x,
        system,
        region,
        rho,
        PerBranch(Stack(found[0]), Stack(found[1])),
        PerBranch(_pairs(found[2], found[3]), _pairs(found[4], found[5])),
        block,
    )


def _pairs(a: Array, b: Array) -> LazyRows[tuple[Array, Array]]:
    """Give the layers of δn, whose components lie in two blocks, (…, layers, W)."""
    nothing = np.empty(0)
    return LazyRows(
        a.shape[-2],
        lambda j: (a[..., j, :], b[..., j, :]) if j else (nothing, nothing),
    )


def sweep_down(
    solved: SolvedPacking,
    rows: tuple[Layer, ...],
    loads: Loads,
    *,
    linear: bool = False,
    stop_at_tension: bool = False,
    work: Work | None = None,
) -> Forces:
    """Do what ``forces.sweep_down`` does, and to the bit; compiled on what ``deposit`` compiled."""
    given = [_stacked(loads.plus), _stacked(loads.minus)]
    if (
        not isinstance(solved, CompiledPacking)
        or linear
        or stop_at_tension
        or not (rows is solved.region.rows or rows == solved.region.rows)
        or any(len(r) and r.shape[1:] != (solved.region.width,) for _, r in given)
    ):
        return forces.sweep_down(
            solved, rows, loads, linear=linear, stop_at_tension=stop_at_tension, work=work
        )
    block = solved.block
    batch, layers, width = len(block), len(rows), solved.rho[0].shape[-1]
    (F_plus, start_plus), (F_minus, start_minus) = (
        _order(own, loaded, width, side) for side, (own, loaded) in enumerate(given)
    )
    g, found = _block(batch, 2, layers + 1, width)
    found = found[:, :, :layers]

    def one(k: int) -> bool:
        return _sweep_down((F_plus, F_minus), (start_plus, start_minus), block[k], g[k], width)

    if not _all(one, batch):
        return forces.sweep_down(solved, rows, loads, work=work)  # which names the bead
    if work is not None:
        for layer in reversed(rows[1:]):
            work.did("balanced", layer, batch)
    found = found[0] if solved.rho[0].ndim == 1 else found.swapaxes(0, 1)
    return Forces(
        solved.system,
        rows,
        PerBranch(_windows(F_plus, start_plus, width), _windows(F_minus, start_minus, width)),
        PerBranch(_above_base(found[0]), _above_base(found[1])),
    )


def _windows(values: Array, start: Array, width: int) -> LazyRows[Array]:
    """Give the layers of what ``_order`` made."""
    return LazyRows(
        len(start) - 1, lambda j: values[start[j] : start[j] + width] if j else np.empty(0)
    )


def _stacked(loads: Sequence[Array | None]) -> tuple[Array, Array]:
    """Give the row that each layer has in the stack of loads (−1: it has no load), and the stack.

    Shapes: (layers,), (loaded layers, W).
    """
    index = [-1] * len(loads)
    loaded: list[Array] = []
    for j, row in enumerate(loads):
        if row is not None:
            index[j] = len(loaded)
            loaded.append(row)
    return np.array(index), np.array(loaded) if loaded else np.empty((0, 0))
