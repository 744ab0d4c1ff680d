"""Quantities: one class a question, what it needs and how its answer is gathered."""

from collections.abc import Callable, Mapping

from ..scene.scene import Scene
from .base import Quantity
from .contact import ContactForce
from .contact_forces import ContactForces
from .contacts_that_open import NETWORK_QUANTITIES
from .histogram import histogram_of
from .positions import Positions
from .profile import Profile
from .response import Response

QUANTITIES: dict[str, Callable[[Scene], Quantity]] = {
    "contact": ContactForce,
    "contact_forces": ContactForces,
    "positions": Positions,
    "profile": Profile,
    "histogram": histogram_of,
    "response": Response,
}


def quantities_of(scene: Scene) -> tuple[Quantity, ...]:
    """Give the questions that a scene asks."""
    known: Mapping[str, Callable[[Scene], Quantity]] = QUANTITIES
    if scene.effects.contacts == "unilateral":
        known = NETWORK_QUANTITIES
    return tuple(known[name](scene.asking(name)) for name in scene.ask.quantities)
