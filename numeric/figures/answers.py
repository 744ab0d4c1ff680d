"""Figures of one answer: of a run, or of an ensemble."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ..arithmetic.systems import Array
from ..mechanics.problem import Route
from ..planning.plan import Plan
from ..scene.checks import refuse
from ..scene.sections import SceneError
from ..unilateral.network import Network
from .library import drawing

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure_of(
    plan: Plan,
    columns: Mapping[str, Array],
    errors: Mapping[str, Array],
    networks: Sequence[Network] = (),
) -> "Figure":
    """Draw an answer; ``columns`` are those of its table, ``errors`` standard errors of some.

    ``networks``: where beads came to rest under unilateral contacts.

    Raises ``MissingLibraryError``, and ``SceneError`` for a quantity that has no figure, or for an
    answer of no rows.
    """
    quantity = plan.quantity.name
    refuse("figures", plan.scene.packing, plan.scene.effects, plan.scene.ask)
    with drawing():
        from . import networks_drawing
        from .answers_drawing import DRAWN

        drawn = DRAWN.get(quantity)
        if plan.problem.route == Route.UNILATERAL:
            drawn = networks_drawing.drawn(quantity, networks)
        assert drawn is not None
        if not len(next(iter(columns.values()), [])):
            raise SceneError("ask.quantity", quantity, "the answer has no rows to be drawn")
        return drawn(plan, columns, errors)
