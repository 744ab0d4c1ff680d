"""The loops around recorded kernels; ``kernels`` puts both into one file and compiles it.

A strip of beads is gathered into one flat array, quantity after quantity at equal distances, so
that LLVM takes several beads at a time; a kernel works on it, and what it gives is put back.
``D`` is the dimension; ``PARTS`` is 2 where numbers carry their errors, which then lie behind the
values: first all quantities, then the errors of all.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from force_diffusion.numeric.arithmetic.compiling import borrowed, compiled
from force_diffusion.numeric.arithmetic.systems import Array

if TYPE_CHECKING:
    D, PARTS, STRIP, RESOLUTION = 2, 1, 256, 0.0

    def rest(strip: Array, beads: int, constants: Array) -> bool:
        """Recorded from ``local.rest``."""

    def balance(strip: Array, beads: int, constants: Array) -> bool:
        """Recorded from ``local.balance``."""

    def gap(strip: Array, beads: int, constants: Array) -> bool:
        """Recorded from ``local.gap``."""


_ALL = 0x7FFF_FFFF_FFFF_FFFF  # all bits of a double but its sign


@compiled
def _piece(at: int, n: int, own: int, link: Array, turn: Array) -> tuple[int, int]:
    """Find where bead ``at`` of a layer has its neighbour, and how many after it have theirs there.

    A layer has rows of ``own`` beads; ``link``: the neighbours' first bead, how many a row of them
    has, by how many columns they are shifted, and after how many all begins anew (0: never).
    ``turn`` says in which row they are. Gives −1 where there is none.
    """
    row = at // own
    q = at - row * own
    c, n = q + link[2], min(own - q, n)
    if link[3] > 0:
        c %= link[3]
        n = min(n, link[3] - c)
    if c < 0:
        return -1, min(n, -c)
    if c >= link[1]:
        return -1, n
    return link[0] + turn[row] * link[1] + c, min(n, link[1] - c)


@compiled
def _gather(
    values: Array, first: int, several: int, link: Array, turn: Array, own: int, at: int, n: int,
    strip: Array, to: int,
) -> None:  # fmt: skip
    """Copy several quantities of the neighbours of ``n`` beads; zeros where there are none."""
    x = 0
    while x < n:
        start, m = _piece(at + x, n - x, own, link, turn)
        for k in range(several):
            part = strip[(to + k) * STRIP + x : (to + k) * STRIP + x + m]
            if start < 0:
                part[:] = 0.0
            else:
                source = values[first + k, start : start + m]
                for i in range(m):
                    part[i] = source[i]
        x += m


@compiled
def deposit(
    rho: Array, block: Array, base: Array, links: Array, turns: Array, layers: Array, m: Array
) -> bool:
    """Deposit packings; say whether every bead rests.

    ``rho`` is (packings, PARTS, beads), ``base`` (PARTS D, beads) what c is in the lowest layer;
    filled is ``block``, (packings, PARTS (D + D²), …): c, and the δn of contacts below, which
    those of the base lack. ``links`` (layers, D, 4) and ``turns`` (D, rows of a layer) name the
    supports, ``layers`` (layers, 3) has each one's first bead, beads, and beads in a row.
    """
    Q = D + D * D
    strip = np.empty((PARTS * (Q + D + 2)) * STRIP)
    rho, block = borrowed(rho), borrowed(block)
    good = True
    for k in range(len(rho)):
        own_rho, of = rho[k], block[k]
        for part in range(PARTS):
            for a in range(D):
                for q in range(layers[0, 1]):
                    of[part * Q + a, q] = base[part * D + a, q]
        for j in range(1, len(layers)):
            first, beads, own = layers[j, 0], layers[j, 1], layers[j, 2]
            for at in range(0, beads, STRIP):
                n, to = min(STRIP, beads - at), 0
                for part in range(PARTS):
                    for a in range(D):
                        _gather(of, part * Q, D, links[j, a], turns[a], own, at, n, strip, to)
                        to += D
                    for a in range(D):
                        _gather(own_rho, part, 1, links[j, a], turns[a], own, at, n, strip, to)
                        to += 1
                    strip[to * STRIP : to * STRIP + n] = own_rho[part, first + at : first + at + n]
                    to += 1
                good &= rest(strip, n, m)
                for r in range(PARTS * Q):
                    to_row = of[r, first + at : first + at + n]
                    from_row = strip[r * STRIP : r * STRIP + n]
                    for i in range(n):
                        to_row[i] = from_row[i]
    return good


@compiled
def sweep_down(
    F: Array, block: Array, g: Array, lost: Array, above: Array, over: Array, here: Array,
    turns: Array, layers: Array, m: Array,
) -> bool:  # fmt: skip
    """Sweep packings from the highest layer down; say if all is in order.

    ``F`` (PARTS D, …) are the ordered forces, ``block`` is that of ``deposit``; filled is ``g``,
    (packings, PARTS D, …), alike. ``lost`` is for what the sums of a layer and the one above have
    lost, which take turns. ``above`` (layers, D, 4) names upper beads among those of ``layers``,
    ``over`` among those of the block, ``here`` (layers, 4) the beads themselves.
    """
    Q = D + D * D
    strip = np.empty((PARTS * (D * (D + 3) + D + D * D)) * STRIP)
    F, block, g, lost = borrowed(F), borrowed(block), borrowed(g), borrowed(lost)
    good, size = True, lost.shape[1] // 2
    still = np.arange(turns.shape[1])
    link = np.empty(4, np.int64)
    for k in range(len(g)):
        of, own_g = block[k], g[k]
        for j in range(len(layers) - 1, 0, -1):
            first, beads, own = layers[j, 0], layers[j, 1], layers[j, 2]
            if not beads:
                break
            for at in range(0, beads, STRIP):
                n, to = min(STRIP, beads - at), 0
                for part in range(PARTS):
                    for a in range(D):
                        up = above[j, a]
                        link[:] = up
                        link[0] = (j + 1) % 2 * size
                        _gather(F, part * D + a, 1, up, turns[a], own, at, n, strip, to)
                        _gather(own_g, part * D + a, 1, up, turns[a], own, at, n, strip, to + 1)
                        row = part * Q + D + a * D
                        _gather(of, row, D, over[j, a], turns[a], own, at, n, strip, to + 2)
                        to += 2 + D
                        _gather(lost, part * D + a, 1, link, turns[a], own, at, n, strip, to)
                        to += 1
                    for a in range(D):
                        to_row = strip[to * STRIP : to * STRIP + n]
                        to_row[:] = F[part * D + a, first + at : first + at + n]
                        to += 1
                    _gather(of, part * Q + D, D * D, here[j], still, own, at, n, strip, to)
                    to += D * D
                good &= balance(strip, n, m)
                new = j % 2 * size + at
                for part in range(PARTS):
                    for a in range(D):
                        r = (2 * part * D + a) * STRIP
                        own_g[part * D + a, first + at : first + at + n] = strip[r : r + n]
                        r += D * STRIP
                        lost[part * D + a, new : new + n] = strip[r : r + n]
    return good


@compiled
def gaps(
    rho: Array, block: Array, kinds: Array, links: Array, turns: Array, layers: Array, m: Array,
    smallest: float, found: Array, strip: Array,
) -> float:  # fmt: skip
    """Measure the gaps of pairs of one kind; give the smallest, if it is below ``smallest``.

    ``rho`` (packings, beads), ``links`` (layers, 4): the other bead of each pair, ``kinds`` are
    constants of the kernel. ``found``: the packing, both beads, overlaps, gaps that are too close
    to tell, and gaps that are no number are counted there. Of equal gaps the first is named.
    """
    rho, block, strip = borrowed(rho), borrowed(block), borrowed(strip)
    words = strip.view(np.int64)
    constants = np.concatenate((m, kinds))
    for j in range(len(layers)):
        own, link = layers[j, 2], links[j]
        for k in range(len(rho)):
            at = 0
            while at < layers[j, 1]:
                other, n = _piece(at, min(STRIP, layers[j, 1] - at), own, link, turns)
                here = layers[j, 0] + at
                at += n
                if other < 0:
                    continue
                for a in range(D):
                    for q in range(n):
                        strip[a * STRIP + q] = block[k, a, here + q]
                        strip[(D + a) * STRIP + q] = block[k, a, other + q]
                for q in range(n):
                    strip[2 * D * STRIP + q] = rho[k, here + q]
                    strip[(2 * D + 1) * STRIP + q] = rho[k, other + q]
                gap(strip, n, constants)
                over = close = odd = 0
                least: Any = np.int64(_ALL)
                for q in range(n):
                    value, word = strip[q], words[q]
                    over += value < -RESOLUTION
                    close += abs(value) <= RESOLUTION
                    odd += not value <= np.inf
                    least = min(least, word ^ ((word >> 63) & _ALL))
                words[STRIP] = least ^ ((least >> 63) & _ALL)
                found[3] += over
                found[4] += close
                found[5] += odd
                if strip[STRIP] < smallest:
                    smallest, place = strip[STRIP], 0
                    while strip[place] != smallest:
                        place += 1
                    found[0], found[1], found[2] = k, here + place, other + place
    return smallest
