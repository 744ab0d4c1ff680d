"""Figures of one answer."""

from typing import TYPE_CHECKING

from ..arithmetic.systems import Array
from ..scene.scene import Scene
from ..scene.sections import SceneError

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def figure_of(
    scene: Scene, quantity: str, columns: dict[str, Array], errors: dict[str, Array]
) -> "Figure":
    """Draw the answer to a scene's question."""
    raise SceneError("ask.quantity", quantity, "has no figure of its own")
