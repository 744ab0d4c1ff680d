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
    refused = (
        (
            slab and not finite,
            "packing.width",
            "is required here: an infinite slab of discs answers for one contact, for one bead, or "
            "for the contacts below loads on single beads",
        ),
        (opens and not discs, "effects.contacts", "must stay closed in three dimensions"),
        (
            opens and geometry != "exact",
            "effects.geometry",
            'must be "exact" with contacts = "unilateral": beads move until no contact pulls',
        ),
        (
            opens and quantity not in _OF_NETWORKS,
            "ask.quantity",
            f'must be {either(_OF_NETWORKS)} with contacts = "unilateral"',
        ),
        (
            opens and several,
            "ask.realisations",
            'must be 1 with contacts = "unilateral"',
        ),
        (
            at and (layers or together),
            "ask.at",
            "asks for one place: for one quantity, and without layers",
        ),
        (
            quantity == "response" and load != "point",
            "load.kind",
            'must be "point" for quantity = "response"',
        ),
        (
            command != "run" and together,
            "ask.quantity",
            "must be one quantity: only run answers several at once",
        ),
        (
            command == "ensemble" and quantity not in _GATHERED,
            "ask.quantity",
            f"must be {either(_GATHERED)} in an ensemble",
        ),
        (
            command in {"ensemble", "cost"} and opens,
            "effects.contacts",
            'must be "bilateral": a single packing is solved where contacts open',
        ),
        (
            command == "ensemble" and tolerance,
            "ask.tolerance",
            "must be left out in an ensemble, which is solved in float64",
        ),
        (
            command == "ensemble" and not drawn,
            "disorder.kind",
            'must be "uniform", "normal" or "two-point" in an ensemble: its radii are drawn',
        ),
        (
            reach and quantity != "histogram",
            "ask.quantity",
            'must be "histogram" with reach, which sets the edges of its bins',
        ),
        (
            command == "figures" and not has_figure,
            "ask.quantity",
            'has no figure: ask for "profile" or "histogram", or of discs for "contact_forces", '
            '"positions" or "response"',
        ),
    )
    return next(((key, why) for holds, key, why in refused if holds), None)


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


_DRAWN, _OPEN = ("uniform", "normal", "two-point"), ("unilateral",)
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
