"""Loads: what is loaded, and how strongly, described exactly for any number system.

F_load = −(L⁺ n⁺ + L⁻ n⁻), so that in the ordered packing a load adds L^± to every contact of the
same orientation straight below it. A vertical unit load has L⁺ = L⁻ = 1/(2 n_y).
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any

import flint

from ..arithmetic.systems import Balls, NumberSystem, zeros
from ..lattice.branch import Branch, PerBranch, Site
from ..lattice.layers import Layer
from . import plain
from .forces import Forces, Loads

Components = tuple[Any, Any]


def components(fx: Any, fy: Any, n_x: Any, n_y: Any) -> Components:
    """Turn a Cartesian load (fx, fy) into (L⁺, L⁻).

    >>> from fractions import Fraction
    >>> components(0, -1, Fraction(3, 5), Fraction(4, 5))
    (Fraction(5, 8), Fraction(5, 8))
    """
    return (-(fx / n_x) - fy / n_y) / 2, (fx / n_x - fy / n_y) / 2


def on_rows(
    loads: Mapping[tuple[int, int], Components],
    rows: tuple[Layer, ...],
    width: int | None,
    system: NumberSystem,
) -> Loads:
    """Put the loads of single beads {(i, j): (L⁺, L⁻)} on the rows; beads outside are left out."""
    plus: list[Any] = [None] * len(rows)
    minus: list[Any] = [None] * len(rows)
    for (i, j), (up, um) in loads.items():
        if j >= len(rows):
            continue
        q = (i - rows[j].first) // 2
        if width is not None:
            q %= width
        if not 0 <= q < rows[j].count:
            continue
        if plus[j] is None:
            plus[j] = zeros(system, rows[j].count)
            minus[j] = zeros(system, rows[j].count)
        plus[j][q] = plus[j][q] + up
        minus[j][q] = minus[j][q] + um
    return Loads(tuple(plus), tuple(minus))


def on_layers(
    load: Components, rows: tuple[Layer, ...], layers: range, system: NumberSystem
) -> Loads:
    """Put the same load on every bead of some layers (surface: only M; bulk: all)."""
    plus: list[Any] = [None] * len(rows)
    minus: list[Any] = [None] * len(rows)
    for j in layers:
        plus[j] = zeros(system, rows[j].count) + load[0]
        minus[j] = zeros(system, rows[j].count) + load[1]
    return Loads(tuple(plus), tuple(minus))


def _exact(system: NumberSystem) -> Balls:
    """Give balls of a system's own precision; of other systems, better than they can hold."""
    return Balls(system.bits if isinstance(system, Balls) else system.bits + 64)


@dataclass(frozen=True)
class Strength:
    """A load's components (L⁺, L⁻) in a number system: one pair, or one pair a loaded bead."""

    unit: Components
    single: Mapping[Site, Components]


