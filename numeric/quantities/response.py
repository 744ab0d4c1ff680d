"""The response to a point load."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..lattice.layers import Block, Region, columns_of, taken
from ..mechanics.problem import Problem, Route, axes
from ..mechanics.sweep import Solved
from .base import Table, contact_forces
from .statistics import Merged, Statistics

# Bytes of a number of one realisation while standard errors are made; measured.
SCATTERED = 56


class Response(Merged):
    """The contacts within a point load's cone: one packing, or mean and std over realisations.

    ``vertical`` is the vertical component of the contact force, f N_y.
    """

    name = "response"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """The contacts below each bead of the cone."""
        beads, layers = region.beads, self.scene.ask.layers
        if layers is not None:
            beads = sum(region.rows[j + 1].count for j in layers if j < region.top)
        return len(self.branches) * beads

    def kept(self, region: Region, realisations: int) -> int:
        """The scatter of both components, of which standard errors are made in the end."""
        several = realisations if realisations > 1 else 0
        return 2 * self.answer_rows(region, 1) * several * SCATTERED

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the contacts twice: by their force, then by its vertical component."""
        contacts = super().labels(problem)
        count = len(contacts["j"])
        labels: dict[str, list[Any]] = {name: 2 * column for name, column in contacts.items()}
        return {**labels, "component": ["force"] * count + ["vertical"] * count}

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (groups, 1), and g, (groups, realisations, 1): forces, then f N_y."""
        blocks = self.blocks(problem)
        _, ny = axes(problem.n_x, solved.system, problem.dimension)
        F, g = contact_forces(solved, blocks, realisations)
        f = F + (g if problem.route == Route.EXACT else 0)
        vertical = g if solved.block is None else g + f * self.tilt(solved, blocks, realisations)
        both = np.concatenate([g, vertical * ny], axis=1)
        return np.concatenate([F, F * ny])[:, None], both.T[:, :, None]

    def tilt(self, solved: Solved, blocks: Sequence[Block], realisations: int) -> Array:
        """Give N_y/n_y − 1 of contacts, (realisations, contacts)."""
        region, tilts = solved.region, [solved.system.zeros(realisations, 0)]
        for branch, row in blocks:
            normal = solved.dn(branch.number, row.j)
            columns = columns_of(region.rows[row.j], row, region.width)
            tilts.append(taken(sum(normal[1:], normal[0]), columns))
        return np.concatenate(tilts, axis=1)

    def table(self, problem: Problem, statistics: Statistics) -> Table:
        """One row a contact."""
        contacts = self.naming.contacts(self.blocks(problem))
        half = len(statistics.mean) // 2
        force, vertical = slice(half), slice(half, None)
        means, changes = statistics.ordered + statistics.mean, statistics.mean
        if problem.realisations == 1:
            numbers = {"force": means[force], "change": changes[force]}
            numbers |= {"vertical": means[vertical], "vertical_change": changes[vertical]}
            return Table(contacts, numbers, ("change", "vertical_change"))
        numbers, errors = {}, {}
        for name, part in (("force", force), ("vertical", vertical)):
            numbers[f"{name}_mean"] = means[part]
            numbers[f"{name}_mean_change"] = changes[part]
            numbers[f"{name}_std"] = statistics.std[part]
            errors[f"{name}_mean_change"] = statistics.mean_error[part]
            errors[f"{name}_std"] = statistics.std_error[part]
        return Table(contacts, numbers, tuple(errors), errors)
