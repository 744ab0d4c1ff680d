"""The loops around recorded kernels; ``kernels`` puts both into one file and compiles it.

Beads lie row after row, each quantity in one flat array. A *run* is as many neighbouring beads as
have their neighbours side by side, too: a kernel works on it in place, several beads at a time.
``D`` is the dimension. Where numbers carry their errors, these lie behind the values: first all
quantities, then the errors of all, which are filled in once the values are.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from force_diffusion.numeric.arithmetic.compiling import borrowed, compiled, inner
from force_diffusion.numeric.arithmetic.systems import Array

if TYPE_CHECKING:
    D, NONE, RESOLUTION, TOGETHER = 2, 32, 0.0, 512

    def rest(rho: Array, block: Array, run: Array, m: Array) -> bool:
        """Recorded from ``local.rest``."""

    def balance(F: Array, block: Array, g: Array, lost: Array, run: Array, m: Array) -> bool:
        """Recorded from ``local.balance``."""

    def order_errors(F: Array, shares: Array, run: Array, m: Array) -> bool:
        """Recorded from ``kernels``."""

    def rest_errors(rho: Array, block: Array, run: Array, m: Array) -> bool:
        """Recorded from ``defects``."""

    def balance_errors(F: Array, block: Array, g: Array, run: Array, m: Array) -> bool:
        """Recorded from ``defects``."""

    def order(F: Array, shares: Array, run: Array, m: Array) -> bool:
        """Recorded from ``kernels``."""

    def gap(rho: Array, block: Array, gaps: Array, run: Array, m: Array) -> bool:
        """Recorded from ``local.gap``."""


_ALL = 0x7FFF_FFFF_FFFF_FFFF  # all bits of a double but its sign


@inner
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
def runs(
    layers: Array, links: Array, turns: Array, nothing: Array, most: int, found: Array
) -> int:  # fmt: skip
    """Cut layers into runs of at most ``most`` beads; say how many there are.

    ``layers`` (layers, 3) has the beads, first bead and beads in a row of each; ``links`` (layers,
    places, 4) and ``turns`` (places, rows of a layer) name the beads of each place. Where there are
    none, ``nothing`` is where ``NONE`` zeros lie; if that is negative, a run is left out. Filled is
    ``found``, (runs, places + 1), as far as it goes.
    """
    places, count = len(nothing), 0
    run = found[len(found) - 1]  # one more than is told of
    for j in range(len(layers)):
        at = 0
        while at < layers[j, 1]:
            n, whole = min(layers[j, 1] - at, most), True
            for k in range(places):
                place, n = _piece(at, n, layers[j, 2], links[j, k], turns[k])
                if place < 0:
                    place, n = nothing[k], min(n, NONE)
                    whole &= place >= 0
                run[k] = place
            at += n
            if whole:
                if count < len(found) - 1:
                    for k in range(places):
                        found[count, k] = run[k]
                    found[count, places] = n
                count += 1
    return count


@inner
def _largest(words: Array, top: int) -> int:
    """Give the largest of absolute values and ``top``, all as the bits of doubles."""
    for i in range(len(words)):
        top = max(top, words[i] & _ALL)
    return top


@compiled
def deposit(
    rho: Array, block: Array, runs: Array, m: Array, words: Array, most: Array
) -> bool:  # fmt: skip
    """Deposit packings; say whether every bead rests.

    ``rho`` is (packings, parts, beads); ``block``, (packings, parts (D + D²), …), has the c of the
    lowest layer; filled in are those of all others, and behind them the δn of contacts below. The
    places of ``runs``, the lowest layer first: the beads, and their supports. ``words`` are the
    bits of the block, and ``most``, (packings, quantities), keeps the largest absolute values.
    """
    rho, block, words, most = borrowed(rho), borrowed(block), borrowed(words), borrowed(most)
    good = True
    for k in range(len(rho)):
        for r in range(len(runs)):
            good &= rest(rho[k], block[k], runs[r], m)
            if rho.shape[1] > 1:
                rest_errors(rho[k], block[k], runs[r], m)
            for q in range(most.shape[1]):
                own = words[k, q, runs[r, 0] : runs[r, 0] + runs[r, -1]]
                most[k, q] = _largest(own, most[k, q])
    return good


@compiled
def straight_down(F: Array, shares: Array, runs: Array, m: Array) -> None:
    """Carry loads straight down: fill in the ordered forces ``F``, (parts D, …) as ``shares``.

    ``runs`` are those of ``sweep_down``.
    """
    for r in range(len(runs)):
        order(F, shares, runs[r], m)
        if len(F) > D:
            order_errors(F, shares, runs[r], m)


@compiled
def sweep_down(F: Array, block: Array, g: Array, lost: Array, runs: Array, m: Array) -> bool:
    """Sweep packings down; say if all is in order.

    ``F`` (parts D, …) are the ordered forces, ``block`` is that of ``deposit``; filled is ``g``,
    (packings, parts D, …), alike. ``lost`` is for what the sums of a layer and the one above have
    lost, which take turns. The places of ``runs``, the highest layer first: the beads
    among those that forces reach, in the block, and where they lose; and of each upper bead these.
    """
    F, block, g, lost = borrowed(F), borrowed(block), borrowed(g), borrowed(lost)
    good = True
    for k in range(len(g)):
        for r in range(len(runs)):
            good &= balance(F, block[k], g[k], lost, runs[r], m)
            if len(F) > D:
                balance_errors(F, block[k], g[k], runs[r], m)
    return good


@compiled
def settle(g: Array, words: Array, at: int, n: int, most: Array) -> None:
    """Round numbers that carry their errors once, in place.

    ``g`` is (packings, parts D, …). ``most``, (parts D,), keeps what was largest before.
    """
    g, words = borrowed(g), borrowed(words)
    for k in range(len(g)):
        for a in range(D):
            for low in range(at, at + n, TOGETHER):
                high = min(at + n, low + TOGETHER)
                values, errors = g[k, a, low:high], g[k, a + D, low:high]
                most[a] = _largest(words[k, a, low:high], most[a])
                most[a + D] = _largest(words[k, a + D, low:high], most[a + D])
                for i in range(high - low):
                    values[i] += errors[i]


@compiled
def gaps(
    rho: Array, block: Array, runs: Array, of_layer: Array, m: Array, smallest: float,
    found: Array, gaps: Array, words: Array,
) -> float:  # fmt: skip
    """Measure the gaps of pairs of one kind; give the smallest, if it is below ``smallest``.

    ``rho`` (packings, 1, beads); the places of ``runs`` are both beads of a pair, ``of_layer``
    has each layer's first run; ``m``: constants of the kernel. ``found``: the packing, both beads,
    overlaps, gaps that are too close to tell, and gaps that are no number are counted there. Of
    equal gaps the first is named: layer after layer, in each packing after packing. ``gaps``:
    memory for those of one run, (1, beads and one); ``words`` are its bits.
    """
    rho, block = borrowed(rho), borrowed(block)
    values, spare = borrowed(gaps)[0], len(words) - 1
    for j in range(len(of_layer) - 1):
        for k in range(len(rho)):
            for r in range(of_layer[j], of_layer[j + 1]):
                gap(rho[k], block[k], gaps, runs[r], m)
                over = close = odd = 0
                least: Any = np.int64(_ALL)
                for q in range(runs[r, -1]):
                    value, word = values[q], words[q]
                    over += value < -RESOLUTION
                    close += abs(value) <= RESOLUTION
                    odd += not value <= np.inf
                    least = min(least, word ^ ((word >> 63) & _ALL))
                words[spare] = least ^ ((least >> 63) & _ALL)
                found[3] += over
                found[4] += close
                found[5] += odd
                if values[spare] < smallest:
                    smallest, place = values[spare], 0
                    while values[place] != smallest:
                        place += 1
                    found[0], found[1], found[2] = k, runs[r, 0] + place, runs[r, 1] + place
    return smallest
