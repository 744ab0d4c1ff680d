"""How beads and contacts are named: (i, j) and a branch, or (p, q, …, j) and an axis.

Columns of names have one entry a bead, or a contact, row by row.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from .branch import Direction, Site, bead_names, direction, directions
from .layers import Array, Layer, bead_of, site_of

_NONE = np.empty(0, dtype=np.int64)


class Block(NamedTuple):
    """Contacts of one branch below a row of upper beads."""

    branch: Direction
    row: Layer


class Naming(NamedTuple):
    """Names of a packing of layers of W (None: the slab), or in d dimensions W^(d−1), beads."""

    dimension: int
    side: int | None

    @property
    def branches(self) -> tuple[Direction, ...]:
        """Along which contacts lead up."""
        return directions(self.dimension)

    @property
    def row(self) -> int | None:
        """How many beads a layer has."""
        return None if self.side is None else self.side ** (self.dimension - 1)

    def home(self, i: Any) -> Any:
        """Give a column i, or an array of them, within 0 … 2W − 1 of a periodic packing."""
        return i if self.side is None else i % (2 * self.side)

    def site(self, at: Sequence[Any]) -> Site:
        """Give the site in its row of a bead that is named as a scene does."""
        if self.dimension == 2:
            return int(at[0]), int(at[1])
        assert self.side is not None
        return site_of([int(one) for one in at], self.side)

    def bead(self, site: Site) -> tuple[int, ...]:
        """Name a bead as a scene does."""
        if self.dimension == 2:
            return site
        assert self.side is not None
        return bead_of(site, self.side, self.dimension)

    def contact(self, at: Sequence[Any]) -> Block:
        """Give the contact that a scene names by its lower bead and its branch."""
        *below, name = at
        branch = direction(name)
        if self.dimension == 2:
            i, j = self.site(below)
            return Block(branch, Layer(j + 1, i + branch.side, 1))
        *columns, j = map(int, below)
        above = [one + (a == branch.number) for a, one in enumerate(columns)]
        i, j = self.site([*above, j + 1])
        return Block(branch, Layer(j, i, 1))

    def beads(self, rows: Sequence[Layer]) -> dict[str, Array]:
        """Give the columns i and j, or p, q, … and j, of beads."""
        j = np.repeat([row.j for row in rows] or _NONE, [row.count for row in rows] or _NONE)
        i = np.concatenate([_NONE, *(row.first + 2 * np.arange(row.count) for row in rows)])
        if self.dimension == 2:
            return {"i": self.home(i), "j": j}
        assert self.side is not None
        return self._named(bead_of((i, j), self.side, self.dimension))

    def contacts(self, blocks: Sequence[Block]) -> dict[str, Array]:
        """Give the columns of the lower beads, and branch, of contacts."""
        names = np.array([branch.value for branch, _ in blocks], dtype="U1")
        branch = np.repeat(names, [row.count for _, row in blocks] or _NONE)
        if self.dimension == 2:
            lower = [Layer(row.j - 1, row.first - b.side, row.count) for b, row in blocks]
            return {**self.beads(lower), "branch": branch}
        assert self.side is not None
        *columns, j = self.beads([row for _, row in blocks]).values()
        along = zip(columns, self.branches, strict=False)
        below = [(one - (branch == axis.value)) % self.side for one, axis in along]
        return {**self._named([*below, j - 1]), "branch": branch}

    def _named(self, numbers: Sequence[Any]) -> dict[str, Array]:
        return dict(zip(bead_names(self.dimension), numbers, strict=True))
