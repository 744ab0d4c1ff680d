"""Packings of discs swept bead by bead: ``local`` compiled by numba, and the loops around it.

Beads lie row after row. Each quantity of a packing is in one flat array, ``pitch`` numbers behind
the one before it; where numbers carry their errors, these lie so many numbers behind them as the
last arguments say, tuples that are empty elsewhere. A *piece* of a row is as many neighbouring
beads as have their neighbours side by side, too: the innermost loops work on it in place, several
beads at a time. Nothing here is called but compiled.
"""

from functools import lru_cache
from typing import Any, NamedTuple

from ..arithmetic import compiling
from ..arithmetic.carried import Carried
from . import local
from .local import Metric, balance, gap, rest

INFINITY = float("inf")


def number(p: Any, i: Any, e: Any) -> Any:
    """Take a number, and its error."""
    if len(e) == 0:
        return p[i]
    return Carried(p[i], p[e[0] + i])


def put(p: Any, i: Any, e: Any, x: Any) -> None:
    """Put a number, and its error."""
    if len(e) == 0:
        p[i] = x
    else:
        p[i] = x.value
        p[e[0] + i] = x.error


def nearest(x: Any, e: Any) -> Any:
    """Give a number without its error."""
    if len(e) == 0:
        return x
    return x.value


def metric_of(m: Any, e: Any) -> Any:
    """Take what φ decides; errors lie behind it."""
    if len(e) == 0:
        return Metric(m[0], m[1], m[2])
    return Metric(Carried(m[0], m[3]), Carried(m[1], m[4]), Carried(m[2], m[5]))


def piece(at: Any, n: Any, count: Any, period: Any) -> Any:
    """Find bead ``at`` of a row of ``count``, and how many of n beads from there lie side by side.

    In a periodic packing (``period`` > 0) that may be an image. Gives −1 where no bead is.
    """
    if period > 0:
        at %= period
        n = min(n, period - at)
    if at < 0:
        return -1, min(n, -at)
    if at >= count:
        return -1, n
    return at, min(n, count - at)


def sound(x: Any, e: Any) -> Any:
    """Say whether a number is positive, and finite."""
    return (nearest(x, e) > 0) & (nearest(x, e) < INFINITY)


def rest_piece(
    rho: Any, block: Any, pitch: Any, r: Any, own: Any, a: Any, b: Any, n: Any, m: Any,
    e: Any, f: Any,
) -> Any:  # fmt: skip
    """Rest n beads on their supports a and b; say whether all can. Radii lie r further on."""
    good = True
    for q in range(n):
        rho_own = number(rho, r + own + q, e)
        bead = rest(
            (
                (number(block, a + q, f), number(block, pitch + a + q, f)),
                (number(block, b + q, f), number(block, pitch + b + q, f)),
            ),
            rho_own,
            (number(rho, r + a + q, e), number(rho, r + b + q, e)),
            m,
        )
        put(block, own + q, f, bead.c[0])
        put(block, pitch + own + q, f, bead.c[1])
        put(block, 2 * pitch + own + q, f, bead.dn[0][0])
        put(block, 3 * pitch + own + q, f, bead.dn[0][1])
        put(block, 4 * pitch + own + q, f, bead.dn[1][0])
        put(block, 5 * pitch + own + q, f, bead.dn[1][1])
        holds = bead.holds
        good &= sound(1 + rho_own, f) & sound(holds[0], f) & sound(holds[1], f)
        good &= sound(holds[2], f)
    return good


def deposit(
    rho: Any, block: Any, rows: Any, m: Any, batch: Any, layers: Any, period: Any, beads: Any,
    pitch: Any, e: Any, f: Any,
) -> int:  # fmt: skip
    """Deposit packings; say whether every bead rests.

    ``rho`` is (batch, beads); ``block``, (batch, 6, pitch), is filled with c and δn. ``rows``
    (layers, 3): each row's first bead, how many there are, and in which column of the row below its
    first bead has the support x − e₊.
    """
    good, metric = True, metric_of(m, f)
    for k in range(batch):
        p = 6 * k * pitch
        r = k * beads - p
        for q in range(rows[1]):  # the base stays where it is
            radius = 1 + number(rho, k * beads + q, e)
            good &= sound(radius, f)
            for a in range(6):
                put(block, p + a * pitch + q, f, 0 * radius)
        for j in range(1, layers):
            below, under = p + rows[3 * j - 3], rows[3 * j - 2]
            start, count, shift = p + rows[3 * j], rows[3 * j + 1], rows[3 * j + 2]
            q = 0
            while q < count:
                a, n = piece(q + shift, count - q, under, period)
                b, n = piece(q + shift + 1, n, under, period)
                good &= rest_piece(
                    rho, block, pitch, r, start + q, below + a, below + b, n, metric, e, f
                )
                q += n
    return int(good)


def balance_piece(
    F: Any, block: Any, g: Any, size: Any, pitch: Any, k: Any, own: Any, here: Any, fa: Any,
    ra: Any, fb: Any, rb: Any, n: Any, e: Any, f: Any, h: Any,
) -> Any:  # fmt: skip
    """Balance n beads below a and b; say whether all is in order. Changes lie k further on."""
    good = True
    for q in range(n):
        bead = balance(
            (number(F, fa + q, e), number(F, size + fb + q, e)),
            (number(g, k + fa + q, h), number(g, k + size + fb + q, h)),
            (
                (number(block, 2 * pitch + ra + q, f), number(block, 3 * pitch + ra + q, f)),
                (number(block, 4 * pitch + rb + q, f), number(block, 5 * pitch + rb + q, f)),
            ),
            (number(F, own + q, e), number(F, size + own + q, e)),
            (
                (number(block, 2 * pitch + here + q, f), number(block, 3 * pitch + here + q, f)),
                (number(block, 4 * pitch + here + q, f), number(block, 5 * pitch + here + q, f)),
            ),
        )
        put(g, k + own + q, h, bead.g[0])
        put(g, k + size + own + q, h, bead.g[1])
        good &= sound(bead.det * bead.det, f)
        good &= (abs(nearest(bead.g[0], f)) < INFINITY) & (abs(nearest(bead.g[1], f)) < INFINITY)
    return good