@dataclass(frozen=True)
class LoadSpec:
    """A load of unit magnitude: "surface", "bulk", "point" (on ``at``) or "file" (``single``).

    ``angle_deg`` turns the load away from straight down, positive towards +i; in three dimensions
    towards +x. ``single`` holds {(i, j): (fx, fy)} in units of the magnitude, or (fx, fy, fz).
    ``height`` and ``width`` are the packing's.
    """

    kind: str
    height: int
    width: int | None
    angle_deg: Fraction = Fraction(0)
    at: Site | None = None
    single: Mapping[Site, tuple[Fraction, ...]] = field(default_factory=dict)

    @property
    def loaded(self) -> list[Site] | None:
        """The loaded beads, or None where whole layers are loaded."""
        if self.kind in {"surface", "bulk"}:
            return None
        return [self.at] if self.at is not None else sorted(self.single)

    def strength(self, n_x: Fraction, system: NumberSystem) -> Strength:
        """Give (L⁺, L⁻) = (cos θ/n_y ∓ sin θ/n_x)/2 of the unit load, or of each loaded bead."""
        exact = _exact(system)
        with exact.active():
            nx, ny = plain.axes(n_x, exact)
            sin, cos = self._turn()
            unit = components(sin, -cos, nx, ny)
            single = {
                site: components(exact.number(fx), exact.number(fy), nx, ny)
                for site, (fx, fy) in self.single.items()
            }
        return Strength(
            (system.from_ball(unit[0]), system.from_ball(unit[1])),
            {s: (system.from_ball(p), system.from_ball(m)) for s, (p, m) in single.items()},
        )

    def turn(self, system: NumberSystem) -> tuple[Any, Any]:
        """Give sin θ and cos θ of the load's angle."""
        with _exact(system).active():
            sin, cos = self._turn()
        return system.from_ball(sin), system.from_ball(cos)

    def _turn(self) -> tuple[flint.arb, flint.arb]:
        angle = flint.fmpq(self.angle_deg.numerator, self.angle_deg.denominator) / 180
        sin, cos = flint.arb.sin_cos_pi_fmpq(angle)
        return sin, cos

    def on(self, rows: tuple[Layer, ...], strength: Strength, system: NumberSystem) -> Loads:
        """Put the load on the beads of ``rows`` (layers 0 … top)."""
        if self.kind == "file":
            return on_rows(strength.single, rows, self.width, system)
        if self.at is not None:
            return on_rows({self.at: strength.unit}, rows, self.width, system)
        layers = range(len(rows)) if self.kind == "bulk" else range(self.height, len(rows))
        return on_layers(strength.unit, rows, layers, system)

    @cached_property
    def _by_diagonal(self) -> dict[tuple[int, int], list[Site]]:
        """Loaded beads by (side, i − side·j), the diagonal that they load."""
        found: dict[tuple[int, int], list[Site]] = {}
        for site in self.loaded or []:
            for side in (1, -1):
                found.setdefault((side, self._diagonal(site[0], site[1], side)), []).append(site)
        return found

    def _diagonal(self, i: int, j: int, side: int) -> int:
        off = i - side * j
        return off if self.width is None else off % (2 * self.width)

    def straight_above(self, i: int, j: int, branch: str) -> list[Site]:
        """Give the single loaded beads that lie straight up the contact f^±_ij."""
        side = Branch(branch).side
        sites = self._by_diagonal.get((side, self._diagonal(i, j, side)), [])
        return [site for site in sites if site[1] > j]

    def carries(self, i: int, j: int, branch: str) -> bool:
        """Say whether any load lies straight up the contact, so that its ordered force is not 0."""
        if self.loaded is None:
            return j < self.height
        return bool(self.straight_above(i, j, branch))

    def ordered_force(
        self, contact: tuple[int, int, str], strength: Strength, system: NumberSystem
    ) -> Any:
        """Give F^±_ij of the ordered packing in closed form, visiting no bead."""
        i, j, branch = contact
        which = 0 if branch == Branch.PLUS else 1
        if self.kind in {"surface", "bulk"}:
            times = 1 if self.kind == "surface" else self.height - j
            return strength.unit[which] * times
        total = system.number(Fraction(0))
        for site in self.straight_above(i, j, branch):
            pair = strength.single[site] if self.kind == "file" else strength.unit
            total = total + pair[which]
        return total

    def ordered_forces(
        self, rows: tuple[Layer, ...], strength: Strength, system: NumberSystem
    ) -> Forces:
        """Give all ordered forces below the beads of ``rows`` in closed form; changes are 0."""
        plus = [zeros(system, 0)] + [zeros(system, row.count) for row in rows[1:]]
        minus = [zeros(system, 0)] + [zeros(system, row.count) for row in rows[1:]]
        if self.kind in {"surface", "bulk"}:
            for j in range(1, len(rows)):
                times = 1 if self.kind == "surface" else self.height - j + 1
                plus[j].fill(strength.unit[0] * times)
                minus[j].fill(strength.unit[1] * times)
        for i, j in self.loaded or []:
            pair = strength.single[i, j] if self.kind == "file" else strength.unit
            for m in range(1, j + 1):
                for values, step, share in ((plus, -1, pair[0]), (minus, 1, pair[1])):
                    q = (i + step * (j - m) - rows[m].first) // 2
                    q = q if self.width is None else q % self.width
                    values[m][q] = values[m][q] + share
        changes = tuple(zeros(system, len(v)) for v in plus)
        return Forces(
            system, rows, PerBranch(tuple(plus), tuple(minus)), PerBranch(changes, changes)
        )
