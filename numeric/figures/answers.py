"""Figures of one answer: of a run, or of an ensemble."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from ..arithmetic.systems import Array, as_floats
from ..planning.plan import Plan
from ..scene.scene import refuse
from ..scene.sections import SceneError
from ..unilateral.network import Network

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# Columns of contacts, which are drawn on the lattice.
PLACES = {"x", "y", "upper_x", "upper_y"}
# Numbers that are drawn: floats hold their sums, and the shares that they have of each other.
LEAST, MOST = 1e-300, 1e280


def figure_of(
    plan: Plan,
    columns: Mapping[str, Array],
    errors: Mapping[str, Array],
    network: Network | None = None,
) -> "Figure":
    """Draw an answer; ``columns`` are those of its table, ``errors`` standard errors of some.

    ``network``: where beads came to rest under unilateral contacts.

    Raises ``MissingLibraryError``, and ``SceneError`` for a quantity that has no figure, for an
    answer of no rows, or for numbers beyond what floats can draw.
    """
    from .style import house_style  # first: it says what to install

    refuse("figures", plan.scene)
    from .answers_drawing import DRAWN

    if not len(next(iter(columns.values()), [])):
        raise SceneError("ask.quantity", plan.quantity.name, "the answer has no rows to be drawn")
    _check_sizes(plan, columns)
    with house_style():
        return DRAWN[plan.quantity.name](plan, columns, errors, network)


def contacts_of(
    plan: Plan,
    ends: Array,
    forces: Array,
    surface: Array,
    *,
    axes: "Axes | None" = None,
    values: Array | None = None,
    label: str = "",
) -> "Axes":
    """Draw contacts between ``ends``, (contacts, 2, 2), as thick as ``forces``; lengths in r.

    ``surface``: the beads of the surface, (W, 2); ``values``, (contacts,), colour the contacts.
    Raises ``MissingLibraryError``, and ``SceneError`` for numbers beyond what floats can draw.
    """
    from .style import house_style  # first: it says what to install
    from . import answers_drawing  # isort: skip

    _check_sizes(plan, {"force": forces})
    with house_style():
        return answers_drawing.contacts_of(plan, ends, forces, surface, axes, values, label)


def _check_sizes(plan: Plan, columns: Mapping[str, Array]) -> None:
    """Raise ``SceneError`` for numbers beyond what floats can draw."""
    for name, values in columns.items():
        if values.dtype.kind not in "fO" or (name in PLACES and plan.quantity.name != "positions"):
            continue
        sizes, exact = np.abs(as_floats(values)), values.dtype == object
        if not exact:  # NaN says that something is not known
            sizes = sizes[np.isfinite(sizes)]
        largest = sizes.max(initial=0)
        vanished = not largest and (name == "high" or (exact and any(v != 0 for v in values)))
        if vanished or 0 < largest < LEAST or not largest <= MOST:
            unit, key = plan.scene.load.magnitude, "load.magnitude"
            if plan.quantity.name == "positions":
                unit, key = plan.scene.packing.radius, "packing.radius"
            allowed = f"what is drawn must lie between {LEAST:g} and {MOST:g}: choose another unit"
            raise SceneError(key, unit, allowed)
