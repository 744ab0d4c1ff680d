"""The float64 sweeps, compiled: bitwise the numbers of the NumPy ones, for packings of any shape.

The same operations as in ``packing.place`` and ``forces.sweep_down``, in the same order and each
rounded by itself. So every result is the NumPy sweep's, bit for bit; whatever is out of the
ordinary (a bead that can't rest, a number that is not finite) is left to the NumPy sweep, whose
errors name the bead.

Beads lie row after row, and the rows' arrays in one piece. Which beads bear on which is the same in
all packings of a problem: tables of *runs*, neighbouring beads whose supports are neighbours, too,
are made once. ``Sweeps`` holds them together with the memory, which is used again.

Only ``engine`` imports this file, and only for work that repays loading the compiler.
"""

from collections.abc import Sequence
from fractions import Fraction
from functools import lru_cache
from math import sqrt

import numpy as np

from ..arithmetic.compiling import compiled, on_all_cores
from ..arithmetic.systems import FLOAT64, Array, NumberSystem
from ..disorder import compiled as drawing
from ..disorder.radii import DrawnRadii, Radii
from ..lattice import runs as tables
from ..lattice.branch import PerBranch
from ..lattice.layers import Layer, LazyRows, Region, Stack, pick, starts
from . import forces, packing, physicality
from .forces import CompiledForces, Forces, Loads, Ordered
from .packing import CompiledPacking, SolvedPacking
from .work import Work


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


@compiled
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


@compiled
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


@compiled
def _sweep_down(F: tuple[Array, Array], runs: Array, block: Array, g: Array, lost: Array) -> bool:
    """Sweep packings from the highest layer down; say if all is in order.

    ``F`` are the ordered forces, ``runs`` the table ``runs.of_loads``, ``block`` is that of
    ``_deposit``; filled is ``g``, (packings, 2, …). ``lost``, alike, is for what the sums of a
    layer and the one above have lost, which take turns. Beyond the last bead all have zeros.
    """
    F_plus, F_minus = F
    good = True
    for k in range(len(block)):
        g_plus, g_minus = g[k, 0], g[k, 1]
        plus_a, plus_b = block[k, 2], block[k, 3]
        minus_a, minus_b = block[k, 4], block[k, 5]
        for r in range(len(runs)):
            q, b, a, n = runs[r, 0], runs[r, 1], runs[r, 2], runs[r, 3]
            here, over_b, over_a = runs[r, 4], runs[r, 5], runs[r, 6]
            Fp, Fb, Fm, Fa = runs[r, 7], runs[r, 8], runs[r, 9], runs[r, 10]
            new, old_b, old_a = runs[r, 11], runs[r, 12], runs[r, 13]
            good &= _balance(
                (F_plus[Fp : Fp + n], F_minus[Fm : Fm + n]),
                (
                    F_plus[Fb : Fb + n],
                    g_plus[b : b + n],
                    plus_a[over_b : over_b + n],
                    plus_b[over_b : over_b + n],
                    lost[k, 0, old_b : old_b + n],
                ),
                (
                    F_minus[Fa : Fa + n],
                    g_minus[a : a + n],
                    minus_a[over_a : over_a + n],
                    minus_b[over_a : over_a + n],
                    lost[k, 1, old_a : old_a + n],
                ),
                (plus_a[here : here + n], plus_b[here : here + n]),
                (minus_a[here : here + n], minus_b[here : here + n]),
                (g_plus[q : q + n], g_minus[q : q + n]),
                (lost[k, 0, new : new + n], lost[k, 1, new : new + n]),
            )
    return good


_ALL = 0x7FFF_FFFF_FFFF_FFFF  # all bits of a double but its sign


