"""Statistics over many packings: moments, and their standard errors."""

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arithmetic.systems import Array, NumberSystem, as_floats
from ..mechanics.problem import Problem
from ..mechanics.sweep import Solved
from ..statistics.moments import Moments, standard_errors, unit_near
from .base import ContactQuantity, Gatherer, Table


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

    def gatherer(self, problem: Problem, system: NumberSystem) -> Gatherer:
        """Start to merge moments."""
        return _Moments(self, problem, system)

    @abstractmethod
    def table(self, problem: Problem, system: NumberSystem, statistics: Statistics) -> Table:
        """Give the rows."""


class _Moments:
    def __init__(self, quantity: Merged, problem: Problem, system: NumberSystem) -> None:
        self.quantity, self.problem, self.system = quantity, problem, system
        self.unit = unit_near(problem.radii.relative_std)
        self.ordered: Any = None
        self.moments, self.scatter = Moments(self.unit), list[Array]()

    def add(self, solved: Solved, realisations: Sequence[int]) -> None:
        """Merge the changes of the contacts; ordered forces only enter the mean."""
        F, g = self.quantity.changes(self.problem, solved, len(realisations))
        with np.errstate(all="ignore"):  # of balls beyond floats no standard error is known
            scaled = as_floats(g / self.unit)
            self.scatter.append(np.stack([scaled.mean(axis=2).T, (scaled**2).mean(axis=2).T], 1))
        if self.ordered is None:
            # under a surface or bulk load F is one number, which a sum would round
            alike = self.problem.load.loaded is None or F.shape[1] == 1
            self.ordered = F[:, 0] if alike else F.sum(axis=1) / F.shape[1]
        self.moments.add(g.reshape(len(g), -1).T)

    def table(self) -> Table:
        """Give what was found, in the columns of the question."""
        mean_error, std_error = (
            error * self.unit for error in standard_errors(np.concatenate(self.scatter))
        )
        mean, std = self.moments.average(), self.moments.std(self.system)
        count = self.moments.count
        statistics = Statistics(self.ordered, mean, std, mean_error, std_error, count)
        return self.quantity.table(self.problem, self.system, statistics)
