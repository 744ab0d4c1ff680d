"""What the sweeps are compared with: the same problem solved by other means.

``force_balance`` writes Eq. 6 of a whole packing as one linear system, for sparse solvers. All of
it serves the benchmarks only.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any
from unittest import mock

import numpy as np
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array, NumberSystem
from force_diffusion.numeric.disorder.radii import DrawnRadii
from force_diffusion.numeric.lattice.layers import Region, whole
from force_diffusion.numeric.mechanics import sweep
from force_diffusion.numeric.mechanics.loads import LoadSpec
from force_diffusion.numeric.mechanics.local import cosine
from force_diffusion.numeric.mechanics.sweep import Solved, deposit, sweep_down

SEED = 1


@dataclass(frozen=True)
class Problem:
    """A whole periodic packing with uniform radii under a surface load of magnitude 1."""

    height: int
    width: int
    relative_std: Fraction = Fraction(1, 10**6)
    n_x: Fraction = Fraction(3, 4)

    @property
    def region(self) -> Region:
        """All beads."""
        return whole(self.width, self.height)

    def radii(self, system: NumberSystem = FLOAT64) -> Any:
        """δr/r, (1, beads); the same numbers in every system."""
        source = DrawnRadii("uniform", self.relative_std, SEED, self.width)
        with system.active():
            return source.of(self.region.rows, range(1), system)

    def ordered(self, system: NumberSystem = FLOAT64) -> Any:
        """The ordered forces of the surface load."""
        spec = LoadSpec("surface", self.height, self.width)
        with system.active():
            return spec.ordered(self.region.rows, spec.strength(self.n_x, system), system)

    def solver(self, system: NumberSystem = FLOAT64) -> Callable[[], Solved]:
        """Give a function that solves it from the radii."""
        region, rho, F = self.region, self.radii(system), self.ordered(system)
        phi = cosine(self.n_x)

        def solve() -> Solved:
            with system.active():
                return sweep_down(deposit(phi, region, rho, system), region.rows, F)

        return solve


def by_numpy(solve: Callable[[], Any]) -> Callable[[], Any]:
    """Let NumPy sweep, as where numba is not installed."""

    def solved() -> Any:
        with mock.patch.object(sweep, "loops", return_value=None):
            return solve()

    return solved


@dataclass(frozen=True)
class Balance:
    """Eq. 6 of all beads above the base: rows, columns and values of the matrix, right-hand side.

    Unknowns, top layer first: for bead q of layer j, 2((M − j)W + q) is f⁺ and the next one f⁻ of
    the contacts below it. Forces in units of the load on one surface bead.
    """

    rows: Array
    columns: Array
    values: Array
    right: Array


Directions = list[tuple[Array, Array, Array, Array]]


def directions(solved: Solved, n: tuple[Any, Any]) -> Directions:
    """Cartesian (N⁺_x, N⁺_y, N⁻_x, N⁻_y) of the contacts below each layer from 1 up."""
    (nx, ny), top = n, solved.region.top
    return [
        ((1 + a - b) * nx, (1 + a + b) * ny, (c - d - 1) * nx, (c + d + 1) * ny)
        for (a, b), (c, d) in ([solved.dn(k, j)[:, 0] for k in (0, 1)] for j in range(1, top + 1))
    ]


def force_balance(N: Directions) -> Balance:
    """Assemble the linear system of a surface load."""
    height, width = len(N), len(N[0][0])
    q = np.arange(width)
    rows, columns, values = [], [], []
    for j in range(height, 0, -1):
        own = 2 * ((height - j) * width + q)
        for x, contact in ((0, 0), (1, 0), (0, 1), (1, 1)):
            force = N[j - 1][2 * contact + x]
            rows.append(own + x)
            columns.append(own + contact)
            values.append(force)
            if j > 1:
                below = (q + j % 2 - 1 + contact) % width
                rows.append(2 * ((height - j + 1) * width + below) + x)
                columns.append(own + contact)
                values.append(-force)
    right = np.zeros(2 * width * height, dtype=N[0][0].dtype)
    right[1 : 2 * width : 2] = 1
    return Balance(np.concatenate(rows), np.concatenate(columns), np.concatenate(values), right)


def changes(unknowns: Array, ordered: Any, width: int) -> Array:
    """Subtract the ordered force from the solution; (layers from 1 up, W, branch)."""
    return np.asarray((unknowns - ordered).reshape(-1, width, 2)[::-1])


def stacked(forces: Solved) -> Array:
    """Give the changes of ``forces`` in the same shape."""
    return np.moveaxis(forces.g[0].reshape(2, len(forces.rows) - 1, -1), 0, -1)