@compiled
def _gap(
    own: Array, c: tuple[Array, Array], run: Array, kind: Array, phi: tuple[float, float],
    found: Array,
) -> tuple[float, int, int]:  # fmt: skip
    """Measure the gaps of a run of pairs; give the smallest, overlaps, and what is too close."""
    a, b, n = run[0], run[1], run[2]
    c_plus, c_minus = c
    p_a, p_b, m_a, m_b = (
        c_plus[a : a + n],
        c_plus[b : b + n],
        c_minus[a : a + n],
        c_minus[b : b + n],
    )
    r_a, r_b, gaps, words = own[a : a + n], own[b : b + n], found[:n], found.view(np.int64)
    along, across, square, excess = kind[0], kind[1], kind[2], kind[3]
    overlaps = undecided = no_number = 0
    for q in range(n):
        up, um = p_b[q] - p_a[q], m_b[q] - m_a[q]
        both = r_a[q] + r_b[q]
        size = (up * up + um * um - phi[0] * up * um) / phi[1]
        change = 2 * (along * up + across * um) + size
        distance = np.sqrt(max(square + change, 0.0))
        gap = (excess + (change - 4 * both - both * both)) / (distance + 2 + both)
        gaps[q] = gap
        overlaps += gap < -physicality.RESOLUTION
        undecided += abs(gap) <= physicality.RESOLUTION
        no_number += not gap <= np.inf
    least = np.int64(_ALL)
    for q in range(n):  # as whole numbers, which are compared together, doubles have their order
        least = min(least, words[q] ^ ((words[q] >> 63) & _ALL))
    words[n] = least ^ ((least >> 63) & _ALL)
    return found[n], overlaps, -1 if no_number else undecided


@compiled
def _gaps(
    rho: Array, block: Array, runs: Array, lattice: Array, phi: tuple[float, float], found: Array
) -> tuple[float, tuple[int, int, int], int, int]:
    """Measure all gaps: the smallest, its (run, place in it, packing), overlaps, what is too close.

    The last is −1 where a gap is no number. ``runs`` is the table ``runs.of_pairs``, ``lattice``
    has what kinds of pairs have in common (``physicality.of_lattice``), ``phi`` what all have;
    ``found`` is as long as the longest run and one more. Of equal gaps the first is named: layer
    and kind after layer and kind, in each packing after packing.
    """
    smallest, run, place, packing_of = np.inf, -1, 0, 0
    overlaps = undecided = first = 0
    while first < len(runs):
        last = first
        while (
            last < len(runs) and runs[last, 3] == runs[first, 3] and runs[last, 4] == runs[first, 4]
        ):
            last += 1
        for k in range(len(rho)):
            for r in range(first, last):
                least, over, close = _gap(
                    rho[k], (block[k, 0], block[k, 1]), runs[r], lattice[runs[r, 3]], phi, found
                )
                if close < 0:
                    return smallest, (run, place, packing_of), overlaps, close
                overlaps += over
                undecided += close
                if least < smallest:
                    smallest, run, packing_of = least, r, k
                    place = 0
                    while found[place] != smallest:
                        place += 1
        first = last
    return smallest, (run, place, packing_of), overlaps, undecided


def gaps(
    solved: CompiledPacking, layers: range
) -> tuple[float, tuple[int, int, int] | None, int, int] | None:
    """Give the smallest gap, between which beads, overlaps, and gaps too close to tell.

    Two beads by their number in the region, and the packing. None where a gap is no number.
    """
    region = solved.region
    runs = tables.of_pairs(region, layers, physicality.NEIGHBOURS)
    kinds = [physicality.of_lattice(solved.n_x, offset) for offset in physicality.NEIGHBOURS]
    lattice = np.array([kind[:4] for kind in kinds])
    found = np.empty(region.widest + 1)
    phi = kinds[0][4], kinds[0][5]
    smallest, (run, q, which), overlaps, undecided = _gaps(
        solved.flat, solved.block, runs, lattice, phi, found
    )
    if undecided < 0:
        return None
    beads = None if run < 0 else (int(runs[run, 0] + q), int(runs[run, 1] + q), which)
    return smallest, beads, overlaps, undecided


