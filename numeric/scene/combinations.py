"""What can't be combined: one table, from which the refusals, the help, the guide and a test come.

A row is refused where a scene and what is done with it have all of its features. What no row
refuses is answered. Features are compared with ``==``; those that a row leaves out may be any.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, get_args

QuantityName = Literal[
    "contact",
    "contact_forces",
    "positions",
    "profile",
    "histogram",
    "response",
    "base_reactions",
]
QUANTITIES: tuple[str, ...] = get_args(QuantityName)
COMMANDS = ("run", "ensemble", "figures", "cost")


@dataclass(frozen=True)
class Refusal:
    """A combination that is refused: ``key`` of the scene is named, and ``why``.

    ``when``: features, each with the values that it has here.
    """

    when: Mapping[str, tuple[Any, ...]]
    key: str
    why: str

    def holds(self, features: Mapping[str, Any]) -> bool:
        """Whether a scene has all of these features."""
        return all(features[name] in values for name, values in self.when.items())


def _but(*quantities: str) -> tuple[str, ...]:
    return tuple(one for one in QUANTITIES if one not in quantities)


def either(words: tuple[str, ...]) -> str:
    """Say that one of several words is allowed."""
    quoted = [f'"{word}"' for word in words]
    return ", ".join(quoted[:-1]) + f" or {quoted[-1]}"


_OPEN, _SPHERES, _STOPS = ("unilateral",), (3,), (True,)
_GATHERED = ("profile", "contact", "contact_forces", "response", "histogram")
_OF_NETWORKS = ("contact", "histogram", "profile", "response")
_IN_THREE = "in three dimensions (packing.dimension = 3)"
_IN_OPEN = 'has no meaning with contacts = "unilateral": beads move, exactly, until none pulls'

TABLE = (
    Refusal(
        {"dimension": _SPHERES, "contacts": _OPEN},
        "effects.contacts",
        f"must stay closed {_IN_THREE}",
    ),
    Refusal(
        {"dimension": _SPHERES, "stop": _STOPS},
        "effects.stop_at_tension",
        f"must be false {_IN_THREE}",
    ),
    Refusal(
        {"dimension": _SPHERES, "at": (True,), "quantity": _but("contact", "positions")},
        "ask.at",
        f'is for "contact" and "positions" {_IN_THREE}',
    ),
    Refusal(
        {"contacts": _OPEN, "geometry": ("ordered", "first-order")}, "effects.geometry", _IN_OPEN
    ),
    Refusal({"contacts": _OPEN, "stop": _STOPS}, "effects.stop_at_tension", _IN_OPEN),
    Refusal(
        {"contacts": _OPEN, "quantity": ("histogram",), "at": (True,)},
        "ask.at",
        'can\'t be said with contacts = "unilateral": P(f) is of all contacts',
    ),
    Refusal(
        {"quantity": _but("response", "histogram"), "layers": (True,)},
        "ask.layers",
        'needs quantity = "response" or "histogram"',
    ),
    Refusal(
        {"contacts": _OPEN, "layers": (True,)},
        "ask.layers",
        'can\'t be said with contacts = "unilateral": beads leave their layers',
    ),
    Refusal(
        {"stop": _STOPS, "layers": (True,)},
        "ask.layers",
        "can't be said with stop_at_tension: the sweep may not come so far",
    ),
    Refusal(
        {"stop": _STOPS, "geometry": ("ordered", "first-order")},
        "effects.stop_at_tension",
        'only has a meaning with geometry = "exact"',
    ),
    Refusal(
        {"stop": _STOPS, "quantity": ("response",), "several": (True,)},
        "effects.stop_at_tension",
        "can't be averaged: each realisation of a response would stop elsewhere",
    ),
    Refusal(
        {"command": ("ensemble",), "quantity": _but(*_GATHERED)},
        "ask.quantity",
        f"an ensemble is of {either(_GATHERED)}",
    ),
    Refusal(
        {"command": ("ensemble",), "contacts": _OPEN, "quantity": _but(*_OF_NETWORKS)},
        "ask.quantity",
        'contacts = "unilateral" differ from packing to packing: an ensemble is of '
        f"{either(_OF_NETWORKS)}",
    ),
    Refusal(
        {"command": ("ensemble",), "contacts": _OPEN, "covariance": (True,)},
        "effects.contacts",
        "a covariance is known on the lattice only, in which no contact opens",
    ),
    Refusal(
        {"command": ("ensemble",), "stop": _STOPS},
        "effects.stop_at_tension",
        "an ensemble needs whole packings",
    ),
    Refusal(
        {"command": ("figures",), "quantity": ("contact",)},
        "ask.quantity",
        'has no figure of its own: ask for "contact_forces" or, of many packings, "histogram"',
    ),
    Refusal(
        {"command": ("figures",), "dimension": _SPHERES, "quantity": _but("profile", "histogram")},
        "packing.dimension",
        'has figures of "profile" and "histogram" only',
    ),
    Refusal(
        {"command": ("cost",), "contacts": _OPEN},
        "effects.contacts",
        "costs are compared of packings on the lattice, in which no contact opens",
    ),
    Refusal(
        {"command": ("cost",), "dimension": _SPHERES},
        "packing.dimension",
        "must be 2: ways are compared for discs",
    ),
)

# What a scene is where it does not say otherwise.
PLAIN = {
    "command": "run",
    "quantity": "profile",
    "dimension": 2,
    "contacts": "bilateral",
    "geometry": "exact",
    "stop": False,
    "at": False,
    "layers": False,
    "several": False,
    "covariance": False,
}


def refusal(**features: Any) -> Refusal | None:
    """Give the first row that refuses what has these features, the others being plain.

    >>> refusal(command="cost", dimension=3).why
    'must be 2: ways are compared for discs'
    >>> refusal(command="ensemble", dimension=3) is None
    True
    """
    found = PLAIN | features
    return next((row for row in TABLE if row.holds(found)), None)


def answered(command: str, **features: Any) -> tuple[str, ...]:
    """Give the quantities that a command answers."""
    return tuple(
        one
        for one in QUANTITIES
        if refusal(command=command, **features | {"quantity": one}) is None
    )


KINDS: dict[str, dict[str, Any]] = {
    "discs": {},
    "spheres": {"dimension": 3},
    "contacts that open": {"contacts": "unilateral"},
    "`stop_at_tension`": {"stop": True},
}


def guide() -> str:
    """Write the table of commands and quantities as the guide to scenes has it."""
    rows = [["quantity", *(f"`{command}`" for command in COMMANDS)], ["---"] * (len(COMMANDS) + 1)]
    for quantity in QUANTITIES:
        cells = []
        for command in COMMANDS:
            kinds = [name for name, own in KINDS.items() if quantity in answered(command, **own)]
            cells.append(", ".join(kinds) or "–")
        rows.append([f"`{quantity}`", *cells])
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)
