"""What can't be combined; the help of the commands and the checks of scenes come from here.

``NEEDS`` has the keys that mean something beside some values of another key alone. What is not
refused is answered.
"""

from typing import Any, NamedTuple

QUANTITIES = ("contact", "contact_forces", "positions", "profile", "histogram", "response")
COMMANDS = ("run", "ensemble", "figures", "cost")
KINDS: dict[str, dict[str, Any]] = {
    "discs": {},
    "spheres": {"dimension": 3},
    "contacts that open": {"contacts": "unilateral"},
}


def either(words: tuple[str, ...]) -> str:
    """Say that one of several words is allowed."""
    quoted = [f'"{word}"' for word in words]
    return " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)


_DRAWN = ("uniform", "normal", "two-point")
_OF_NETWORKS = ("contact_forces", "positions")
_GATHERED = ("profile", "contact", "contact_forces", "response", "histogram")


def refusal(
    command: str,
    quantity: str,
    *,
    dimension: int = 2,
    slab: bool = False,
    drawn: bool = True,
    load: str = "surface",
    contacts: str = "bilateral",
    geometry: str = "exact",
    at: bool = False,
    layers: bool = False,
    several: bool = False,
    together: bool = False,
    tolerance: bool = False,
    reach: bool = False,
) -> tuple[str, str] | None:
    """Give the key of the scene that is refused, and why; None where nothing is.

    Asked is one question of a scene, what the scene is, and what is done with it.

    >>> refusal("ensemble", "profile", tolerance=True)
    ('ask.tolerance', 'must be left out in an ensemble, which is solved in float64')
    >>> refusal("cost", "profile", dimension=3) is None
    True
    """
    discs, opens = dimension == 2, contacts == "unilateral"
    few = load in {"point", "file"} and quantity not in {"profile", "positions"}
    finite = (at or few) and discs and not opens
    has_figure = quantity in {"profile", "histogram"} or (discs and quantity != "contact")
    if slab and not finite:
        return "packing.width", (
            "is required here: an infinite slab of discs answers for one contact, for one bead, or "
            "for the contacts below loads on single beads"
        )
    if opens and not discs:
        return "effects.contacts", "must stay closed in three dimensions"
    if opens and geometry != "exact":
        where = 'with contacts = "unilateral": beads move until no contact pulls'
        return "effects.geometry", f'must be "exact" {where}'
    if opens and quantity not in _OF_NETWORKS:
        return "ask.quantity", f'must be {either(_OF_NETWORKS)} with contacts = "unilateral"'
    if opens and several:
        return "ask.realisations", 'must be 1 with contacts = "unilateral"'
    if at and (layers or together):
        return "ask.at", "asks for one place: for one quantity, and without layers"
    if quantity == "response" and load != "point":
        return "load.kind", 'must be "point" for quantity = "response"'
    if command != "run" and together:
        return "ask.quantity", "must be one quantity: only run answers several at once"
    if command == "ensemble" and quantity not in _GATHERED:
        return "ask.quantity", f"must be {either(_GATHERED)} in an ensemble"
    if command in {"ensemble", "cost"} and opens:
        return "effects.contacts", 'must be "bilateral": only run and figures let contacts open'
    if command == "ensemble" and tolerance:
        return "ask.tolerance", "must be left out in an ensemble, which is solved in float64"
    if command == "ensemble" and not drawn:
        kinds = either(_DRAWN)
        return "disorder.kind", f"must be {kinds} in an ensemble: its radii are drawn"
    if reach and quantity != "histogram":
        why = "reach, which sets the edges of its bins"
        return "ask.quantity", f'must be "histogram" with {why}'
    if command == "figures" and not has_figure:
        return "ask.quantity", (
            'has no figure: ask for "profile" or "histogram", or of discs for "contact_forces", '
            '"positions" or "response"'
        )
    return None


def answered(command: str, **features: Any) -> tuple[str, ...]:
    """Give the quantities that a command answers."""

    def refused(quantity: str) -> object:
        load = "point" if quantity == "response" else "surface"
        return refusal(command, quantity, load=load, at=quantity == "contact", **features)

    return tuple(quantity for quantity in QUANTITIES if not refused(quantity))


class Need(NamedTuple):
    """A ``key`` that means something beside these ``values`` of another alone.

    It is ``required`` beside some of them.
    """

    key: str
    other: str
    values: tuple[str, ...]
    required: tuple[str, ...] = ()


_OPEN = ("unilateral",)
NEEDS = (
    Need("disorder.relative_std", "kind", _DRAWN, _DRAWN),
    Need("disorder.seed", "kind", _DRAWN),
    Need("disorder.file", "kind", ("file",), ("file",)),
    Need("load.angle_deg", "kind", ("surface", "bulk", "point")),
    Need("load.at", "kind", ("point",), ("point",)),
    Need("load.file", "kind", ("file",), ("file",)),
    Need("effects.most_programs", "contacts", _OPEN),
    Need("effects.most_seconds", "contacts", _OPEN),
    Need("ask.at", "quantity", ("contact", "histogram", "positions"), ("contact",)),
    Need("ask.layers", "quantity", ("response", "histogram")),
    Need("ask.bins", "quantity", ("histogram",)),
)