def _ordered(rows: tuple[Layer, ...], width: int | None, loads: Loads, *, whole: bool) -> Ordered:
    """Carry the loads straight down; ``whole`` layers share what they have alike."""
    if whole:
        assert width is not None
        (plus, at_plus), (minus, at_minus) = (
            _order(*_stacked(of), width, side) for side, of in enumerate((loads.plus, loads.minus))
        )
        return Ordered((plus, minus), (at_plus, at_minus), (0, 0))
    at = starts(rows)
    found = []
    for side, of in ((1, loads.plus), (-1, loads.minus)):
        F = np.zeros(at[-1] + max(row.count for row in rows))
        above, over = np.empty(0), Layer(len(rows), 0, 0)
        for j in range(len(rows) - 1, 0, -1):
            row, load = rows[j], of[j]
            if not row.count:
                break
            above = pick(above, over, Layer(j + 1, row.first + side, row.count), width, 0.0)
            above = above if load is None else above + load
            F[at[j] : at[j + 1]], over = above, row
        found.append(F)
    end = int(at[-1])
    return Ordered((found[0], found[1]), (at, at), (end, end))


def _block(batch: int, quantities: int, size: int, zeros: int) -> Array:
    """Give memory, (batch, quantities, size and more): ``zeros`` behind what will be filled.

    It is one piece, since the system hands out big pieces faster. Quantities at distances that are
    multiples of 4096 bytes would compete for the same places of the cache.
    """
    end = size + zeros
    block = np.empty((batch, quantities, end + (72 - end) % 512))
    block[..., size:end] = 0.0
    return block


def _rows(values: Array, starts: Array, lowest: int = 0) -> LazyRows[Array]:
    """Give the rows of (…, beads), of which those below ``lowest`` have nothing to say."""

    def row(j: int) -> Array:
        return values[..., starts[j] : starts[j + 1]] if j >= lowest else np.empty(0)

    return LazyRows(len(starts) - 1, row)


def _pairs(a: Array, b: Array, starts: Array) -> LazyRows[tuple[Array, Array]]:
    """Give the rows of δn, whose components lie in two arrays."""
    of_a, of_b = _rows(a, starts, 1), _rows(b, starts, 1)
    return LazyRows(len(of_a), lambda j: (of_a[j], of_b[j]))


@lru_cache(maxsize=1)
def _metric(n_x: Fraction) -> tuple[float, float]:
    """Give φ and 1/(1 − φ²): all packings of an ensemble have the same."""
    m = packing.metric(n_x, FLOAT64)
    return float(m.phi), float(m.inverse_det)


class Deposition:
    """Deposits packings of one region, in memory that is used again for the next ones."""

    def __init__(self, n_x: Fraction, region: Region) -> None:
        """Raise ``LookupError`` where the region lacks a support."""
        self.n_x, self.region = n_x, region
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
        batch = len(rho)
        base = np.zeros((2, self.region.rows[0].count)) if base is None else base
        if len(self.block) < batch:
            self.block = _block(batch, 6, *self.size)
        block = self.block[:batch]
        phi, inverse = _metric(self.n_x)

        def part(of: slice) -> bool:
            return _deposit(base, self.runs, rho[of], block[of], phi, inverse)

        if not on_all_cores(part, batch):
            return None
        found = block[0] if rows[0].ndim == 1 else block.swapaxes(0, 1)
        turns = [_pairs(found[m], found[m + 1], self.starts) for m in (2, 4)]
        return CompiledPacking(
            self.n_x,
            FLOAT64,
            self.region,
            rows,
            PerBranch(_rows(found[0], self.starts), _rows(found[1], self.starts)),
            PerBranch(turns[0], turns[1]),
            rho,
            block,
        )


