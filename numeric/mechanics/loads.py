"""Loads: what is loaded, and how strongly, described exactly for any number system.

F_load = −(L⁺ n⁺ + L⁻ n⁻), so that in the ordered packing a load adds L^± to every contact of the
same orientation straight below it. A vertical unit load has L⁺ = L⁻ = 1/(2 n_y).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any

import flint

from ..arithmetic.carried import Carrying
from ..arithmetic.systems import Balls, NumberSystem, zeros
from ..lattice.branch import Branch, Site, per_direction
from ..lattice.layers import Region, Rows
from .local import level, vertical_square
from .sweep import Forces, Loads, straight_down

Components = tuple[Any, ...]


def components(force: Sequence[Any], n_x: Any, up: Any) -> Components:
    """Turn a Cartesian load into (L^a), n^1 − n^d along x; ``up`` is the vertical part of the n^a.

    >>> from fractions import Fraction
    >>> components((0, -1), Fraction(3, 5), Fraction(4, 5))
    (Fraction(5, 8), Fraction(5, 8))
    """
    d = len(force)
    found = [-force[-1] / (d * up)] * d
    for k, (part, row) in enumerate(zip(force, level(d), strict=False), 1):
        # k (k + 1) (1 − φ) is the square of the level vector, and 1 − φ = 2 n_x²
        size = n_x * (2 if k == 1 else flint.arb(12).sqrt())
        found = [of - h * part / size if h else of for of, h in zip(found, row, strict=True)]
    return tuple(found)


def on_rows(
    loads: Mapping[tuple[int, int], Components],
    rows: Rows,
    width: int | None,
    system: NumberSystem,
    dimension: int = 2,
) -> Loads:
    """Put the loads of single beads {(i, j): (L^a)} on the rows; beads outside are left out."""
    found: dict[int, dict[int, Components]] = {}
    for (i, j), load in loads.items():
        if j >= len(rows):
            continue
        q = (i - rows[j].first) // 2
        if width is not None:
            q %= width
        if 0 <= q < rows[j].count:
            on = found.setdefault(j, {})
            on[q] = tuple(a + b for a, b in zip(on[q], load, strict=True)) if q in on else load

    def row(j: int, a: int) -> Any:
        if j not in found:
            return None
        return placed({q: load[a] for q, load in found[j].items()}, rows[j].count, system)

    return per_direction([tuple(row(j, a) for j in range(len(rows))) for a in range(dimension)])


def placed(values: Mapping[int, Any], count: int, system: NumberSystem) -> Any:
    """Give an array that is zero but for some values."""
    if isinstance(system, Carrying):
        none = system.number(Fraction(0))
        return system.column([values.get(q, none) for q in range(count)])
    row = zeros(system, count)
    for q, value in values.items():
        row[q] = value
    return row


def on_layers(load: Components, rows: Rows, layers: range, system: NumberSystem) -> Loads:
    """Put the same load on every bead of some layers (surface: only M; bulk: all)."""

    def along(share: Any) -> tuple[Any, ...]:
        return tuple(
            zeros(system, row.count) + share if j in layers else None for j, row in enumerate(rows)
        )

    return per_direction([along(share) for share in load])


def _exact(system: NumberSystem) -> Balls:
    """Give balls of a system's own precision; of other systems, better than they can hold."""
    return Balls(system.bits if isinstance(system, Balls) else system.bits + 64)


@dataclass(frozen=True)
class Strength:
    """A load's components (L^a) in a number system, of all loads or of each loaded bead."""

    unit: Components
    single: Mapping[Site, Components]


@dataclass(frozen=True)
class LoadSpec:
    """A load of unit magnitude: "surface", "bulk", "point" (on ``at``) or "file" (``single``).

    ``angle_deg`` turns the load away from straight down, positive towards +i; in three dimensions
    towards +x. ``single`` holds {(i, j): (fx, fy)} in units of the magnitude, or (fx, fy, fz).
    ``height`` is the packing's, ``width`` the beads of a row: W, or in three dimensions W².
    """

    kind: str
    height: int
    width: int | None
    angle_deg: Fraction = Fraction(0)
    at: Site | None = None
    single: Mapping[Site, tuple[Fraction, ...]] = field(default_factory=dict)
    dimension: int = 2

    @property
    def loaded(self) -> list[Site] | None:
        """The loaded beads, or None where whole layers are loaded."""
        if self.kind in {"surface", "bulk"}:
            return None
        if self.at is not None:
            return [self.at]
        return sorted(site for site, force in self.single.items() if any(force))

    def strength(self, n_x: Fraction, system: NumberSystem) -> Strength:
        """Give (L^a) of the unit load, or of each loaded bead.

        Of discs it is (cos θ/n_y ∓ sin θ/n_x)/2.
        """
        exact = _exact(system)
        with exact.active():
            sin, cos = self._turn()
            forces: dict[Site, Components] = {
                site: tuple(map(exact.number, force)) for site, force in self.single.items()
            }
            nx, up = exact.number(n_x), exact.root(vertical_square(self.dimension, n_x))
            unit = components((sin, *[0 * sin] * (self.dimension - 2), -cos), nx, up)
            single = {site: components(force, nx, up) for site, force in forces.items()}
        return Strength(
            tuple(map(system.from_ball, unit)),
            {site: tuple(map(system.from_ball, load)) for site, load in single.items()},
        )

    def _turn(self) -> tuple[flint.arb, flint.arb]:
        angle = flint.fmpq(self.angle_deg.numerator, self.angle_deg.denominator) / 180
        sin, cos = flint.arb.sin_cos_pi_fmpq(angle)
        return sin, cos

    def on(self, rows: Rows, strength: Strength, system: NumberSystem) -> Loads:
        """Put the load on the beads of ``rows`` (layers 0 … top)."""
        if self.kind == "file":
            return on_rows(strength.single, rows, self.width, system, self.dimension)
        if self.at is not None:
            return on_rows({self.at: strength.unit}, rows, self.width, system, self.dimension)
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
        self, region: Region, rows: Rows, strength: Strength, system: NumberSystem
    ) -> Forces:
        """Give all ordered forces below the beads of ``rows``; changes are 0."""
        d = len(strength.unit)
        if self.kind in {"surface", "bulk"}:  # in closed form
            times = [1 if self.kind == "surface" else self.height - j + 1 for j in range(len(rows))]
            found = [
                [zeros(system, row.count if j else 0) + share * times[j]
                 for j, row in enumerate(rows)]
                for share in strength.unit
            ]  # fmt: skip
        else:
            down = straight_down(rows, region, self.on(rows, strength, system), system)
            found = [
                [down[j][a] if len(down[j][a]) or not j else zeros(system, row.count)
                 for j, row in enumerate(rows)]
                for a in range(d)
            ]  # fmt: skip
        changes = tuple(zeros(system, row.count if j else 0) for j, row in enumerate(rows))
        return Forces(
            system,
            region,
            rows,
            per_direction([tuple(of) for of in found]),
            per_direction([changes] * d),
        )
