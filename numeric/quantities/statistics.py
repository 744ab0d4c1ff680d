"""Statistics over many packings: moments, and their standard errors."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arithmetic.systems import Array
from ..mechanics.problem import Problem
from ..mechanics.sweep import Solved
from ..statistics.moments import mean_and_std, standard_errors, unit_near
from .base import ContactQuantity, Listing, Table


@dataclass(frozen=True)
class Statistics:
    """Of each group: ordered force, mean and standard deviation of the change, standard errors.

    Shape (groups,) each; ``count`` samples a group.
    """

    ordered: Array
    mean: Array
    std: Array
    mean_error: Array
    std_error: Array
    count: int


class Merged(ContactQuantity):
    """A quantity whose realisations are merged, group by group."""

    merged = True
    roundings = 6

    def gatherer(self, problem: Problem) -> Listing:
        """Start to gather moments."""
        return _Moments(self, problem)

    @abstractmethod
    def table(self, problem: Problem, statistics: Statistics) -> Table:
        """Give the rows."""


class _Moments(Listing):
    quantity: Merged

    def __init__(self, quantity: Merged, problem: Problem) -> None:
        super().__init__(quantity, problem)
        # a power of two, in which squares of changes are within the range of floats
        self.unit = unit_near(problem.radii.relative_std)
        self.ordered: Any = None
        self.moments, self.members = list[Array](), 0

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Give mean and variance of each packing's groups; ordered forces only enter the mean."""
        F, g = self.quantity.changes(self.problem, solved, len(realisations))
        if self.ordered is None:
            # under a surface or bulk load F is one number, which a sum would round
            alike = self.problem.load.loaded is None or F.shape[1] == 1
            self.ordered = F[:, 0] if alike else F.sum(axis=1) / F.shape[1]
        g, self.members = g / self.unit, g.shape[2]
        apart = g - (mean := g.mean(axis=2, keepdims=True))
        self.moments.append(np.stack([mean[..., 0].T, (apart * apart).mean(axis=2).T], axis=1))

    def table(self) -> Table:
        """Give what was found, in the columns of the question."""
        parts = np.concatenate(self.moments)
        mean, std = mean_and_std(*parts.swapaxes(0, 1))
        with np.errstate(all="ignore"):  # of balls beyond floats no standard error is known
            floats = np.asarray(parts, np.float64)
            floats[:, 1] += floats[:, 0] ** 2  # about zero
            errors = standard_errors(floats)
        mean, std, of_mean, of_std = (of * self.unit for of in (mean, std, *errors))
        count = len(parts) * self.members
        statistics = Statistics(self.ordered, mean, std, of_mean, of_std, count)
        return self.quantity.table(self.problem, statistics)
