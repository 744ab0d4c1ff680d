"""The two branches of contacts, and what there is of each."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Generic, NamedTuple, TypeVar

T = TypeVar("T")
Site = tuple[int, int]


class Branch(StrEnum):
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


class Contact(NamedTuple):
    """The contact f^±_ij, named by its lower bead (i, j) and its branch, as in the paper."""

    i: int
    j: int
    branch: Branch

    @property
    def upper(self) -> Site:
        """The bead that the contact supports."""
        return self.i + self.branch.side, self.j + 1


@dataclass(frozen=True)
class PerBranch(Generic[T]):
    """Something for either branch of contacts.

    >>> [(str(branch), value) for branch, value in PerBranch(1, 2)], PerBranch(1, 2)[Branch.MINUS]
    ([('+', 1), ('-', 2)], 2)
    """

    plus: T
    minus: T

    def __getitem__(self, branch: Branch) -> T:
        return self.plus if branch == Branch.PLUS else self.minus

    def __iter__(self) -> Iterator[tuple[Branch, T]]:
        yield Branch.PLUS, self.plus
        yield Branch.MINUS, self.minus
