"""The base vectors along which contacts lead up: two branches, or three axes."""

from enum import StrEnum
from typing import NamedTuple

Site = tuple[int, int]


class Branch(StrEnum):
    """Along which base vector a contact leads up: two branches of discs, three axes of spheres.

    Those of discs are orientations, from the lower bead (i, j) up to (i + side, j + 1).

    >>> [(branch.value, branch.side, branch.number) for branch in directions(2)]
    [('+', 1, 0), ('-', -1, 1)]
    """

    PLUS = "+"
    MINUS = "-"
    FIRST = "1"
    SECOND = "2"
    THIRD = "3"

    @property
    def side(self) -> int:
        """The change of i; 0 in three dimensions, where nothing is called i."""
        return {"+": 1, "-": -1}.get(self, 0)

    @property
    def number(self) -> int:
        """0, 1, …, in the order in which they are named."""
        return ("+-" if self.side else "123").index(self)


def directions(dimension: int) -> tuple[Branch, ...]:
    """Give the directions along which contacts lead up.

    >>> [one.value for one in directions(2)], [one.value for one in directions(3)]
    (['+', '-'], ['1', '2', '3'])
    """
    return tuple(map(Branch, "+-" if dimension == 2 else "123"))


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