class Descent:
    """Carries loads down through packings of one region, in memory that is used again."""

    def __init__(self, region: Region, rows: tuple[Layer, ...], loads: Loads) -> None:
        """``rows`` are those whose forces are balanced, ``loads`` belong to them."""
        whole = region.has_whole(rows)
        self.rows, self.F = rows, _ordered(rows, region.width, loads, whole=whole)
        self.starts = region.starts[: len(rows) + 1] if whole else starts(rows)
        widest = region.widest if whole else max(row.count for row in rows)
        self.size = int(self.starts[-1]), widest
        self.beads = int(self.starts[-1] - self.starts[1])  # that pass forces on
        self.runs = tables.of_loads(rows, region, self.F.start, self.F.missing)
        self.lowest = next((j + 1 for j in range(len(rows) - 1, 0, -1) if not rows[j].count), 1)
        self.g = self.lost = np.empty((0, 2, 0))

    def __call__(
        self, solved: CompiledPacking, above: Array | None = None
    ) -> CompiledForces | None:
        """Balance the forces; None where not all is in order.

        ``above`` holds what ``row`` gave of the highest row, if that is balanced already.
        """
        batch, spare = len(solved.block), self.size[1]
        if len(self.g) < batch:
            self.g = _block(batch, 2, *self.size)
            self.lost = _block(batch, 2, 2 * spare, spare)
        g, F, runs = self.g[:batch], self.F, self.runs
        if above is not None:
            top = len(self.rows) - 1
            runs = runs[runs[:, 0] < self.starts[top]]
            of_g, of_lost = self._of_row(top)
            g[0, :, of_g], self.lost[0, :, of_lost] = above

        def part(of: slice) -> bool:
            return _sweep_down(F.values, runs, solved.block[of], g[of], self.lost[of])

        if not on_all_cores(part, batch):
            return None
        found = g[0] if solved.rho[0].ndim == 1 else g.swapaxes(0, 1)
        plus, minus = (self._ordered(F.values[b], F.start[b]) for b in (0, 1))
        changes = [_rows(of, self.starts, self.lowest) for of in found]
        return CompiledForces(
            FLOAT64,
            self.rows,
            PerBranch(plus, minus),
            PerBranch(changes[0], changes[1]),
            F=F,
            g=g,
            starts=self.starts,
            lowest=self.lowest,
        )

    def _of_row(self, j: int) -> tuple[slice, slice]:
        """Give the places of a row: those of changes, and of what their sums have lost."""
        count, turn = self.rows[j].count, j % 2 * self.size[1]
        return slice(self.starts[j], self.starts[j] + count), slice(turn, turn + count)

    def row(self, j: int) -> Array:
        """Give g and what was lost of the lowest row but one that was balanced, (2, 2, beads)."""
        of_g, of_lost = self._of_row(j)
        return np.stack([self.g[0, :, of_g], self.lost[0, :, of_lost]])

    def _ordered(self, values: Array, start: Array) -> LazyRows[Array]:
        """Give the rows of what ``_order`` made: they may overlap."""

        def row(j: int) -> Array:
            if j < self.lowest:
                return np.empty(0)
            return values[start[j] : start[j] + self.rows[j].count]

        return LazyRows(len(self.rows), row)


class Drawing:
    """Gives radii of one region, in memory that is used again."""

    def __init__(self, radii: Radii, region: Region) -> None:
        """``radii`` are drawn here, if they are drawn at all."""
        self.radii, self.rows = radii, region.rows
        self.starts, self.size = region.starts, region.beads
        self.runs = drawing.runs_of(radii, region.rows) if isinstance(radii, DrawnRadii) else None
        self.rho = np.empty((0, 0))

    def __call__(self, realisations: Sequence[int]) -> tuple[Array, Sequence[Array]]:
        """Give δr/r, (packings, beads), and its rows. Raises what ``radii`` raises."""
        batch = len(realisations)
        if len(self.rho) < batch:
            self.rho = np.empty((batch, self.size))
        rho, radii, runs = self.rho[:batch], self.radii, self.runs

        def part(of: slice) -> bool:
            assert isinstance(radii, DrawnRadii)
            assert runs is not None
            return drawing.draw(radii, runs, realisations[of], rho[of])

        if runs is None or not on_all_cores(part, batch):
            for j, row in enumerate(self.rows):
                of = slice(self.starts[j], self.starts[j + 1])
                rho[:, of] = radii.row(row, realisations, FLOAT64)
        return rho, _rows(rho[0] if batch == 1 else rho, self.starts)