def sweep_down(
    F: Any, block: Any, g: Any, rows: Any, batch: Any, layers: Any, period: Any, nothing: Any,
    size: Any, pitch: Any, e: Any, f: Any, h: Any,
) -> int:  # fmt: skip
    """Balance packings from the top down; say whether all is in order.

    ``F`` (2, size) are ordered forces, ``block`` is that of ``deposit``; filled is ``g``, (batch,
    2, size). From ``nothing`` on both have zeros, as many as a row has beads. ``rows`` (layers, 7):
    the first bead of a row among those that forces reach, and how many these are; the same of all
    beads deposited; where among these the first of the former is; and in which column of either
    row above its neighbour x + e₊ is.
    """
    good = True
    for k in range(batch):
        p, c = 6 * k * pitch, 2 * k * size
        for j in range(layers - 1, 0, -1):
            row = 7 * j
            start, count, region, wide = rows[row], rows[row + 1], rows[row + 2], rows[row + 3]
            q = 0
            while q < count:
                here, n = piece(q + rows[row + 4], count - q, wide, period)
                here += p + region
                fa = fb = nothing
                ra = rb = here
                if j + 1 < layers:
                    force, reached, bead, over = (
                        rows[row + 7], rows[row + 8], p + rows[row + 9], rows[row + 10],
                    )  # fmt: skip
                    a, n = piece(q + rows[row + 5], n, reached, period)
                    b, n = piece(q + rows[row + 5] - 1, n, reached, period)
                    if a >= 0:
                        fa, (x, n) = force + a, piece(q + rows[row + 6], n, over, period)
                        ra = bead + x
                    if b >= 0:
                        fb, (x, n) = force + b, piece(q + rows[row + 6] - 1, n, over, period)
                        rb = bead + x
                good &= balance_piece(
                    F, block, g, size, pitch, c, start + q, here, fa, ra, fb, rb, n, e, f, h
                )
                q += n
            if count == 0:
                break
    return int(good)


def gaps(
    rho: Any, block: Any, found: Any, rows: Any, m: Any, batch: Any, layers: Any, rise: Any,
    period: Any, beads: Any, pitch: Any,
) -> int:  # fmt: skip
    """Fill in the gaps of beads and those that lie so many steps on, where these are there.

    ``found`` (batch, beads); ``rows`` (layers, 3): as for ``deposit``, but the column, in the row
    that lies ``rise`` above, of the other bead. ``m``: of floats, then steps, square and excess.
    """
    metric, steps = Metric(m[0], m[1], m[2]), (m[3], m[4])
    for k in range(batch):
        r, p = k * beads, 6 * k * pitch
        for j in range(layers - rise):
            start, count, shift = rows[3 * j], rows[3 * j + 1], rows[3 * j + 2]
            other, over = rows[3 * (j + rise)], rows[3 * (j + rise) + 1]
            q = 0
            while q < count:
                a, n = piece(q + shift, count - q, over, period)
                if a >= 0:
                    gap_piece(
                        rho, block, found, pitch, r, p, start + q, other + a, n, metric, steps, m
                    )
                q += n
    return 0


def gap_piece(
    rho: Any, block: Any, found: Any, pitch: Any, r: Any, p: Any, own: Any, a: Any, n: Any,
    metric: Any, steps: Any, m: Any,
) -> None:  # fmt: skip
    """Fill in the gaps of n beads from ``own`` on, and as many from ``a`` on."""
    for q in range(n):
        u = (
            block[p + a + q] - block[p + own + q],
            block[p + pitch + a + q] - block[p + pitch + own + q],
        )
        both = rho[r + a + q] + rho[r + own + q]
        found[r + own + q] = gap(steps, m[5], m[6], u, both, metric)


_NUMBERS = ("float", "float", "whole", "float", *["number"] * 5)
_FORCES = ("float", "float", "float", "whole", *["number"] * 6)
_GAPS = ("float", "float", "float", "whole", "float", *["number"] * 6)


class Loops(NamedTuple):
    """What is compiled: without errors, and with them."""

    deposit: Any
    sweep_down: Any
    deposit_carried: Any
    sweep_down_carried: Any
    gaps: Any


@lru_cache(maxsize=1)
def loops() -> Loops | None:
    """Give the compiled loops; None where numba is not installed."""
    own = number, put, nearest, metric_of, piece, sound, rest_piece, balance_piece, gap_piece
    of_bead = (
        local.total, local.plus, local.less, local.times, local.scaled, local.over, local.shifted,
        local.replaced, local.raised, local.dot, local.turned, local._line, local._turn,
        local._solved, rest, balance, gap,
    )  # fmt: skip
    entries: list[tuple[Any, tuple[str, ...]]] = [
        (deposit, (*_NUMBERS, "none", "none")),
        (sweep_down, (*_FORCES, "none", "none", "none")),
        (deposit, (*_NUMBERS, "offset", "offset")),
        (sweep_down, (*_FORCES, "offset", "offset", "offset")),
        (gaps, _GAPS),
    ]
    made = compiling.compiled(entries, [*of_bead, *own])
    return None if made is None else Loops(*made)
