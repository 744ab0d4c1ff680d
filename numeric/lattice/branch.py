"""Along which base vector contacts lead up: two branches, or three axes; what there is of each."""

from enum import StrEnum
from typing import NamedTuple

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


class Contact(NamedTuple):
    """The contact f^±_ij, named by its lower bead (i, j) and its branch, as in the paper."""

    i: int
    j: int
    branch: Branch

    @property
    def upper(self) -> Site:
        """The bead that the contact supports."""
        return self.i + self.branch.side, self.j + 1
