"""What is measured of each packing of an ensemble: changes of contact forces, in groups.

A group holds contacts that are alike: a layer and branch of a profile, or one contact. The changes
are those of the engine in float64, and each depends on the scene and the realisation alone.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np

from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import FLOAT64, Array
from ..lattice.branch import PerBranch
from ..lattice.layers import Block, Region
from ..mechanics.engine import compiles
from ..mechanics.problem import Problem, Route
from ..planning.plan import Plan
from ..planning.planner import plan
from ..quantities.base import ContactQuantity, first_order_std
from ..scene.scene import Scene, refuse
from ..scene.sections import SceneError
from ..statistics.moments import unit_near

DEFAULT_BINS = 60
# Outer edges of a histogram, in units of the largest theoretical σ_f.
REACH = 6


class ArgumentError(ForceDiffusionError, ValueError):
    """An argument is wrong: which, what it is, and what is allowed."""

    def __init__(self, name: str, value: object, allowed: str) -> None:
        """Say all three."""
        super().__init__(f"{name} = {value}: {allowed}")


@dataclass(frozen=True)
class Measurement:
    """What is measured, and how it is summed up; ``plan`` has one realisation.

    ``edges`` are those of the bins, float64. ``expected`` is how many packings there will be; it
    decides who sweeps, never a number.
    """

    plan: Plan
    edges: tuple[float, ...] = ()
    expected: int = 1

    @property
    def problem(self) -> Problem:
        """What is solved."""
        return self.plan.problem

    @property
    def quantity(self) -> ContactQuantity:
        """What is asked of each packing."""
        assert isinstance(self.plan.quantity, ContactQuantity)
        return self.plan.quantity

    @cached_property
    def many(self) -> Problem:
        """What is solved, with as many realisations as there will be."""
        return replace(self.problem, realisations=self.expected)

    @property
    def compiled(self) -> bool:
        """Whether compiled loops solve the packings."""
        return self.problem.route == Route.EXACT and compiles(self.many, FLOAT64)

    @property
    def counted(self) -> int:
        """B + 2: bins, and what lies outside; 0 where none are asked for."""
        return len(self.edges) + 1 if self.edges else 0

    @cached_property
    def unit(self) -> int:
        """The power of two in whose units changes are summed up (σ/r is near it)."""
        return math.frexp(unit_near(self.problem.radii.relative_std()))[1] - 1

    @cached_property
    def labels(self) -> dict[str, list[Any]]:
        """Columns that name the groups, each of length ``groups``."""
        return self.quantity.labels(self.problem)

    @cached_property
    def groups(self) -> int:
        """How many groups there are."""
        return len(next(iter(self.labels.values()), [None]))

    @cached_property
    def members(self) -> int:
        """Contacts in a group."""
        return self.quantity.members(self.problem)

    @cached_property
    def blocks(self) -> list[Block]:
        """Give the whole rows of contacts that groups are made of, in order; none of contacts."""
        if self.members < 2:
            return []
        return self.quantity.blocks(self.problem)

    @cached_property
    def runs(self) -> Array | None:
        """Give the branch of each of these rows, its first contact, and the one behind its last.

        None where rows are not those whose forces are balanced, from the base up.
        """
        rows, problem = self.problem.force_rows, self.problem
        starts = Region(problem.width, rows, problem.dimension).starts
        if not self.blocks or not all(row.count for row in rows[1:]):
            return None
        if any(row.j >= len(rows) or rows[row.j] != row for _, row in self.blocks):
            return None
        return np.array([(b.number, starts[r.j], starts[r.j + 1]) for b, r in self.blocks])

    @property
    def sizes(self) -> list[int]:
        """How many contacts of a group lie in each row."""
        return [row.count for _, row in self.blocks] if self.groups == 1 else [self.members]

    def ordered(self) -> Array:
        """Give the ordered force of each group (of a group whose forces differ, their mean)."""
        return np.array([float(force) for force in self.quantity.ordered(self.problem)])

    def theory(self) -> PerBranch[Sequence[Fraction]] | None:
        """Give σ_f of layers j = 0 … M − 1, exact to first order; None where it does not apply."""
        return first_order_std(self.problem)


def measurement(scene: Scene, *, reach: float | None = None) -> Measurement:
    """Say what is measured of an ensemble of a scene's packings.

    ``reach`` is the outer edge of a histogram, in units of force; by default six times the largest
    theoretical σ_f. Raises ``SceneError`` for what has no statistics over an ensemble.
    """
    ask = scene.ask
    refuse("ensemble", scene, reach=reach is not None)
    one = scene.model_copy(update={"ask": ask.model_copy(update={"realisations": 1})})
    planned = plan(one)
    if planned.problem.route == Route.ORDERED:
        why = planned.skipped[-1].reason
        raise SceneError("disorder", None, f"every realisation would be the same: {why}")
    made = Measurement(planned)
    if not (made.groups and made.members):
        allowed = "bears on no contact that is asked for: there is nothing to gather"
        raise SceneError("load.kind", scene.load.kind, allowed)
    if ask.quantity == "histogram":
        made = replace(made, edges=_edges(made, reach))
    return made


def _edges(made: Measurement, reach: float | None) -> tuple[float, ...]:
    """Edges that are fixed before anything is drawn, symmetric about no change at all."""
    if reach is None:
        reach = _usual_reach(made)
    else:
        reach /= float(made.plan.scene.load.magnitude)
    if not 0 < reach < 1e300:
        raise ArgumentError("reach", reach, "must be a positive number below 1e300")
    bins = made.plan.scene.ask.bins or DEFAULT_BINS
    low = -Fraction(reach)
    width = (Fraction(reach) - low) / bins
    edges = tuple(float(low + k * width) for k in range(bins + 1))
    if len(set(edges)) <= bins:
        raise SceneError("ask.bins", bins, "are more than float64 can tell apart here")
    return edges


def _usual_reach(made: Measurement) -> float:
    """Give the outer edge that is taken where none is named."""
    theory = made.theory()
    if theory is None:
        raise SceneError(
            "ask.quantity",
            "histogram",
            "no theory says how wide it will be here: give reach (--reach X), the outer edge "
            "of the bins in units of force",
        )
    contact = made.problem.contact
    if contact is None:
        layers = made.plan.scene.ask.layers or range(len(theory.plus))
        return float(REACH * max(rows[j] for _, rows in theory for j in layers))
    return float(REACH * theory[contact.branch][contact.j])
