"""σ_f layer by layer."""

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.decimals import short
from ..arithmetic.systems import Array, NumberSystem, as_floats
from ..lattice.branch import Direction
from ..lattice.layers import Block, Region, full_layer
from ..mechanics.problem import Problem, Solved
from ..statistics.moments import Moments, Scatter, unit_near
from .base import (
    RATIO,
    ContactQuantity,
    Gatherer,
    Table,
    column,
    contact_changes,
    first_order_std,
)


class Profile(ContactQuantity):
    """Mean force, mean and standard deviation of its change, by layer and branch.

    Under a surface or bulk load all ordered forces of a layer are equal, and the standard deviation
    of the change is that of the force, σ_f.
    """

    name = "profile"
    merged = True

    def answer_rows(self, region: Region, realisations: int) -> int:
        """One a layer and branch."""
        return len(self.branches) * self.height

    def gathered(self, region: Region, realisations: int) -> int:
        """Whole layers, also where a load reaches few of their contacts: 38 numbers a bead."""
        idle = max((self.width or 0) * (self.height + 1) - region.beads, 0)
        return 2 * idle * (realisations + 1) // 38

    def gatherer(self, problem: Problem, system: NumberSystem) -> "ProfileMoments":
        """Start to merge moments."""
        return ProfileMoments(self, problem, system)

    def blocks(self, problem: Problem) -> list[Block]:
        """Give whole layers, those that no load reaches included."""
        assert self.width is not None
        rows = [full_layer(j, self.width) for j in range(1, self.height + 1)]
        return [Block(branch, row) for row in rows for branch in self.branches]

    def labels(self, problem: Problem) -> dict[str, list[Any]]:
        """Name the layers, by the lower beads of their contacts."""
        blocks = self.blocks(problem)
        return {"j": [row.j - 1 for _, row in blocks], "branch": [b.value for b, _ in blocks]}

    def members(self, problem: Problem) -> int:
        """W contacts."""
        assert self.width is not None
        return self.width

    def changes(self, problem: Problem, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give F, shape (2M, W), and g, (2M, realisations, W)."""
        parts = contact_changes(solved, self.blocks(problem), realisations)
        return np.stack([F for _, F, _ in parts]), np.stack([g for _, _, g in parts])

    def ordered(self, problem: Problem) -> list[Fraction]:
        """Give the mean ordered force of each layer and branch."""
        blocks = self.ordered_blocks(problem)
        return [sum(block, Fraction(0)) / self.members(problem) for block in blocks]


class ProfileMoments(Gatherer):
    """Merges moments of layers; ``found`` holds each layer's ordered force and its moments."""

    def __init__(self, quantity: Profile, problem: Problem, system: NumberSystem) -> None:
        self.quantity, self.problem, self.system = quantity, problem, system
        self.unit = unit_near(problem.radii.relative_std())
        self.found: dict[tuple[int, Direction], tuple[Any, Moments]] = {}
        self.scatter = Scatter()

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Merge the changes of the contacts; ordered forces only enter the mean."""
        assert solved.forces is not None
        blocks = self.quantity.blocks(self.problem)
        means, squares = [], []
        for (branch, row), F, g in contact_changes(solved, blocks, len(realisations)):
            with np.errstate(all="ignore"):  # of balls beyond floats no standard error is known
                scaled = as_floats(g / self.unit)
                means.append(scaled.mean(axis=1))
                squares.append((scaled**2).mean(axis=1))
            key = row.j - 1, branch
            if key not in self.found:
                # under a surface or bulk load F is one number, which a sum would round
                one = self.problem.load.loaded is None
                self.found[key] = (F[0] if one else F.sum() / len(F), Moments(self.unit))
            self.found[key][1].add(g.reshape(-1))
        self.scatter.add(np.stack(means, axis=1), np.stack(squares, axis=1))

    def table(self) -> Table:
        """One row a layer and branch, base first."""
        keys = sorted(self.found)
        ordered = [self.found[key][0] for key in keys]
        moments = [self.found[key][1] for key in keys]
        mean = [one.average().item() for one in moments]
        std = [one.std(self.system).item() for one in moments]
        index = {
            "j": np.array([j for j, _ in keys], dtype=np.int64),
            "branch": np.array([branch.value for _, branch in keys], dtype="U1"),
            "samples": np.array([one.count for one in moments], dtype=np.int64),
        }
        theory = first_order_std(self.problem)
        if theory is not None:
            index["first_order_std"] = np.array(
                [
                    short(theory[branch][j] * self.quantity.scene.load.magnitude, 12)
                    for j, branch in keys
                ],
                dtype="U",
            )
        numbers = {
            "mean": column([a + b for a, b in zip(ordered, mean, strict=True)], self.system),
            "mean_change": column(mean, self.system),
            "std": column(std, self.system),
        }
        if self.problem.load.loaded is None and not self.problem.load.angle_deg:  # no mean is zero
            numbers[RATIO] = numbers["std"] / numbers["mean"]
        small = ("mean_change", "std")
        return Table(index, numbers, small, self._errors())

    def _errors(self) -> dict[str, Array]:
        mean, std = (error * self.unit for error in self.scatter.errors())
        return {"mean_change": mean, "std": std}
