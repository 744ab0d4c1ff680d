"""One small periodic packing at one disorder strength ε, solved in a chosen arithmetic, by sites.

δr = ε ρ, r = 1, forces in the unit of the given loads. Numbers are rational, or decimal strings
that are read exactly.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from force_diffusion.numeric.arithmetic.systems import NumberSystem
from force_diffusion.numeric.disorder.radii import MeasuredRadii
from force_diffusion.numeric.lattice.branch import Branch
from force_diffusion.numeric.lattice.layers import column, whole
from force_diffusion.numeric.mechanics import engine
from force_diffusion.numeric.mechanics.loads import LoadSpec
from force_diffusion.numeric.mechanics.problem import Problem, Route, axes
from force_diffusion.numeric.mechanics.sweep import Solved
from force_diffusion.numeric.mechanics.work import Work

Site = tuple[int, int]
Rational = Fraction | int | str


@dataclass(frozen=True)
class Solution:
    """Answers by site (i, j), i modulo 2W; branch "+" or "-" with lower bead (i, j), as printed."""

    problem: Problem
    solved: Solved

    def displacement(self, i: int, j: int) -> tuple[Any, Any]:
        """Cartesian (δx, δy) of a bead, units of r (Eqs. 2, 3)."""
        q, packing = column(i, j, self.problem.region.rows[j].count), self.solved.packing
        assert packing is not None
        nx, ny = axes(self.problem.n_x, self.solved.system)
        plus, minus = (c[j][q] for _, c in packing.c)
        return (plus - minus) / (2 * nx), (plus + minus) / (2 * ny)

    def force(self, i: int, j: int, branch: str) -> Any:
        """Contact force f^±_ij (Eqs. 6–11)."""
        F, g = self._parts(i, j, branch)
        return F + g

    def change(self, i: int, j: int, branch: str) -> Any:
        """f^±_ij minus its ordered value."""
        return self._parts(i, j, branch)[1]

    def _parts(self, i: int, j: int, branch: str) -> tuple[Any, Any]:
        own, width, forces = Branch(branch), self.problem.region.rows[j].count, self.solved.forces
        assert forces is not None
        column(i, j, width)  # refuses what is no site
        q = column(i + own.side, j + 1, width)
        return forces.ordered[own][j + 1][q], forces.change[own][j + 1][q]


def solve(
    width: int,
    height: int,
    *,
    n_x: Rational,
    rho: Mapping[Site, Rational],
    loads: Mapping[Site, tuple[Rational, Rational]],
    strength: Rational,
    system: NumberSystem,
) -> Solution:
    """Solve by the engine, in the deviation form: no ordered value is ever subtracted.

    ``rho``: {(i, j): ρ}, 0 for others; ``loads``: {(i, j): (fx, fy)}. Raises ``ValueError``
    for a site off the lattice, and what the sweeps raise.
    """
    region = whole(width, height)
    radii = {(i, row.j): Fraction(0) for row in region.rows for i in row.sites()}
    for (i, j), value in rho.items():
        radii[2 * column(i, j, width) + j % 2, j] = Fraction(strength) * Fraction(value)
    on = {site: (Fraction(fx), Fraction(fy)) for site, (fx, fy) in loads.items()}
    for i, j in on:
        column(i, j, width)
    problem = Problem(
        Fraction(n_x),
        MeasuredRadii(radii, width),
        LoadSpec("file", height, width, single=on),
        Route.EXACT,
        region,
        region.rows,
        needs_forces=True,
    )
    with system.active():
        return Solution(problem, engine.solve(problem, [0], system, Work()))
