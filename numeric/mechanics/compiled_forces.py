"""Balance of forces in float64, compiled: bitwise the numbers of ``forces.sweep_down``.

The same operations in the same order, each rounded by itself, on packings that were deposited by
``compiled_packing``.
"""

from collections.abc import Sequence

import numpy as np

from ..arithmetic.compiling import borrowed, compiled, on_all_cores
from ..arithmetic.systems import FLOAT64, Array
from ..lattice import runs as tables
from ..lattice.branch import PerBranch
from ..lattice.layers import Layer, LazyRows, Region, pick, starts
from .compiled_packing import lazy_rows, memory
from .forces import CompiledForces, Loads, Ordered
from .packing import CompiledPacking


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
def _sweep_down(F: tuple[Array, ...], runs: Array, block: Array, g: Array, lost: Array) -> bool:
    """Sweep packings from the highest layer down; say if all is in order.

    ``F`` are the ordered forces, ``runs`` the table ``runs.of_loads``, ``block`` is that of
    ``_deposit``; filled is ``g``, (packings, 2, …). ``lost``, alike, is for what the sums of a
    layer and the one above have lost, which take turns. Beyond the last bead all have zeros.
    """
    F_plus, F_minus = borrowed(F[0]), borrowed(F[1])
    block, g, lost = borrowed(block), borrowed(g), borrowed(lost)
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
        g, F = self.changes(solved.block, above), self.F
        if g is None:
            return None
        found = g[0] if solved.rho[0].ndim == 1 else g.swapaxes(0, 1)
        plus, minus = (self._ordered(F.values[b], F.start[b]) for b in (0, 1))
        changes = [lazy_rows(of, self.starts, self.lowest) for of in found]
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

    def changes(self, block: Array, above: Array | None = None) -> Array | None:
        """Give ``g`` of ``_sweep_down`` alone, for packings whose ``block`` that is."""
        batch, spare = len(block), self.size[1]
        if len(self.g) < batch:
            self.g = memory(batch, 2, *self.size)
            self.lost = memory(batch, 2, 2 * spare, spare)
        g, lost, runs = self.g[:batch], self.lost, self.runs
        if above is not None:
            top = len(self.rows) - 1
            runs = runs[runs[:, 0] < self.starts[top]]
            of_g, of_lost = self._of_row(top)
            g[0, :, of_g], lost[0, :, of_lost] = above

        def part(of: slice) -> bool:
            return _sweep_down(self.F.values, runs, block[of], g[of], lost[of])

        return g if on_all_cores(part, batch) else None

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
