"""σ_f layer by layer."""

from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..lattice.layers import Block, Region
from ..mechanics.problem import Problem
from ..mechanics.sweep import Solved
from .base import RATIO, Table, contact_forces, first_order_std
from .statistics import Merged, Statistics


class Profile(Merged):
    """Mean force, mean and standard deviation of its change, by layer and branch.

    Under a surface or bulk load all ordered forces of a layer are equal, and the standard deviation
    of the change is that of the force, σ_f.
    """

    name = "profile"

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a layer and branch."""
        return len(self.branches) * self.height

    def gathered(self, region: Region, realisations: int) -> int:
        """Whole layers, of which a load may reach little: 10 numbers of the 38 of a bead."""
        idle = max((self.width or 0) * (self.height + 1) - region.beads, 0)
        return 10 * idle * (realisations + 1) // 38

    def blocks(self, problem: Problem) -> list[Block]:
        """Give whole layers, those that no load reaches included."""
        return self.all_contacts

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the layers, by the lower beads of their contacts."""
        blocks = self.blocks(problem)
        return {"j": [row.j - 1 for _, row in blocks], "branch": [b.value for b, _ in blocks]}

    def members(self, problem: Problem) -> int:
        """W contacts."""
        return self.layers_up_to(0).widest

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (2M, W), and g, (2M, realisations, W)."""
        F, g = contact_forces(solved, self.blocks(problem), realisations)
        shape = -1, self.members(problem)
        return F.reshape(shape), g.reshape(realisations, *shape).swapaxes(0, 1)

    def table(self, problem: Problem, statistics: Statistics) -> Table:
        """One row a layer and branch, base first."""
        index = {name: np.array(column) for name, column in self.labels(problem).items()}
        index["samples"] = np.full(len(statistics.mean), statistics.count)
        contacts = zip(index["j"].tolist(), index["branch"], strict=True)
        theory = first_order_std(problem, contacts)
        if theory is not None:
            index["first_order_std"] = theory * self.scene.load.magnitude
        numbers = {
            "mean": statistics.ordered + statistics.mean,
            "mean_change": statistics.mean,
            "std": statistics.std,
        }
        if problem.load.loaded is None and not problem.load.angle_deg:  # no mean is zero
            numbers[RATIO] = numbers["std"] / numbers["mean"]
        errors = {"mean_change": statistics.mean_error, "std": statistics.std_error}
        return Table(index, numbers, ("mean_change", "std"), errors)
