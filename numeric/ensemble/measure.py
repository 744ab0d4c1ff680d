"""What is measured of each packing of an ensemble: changes of contact forces, in groups.

A group holds contacts that are alike: a layer and branch of a profile, or one contact. The changes
are those of the engine in float64, and each depends on the scene and the realisation alone.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from ..arithmetic.systems import Array
from ..mechanics.problem import Problem, Solved
from ..planning.plan import Plan
from ..quantities.base import ContactQuantity, first_order_std
from ..statistics.moments import unit_near


@dataclass(frozen=True)
class Measurement:
    """What is measured, and how it is summed up; ``plan`` has one realisation.

    ``edges`` are those of the bins, float64; ``covariance`` asks for that of the groups.
    """

    plan: Plan
    edges: tuple[float, ...]
    covariance: bool

    @property
    def problem(self) -> Problem:
        """What is solved."""
        return self.plan.problem

    @property
    def _of(self) -> ContactQuantity:
        assert isinstance(self.plan.quantity, ContactQuantity)
        return self.plan.quantity

    @property
    def quantity(self) -> str:
        """What the scene asks."""
        return self.plan.quantity.name

    @property
    def squares(self) -> bool:
        """Whether covariances are of mean squares of packings, and not of changes."""
        return self._of.squares

    @cached_property
    def unit(self) -> int:
        """The power of two in which means of single packings are rounded (σ/r is near it)."""
        return math.frexp(unit_near(self.problem.radii.relative_std()))[1] - 1

    @cached_property
    def labels(self) -> dict[str, list[Any]]:
        """Columns that name the groups, each of length ``groups``."""
        return self._of.labels(self.problem)

    @cached_property
    def groups(self) -> int:
        """How many groups there are."""
        return len(next(iter(self.labels.values()), [None]))

    @cached_property
    def members(self) -> int:
        """Contacts in a group."""
        return self._of.members(self.problem)

    @property
    def variables(self) -> int:
        """Size of the covariance matrix."""
        return self.groups if self.covariance else 0

    def changes(self, solved: Solved, realisations: int) -> tuple[Array, Array]:
        """Give ordered forces (groups, 1 or members) and changes (groups, realisations, members).

        Of a response the second half of the groups is vertical: f N_y, its change likewise.
        """
        return self._of.changes(self.problem, solved, realisations)

    def ordered(self) -> list[Fraction]:
        """Give the ordered force of each group (of a group whose forces differ, their mean)."""
        return self._of.ordered(self.problem)

    def theory(self) -> list[Fraction] | None:
        """Give σ_f of layers j = 0 … M − 1, exact to first order; None where it does not apply."""
        return first_order_std(self.problem)
