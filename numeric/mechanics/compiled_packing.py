"""Deposition in float64, compiled: bitwise the numbers of ``packing.deposit``, for any shape.

The same operations in the same order, each rounded by itself. A packing out of the ordinary (a bead
that can't rest, a number that is not finite) is given back, and left to the NumPy sweep, whose
errors name the bead.

Beads lie row after row, and the rows' arrays in one piece. Which beads bear on which is the same in
all packings of a problem: tables of *runs*, neighbouring beads whose supports are neighbours, too,
are made once.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from math import sqrt

import numpy as np

from ..arithmetic.compiling import borrowed, compiled, on_all_cores
from ..arithmetic.systems import FLOAT64, Array
from ..lattice import runs as tables
from ..lattice.branch import PerBranch
from ..lattice.layers import LazyRows, Region
from .packing import CompiledPacking, metric


@compiled
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


@compiled
def _deposit(
    base: Array, runs: Array, rho: Array, block: Array, phi: float, inverse: float
) -> bool:
    """Deposit packings; say whether every bead rests.

    ``rho`` is (packings, beads), ``base`` (2, beads) c⁺ and c⁻ of the lowest row, ``runs`` the
    table ``runs.of_supports``; filled is ``block``, (packings, 6, …): c⁺, c⁻, the δn of plus, of
    minus; the δn of the lowest row are not touched.
    """
    good = True
    rho, block = borrowed(rho), borrowed(block)
    for k in range(len(rho)):
        own_rho = rho[k]
        c_plus, c_minus = block[k, 0], block[k, 1]
        plus_a, plus_b = block[k, 2], block[k, 3]
        minus_a, minus_b = block[k, 4], block[k, 5]
        for q in range(base.shape[1]):
            c_plus[q], c_minus[q] = base[0, q], base[1, q]
            good &= (1 + own_rho[q] > 0) & (own_rho[q] < np.inf)
        for r in range(len(runs)):
            q, a, b, n = runs[r, 0], runs[r, 1], runs[r, 2], runs[r, 3]
            good &= _place(
                (c_plus[a : a + n], c_minus[a : a + n], c_plus[b : b + n], c_minus[b : b + n]),
                (own_rho[q : q + n], own_rho[a : a + n], own_rho[b : b + n]),
                (c_plus[q : q + n], c_minus[q : q + n]),
                (plus_a[q : q + n], plus_b[q : q + n]),
                (minus_a[q : q + n], minus_b[q : q + n]),
                phi,
                inverse,
            )
    return good


def memory(batch: int, quantities: int, size: int, zeros: int) -> Array:
    """Give memory, (batch, quantities, size and more): ``zeros`` behind what will be filled.

    It is one piece, since the system hands out big pieces faster. Quantities at distances that are
    multiples of 4096 bytes would compete for the same places of the cache.
    """
    end = size + zeros
    block = np.empty((batch, quantities, end + (72 - end) % 512))
    block[..., size:end] = 0.0
    return block


def lazy_rows(values: Array, starts: Array, lowest: int = 0) -> LazyRows[Array]:
    """Give the rows of (…, beads), of which those below ``lowest`` have nothing to say."""

    def row(j: int) -> Array:
        return values[..., starts[j] : starts[j + 1]] if j >= lowest else np.empty(0)

    return LazyRows(len(starts) - 1, row)


def _pairs(a: Array, b: Array, starts: Array) -> LazyRows[tuple[Array, Array]]:
    """Give the rows of δn, whose components lie in two arrays."""
    of_a, of_b = lazy_rows(a, starts, 1), lazy_rows(b, starts, 1)
    return LazyRows(len(of_a), lambda j: (of_a[j], of_b[j]))


@lru_cache(maxsize=1)
def _metric(n_x: Fraction) -> tuple[float, float]:
    """Give φ and 1/(1 − φ²): all packings of an ensemble have the same."""
    m = metric(n_x, FLOAT64)
    return float(m.phi), float(m.inverse_det)


class Deposition:
    """Deposits packings of one region, in memory that is used again for the next ones."""

    def __init__(self, n_x: Fraction, region: Region) -> None:
        """Raise ``LookupError`` where the region lacks a support."""
        self.n_x, self.region, self.metric = n_x, region, _metric(n_x)
        self.runs = tables.of_supports(region)
        self.starts = region.starts
        self.size = region.beads, region.widest
        self.block = np.empty((0, 6, 0))

    def __call__(
        self, rho: Array, rows: Sequence[Array], base: Array | None = None
    ) -> CompiledPacking | None:
        """Deposit packings of δr/r (packings, beads), whose ``rows`` they are; None: not all rest.

        ``base`` holds c⁺ and c⁻ of the lowest row, (2, beads), if it is not the ordered base. What
        was given before is overwritten.
        """
        block = self.rested(rho, base)
        if block is None:
            return None
        found = block[0] if rows[0].ndim == 1 else block.swapaxes(0, 1)
        turns = [_pairs(found[m], found[m + 1], self.starts) for m in (2, 4)]
        return CompiledPacking(
            self.n_x,
            FLOAT64,
            self.region,
            rows,
            PerBranch(lazy_rows(found[0], self.starts), lazy_rows(found[1], self.starts)),
            PerBranch(turns[0], turns[1]),
            rho,
            block,
        )

    def rested(self, rho: Array, base: Array | None = None) -> Array | None:
        """Give the ``block`` of ``_deposit`` alone; arguments as above."""
        batch = len(rho)
        base = np.zeros((2, self.region.rows[0].count)) if base is None else base
        if len(self.block) < batch:
            self.block = memory(batch, 6, *self.size)
        block = self.block[:batch]
        phi, inverse = self.metric

        def part(of: slice) -> bool:
            return _deposit(base, self.runs, rho[of], block[of], phi, inverse)

        return block if on_all_cores(part, batch) else None
