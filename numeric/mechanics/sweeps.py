"""Radii drawn, packings deposited and balanced by compiled loops, in memory that is used again.

Import it only for work that repays loading the compiler.
"""

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from operator import add
from typing import Any

import numpy as np

from ..arithmetic.carried import CARRYING, NONE, Carried, Sizes
from ..arithmetic.compiling import on_all_cores
from ..arithmetic.systems import FLOAT64, Array
from ..disorder import compiled as drawing
from ..disorder.radii import ArrayRadii, DrawnRadii, Radii
from ..lattice.layers import Region, Rows
from .kernels import kernels, numbers
from .passes import Deposition, Descent, told
from .problem import Problem, Solved
from .sweep import Loads, SolvedPacking


class Drawing:
    """Gives radii of one region, in memory that is used again."""

    def __init__(self, radii: Radii, region: Region, *, carried: bool = False) -> None:
        """``radii`` are drawn here, if they are drawn at all."""
        self.region, self.carried = region, carried
        self.rho: Array = np.empty((0, 0, 0))
        self._deviates: Array = np.empty((0, 0, 0))
        self.take(radii)

    def take(self, radii: Radii) -> None:
        """Take other radii."""
        self.radii = radii
        self.runs = None
        if isinstance(radii, DrawnRadii):
            self.runs = drawing.runs_of(radii, self.region.rows)

    def __call__(self, realisations: Sequence[int]) -> Array:
        """Give δr/r, (packings, parts, beads). Raises what ``radii`` raises."""
        found = self.drawn(realisations)
        if found is not None:
            return found
        system, region = (CARRYING if self.carried else FLOAT64), self.region
        rho, radii = self._memory(len(realisations)), self.radii
        if isinstance(radii, ArrayRadii) and region.is_whole:
            values = radii.values[np.asarray(realisations), : len(region.rows)]
            return self._scaled(values.reshape(len(rho), 1, -1), radii.origin, radii.radius)
        for j, row in enumerate(region.rows):
            of = slice(region.starts[j], region.starts[j + 1])
            self._put(rho, of, self.radii.row(row, realisations, system))
        return rho

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
        if self.carried and len(self._deviates) < batch:
            self._deviates = np.empty((batch, 1, self.region.beads))
        values = self._deviates[:batch, 0] if self.carried else rho[:, 0]

        def part(of: slice) -> bool:
            return drawing.draw(radii, runs, realisations[of], values[of], scaled=not self.carried)

        if not on_all_cores(part, batch):
            return None
        return self._scaled(values[:, None], radii.std) if self.carried else rho

    def _scaled(self, values: Array, *of: Fraction) -> Array:
        """Give δr/r of radii, of their origin and r; or of deviates, of σ/r."""
        m = _constants(*of, carried=self.carried)
        rho = self._memory(len(values))
        k, run = kernels(self.region.dimension), np.array([0, rho.shape[-1]])
        both = (k.relative, k.relative_errors) if len(of) > 1 else (k.scaled, k.scaled_errors)
        for loop in both[: 1 + self.carried]:
            for one, found in zip(values, rho, strict=True):
                loop(one, found, run, m)
        return rho


@lru_cache(maxsize=8)
def _constants(*of: Fraction, carried: bool) -> Array:
    """Give numbers as kernels take them."""
    system = CARRYING if carried else FLOAT64
    return numbers([system.scalar(one) for one in of], carried=carried)


class Sweeps:
    """Draws, deposits and balances packings of one problem, for one batch after the other.

    What was given for the last is overwritten.
    """

    def __init__(self, problem: Problem, *, carried: bool = False) -> None:
        """``carried``: numbers carry their errors."""
        self._shape, self.carried = _shape(problem), carried
        self.phi, self.region = problem.phi, problem.region
        self._draw = Drawing(problem.radii, self.region, carried=carried)
        self._deposit = Deposition(problem.phi, self.region, carried=carried)
        self._descent: tuple[Loads, Descent] | None = None

    @property
    def bytes(self) -> int:
        """What its memory takes."""
        parts = [self._draw.rho, self._deposit.block]
        if self._descent is not None:
            parts += [self._descent[1].F, self._descent[1].g]
        return sum(part.nbytes for part in parts)

    def serves(self, problem: Problem, *, carried: bool) -> bool:
        """Say whether it sweeps such packings; if so, the next ones are of this problem."""
        if carried != self.carried or self._shape != _shape(problem):
            return False
        if self._draw.radii is not problem.radii:
            self._draw.take(problem.radii)
        return True

    def radii(self, realisations: Sequence[int]) -> Array:
        """Give δr/r, (packings, parts, beads)."""
        return self._draw(realisations)

    def rows(self, rho: Array) -> list[Any]:
        """Give the rows of a block of δr/r, as ``sweep`` takes them."""
        values = rho[0] if len(rho) == 1 else rho.swapaxes(0, 1)
        parts = [np.split(part, self.region.starts[1:-1], axis=-1) for part in values]
        return [Carried(*one) for one in zip(*parts, strict=True)] if self.carried else parts[0]

    def deposit(self, rho: Array) -> Array | None:
        """Deposit what was drawn last; None where not all rest."""
        return self._deposit(rho)

    def descent(self, rows: Rows, loads: Loads) -> Descent:
        """Give what balances, the same for the same ``loads``."""
        if self._descent is None or self._descent[0] is not loads:
            self._descent = loads, Descent(self.region, rows, loads, carried=self.carried)
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
        parts = self.phi, self.region, rho, block, self._deposit.most
        if not self.carried:
            return told(*parts)
        return replace(told(*parts, Carried), system=CARRYING, memory=None)

    def told(self, rho: Array, block: Array, descent: Descent | None, g: Array | None) -> Solved:
        """Tell what was solved row by row."""
        return tell(self.phi, self._deposit, rho, descent, g)


def _shape(problem: Problem) -> tuple[Any, ...]:
    """Give all of a problem that sweeps hang on but its radii."""
    of = problem
    return of.n_x, of.route, of.needs_forces, of.load, of.region, of.force_rows


def tell(
    phi: Fraction,
    deposition: Deposition,
    rho: Array,
    descent: Descent | None = None,
    g: Array | None = None,
) -> Solved:
    """Tell what loops have filled row by row; where numbers carry errors, rounded once.

    Changes are rounded in place: no sweep goes on from them.
    """
    region, most, carried = deposition.region, deposition.most, deposition.carried
    d, forces, sizes = region.dimension, None, NONE
    if carried:
        moved, turned = most[:, d + d * d : 2 * d + d * d], most[:, 2 * d + d * d :]
        sizes = Sizes(float(moved.max()), float(turned.max()))
    if g is not None and descent is not None:
        largest = None
        if carried:
            largest, off = descent.settle(g)
            sizes |= Sizes(changed=off, force=descent.bounds[1] + largest)
        forces = descent.told(g[:, :d, descent.beads_below], largest)
    block = deposition.block[: len(rho)]
    packing = told(phi, region, rho, block, most, add if carried else None)
    return Solved(FLOAT64, packing, forces, None, sizes)
