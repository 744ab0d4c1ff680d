"""What the sweeps are compared with: the same problem solved by other means.

``force_balance`` writes Eq. 6 of a whole packing as one linear system, for sparse and dense
solvers; ``CSweep`` builds the same arithmetic in C. All of it serves the benchmarks only.
"""

import ctypes
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from force_diffusion.numeric.arithmetic.carried import CARRYING
from force_diffusion.numeric.arithmetic.systems import FLOAT64, Array, NumberSystem
from force_diffusion.numeric.disorder.radii import DrawnRadii, rows_of
from force_diffusion.numeric.lattice.layers import Region, whole
from force_diffusion.numeric.mechanics.loads import LoadSpec
from force_diffusion.numeric.mechanics.local import cosine
from force_diffusion.numeric.mechanics.sweep import (
    Forces,
    Loads,
    SolvedPacking,
    deposit,
    sweep_down,
)

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

    def radii(self, system: NumberSystem = FLOAT64, realisations: int = 1) -> Sequence[Array]:
        """δr/r, layer by layer; the same numbers in every system."""
        source = DrawnRadii("uniform", self.relative_std, SEED, self.width)
        with system.active():
            return rows_of(source, self.region.rows, range(realisations), system)

    def loads(self, system: NumberSystem = FLOAT64) -> Loads:
        """The surface load."""
        spec = LoadSpec("surface", self.height, self.width)
        with system.active():
            return spec.on(self.region.rows, spec.strength(self.n_x, system), system)

    def solver(
        self, system: NumberSystem = FLOAT64, realisations: int = 1
    ) -> Callable[[], tuple[SolvedPacking, Forces]]:
        """Give a function that solves it from the radii, by NumPy."""
        region, rho, loads = self.region, self.radii(system, realisations), self.loads(system)
        phi = cosine(self.n_x)

        def solve() -> tuple[SolvedPacking, Forces]:
            with system.active():
                solved = deposit(phi, region, rho, system)
                return solved, sweep_down(solved, region.rows, loads)

        return solve

    def compiled(
        self, realisations: int = 1, *, again: bool = False, carried: bool = False
    ) -> Callable[[], tuple[SolvedPacking, Forces]]:
        """Give a function that solves it by compiled loops; ``again``: in memory that stays."""
        from force_diffusion.numeric.mechanics.passes import Deposition, Descent
        from force_diffusion.numeric.mechanics.sweeps import tell

        region, phi = self.region, cosine(self.n_x)
        rho = np.zeros((realisations, 1 + carried, region.beads))
        rho[:, 0] = np.concatenate(self.radii(realisations=realisations), axis=-1)
        loads = self.loads(CARRYING if carried else FLOAT64)

        def parts() -> tuple[Deposition, Descent]:
            descent = Descent(region, region.rows, loads, carried=carried)
            return Deposition(phi, region, carried=carried), descent

        ready = parts() if again else None

        def solve() -> tuple[SolvedPacking, Forces]:
            deposition, descent = ready or parts()
            block = deposition(rho)
            assert block is not None
            g = descent(block)
            found = tell(phi, deposition, rho, descent, g)
            assert found.packing is not None
            assert found.forces is not None
            return found.packing, found.forces

        return solve


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


def directions(solved: SolvedPacking, n: tuple[Any, Any]) -> Directions:
    """Cartesian (N⁺_x, N⁺_y, N⁻_x, N⁻_y) of the contacts below each layer from 1 up."""
    nx, ny = n
    return [
        ((1 + a - b) * nx, (1 + a + b) * ny, (c - d - 1) * nx, (c + d + 1) * ny)
        for (a, b), (c, d) in zip(solved.dn.plus[1:], solved.dn.minus[1:], strict=True)
    ]


def force_balance(N: Directions, one: Any = 1.0) -> Balance:
    """Assemble the linear system of a surface load; ``one`` in the arithmetic of ``N``."""
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
    right[1 : 2 * width : 2] = one
    return Balance(np.concatenate(rows), np.concatenate(columns), np.concatenate(values), right)


def changes(unknowns: Array, ordered: Any, width: int) -> Array:
    """Subtract the ordered force from the solution; (layers from 1 up, W, branch)."""
    return np.asarray((unknowns - ordered).reshape(-1, width, 2)[::-1])


def stacked(forces: Forces) -> Array:
    """Give the changes of ``forces`` in the same shape."""
    return np.stack([np.stack(forces.change.plus[1:]), np.stack(forces.change.minus[1:])], axis=-1)


class CSweep:
    """``sweep.c``, built by gcc, with memory of its own."""

    def __init__(self, problem: Problem, folder: Path, *flags: str) -> None:
        """Compile (-O3, this machine's instructions) and put the radii in place."""
        source = Path(__file__).with_name("sweep.c")
        target = folder / f"sweep{len(list(folder.iterdir()))}.so"
        fixed = ["-O3", "-march=native", "-fno-math-errno", "-shared", "-fPIC"]
        command = ["gcc", *fixed, *flags, str(source), "-lm", "-o", str(target)]
        subprocess.run(command, check=True)
        self.library = ctypes.CDLL(str(target))
        shape = (problem.height + 1, problem.width)
        self.rho = np.ascontiguousarray(np.stack(problem.radii()))
        # At distances as in numeric/fast.py, which suit the cache.
        beads = shape[0] * shape[1]
        memory = np.zeros((10, beads + (72 - beads) % 512))
        self.blocks = memory[:, :beads].reshape(10, *shape)
        self.nothing = np.zeros(problem.width)
        self.lost = np.zeros((2, 2, problem.width))
        phi = cosine(problem.n_x)
        loads = problem.loads()
        last_plus, last_minus = loads.plus[-1], loads.minus[-1]
        assert last_plus is not None
        assert last_minus is not None
        scalars = (phi, 1 / (1 - phi**2), last_plus[0], last_minus[0])
        self.arguments = (
            ctypes.c_ssize_t(problem.height),
            ctypes.c_ssize_t(problem.width),
            *(ctypes.c_double(float(value)) for value in scalars),
            *(
                ctypes.c_void_p(a.ctypes.data)
                for a in (self.nothing, self.lost, self.rho, *self.blocks)
            ),
        )

    def __call__(self) -> Array:
        """Sweep up and down; the blocks are c±, δn⁺ and δn⁻ (two each), F±, g±."""
        self.library.sweep(*self.arguments)
        return self.blocks

    def bandwidth(self, n: int = 20_000_000) -> Callable[[], None]:
        """Give a function that moves 32 n bytes: two reads, a write, and the line it fetches."""
        a, b, c = np.zeros(n), np.ones(n), np.ones(n)
        pointers = [ctypes.c_void_p(v.ctypes.data) for v in (a, b, c)]
        kept = (a, b, c)

        def move() -> None:
            assert kept
            self.library.triad(ctypes.c_ssize_t(n), *pointers)

        return move
