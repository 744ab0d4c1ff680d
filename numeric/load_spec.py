"""What is loaded, and how strongly: exact descriptions that any number system can be given."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import flint

from numeric import plain
from numeric.forces import Loads
from numeric.lattice import Layer
from numeric.loads import components, on_layers, on_rows
from numeric.systems import Balls, NumberSystem

Site = tuple[int, int]


@dataclass(frozen=True)
class LoadSpec:
    """A load of unit magnitude: "surface", "bulk", "point" (on ``at``) or "file" (``single``).

    ``angle_deg`` turns the load away from straight down, positive towards +i. ``single`` holds
    {(i, j): (fx, fy)} in units of the magnitude.
    """

    kind: str
    height: int
    angle_deg: Fraction = Fraction(0)
    at: Site | None = None
    single: Mapping[Site, tuple[Fraction, Fraction]] = field(default_factory=dict)

    @property
    def loaded(self) -> list[Site] | None:
        """The loaded beads, or None where whole layers are loaded."""
        if self.kind == "point":
            assert self.at is not None
            return [self.at]
        return sorted(self.single) if self.kind == "file" else None

    def components(self, n_x: Fraction, system: NumberSystem) -> tuple[Any, Any]:
        """(L⁺, L⁻) of the unit load: (cos θ/n_y ∓ sin θ/n_x)/2."""
        with Balls(_working_bits(system)).active():
            sin, cos = flint.arb.sin_cos_pi_fmpq(
                flint.fmpq(self.angle_deg.numerator, self.angle_deg.denominator) / 180
            )
            nx, ny = plain.axes(n_x, Balls(0))
            plus, minus = components(sin, -cos, nx, ny)
        return system.from_ball(plus), system.from_ball(minus)

    def _single_components(self, n_x: Fraction, system: NumberSystem) -> dict[Site, Any]:
        exact = Balls(0)
        with Balls(_working_bits(system)).active():
            nx, ny = plain.axes(n_x, exact)
            return {
                site: tuple(
                    system.from_ball(c)
                    for c in components(exact.number(fx), exact.number(fy), nx, ny)
                )
                for site, (fx, fy) in self.single.items()
            }

    def on(
        self, rows: tuple[Layer, ...], width: int | None, n_x: Fraction, system: NumberSystem
    ) -> Loads:
        """Put the load on the beads of ``rows`` (layers 0 … top)."""
        if self.kind == "file":
            return on_rows(self._single_components(n_x, system), rows, width, system)
        unit = self.components(n_x, system)
        if self.kind == "point":
            assert self.at is not None
            return on_rows({self.at: unit}, rows, width, system)
        layers = range(len(rows)) if self.kind == "bulk" else range(self.height, len(rows))
        return on_layers(unit, rows, layers, system)

    def ordered_contact(
        self, i: int, j: int, branch: str, width: int | None
    ) -> list[tuple[int, Site | None]]:
        """Say which loads lie straight up the contact f^±_ij: [(how many, which bead)].

        The ordered force is the sum of their components L^±; the bead is None for the unit load.
        """
        step = 1 if branch == "+" else -1

        def straight(site: Site) -> bool:
            off = site[0] - step * site[1] - (i - step * j)
            return site[1] > j and (off == 0 if width is None else off % (2 * width) == 0)

        if self.kind == "surface":
            return [(1, None)]
        if self.kind == "bulk":
            return [(self.height - j, None)]
        if self.kind == "point":
            assert self.at is not None
            return [(1, None)] if straight(self.at) else []
        return [(1, site) for site in self.single if straight(site)]

    def ordered_force(
        self, contact: tuple[int, int, str], width: int | None, n_x: Fraction, system: NumberSystem
    ) -> Any:
        """Give F^±_ij of the ordered packing in closed form, visiting no bead."""
        i, j, branch = contact
        which = 0 if branch == "+" else 1
        total = system.number(Fraction(0))
        single = self._single_components(n_x, system) if self.kind == "file" else {}
        unit = self.components(n_x, system)[which]
        for count, site in self.ordered_contact(i, j, branch, width):
            total = total + (unit if site is None else single[site][which]) * count
        return total


def _working_bits(system: NumberSystem) -> int:
    # Balls keep their own precision; other systems get constants far better than they can hold.
    return system.bits if isinstance(system, Balls) else system.bits + 64
