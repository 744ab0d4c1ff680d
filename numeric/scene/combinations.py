"""What can't be combined: two tables, from which the refusals, the help, the guide and tests come.

A row of ``TABLE`` is refused where a scene and what is done with it have all of its features. Those
that a row leaves out may be any. ``ONLY_WITH`` has the keys that mean something beside some values
of another key alone, ``REQUIRED`` those that are needed there. What no row refuses is answered.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

QUANTITIES = ("contact", "contact_forces", "positions", "profile", "histogram", "response")
COMMANDS = ("run", "ensemble", "figures", "cost")


@dataclass(frozen=True)
class Refusal:
    """A combination that is refused: ``key`` of the scene is named, and ``why``.

    ``when``: features, each with the values that it has here; ``words`` say the same.
    """

    words: str
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
    return " or ".join([", ".join(quoted[:-1]), quoted[-1]] if len(quoted) > 1 else quoted)


_OPEN, _SPHERES, _YES = ("unilateral",), (3,), (True,)
_GATHERED = ("profile", "contact", "contact_forces", "response", "histogram")
_OF_NETWORKS = ("contact_forces", "positions")

TABLE = (
    Refusal(
        "an infinite slab, of which infinitely many beads are asked for, or layers of spheres",
        {"endless": _YES},
        "packing.width",
        "is required here: an infinite slab of discs answers for one contact, for one bead, or for "
        "the contacts below loads on single beads",
    ),
    Refusal(
        "spheres, contacts that open",
        {"dimension": _SPHERES, "contacts": _OPEN},
        "effects.contacts",
        "must stay closed in three dimensions",
    ),
    Refusal(
        'contacts that open, `geometry` other than "exact"',
        {"contacts": _OPEN, "geometry": ("ordered", "first-order")},
        "effects.geometry",
        'must be "exact" with contacts = "unilateral": beads move until no contact pulls',
    ),
    Refusal(
        "contacts that open, other quantities",
        {"contacts": _OPEN, "quantity": _but(*_OF_NETWORKS)},
        "ask.quantity",
        f'must be {either(_OF_NETWORKS)} with contacts = "unilateral"',
    ),
    Refusal(
        "contacts that open, realisations",
        {"contacts": _OPEN, "several": _YES},
        "ask.realisations",
        'must be 1 with contacts = "unilateral"',
    ),
    Refusal(
        "`ask.at`, `ask.layers` or several quantities",
        {"at": _YES, "beside": _YES},
        "ask.at",
        "asks for one place: for one quantity, and without layers",
    ),
    Refusal(
        "`response`, a load that is no point load",
        {"load": ("surface", "bulk", "file"), "quantity": ("response",)},
        "load.kind",
        'must be "point" for quantity = "response"',
    ),
    Refusal(
        "`ensemble`, `figures` or `cost`, several quantities",
        {"command": ("ensemble", "figures", "cost"), "together": _YES},
        "ask.quantity",
        "must be one quantity: only run answers several at once",
    ),
    Refusal(
        "`ensemble`, `positions`",
        {"command": ("ensemble",), "quantity": _but(*_GATHERED)},
        "ask.quantity",
        f"an ensemble is of {either(_GATHERED)}",
    ),
    Refusal(
        "`ensemble` or `cost`, contacts that open",
        {"command": ("ensemble", "cost"), "contacts": _OPEN},
        "effects.contacts",
        'must be "bilateral": a single packing is solved where contacts open',
    ),
    Refusal(
        "`ensemble`, a tolerance",
        {"command": ("ensemble",), "tolerance": _YES},
        "ask.tolerance",
        "an ensemble is solved in float64: leave it out",
    ),
    Refusal(
        "`ensemble`, radii of a file",
        {"command": ("ensemble",), "drawn": (False,)},
        "disorder.kind",
        "an ensemble needs radii that are drawn",
    ),
    Refusal(
        "`ensemble --reach`, all but `histogram`",
        {"command": ("ensemble",), "quantity": _but("histogram"), "reach": _YES},
        "ask.quantity",
        'only a "histogram" has bins that reach',
    ),
    Refusal(
        "`figures`, `contact`; of spheres all but `profile` and `histogram`",
        {"command": ("figures",), "drawing": (False,)},
        "ask.quantity",
        'has no figure: ask for "profile" or "histogram", or of discs for "contact_forces", '
        '"positions" or "response"',
    ),
)
_DRAWN = ("uniform", "normal", "two-point")
_Beside = tuple[tuple[str, str, tuple[str, ...]], ...]
# Keys that only mean something where another key of their section has one of these values.
ONLY_WITH: _Beside = (
    ("disorder.relative_std", "kind", _DRAWN),
    ("disorder.seed", "kind", _DRAWN),
    ("disorder.file", "kind", ("file",)),
    ("load.angle_deg", "kind", ("surface", "bulk", "point")),
    ("load.at", "kind", ("point",)),
    ("load.file", "kind", ("file",)),
    ("effects.most_programs", "contacts", _OPEN),
    ("effects.most_seconds", "contacts", _OPEN),
    ("ask.at", "quantity", ("contact", "histogram", "positions")),
    ("ask.layers", "quantity", ("response", "histogram")),
    ("ask.bins", "quantity", ("histogram",)),
)
# Keys that are required where another has one of these values.
REQUIRED: _Beside = (
    ("disorder.relative_std", "kind", _DRAWN),
    ("disorder.file", "kind", ("file",)),
    ("load.at", "kind", ("point",)),
    ("load.file", "kind", ("file",)),
    ("ask.at", "quantity", ("contact",)),
)

# What a scene is where it does not say otherwise, and what is asked of it by the command.
PLAIN: dict[str, Any] = {
    "command": "run",
    "quantity": "profile",
    "dimension": 2,
    "slab": False,
    "drawn": True,
    "load": "surface",
    "contacts": "bilateral",
    "geometry": "exact",
    "at": False,
    "layers": False,
    "several": False,
    "together": False,
    "tolerance": False,
    "reach": False,
}


def refusal(**features: Any) -> Refusal | None:
    """Give the first row that refuses what has these features, the others being plain.

    >>> refusal(command="ensemble", tolerance=True).key
    'ask.tolerance'
    >>> refusal(command="cost", dimension=3) is None
    True
    """
    quantity = features.get("quantity", PLAIN["quantity"])
    own = {"load": "point"} if quantity == "response" else {}
    found = PLAIN | own | {"at": quantity == "contact"} | features
    few = found["load"] in ("point", "file") and quantity not in {"profile", "positions"}
    finite = (found["at"] or few) and found["dimension"] == 2 and found["contacts"] == "bilateral"
    discs = ("contact_forces", "positions", "response") if found["dimension"] == 2 else ()
    found |= {
        "endless": found["slab"] and not finite,
        "beside": found["layers"] or found["together"],
        "drawing": quantity in ("profile", "histogram", *discs),
    }
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


def limits() -> str:
    """Write the rows of both tables as the guide to scenes has them."""
    rows = [["asked together", "refused"], ["---"] * 2]
    rows += [[row.words, f"`{row.key}` {row.why}"] for row in TABLE]
    rows += [
        [f"`{key}`, another `{other}`", f"`{key}` needs {other} = {either(values)}"]
        for key, other, values in ONLY_WITH
    ]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)
