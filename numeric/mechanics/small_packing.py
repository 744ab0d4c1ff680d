"""One small periodic packing at one disorder strength ε, solved exactly in a chosen arithmetic.

``deviation_form`` and ``plain_form`` answer the same questions by the two routes; each takes
rationals (or decimal strings, read exactly) and a number system such as ``BigFloat(60)``. δr = ε ρ,
r = 1, forces in the unit of the given loads.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from ..arithmetic.systems import Array, NumberSystem, array, zeros
from ..lattice.layers import column, whole
from . import plain, sweep
from .loads import components, on_rows
from .local import cosine

Site = tuple[int, int]
Rational = Fraction | int | str


@dataclass(frozen=True)
class Solution:
    """Answers by site (i, j), i modulo 2W; branch "+" or "-" with lower bead (i, j), as printed."""

    width: int
    dx: tuple[Array, ...]
    dy: tuple[Array, ...]
    dn: Mapping[str, tuple[tuple[Array, Array], ...]]
    forces: Mapping[str, Sequence[Array]]
    changes: Mapping[str, Sequence[Array]]

    def displacement(self, i: int, j: int) -> tuple[Any, Any]:
        """Cartesian (δx, δy) of a bead, units of r (Eqs. 2, 3)."""
        q = column(i, j, self.width)
        return self.dx[j][q], self.dy[j][q]

    def direction(self, i: int, j: int, branch: str) -> tuple[Any, Any]:
        """Cartesian δn of a contact (Eqs. 4, 5)."""
        upper, q = self._upper(i, j, branch)
        x, y = self.dn[branch][upper]
        return x[q], y[q]

    def force(self, i: int, j: int, branch: str) -> Any:
        """Contact force f^±_ij (Eqs. 6–11)."""
        upper, q = self._upper(i, j, branch)
        return self.forces[branch][upper][q]

    def change(self, i: int, j: int, branch: str) -> Any:
        """f^±_ij minus its ordered value (plain form: by that very subtraction)."""
        upper, q = self._upper(i, j, branch)
        return self.changes[branch][upper][q]

    def _upper(self, i: int, j: int, branch: str) -> tuple[int, int]:
        column(i, j, self.width)
        return j + 1, column(i + 1 if branch == "+" else i - 1, j + 1, self.width)


def _prepared(
    width: int,
    height: int,
    rho: Mapping[Site, Rational],
    loads: Mapping[Site, tuple[Rational, Rational]],
    strength: Rational,
) -> tuple[list[list[Fraction]], dict[Site, tuple[Fraction, Fraction]]]:
    rows = [[Fraction(0)] * width for _ in range(height + 1)]
    for (i, j), value in rho.items():
        rows[j][column(i, j, width)] = Fraction(strength) * Fraction(value)
    return rows, {site: (Fraction(fx), Fraction(fy)) for site, (fx, fy) in loads.items()}


def deviation_form(
    width: int,
    height: int,
    *,
    n_x: Rational,
    rho: Mapping[Site, Rational],
    loads: Mapping[Site, tuple[Rational, Rational]],
    strength: Rational,
    system: NumberSystem,
) -> Solution:
    """Solve by ``sweep.deposit`` and ``sweep.sweep_down``: no ordered value is ever subtracted.

    ``rho``: {(i, j): ρ}; ``loads``: {(i, j): (fx, fy)}. Raises what the sweeps raise.
    """
    n_x = Fraction(n_x)
    rows, cartesian = _prepared(width, height, rho, loads, strength)
    region = whole(width, height)
    with system.active():
        nx, ny = plain.axes(n_x, system)
        radii = tuple(array(system, r) for r in rows)
        solved = sweep.deposit(cosine(n_x), region, radii, system)
        supported = {
            site: components(system.number(fx), system.number(fy), nx, ny)
            for site, (fx, fy) in cartesian.items()
        }
        f = sweep.sweep_down(solved, region.rows, on_rows(supported, region.rows, width, system))
        return Solution(
            width,
            tuple((p - m) / (2 * nx) for p, m in zip(solved.c.plus, solved.c.minus, strict=True)),
            tuple((p + m) / (2 * ny) for p, m in zip(solved.c.plus, solved.c.minus, strict=True)),
            {
                "+": tuple(((a - b) * nx, (a + b) * ny) for a, b in solved.dn.plus),
                "-": tuple(((a - b) * nx, (a + b) * ny) for a, b in solved.dn.minus),
            },
            {
                "+": tuple(F + g for F, g in zip(f.ordered.plus, f.change.plus, strict=True)),
                "-": tuple(F + g for F, g in zip(f.ordered.minus, f.change.minus, strict=True)),
            },
            {"+": f.change.plus, "-": f.change.minus},
        )


def plain_form(
    width: int,
    height: int,
    *,
    n_x: Rational,
    rho: Mapping[Site, Rational],
    loads: Mapping[Site, tuple[Rational, Rational]],
    strength: Rational,
    system: NumberSystem,
) -> Solution:
    """Solve by circle intersection and force balance, then subtract the ordered packing.

    Arguments and errors as for ``deviation_form``.
    """
    n_x = Fraction(n_x)
    rows, cartesian = _prepared(width, height, rho, loads, strength)
    with system.active():
        radii = tuple(array(system, r) for r in rows)
        given: list[plain.Vector | None] = [None] * (height + 1)
        for (i, j), (fx, fy) in cartesian.items():
            if (own := given[j]) is None:
                given[j] = own = plain.Vector(zeros(system, width), zeros(system, width))
            q = column(i, j, width)
            own.x[q] = own.x[q] + system.number(fx)
            own.y[q] = own.y[q] + system.number(fy)
        solved = plain.deposit(n_x, radii, system)
        still = plain.deposit(n_x, tuple(zeros(system, width) for _ in rows), system)
        f, F = plain.forces(solved, tuple(given)), plain.forces(still, tuple(given))
        d = plain.displacements(solved)
        nx, ny = solved.n
        return Solution(
            width,
            tuple(v.x for v in d),
            tuple(v.y for v in d),
            {
                "+": tuple((v.x - nx, v.y - ny) for v in solved.plus),
                "-": tuple((v.x + nx, v.y - ny) for v in solved.minus),
            },
            {"+": f.plus, "-": f.minus},
            {
                "+": tuple(a - b for a, b in zip(f.plus, F.plus, strict=True)),
                "-": tuple(a - b for a, b in zip(f.minus, F.minus, strict=True)),
            },
        )
