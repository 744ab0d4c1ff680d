"""What one part of a sweep adds to an answer: the whole of it, or a segment, and how it is kept."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, astuple, dataclass
from functools import reduce
from operator import or_
from typing import Any

import numpy as np

from ..arithmetic.carried import NONE, Sizes
from ..arithmetic.systems import Array
from ..lattice.branch import Axis, AxisContact, Branch, Contact, direction
from ..mechanics.kept import Kept
from ..mechanics.physicality import Physicality
from .base import Columns, Table


@dataclass
class Part:
    """A table of rows, one below those of the parts of lower layers, and what is known of them.

    ``physical``: None where it was not looked at. ``exact`` is the table with the errors that the
    sweep carried, in a longer arithmetic, or ``left`` says how far numbers are from it; ``sizes``
    are those of the errors. ``stopped``: the contact at which a sweep stopped.
    """

    table: Table
    physical: Physicality | None
    exact: Table | None = None
    left: float | None = None
    sizes: Sizes = NONE
    stopped: Contact | AxisContact | None = None

    def measured(self) -> "Part":
        """Give it without the longer numbers, with how far they are from its own."""
        if self.exact is None:
            return self
        apart = (
            _above(np.abs(self.exact.numbers[name] - self.table.numbers[name]).max(initial=0))
            for name in self.table.small
        )
        return Part(self.table, self.physical, None, max(apart), self.sizes)

    def extremes(self) -> "Part":
        """Give it with the smallest and the largest change alone."""
        change = self.table.numbers["change"]
        if len(change):
            change = np.array([change.min(), change.max()])
        table = Table({}, {"change": change}, ("change",))
        return Part(table, self.physical, None, self.left, self.sizes)

    def keep(self, kept: Kept, number: int) -> None:
        """Keep it; what was measured first, so that it is whole once its words are there."""
        table, physical = self.table, self.physical
        assert physical is not None
        parts: dict[str, Mapping[str, Array]] = {
            "index": table.index,
            "numbers": table.numbers,
            "errors": table.errors,
        }
        for kind, columns in parts.items():
            for name, column in columns.items():
                kept.put(f"{kind}{number} {name}", column)
        said = asdict(physical)
        del said["looks_at"]  # the one realisation
        errors = [self.left, *astuple(self.sizes)]
        words = [said, [list(columns) for columns in parts.values()], table.small, errors]
        kept.put(f"words{number}", np.frombuffer(json.dumps(words).encode(), np.uint8))

    @classmethod
    def of(cls, kept: Kept, number: int) -> "Part | None":
        """Read what was kept, if it was."""
        words = kept.get(f"words{number}")
        if words is None:
            return None
        said, parts, small, errors = json.loads(words.tobytes())
        found = Physicality(**said, looks_at=range(1))
        if found.between is not None:
            lower, upper = found.between
            found.between = tuple(lower), tuple(upper)
        if found.first_tensile is not None:
            *lower, name = said["first_tensile"]
            along = direction(name)
            if isinstance(along, Axis):
                found.first_tensile = AxisContact(tuple(lower[0]), along)
            else:
                found.first_tensile = Contact(lower[0], lower[1], Branch(along))

        def columns(kind: str, of: list[str]) -> dict[str, Array]:
            columns = {name: kept.get(f"{kind}{number} {name}") for name in of}
            return {name: column for name, column in columns.items() if column is not None}

        index, numbers, scatter = map(columns, ("index", "numbers", "errors"), parts)
        table = Table(index, numbers, tuple(small), scatter)
        return cls(table, found, None, errors[0], Sizes(*errors[1:]))


def joined(parts: Sequence[Part]) -> Part:
    """Put parts together, that of the lowest layers first; their columns are used up."""
    first = parts[0]
    tables = [part.table for part in parts if part.table.rows] or [first.table]

    def column_by_column(columns: Sequence[Columns]) -> dict[str, Array]:
        return {n: np.concatenate([one.pop(n) for one in columns]) for n in list(columns[0])}

    index = column_by_column([table.index for table in tables])
    numbers = column_by_column([table.numbers for table in tables])
    errors = column_by_column([table.errors for table in tables])
    for part in parts[1:]:
        if first.physical is not None and part.physical is not None:
            first.physical.above(part.physical)
    return Part(
        Table(index, numbers, first.table.small, errors, in_order=True),
        first.physical,
        None,
        max(part.left or 0.0 for part in parts),
        reduce(or_, [part.sizes for part in parts]),
    )


def _above(value: Any) -> float:
    """Round a number up that may be longer."""
    return math.nextafter(float(value), math.inf) if value else 0.0
