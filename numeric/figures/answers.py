"""Figures of one answer."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from ..arithmetic.systems import Array
from ..planning.plan import Plan
from ..scene.sections import SceneError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure_of(plan: Plan, columns: Mapping[str, Array], errors: Mapping[str, Array]) -> "Figure":
    """Draw the answer to a scene's question."""
    raise SceneError("ask.quantity", plan.quantity.name, "has no figure of its own")
