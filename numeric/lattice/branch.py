"""Along which base vector contacts lead up: two branches, or three axes; what there is of each."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Generic, NamedTuple, TypeVar

T = TypeVar("T")
Site = tuple[int, int]


class Direction(StrEnum):
    """Along which base vector a contact leads up."""

    @property
    def side(self) -> int:
        """The change of i; 0 in three dimensions, where nothing is called i."""
        return 0

    @property
    def number(self) -> int:
        """0, 1, …, in the order in which they are named."""
        return list(type(self)).index(self)


class Branch(Direction):
    """Orientation of a contact: from its lower bead (i, j) up to (i + side, j + 1).

    >>> [(branch.value, branch.side) for branch in Branch]
    [('+', 1), ('-', -1)]
    """

    PLUS = "+"
    MINUS = "-"

    @property
    def side(self) -> int:
        """+1 for the contacts that lead up and to the right, −1 for the others."""
        return 1 if self is Branch.PLUS else -1

    @property
    def other(self) -> "Branch":
        """The other branch."""
        return Branch.MINUS if self is Branch.PLUS else Branch.PLUS


class Axis(Direction):
    """One of the three base vectors in three dimensions.

    >>> [(axis.value, axis.number) for axis in Axis], Branch.MINUS.number
    ([('1', 0), ('2', 1), ('3', 2)], 1)
    """

    FIRST = "1"
    SECOND = "2"
    THIRD = "3"


def directions(dimension: int) -> tuple[Direction, ...]:
    """Give the directions along which contacts lead up.

    >>> [one.value for one in directions(2)], [one.value for one in directions(3)]
    (['+', '-'], ['1', '2', '3'])
    """
    return tuple(Branch if dimension == 2 else Axis)


def direction(name: str) -> Direction:
    """Give a branch or an axis by its name.

    >>> direction("-"), direction("2")
    (<Branch.MINUS: '-'>, <Axis.SECOND: '2'>)
    """
    return Axis(name) if name.isdigit() else Branch(name)


ORDER = ("branch", "q", "p", "i", "j")
"""By what rows are sorted, the last first."""


def bead_names(dimension: int) -> tuple[str, ...]:
    """Give what the numbers that name a bead are called, its layer last."""
    return ("i", "j") if dimension == 2 else ("p", "q", "j")


def axis_names(dimension: int) -> str:
    """Give what Cartesian coordinates are called, the vertical one last."""
    return "xyz"[:dimension]


class AxisContact(NamedTuple):
    """A contact in three dimensions: its lower bead (p, q, j), and its axis."""

    bead: tuple[int, ...]
    axis: Axis

    @property
    def j(self) -> int:
        """The layer of the lower bead."""
        return self.bead[-1]

    def named(self) -> dict[str, int | str]:
        """Give its numbers and its axis by their names."""
        return {**dict(zip(bead_names(len(self.bead)), self.bead, strict=True)), "axis": self.axis}


class Contact(NamedTuple):
    """The contact f^±_ij, named by its lower bead (i, j) and its branch, as in the paper."""

    i: int
    j: int
    branch: Branch

    @property
    def upper(self) -> Site:
        """The bead that the contact supports."""
        return self.i + self.branch.side, self.j + 1

    def named(self) -> dict[str, int | str]:
        """Give its numbers and its branch by their names."""
        return {"i": self.i, "j": self.j, "branch": self.branch}


@dataclass(frozen=True)
class PerBranch(Generic[T]):
    """Something for either branch of contacts.

    >>> [(str(branch), value) for branch, value in PerBranch(1, 2)], PerBranch(1, 2)[Branch.MINUS]
    ([('+', 1), ('-', 2)], 2)
    """

    plus: T
    minus: T

    def __getitem__(self, branch: Direction) -> T:
        return self.plus if branch == Branch.PLUS else self.minus

    def __iter__(self) -> Iterator[tuple[Direction, T]]:
        yield Branch.PLUS, self.plus
        yield Branch.MINUS, self.minus


class PerAxis(PerBranch[T]):
    """Something for each axis, of which ``plus`` and ``minus`` are the first two.

    >>> PerAxis(5, 6, 7)[Axis.THIRD], [value for _, value in PerAxis(5, 6, 7)]
    (7, [5, 6, 7])
    """

    _values: tuple[T, ...]

    def __init__(self, *values: T) -> None:
        """``values``: one an axis."""
        first, second, _ = values
        super().__init__(first, second)
        object.__setattr__(self, "_values", values)

    def __getitem__(self, axis: Direction) -> T:
        return self._values[int(axis.value) - 1]

    def __iter__(self) -> Iterator[tuple[Direction, T]]:
        yield from zip(Axis, self._values, strict=True)


def per_direction(values: Sequence[T]) -> PerBranch[T]:
    """Give what there is of each branch or axis.

    >>> per_direction([1, 2]), per_direction([5, 6, 7])[Axis.THIRD]
    (PerBranch(plus=1, minus=2), 7)
    """
    return PerBranch(*values) if len(values) == 2 else PerAxis(*values)
