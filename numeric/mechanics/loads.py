"""Loads: what is loaded, and how strongly, described exactly for any number system.

F_load = −(L⁺ n⁺ + L⁻ n⁻), so that in the ordered packing a load adds L^± to every contact of the
same orientation straight below it. A vertical unit load has L⁺ = L⁻ = 1/(2 n_y).
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np

from ..arithmetic.carried import CARRYING
from ..arithmetic.systems import FLOAT64, Array, Balls, NumberSystem, flint, midpoint
from ..lattice.branch import Site
from ..lattice.layers import Rows
from .local import level, vertical_square

Components = tuple[Any, ...]


def components(force: Sequence[Any], n_x: Any, up: Any, root12: Any = None) -> Components:
    """Turn a Cartesian load into (L^a), n^1 − n^d along x; ``up`` is the vertical part of the n^a.

    Of spheres √12 is needed, too.

    >>> from fractions import Fraction
    >>> components((0, -1), Fraction(3, 5), Fraction(4, 5))
    (Fraction(5, 8), Fraction(5, 8))
    """
    d = len(force)
    parts = [-force[-1] / (d * up)] * d
    for k, (part, row) in enumerate(zip(force, level(d), strict=False), 1):
        # k (k + 1) (1 − φ) is the square of the level vector, and 1 − φ = 2 n_x²
        size = n_x * (2 if k == 1 else root12)
        parts = [of - h * part / size if h else of for of, h in zip(parts, row, strict=True)]
    return tuple(parts)


class Strength(NamedTuple):
    """A load's components (L^a) in a number system, of all loads or of each single loaded bead."""

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

    @property
    def top(self) -> int:
        """The highest layer that is loaded."""
        return self.height if self.loaded is None else max((j for _, j in self.loaded), default=0)

    @property
    def count(self) -> Strength:
        """One along each direction of every load, which add up to how many loads there are."""
        one = (1.0,) * self.dimension
        return Strength(one, dict.fromkeys(self.loaded or [], one))

    def strength(self, n_x: Fraction, system: NumberSystem) -> Strength:
        """Give (L^a) of the unit load, or of each loaded bead.

        Of discs it is (cos θ/n_y ∓ sin θ/n_x)/2. Of float64 it is rounded once.
        """
        own: Any = CARRYING if system is FLOAT64 else system
        nx, up = own.number(n_x), own.root(vertical_square(self.dimension, n_x))
        root12 = own.root(Fraction(12)) if self.dimension > 2 else None

        def nearest(parts: Components) -> Components:
            return tuple(x.nearest for x in parts) if own is not system else parts

        single = {
            site: nearest(components(tuple(map(own.number, force)), nx, up, root12))
            for site, force in self.single.items()
        }
        unit: Components = (1 / (self.dimension * up),) * self.dimension
        if self.angle_deg:
            sin, cos = self._turn(own)
            unit = components((sin, *[0 * sin] * (self.dimension - 2), -cos), nx, up, root12)
        unit = nearest(unit)
        return Strength(unit, single if self.at is None else {self.at: unit})

    def _turn(self, system: NumberSystem) -> tuple[Any, Any]:
        """Give sin θ and cos θ."""
        balls = system if isinstance(system, Balls) else Balls(400)
        with balls.active():
            angle = flint().fmpq(*self.angle_deg.as_integer_ratio()) / 180
            sin, cos = flint().arb.sin_cos_pi_fmpq(angle)
        if balls is system:
            return sin, cos
        return system.number(midpoint(sin)), system.number(midpoint(cos))

    def ordered(self, rows: Rows, strength: Strength, system: NumberSystem) -> Any:
        """Give the ordered forces below the beads of all ``rows`` but the lowest, (d, beads).

        A load goes straight down, along each direction by itself.
        """
        starts = rows.starts_above
        forces = system.zeros(self.dimension, int(starts[-1]))
        if self.loaded is None:
            times: Any = 1
            if self.kind == "bulk":
                above = self.height - rows.layers + 1.0
                times = system.from_floats(above.repeat(np.diff(starts)))
            for a, share in enumerate(strength.unit):
                forces[a] = times * share
            return forces
        for site, load in strength.single.items():
            for a, share in enumerate(load):
                below, columns = self._below(site, a, rows)
                at = (starts[below] + columns)[below > 0]
                forces[a, at] = forces[a, at] + share
        return forces

    def _below(self, site: Site, a: int, rows: Rows) -> tuple[Array, Array]:
        """Give numbers of ``rows``, and columns, of the beads from a site straight down −e_a."""
        i, j = site
        below = np.arange(min(j - rows.lowest, len(rows) - 1), -1, -1)
        down = j - rows.lowest - below
        if self.dimension == 2:
            columns = (i + (2 * a - 1) * down - rows.firsts[below]) // 2
            if self.width is not None:
                columns %= self.width
        else:
            side = math.isqrt(self.width or 0)
            p, q = divmod((i - j % 2) // 2, side)
            columns = (p - down * (a == 0)) % side * side + (q - down * (a == 1)) % side
        there = (columns >= 0) & (columns < rows.counts[below])
        return below[there], columns[there]
