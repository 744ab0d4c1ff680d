"""Quantities: a class for each question, what it needs and how its answer is gathered."""

from ..scene.scene import CheckedScene
from .base import Quantity
from .contact import ContactForce
from .contact_forces import ContactForces
from .histogram import Histogram
from .positions import Positions
from .profile import Profile
from .response import Response

QUANTITIES: dict[str, type[Quantity]] = {
    kind.name: kind
    for kind in (ContactForce, ContactForces, Positions, Profile, Histogram, Response)
}


def quantities_of(scene: CheckedScene) -> tuple[Quantity, ...]:
    """Give the questions that a scene asks."""
    return tuple(QUANTITIES[name](scene.asking(quantity=name)) for name in scene.ask.quantities)
