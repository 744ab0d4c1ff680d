"""Exact Taylor coefficients of the nonlinear packing: δr = ε ρ with rational ρ, r = 1.

With rational n^± (n_x and n_y both rational, as 3/5 and 4/5) the ordered packing is rational, and
so is every Taylor coefficient of the exact packing and of its forces. They are found by the
very sweeps that solve packings in floating point, run on truncated power series in ε. Order
ε¹ must equal the first-order formulas of the paper as fractions, with no tolerance.

Every function here gives a coefficient list ``[order 0, order 1, …, order n]``.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import flint
import numpy as np
import sympy
from force_diffusion.numeric.arithmetic.systems import Array, NumberSystem
from force_diffusion.numeric.lattice.branch import Branch
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.loads import LoadSpec, Strength, components
from force_diffusion.numeric.mechanics.local import cosine
from force_diffusion.numeric.mechanics.sweep import Solved, deposit, sweep_down

Site = tuple[int, int]
Coefficients = list[flint.fmpq]


def column(i: int, j: int, width: int) -> int:
    """The column of site (i, j) in a periodic layer."""
    return (i - j % 2) // 2 % width


def exact(value: Fraction | int | sympy.Rational | flint.fmpq) -> flint.fmpq:
    """A fraction as one of flint's, which are faster."""
    return flint.fmpq(int(value.numerator), int(value.denominator))


@dataclass(frozen=True)
class Series(NumberSystem):
    """Power series in ε with exact rational coefficients, up to and including ε^``order``."""

    order: int

    name = "rational series"

    def number(self, value: Fraction) -> Any:
        """Give a plain rational: NumPy would take a series for a sequence of numbers."""
        return exact(value)

    def zeros(self, *shape: int) -> Any:
        """Give constant series."""
        return self.filled([self.series([Fraction(0)])] * math.prod(shape)).reshape(shape)

    def series(self, coefficients: Sequence[Fraction]) -> Any:
        """Give the series with these coefficients of ε⁰, ε¹, …"""
        return flint.fmpq_series([exact(c) for c in coefficients])

    def root(self, value: Fraction) -> Any:
        """Give the rational root; ``ValueError`` where there is none."""
        square = exact(value)
        root = flint.fmpq(math.isqrt(int(square.p)), math.isqrt(int(square.q)))
        if root * root != square:
            raise ValueError(f"the square root of {value} is no rational number")
        return root

    def signs(self, values: Array) -> tuple[Array, Array]:
        """Look at the constant term: the sign for small enough ε."""
        good = np.asarray(np.frompyfunc(lambda value: value[0] > 0, 1, 1)(values), dtype=bool)
        return good, ~good

    @contextmanager
    def active(self) -> Iterator[None]:
        """Set flint's global truncation order and put it back."""
        before, flint.ctx.cap = flint.ctx.cap, self.order + 1
        try:
            yield
        finally:
            flint.ctx.cap = before


@dataclass(frozen=True)
class TaylorPacking:
    """A periodic packing and its forces as power series in the disorder strength ε.

    Sites are (i, j) with i + j even, i taken modulo 2W. Contacts are named as in the paper:
    branch "+" ("−" is written "-") at (i, j) runs from the lower bead (i, j) to (i ± 1, j + 1).
    Lengths are in units of r, forces in the unit of the given loads.
    """

    width: int
    height: int
    n_x: flint.fmpq
    n_y: flint.fmpq
    order: int
    packing: Solved
    contact_forces: Solved

    def line_sums(self, i: int, j: int) -> tuple[Coefficients, Coefficients]:
        """(c⁺, c⁻) with c^± = n^±·δx of bead (i, j) (Eqs. 2 and 3)."""
        q = column(i, j, self.width)
        plus, minus = (self.packing.c(a, j)[0, q] for a in range(2))
        return self._list(plus), self._list(minus)

    def displacement(self, i: int, j: int) -> tuple[Coefficients, Coefficients]:
        """Cartesian (δx, δy) of bead (i, j), from δx = c⁺ b⁺ + c⁻ b⁻ (Eqs. 2 and 3)."""
        plus, minus = self.line_sums(i, j)
        return (
            [(p - m) / (2 * self.n_x) for p, m in zip(plus, minus, strict=True)],
            [(p + m) / (2 * self.n_y) for p, m in zip(plus, minus, strict=True)],
        )

    def direction(self, i: int, j: int, branch: str) -> tuple[Coefficients, Coefficients]:
        """Cartesian δn of the contact from (i, j) to (i ± 1, j + 1) (Eqs. 4 and 5)."""
        upper, q = self._upper(i, j, branch)
        a, b = self.packing.dn(Branch(branch).number, upper)
        along, across = self._list(a[0, q]), self._list(b[0, q])
        return (
            [(p - m) * self.n_x for p, m in zip(along, across, strict=True)],
            [(p + m) * self.n_y for p, m in zip(along, across, strict=True)],
        )

    def force(self, i: int, j: int, branch: str) -> Coefficients:
        """Contact force f^±_ij; order 0 is the ordered force (Eqs. 6–11)."""
        upper, q = self._upper(i, j, branch)
        f = self.contact_forces
        a = Branch(branch).number
        return self._list(f.ordered(a, upper)[q] + f.change(a, upper)[0, q])

    def _upper(self, i: int, j: int, branch: str) -> tuple[int, int]:
        return j + 1, column(i + 1 if branch == "+" else i - 1, j + 1, self.width)

    def _list(self, value: Any) -> Coefficients:
        return [value[k] for k in range(self.order + 1)]


def solve(
    width: int,
    height: int,
    *,
    n: tuple[Fraction, Fraction],
    rho: Mapping[Site, Fraction],
    loads: Mapping[Site, tuple[Fraction, Fraction]],
    order: int = 1,
) -> TaylorPacking:
    """Solve the exact packing as a power series in ε up to ε^order.

    ``width`` = W beads a layer, ``height`` = M; ``rho``: {(i, j): ρ}, absent beads have ρ = 0;
    ``loads``: {(i, j): (fx, fy)} Cartesian loads on single beads (a unit vertical surface load is
    {(i, M): (0, −1)} for every i); ``n`` = (n_x, n_y) with n_x² + n_y² = 1; all numbers rational.
    Raises ``ValueError`` for a site off the lattice. Flint's series cap is put back.
    """
    n_x, n_y = n
    system = Series(order)
    region = whole(width, height)
    with system.active():
        rho_of = system.zeros(1, (height + 1) * width)
        for (i, j), value in rho.items():
            rho_of[0, j * width + column(i, j, width)] = system.series([Fraction(0), value])
        supported = {}
        for (i, j), (fx, fy) in loads.items():
            up, um = components((fx, fy), n_x, n_y)
            supported[i, j] = (system.number(up), system.number(um))
        packing = deposit(cosine(n_x), region, rho_of, system)
        spec = LoadSpec("file", height, width, single=loads)
        F = spec.ordered(region.rows, Strength((), supported), system)
        contact_forces = sweep_down(packing, region.rows, F)
    return TaylorPacking(width, height, exact(n_x), exact(n_y), order, packing, contact_forces)
