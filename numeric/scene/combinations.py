"""What can't be combined: one table, from which the refusals, the help, the guide and a test come.

A row is refused where a scene and what is done with it have all of its features. What no row
refuses is answered. Features are compared with ``==``; those that a row leaves out may be any.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, get_args

QuantityName = Literal[
    "contact",
    "contact_forces",
    "positions",
    "profile",
    "histogram",
    "response",
]
QUANTITIES: tuple[str, ...] = get_args(QuantityName)
COMMANDS = ("run", "ensemble", "figures", "cost")
LOADS = ("surface", "bulk", "point", "file")


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


def _load_but(*kinds: str) -> tuple[str, ...]:
    return tuple(one for one in LOADS if one not in kinds)


def either(words: tuple[str, ...]) -> str:
    """Say that one of several words is allowed."""
    quoted = [f'"{word}"' for word in words]
    return ", ".join(quoted[:-1]) + f" or {quoted[-1]}"


_OPEN, _SPHERES, _YES, _NO = ("unilateral",), (3,), (True,), (False,)
_PLACES = ("contact", "histogram", "positions")
_GATHERED = ("profile", "contact", "contact_forces", "response", "histogram")
_OF_NETWORKS = ("contact_forces", "positions")
_IN_THREE = "in three dimensions"
_ENDLESS = "is required: an infinite slab has infinitely many of these"

TABLE = (
    Refusal(
        {"dimension": _SPHERES, "slab": _YES},
        "packing.width",
        f"is required: beads lie in finite layers {_IN_THREE}",
    ),
    Refusal(
        {"contacts": _OPEN, "slab": _YES},
        "packing.width",
        'is required with contacts = "unilateral": beads move in a periodic strip',
    ),
    Refusal(
        {"leaning": _YES, "load": ("file",)}, "load.angle_deg", 'has no meaning with kind = "file"'
    ),
    Refusal(
        {"dimension": _SPHERES, "contacts": _OPEN},
        "effects.contacts",
        f"must stay closed {_IN_THREE}",
    ),
    Refusal(
        {"dimension": _SPHERES, "at": _YES, "quantity": _but("contact", "positions")},
        "ask.at",
        f'is for "contact" and "positions" {_IN_THREE}',
    ),
    Refusal(
        {"contacts": _OPEN, "geometry": ("ordered", "first-order")},
        "effects.geometry",
        'must be "exact" with contacts = "unilateral": beads move until no contact pulls',
    ),
    Refusal(
        {"contacts": _OPEN, "quantity": _but(*_OF_NETWORKS)},
        "ask.quantity",
        f'must be {either(_OF_NETWORKS)} with contacts = "unilateral"',
    ),
    Refusal(
        {"contacts": _OPEN, "several": _YES},
        "ask.realisations",
        'must be 1 with contacts = "unilateral"',
    ),
    Refusal(
        {"quantity": _but("response", "histogram"), "layers": _YES},
        "ask.layers",
        'needs quantity = "response" or "histogram"',
    ),
    Refusal(
        {"bins": _YES, "quantity": _but("histogram")}, "ask.bins", 'needs quantity = "histogram"'
    ),
    Refusal({"at": _YES, "quantity": _but(*_PLACES)}, "ask.at", f"is for {either(_PLACES)}"),
    Refusal(
        {"at": _YES, "layers": _YES}, "ask.layers", "one contact lies in one layer: leave at out"
    ),
    Refusal(
        {"load": _load_but("point"), "quantity": ("response",)},
        "load.kind",
        'must be "point" for quantity = "response"',
    ),
    Refusal(
        {"load": ("surface", "bulk"), "quantity": ("contact_forces",), "slab": _YES},
        "packing.width",
        _ENDLESS,
    ),
    Refusal(
        {"at": _NO, "quantity": ("positions", "profile", "histogram"), "slab": _YES},
        "packing.width",
        _ENDLESS,
    ),
    Refusal(
        {"command": ("ensemble",), "quantity": _but(*_GATHERED)},
        "ask.quantity",
        f"an ensemble is of {either(_GATHERED)}",
    ),
    Refusal(
        {"command": ("ensemble", "cost"), "contacts": _OPEN},
        "effects.contacts",
        'must be "bilateral": a single packing is solved where contacts open',
    ),
    Refusal(
        {"command": ("ensemble",), "tolerance": _YES},
        "ask.tolerance",
        "an ensemble is solved in float64: leave it out",
    ),
    Refusal(
        {"command": ("ensemble",), "drawn": _NO},
        "disorder.kind",
        "an ensemble needs radii that are drawn",
    ),
    Refusal(
        {"command": ("ensemble",), "quantity": _but("histogram"), "reach": _YES},
        "ask.quantity",
        'only a "histogram" has bins that reach',
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
        {"command": ("cost",), "dimension": _SPHERES},
        "packing.dimension",
        "must be 2: ways are compared for discs",
    ),
)

# What a scene is where it does not say otherwise, and what is asked of it by the command.
PLAIN: dict[str, Any] = {
    "command": "run",
    "quantity": "profile",
    "dimension": 2,
    "slab": False,
    "drawn": True,
    "load": "surface",
    "leaning": False,
    "contacts": "bilateral",
    "geometry": "exact",
    "at": False,
    "layers": False,
    "bins": False,
    "several": False,
    "tolerance": False,
    "reach": False,
}


def plain(quantity: str) -> dict[str, Any]:
    """Give the features of the plainest scene with a question."""
    own: dict[str, Any] = {"load": "point"} if quantity == "response" else {}
    return PLAIN | {"quantity": quantity, "at": quantity == "contact"} | own


@lru_cache(maxsize=1024)  # scenes that are solved one after the other are often alike
def refusal(**features: Any) -> Refusal | None:
    """Give the first row that refuses what has these features, the others being plain.

    >>> refusal(command="cost", dimension=3).why
    'must be 2: ways are compared for discs'
    >>> refusal(command="ensemble", dimension=3) is None
    True
    """
    found = plain(features.get("quantity", PLAIN["quantity"])) | features
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


# What is said where a feature is not plain; of others the words are the values.
_SAID = {
    "slab": "no `packing.width`",
    "drawn": "radii of a file",
    "leaning": "`load.angle_deg`",
    "at": "`ask.at`",
    "layers": "`ask.layers`",
    "bins": "`ask.bins`",
    "several": "realisations",
    "tolerance": "a tolerance",
    "reach": "`--reach`",
}


def limits() -> str:
    """Write the rows of the table as the guide to scenes has them."""
    rows = [["asked together", "refused"], ["---"] * 2]
    for row in TABLE:
        words = []
        for name, values in row.when.items():
            if name in _SAID and values == (PLAIN[name],):
                words += [f"no {_SAID[name]}"] * (name == "at")
            elif name in _SAID:
                words.append(_SAID[name])
            elif name == "dimension":
                words.append("spheres")
            elif len(values) > len(_but(*values)):
                words.append("all but " + " and ".join(f"`{one}`" for one in _but(*values)))
            else:
                words.append(" or ".join(f"`{value}`" for value in values))
        rows.append([", ".join(words), f"`{row.key}` {row.why}"])
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)
