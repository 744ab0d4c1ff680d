"""The float64 sweeps of whole periodic packings, compiled: bitwise the numbers of the NumPy ones.

The same operations as in ``packing.place`` and ``forces.sweep_down``, in the same order and each
rounded by itself: no fast-math, and LLVM is not given leave to fuse a product with a sum. So every
result is the NumPy sweep's, bit for bit; whatever is out of the ordinary (a bead that can't rest,
a number that is not finite) is left to the NumPy sweep, whose errors name the bead.

Only ``engine`` imports this file, and only for work that repays loading the compiler.
"""

import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from fractions import Fraction
from math import prod, sqrt
from typing import Any, TypeVar, cast

import llvmlite.binding
import numba
import numpy as np

from numeric import forces, packing
from numeric.forces import Forces, Loads
from numeric.lattice import Array, Layer, Region
from numeric.packing import Packing
from numeric.systems import FLOAT64, NumberSystem
from numeric.work import Work

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
def _deposit(
    rho: Array,
    c: tuple[Array, Array],
    plus: tuple[Array, Array],
    minus: tuple[Array, Array],
    phi: float,
    inverse: float,
) -> bool:
    """Deposit a packing; say whether every bead rests.

    All blocks are (layers, W); layer 0 of ``plus`` and ``minus`` is not touched.
    """
    layers, width = rho.shape
    for q in range(width):
        c[0][0, q] = c[1][0, q] = 0.0
    good = True
    for q in range(width):
        good &= (1 + rho[0, q] > 0) & (rho[0, q] < np.inf)
    for j in range(1, layers):
        cp, cm, under = c[0][j - 1], c[1][j - 1], rho[j - 1]
        # A is one column to the left of B. First all beads whose supports are neighbours in the
        # arrays, then the one that rests on the last and the first bead of its layer.
        for run in range(2):
            if run == 0:
                first, last = 1 - j % 2, width - j % 2
                left, right = slice(0, width - 1), slice(1, width)
            else:
                first = (width - 1) * (j % 2)
                last = first + 1
                left, right = slice(width - 1, width), slice(0, 1)
            good &= _place(
                (cp[left], cm[left], cp[right], cm[right]),
                (rho[j, first:last], under[left], under[right]),
                (c[0][j, first:last], c[1][j, first:last]),
                (plus[0][j, first:last], plus[1][j, first:last]),
                (minus[0][j, first:last], minus[1][j, first:last]),
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
def _order(F: tuple[Array, Array], rows: tuple[Array, Array], loads: tuple[Array, Array]) -> None:
    """Fill the ordered forces ``F``, (layers, W), from the highest layer down to layer 1.

    ``rows`` gives for each layer the row of ``loads`` that it carries, −1 for none.
    """
    layers, width = F[0].shape
    for side in range(2):
        f, own, load = F[side], rows[side], loads[side]
        f[layers - 1] = 0.0
        for j in range(layers - 1, 0, -1):
            if j < layers - 1:
                by = j % 2 - side  # columns from a bead to the one above that loads it
                for q in range(width):
                    f[j, q] = f[j + 1, q + by if 0 <= q + by < width else (q + by) % width]
            if own[j] >= 0:
                for q in range(width):
                    f[j, q] += load[own[j], q]


@_compiled
def _sweep_down(
    F: tuple[Array, Array],
    plus: tuple[Array, Array],
    minus: tuple[Array, Array],
    g: tuple[Array, Array],
) -> bool:
    """Sweep a packing from the highest layer down; say if all is in order.

    All blocks are (layers, W); layer 0 of ``g`` is not touched.
    """
    layers, width = F[0].shape
    nothing = np.zeros(width)
    lost = np.zeros((2, 2, width))  # of a layer and the one above, taking turns
    good = True
    for j in range(layers - 1, 0, -1):
        up = min(j + 1, layers - 1)
        above = (F[0][up], g[0][up])
        right_a, right_b = plus[0][up], plus[1][up]
        beside = (F[1][up], g[1][up])
        left_a, left_b = minus[0][up], minus[1][up]
        if j == layers - 1:
            above = beside = (nothing, nothing)
            right_a = right_b = left_a = left_b = nothing
        for run in range(2):
            if run == 0:
                first, last = 1 - j % 2, width - j % 2
                left, right = slice(0, width - 1), slice(1, width)
            else:
                first = (width - 1) * (j % 2)
                last = first + 1
                left, right = slice(width - 1, width), slice(0, 1)
            good &= _balance(
                (F[0][j, first:last], F[1][j, first:last]),
                (
                    above[0][right],
                    above[1][right],
                    right_a[right],
                    right_b[right],
                    lost[(j + 1) % 2, 0, right],
                ),
                (
                    beside[0][left],
                    beside[1][left],
                    left_a[left],
                    left_b[left],
                    lost[(j + 1) % 2, 1, left],
                ),
                (plus[0][j, first:last], plus[1][j, first:last]),
                (minus[0][j, first:last], minus[1][j, first:last]),
                (g[0][j, first:last], g[1][j, first:last]),
                (lost[j % 2, 0, first:last], lost[j % 2, 1, first:last]),
            )
    return good


Pair = tuple[Array, Array]


@dataclass(frozen=True)
class CompiledPacking(Packing):
    """A packing whose δn also lie in ``blocks``, (batch, layers, W): those of plus, of minus."""

    blocks: tuple[Pair, Pair]


def _pairs(*shapes: tuple[int, ...]) -> list[Pair]:
    """Give pairs of blocks, all in one piece of memory: the system hands out big pieces faster."""
    sizes = [prod(shape) for shape in shapes]
    memory = np.empty(2 * sum(sizes))
    pairs, at = [], 0
    for shape, size in zip(shapes, sizes, strict=True):
        first, second = memory[at : at + 2 * size].reshape(2, *shape)
        pairs.append((first, second))
        at += 2 * size
    return pairs


def _all(function: Callable[[int], bool], batch: int) -> bool:
    """Call ``function`` for every packing of a batch, on all cores that may be used."""
    if batch == 1:
        return function(0)
    with ThreadPoolExecutor(min(batch, _cores())) as pool:
        return all(pool.map(function, range(batch)))


def _one(pair: Pair, number: int) -> Pair:
    return pair[0][number], pair[1][number]


def _cores() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this system
        return os.cpu_count() or 1


def _is_whole(rows: tuple[Layer, ...], width: int | None) -> bool:
    return all(r.count == width and r.first == j % 2 for j, r in enumerate(rows))


def _layers(block: Array, shape: tuple[int, ...], first: int = 1) -> tuple[Array, ...]:
    """Give the layers of a block in the shape that a caller knows; below ``first``, nothing."""
    by_layer = block[0] if len(shape) == 1 else block.swapaxes(0, 1)
    return (*(np.empty(0),) * first, *by_layer[first:])


def deposit(
    n_x: Fraction,
    region: Region,
    rho: tuple[Array, ...],
    system: NumberSystem,
    work: Work | None = None,
) -> Packing:
    """Do what ``packing.deposit`` does, and to the bit; compiled for whole packings in float64."""
    shape = rho[0].shape
    if system is not FLOAT64 or len(shape) > 2 or not _is_whole(region.rows, region.width):
        return packing.deposit(n_x, region, rho, system, work)
    m = packing.metric(n_x, system)
    phi, inverse = float(m.phi), float(m.inverse_det)
    # Each packing of a batch lies in one piece: cores that write next to each other are slow.
    batch = rho[0].size // shape[-1]
    size = (batch, len(rho), shape[-1])
    radii = np.concatenate(rho).reshape(size) if len(shape) == 1 else np.stack(rho, axis=1)
    c, plus, minus = _pairs(size, size, size)

    def one(k: int) -> bool:
        return _deposit(radii[k], _one(c, k), _one(plus, k), _one(minus, k), phi, inverse)

    if not _all(one, batch):
        return packing.deposit(n_x, region, rho, system, work)  # which names the bead
    if work is not None:
        for layer in region.rows:
            work.did("deposited", layer, batch)
    return CompiledPacking(
        n_x,
        system,
        region,
        rho,
        _layers(c[0], shape, 0),
        _layers(c[1], shape, 0),
        tuple(zip(_layers(plus[0], shape), _layers(plus[1], shape), strict=True)),
        tuple(zip(_layers(minus[0], shape), _layers(minus[1], shape), strict=True)),
        (plus, minus),
    )


def sweep_down(
    solved: Packing,
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
        or len(rows) != len(solved.rho)
        or not (rows is solved.region.rows or _is_whole(rows, solved.region.width))
        or any(len(r) and r.shape[1:] != (solved.region.width,) for _, r in given)
    ):
        return forces.sweep_down(
            solved, rows, loads, linear=linear, stop_at_tension=stop_at_tension, work=work
        )
    plus, minus = solved.blocks
    size = plus[0].shape
    F, g = _pairs((1, *size[1:]), size)
    (plus_rows, plus_loads), (minus_rows, minus_loads) = given
    ordered = _one(F, 0)
    _order(ordered, (plus_rows, minus_rows), (plus_loads, minus_loads))

    def one(k: int) -> bool:
        return _sweep_down(ordered, _one(plus, k), _one(minus, k), _one(g, k))

    if not _all(one, size[0]):
        return forces.sweep_down(solved, rows, loads, work=work)  # which names the bead
    if work is not None:
        for layer in reversed(rows[1:]):
            work.did("balanced", layer, size[0])
    shape = solved.rho[0].shape
    return Forces(
        solved.system,
        rows,
        _layers(F[0], shape[-1:]),
        _layers(F[1], shape[-1:]),
        _layers(g[0], shape),
        _layers(g[1], shape),
    )


def _stacked(loads: tuple[Array | None, ...]) -> tuple[Array, Array]:
    """Give the row that each layer has in the stack of loads (−1: it has no load), and the stack.

    Shapes: (layers,), (loaded layers, W).
    """
    present = [row for row in loads if row is not None]
    count = itertools.count()
    index = np.array([-1 if row is None else next(count) for row in loads])
    return index, np.stack(present) if present else np.empty((0, 0))
