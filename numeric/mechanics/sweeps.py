"""Radii drawn, packings deposited and balanced by compiled loops, in memory that is used again.

Import it only for work that repays loading the compiler.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.carried import CARRYING, Carried, Sizes
from ..arithmetic.compiling import on_all_cores
from ..arithmetic.systems import FLOAT64, Array
from ..disorder import compiled as drawing
from ..disorder.radii import ArrayRadii, DrawnRadii, Radii
from ..lattice.branch import PerBranch, per_direction
from ..lattice.layers import Layer, LazyRows, Region
from .kernels import Deposition, Descent, told
from .problem import Problem, Solved, rounded
from .sweep import Loads, SolvedPacking


class Drawing:
    """Gives radii of one region, in memory that is used again."""

    def __init__(self, radii: Radii, region: Region, *, carried: bool = False) -> None:
        """``radii`` are drawn here, if they are drawn at all."""
        self.radii, self.region, self.carried = radii, region, carried
        self.runs = drawing.runs_of(radii, region.rows) if isinstance(radii, DrawnRadii) else None
        self.rho = np.empty((0, 0, 0))

    def __call__(self, realisations: Sequence[int]) -> Array:
        """Give δr/r, (packings, parts, beads). Raises what ``radii`` raises."""
        found = self.drawn(realisations)
        if found is not None:
            return found
        system, region = (CARRYING if self.carried else FLOAT64), self.region
        rho = self._memory(len(realisations))
        if isinstance(self.radii, ArrayRadii) and region.is_whole and not region.rows[0].j:
            parts = self.radii.layers(len(region.rows), realisations, system)
            self._put(rho, slice(None), parts)
            return rho
        for j, row in enumerate(region.rows):
            of = slice(region.starts[j], region.starts[j + 1])
            self._put(rho, of, self.radii.row(row, realisations, system))
        return rho

    @property
    def shape(self) -> tuple[int, int]:
        """Parts, and the numbers of each, in memory."""
        return 1 + self.carried, self.region.beads

    def _memory(self, batch: int) -> Array:
        if len(self.rho) < batch:
            self.rho = np.empty((batch, 1 + self.carried, self.region.beads))
        return self.rho[:batch]

    def _put(self, rho: Array, of: slice, values: "Array | Carried") -> None:
        if isinstance(values, Carried):
            rho[:, 0, of], rho[:, 1, of] = values.value, values.error
        else:
            rho[:, 0, of] = values

    def drawn(self, realisations: Sequence[int]) -> Array | None:
        """Give δr/r, (packings, parts, beads); None where a radius may not be positive."""
        if self.runs is None:
            return None
        batch, radii, runs = len(realisations), self.radii, self.runs
        assert isinstance(radii, DrawnRadii)
        rho = self._memory(batch)
        values = np.empty((batch, self.region.beads)) if self.carried else rho[:, 0]

        def part(of: slice) -> bool:
            return drawing.draw(radii, runs, realisations[of], values[of], scaled=not self.carried)

        if not on_all_cores(part, batch):
            return None
        if self.carried:
            self._put(rho, slice(None), Carried(values, 0.0) * CARRYING.scalar(radii.std))
        return rho


class Sweeps:
    """Draws, deposits and balances packings of one problem, for one batch after the other.

    What was given for the last is overwritten.
    """

    def __init__(self, problem: Problem, *, carried: bool = False) -> None:
        """``carried``: numbers carry their errors."""
        self.problem, self.carried = problem, carried
        self._draw = Drawing(problem.radii, problem.region, carried=carried)
        self._deposit = Deposition(problem.phi, problem.region, carried=carried)
        self._descent: tuple[Loads, Descent] | None = None

    def radii(self, realisations: Sequence[int]) -> Array:
        """Give δr/r, (packings, parts, beads)."""
        return self._draw(realisations)

    def deposit(self, rho: Array) -> Array | None:
        """Deposit what was drawn last; None where not all rest."""
        return self._deposit(rho)

    def descent(self, rows: tuple[Layer, ...], loads: Loads) -> Descent:
        """Give what balances, the same for the same ``loads``."""
        if self._descent is None or self._descent[0] is not loads:
            made = Descent(self.problem.region, rows, loads, carried=self.carried)
            self._descent = loads, made
        return self._descent[1]

    def changes(self, realisations: Sequence[int], descent: Descent) -> Array | None:
        """Draw, deposit and balance; give g, as ``Forces`` have it, and nothing else.

        None where something is out of the ordinary.
        """
        rho = self._draw.drawn(realisations)
        block = None if rho is None else self._deposit(rho)
        return None if block is None else descent(block)

    def swept(self, rho: Array, block: Array) -> SolvedPacking:
        """Tell a packing as ``sweep`` would, for the NumPy sweep of forces."""
        at, phi, region = self._deposit.quantities, self.problem.phi, self.problem.region
        values = told(phi, region, rho[:, 0], block[:, :at], carried=self.carried)
        if not self.carried:
            return values
        errors = told(phi, region, rho[:, 1], block[:, at:])
        return replace(_paired(values, errors), system=CARRYING, memory=None)

    def told(self, rho: Array, block: Array, descent: Descent | None, g: Array | None) -> Solved:
        """Tell what was solved row by row, with what rounding left if that is known."""
        return tell(self.problem.phi, self.problem.region, rho, block, descent, g)


def tell(
    phi: Fraction,
    region: Region,
    rho: Array,
    block: Array,
    descent: Descent | None = None,
    g: Array | None = None,
) -> Solved:
    """Tell what loops have filled row by row; where numbers carry errors, rounded once."""
    d, carried = region.dimension, rho.shape[1] == 2
    at, beads, first = d + d * d, region.beads, region.rows[0].count
    values = told(phi, region, rho[:, 0], block[:, :at], carried=carried)
    F = None
    if g is not None and descent is not None:
        F, g = descent.F[:, descent.beads_below], g[..., descent.beads_below]
    if not carried:
        forces = None
        if F is not None and g is not None and descent is not None:
            forces = descent.told(F, g)
        return Solved(FLOAT64, values, forces, None)
    errors = told(phi, region, rho[:, 1], block[:, at:])
    found = rounded(Solved(FLOAT64, _paired(values, errors), None, None))
    sizes = Sizes(largest(block[:, at : at + d, :beads]), largest(block[:, at + d :, first:beads]))
    if F is None or g is None or descent is None:
        return replace(found, sizes=sizes)
    ordered, changes = Carried(F[:d], F[d:]), Carried(g[:, :d], g[:, d:])
    near, rest = (
        descent.told(*pair) for pair in zip(ordered.nearest, changes.nearest, strict=True)
    )
    sizes |= Sizes(changed=largest(g[:, d:]), force=largest(F[:d]) + largest(g[:, :d]))
    assert found.rest is not None
    return replace(found, forces=near, rest=replace(found.rest, forces=rest), sizes=sizes)


def largest(values: Array) -> float:
    """Give the largest absolute value."""
    return float(max(values.max(initial=0), -values.min(initial=0)))


def _paired(values: SolvedPacking, errors: SolvedPacking) -> SolvedPacking:
    """Put values and errors together, row by row."""

    def pair(a: Any, b: Any) -> Any:
        if isinstance(a, tuple):
            return tuple(pair(*both) for both in zip(a, b, strict=True))
        return Carried(a, b)

    def rows(a: Sequence[Any], b: Sequence[Any]) -> LazyRows[Any]:
        return LazyRows(len(a), lambda j: pair(a[j], b[j]))

    def each(a: PerBranch[Any], b: PerBranch[Any]) -> PerBranch[Any]:
        return per_direction([rows(x, y) for (_, x), (_, y) in zip(a, b, strict=True)])

    return replace(
        values,
        rho=rows(values.rho, errors.rho),
        c=each(values.c, errors.c),
        dn=each(values.dn, errors.dn),
    )
