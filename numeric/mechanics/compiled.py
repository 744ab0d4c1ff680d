"""The compiled sweeps of ``compiled_packing`` and ``compiled_forces``, in memory used again.

What is out of the ordinary there is left to the NumPy sweeps. Import it only for work that repays
loading the compiler.
"""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from ..arithmetic.compiling import on_all_cores
from ..arithmetic.systems import FLOAT64, Array, NumberSystem
from ..disorder import compiled as drawing
from ..disorder.radii import DrawnRadii, Radii
from ..lattice.layers import Layer, Region, Stack
from . import forces, packing
from .compiled_forces import Descent
from .compiled_packing import Deposition, lazy_rows
from .forces import Forces, Loads
from .packing import CompiledPacking, SolvedPacking
from .work import Work


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
        rho = self.drawn(realisations)
        if rho is None:
            rho = self.rho[:batch]
            for j, row in enumerate(self.rows):
                of = slice(self.starts[j], self.starts[j + 1])
                rho[:, of] = self.radii.row(row, realisations, FLOAT64)
        return rho, lazy_rows(rho[0] if batch == 1 else rho, self.starts)

    def drawn(self, realisations: Sequence[int]) -> Array | None:
        """Give δr/r, (packings, beads); None where a radius may not be positive."""
        batch = len(realisations)
        if len(self.rho) < batch:
            self.rho = np.empty((batch, self.size))
        rho, radii, runs = self.rho[:batch], self.radii, self.runs

        def part(of: slice) -> bool:
            assert isinstance(radii, DrawnRadii)
            assert runs is not None
            return drawing.draw(radii, runs, realisations[of], rho[of])

        return None if runs is None or not on_all_cores(part, batch) else rho


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
        return _swept(
            self.descent(rows, loads), solved, loads,
            linear=linear, stop_at_tension=stop_at_tension, work=work,
        )  # fmt: skip

    def descent(self, rows: tuple[Layer, ...], loads: Loads) -> Descent:
        """Give what balances, the same for the same ``loads``."""
        if self._descent is None or self._descent[0] is not loads:
            self._descent = loads, Descent(self._deposit.region, rows, loads)
        return self._descent[1]

    def changes(self, realisations: Sequence[int], descent: Descent) -> Array | None:
        """Draw, deposit and balance; give g, as ``CompiledForces`` have it, and nothing else.

        None where something is out of the ordinary.
        """
        rho = self._draw.drawn(realisations)
        block = None if rho is None else self._deposit.rested(rho)
        return None if block is None else descent.changes(block)


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