class Sweeps:
    """Draws, deposits and balances packings of one problem, in memory that is used again.

    Its functions are those of ``rows_of``, ``packing.deposit`` and ``forces.sweep_down``, for one
    batch after the other: what they gave for the last is overwritten.
    """

    def __init__(self, radii: Radii, n_x: Fraction, region: Region) -> None:
        """Raise ``LookupError`` where the region lacks a support."""
        self._draw, self._deposit = Drawing(radii, region), Deposition(n_x, region)
        self._descent: tuple[Loads, Descent] | None = None
        self._drawn: tuple[Array, Sequence[Array]] = np.empty((0, 0)), ()

    def radii(self, realisations: Sequence[int]) -> Sequence[Array]:
        """Give δr/r, row by row."""
        self._drawn = self._draw(realisations)
        return self._drawn[1]

    def deposit(
        self,
        n_x: Fraction,
        region: Region,
        rho: Sequence[Array],
        system: NumberSystem,
        work: Work | None = None,
    ) -> SolvedPacking:
        """Deposit what was drawn last."""
        assert rho is self._drawn[1]
        solved = self._deposit(*self._drawn)
        if solved is None:
            return packing.deposit(n_x, region, rho, system, work)  # which names the bead
        if work is not None:
            work.did_rows("deposited", region.rows, region.beads * len(solved.block))
        return solved

    def sweep_down(
        self,
        solved: SolvedPacking,
        rows: tuple[Layer, ...],
        loads: Loads,
        *,
        linear: bool = False,
        stop_at_tension: bool = False,
        work: Work | None = None,
    ) -> Forces:
        """Balance what was deposited last; the tables are kept for the same ``loads``."""
        if self._descent is None or self._descent[0] is not loads:
            self._descent = loads, Descent(solved.region, rows, loads)
        return _swept(
            self._descent[1], solved, loads,
            linear=linear, stop_at_tension=stop_at_tension, work=work,
        )  # fmt: skip


def _swept(
    descent: Descent,
    solved: SolvedPacking,
    loads: Loads,
    *,
    linear: bool,
    stop_at_tension: bool,
    work: Work | None,
) -> Forces:
    """Sweep down; whatever is out of the ordinary is left to the NumPy sweep."""
    found = None
    if isinstance(solved, CompiledPacking) and not (linear or stop_at_tension):
        found = descent(solved)
    if found is None:
        return forces.sweep_down(
            solved, descent.rows, loads, linear=linear, stop_at_tension=stop_at_tension, work=work
        )
    if work is not None:
        work.did_rows("balanced", descent.rows[:0:-1], descent.beads * len(found.g))
    return found


def deposit(
    n_x: Fraction,
    region: Region,
    rho: Sequence[Array],
    system: NumberSystem,
    work: Work | None = None,
) -> SolvedPacking:
    """Do what ``packing.deposit`` does, and to the bit; compiled in float64."""
    shape = rho[0].shape
    solved = None
    if system is FLOAT64 and len(shape) <= 2:
        if isinstance(rho, Stack):
            radii = rho.block.reshape(-1, region.beads)
        else:
            radii = np.concatenate([row.reshape(-1, row.shape[-1]) for row in rho], axis=1)
        solved = Deposition(n_x, region)(radii, rho)
    if solved is None:
        return packing.deposit(n_x, region, rho, system, work)
    if work is not None:
        work.did_rows("deposited", region.rows, region.beads * len(solved.block))
    return solved


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
    if isinstance(solved, CompiledPacking) and not (linear or stop_at_tension):
        descent = Descent(solved.region, rows, loads)
        return _swept(descent, solved, loads, linear=False, stop_at_tension=False, work=work)
    return forces.sweep_down(
        solved, rows, loads, linear=linear, stop_at_tension=stop_at_tension, work=work
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
