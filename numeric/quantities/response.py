"""The response to a point load."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import FLOAT64, Array, NumberSystem, as_floats, zeros
from ..lattice.branch import Direction
from ..lattice.layers import Layer, Region, pick
from ..mechanics.problem import Problem, Route, Solved
from ..statistics.moments import Moments, Scatter, unit_near
from .base import (
    ContactQuantity,
    Gatherer,
    Table,
    contact_changes,
    joined,
    slope,
)

# Bytes of a number of one realisation while standard errors are made; measured.
SCATTERED = 56


class Response(ContactQuantity):
    """The contacts within a point load's cone: one packing, or mean and std over realisations.

    ``vertical`` is the vertical component of the contact force, f N_y.
    """

    name = "response"
    merged = True

    def answer_rows(self, region: Region, realisations: int) -> int:
        """The contacts below each bead of the cone."""
        beads = region.beads
        if self.layers is not None:
            beads = sum(region.rows[j + 1].count for j in self.layers if j < region.top)
        return len(self.branches) * beads

    def kept(self, region: Region, realisations: int) -> int:
        """The scatter of both components, of which standard errors are made in the end."""
        several = realisations if realisations > 1 else 0
        return 2 * self.answer_rows(region, 1) * several * SCATTERED

    def gatherer(self, problem: Problem, system: NumberSystem) -> Gatherer:
        """Start with no realisation."""
        return _Responses(self, problem, system)

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the contacts twice: by their force, then by its vertical component."""
        contacts = super().labels(problem)
        count = len(contacts["j"])
        labels: dict[str, list[Any]] = {name: 2 * column for name, column in contacts.items()}
        return {**labels, "component": ["force"] * count + ["vertical"] * count}

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (groups, 1), and g, (groups, realisations, 1); of both components."""
        _, F, g, vertical = self.both(problem, solved, realisations)
        ny = slope(problem, solved.system)
        F, g = np.concatenate([F, F * ny]), np.concatenate([g, vertical], axis=1)
        return F[:, None], g.T[:, :, None]

    def one(
        self,
        problem: Problem,
        system: NumberSystem,
        contacts: dict[str, Array],
        F: Array,
        g: Array,
        vertical: Array,
    ) -> Table:
        """Give the rows of one packing, from what ``both`` gave."""
        F_y = F * slope(problem, system)
        return Table(
            contacts,
            {
                "force": F + g[0],
                "change": g[0],
                "vertical": F_y + vertical[0],
                "vertical_change": vertical[0],
            },
            ("change", "vertical_change"),
        )

    def both(
        self, problem: Problem, solved: Solved, realisations: int
    ) -> tuple[dict[str, Array], Array, Array, Array]:
        """Give the contacts, F, g and the change of the vertical component f N_y.

        Shapes: (contacts,), (realisations, contacts) and the same.
        """
        assert solved.forces is not None
        blocks = self.blocks(problem)
        system = solved.system
        ny = slope(problem, system)
        parts = contact_changes(solved, blocks, realisations)
        verticals = []
        for (branch, row), F, g in parts:
            tilt = self.tilt(solved, branch, row)
            f = F + (g if problem.route == Route.EXACT else 0)
            verticals.append((g + f * tilt.reshape(-1, row.count)) * ny)
        contacts = self.naming.contacts([block for block, _, _ in parts])
        nothing = zeros(system, realisations, 0)
        return (
            contacts,
            joined(system, [F for _, F, _ in parts]),
            np.concatenate([nothing, *(g for _, _, g in parts)], axis=1),
            np.concatenate([nothing, *verticals], axis=1),
        )

    def tilt(self, solved: Solved, branch: Direction, row: Layer) -> Array:
        """Give N_y/n_y − 1 of the contacts below a row."""
        if solved.packing is None:
            return zeros(solved.system, row.count)
        source, width = solved.packing.region.rows[row.j], solved.packing.region.width
        parts = [pick(v, source, row, width) for v in solved.packing.dn[branch][row.j]]
        return np.asarray(sum(parts[1:], parts[0]))

    def ordered(self, problem: Problem) -> list[Fraction]:
        """Give the ordered forces, then their vertical components."""
        forces = super().ordered(problem)
        ny = Fraction(float(slope(problem, FLOAT64)))
        return forces + [force * ny for force in forces]


class _Responses(Gatherer):
    def __init__(self, quantity: Response, problem: Problem, system: NumberSystem) -> None:
        self.quantity, self.problem, self.system = quantity, problem, system
        self.moments = Moments(unit_near(problem.radii.relative_std()))
        self.scatter = Scatter()
        self.last: tuple[dict[str, Array], Array, Array, Array] | None = None

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Take in realisations, one after the other."""
        self.last = self.quantity.both(self.problem, solved, len(realisations))
        if self.problem.realisations > 1:
            both = np.concatenate(self.last[2:], axis=1)
            for one in both:
                self.moments.add(one[None])
            self.scatter.add(*_squared(both))

    def table(self) -> Table:
        """One row a contact."""
        assert self.last is not None
        if self.problem.realisations == 1:
            return self.quantity.one(self.problem, self.system, *self.last)
        contacts, F, *_ = self.last
        ny = slope(self.problem, self.system)
        half = len(F)
        mean, std = self.moments.average(), self.moments.std(self.system)
        of_mean, of_std = self.scatter.errors()
        return Table(
            contacts,
            {
                "force_mean": F + mean[:half],
                "force_mean_change": mean[:half],
                "force_std": std[:half],
                "vertical_mean": F * ny + mean[half:],
                "vertical_mean_change": mean[half:],
                "vertical_std": std[half:],
            },
            ("force_mean_change", "force_std", "vertical_mean_change", "vertical_std"),
            {
                "force_mean_change": of_mean[:half],
                "force_std": of_std[:half],
                "vertical_mean_change": of_mean[half:],
                "vertical_std": of_std[half:],
            },
        )


def _squared(values: Array) -> tuple[Array, Array]:
    with np.errstate(all="ignore"):  # of balls beyond floats no standard error is known
        floats = as_floats(values)
        return floats, floats**2
