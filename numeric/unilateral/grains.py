"""Discs on a fixed base, in float64: gaps, directions, neighbours, energy of the load."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu
from scipy.spatial import cKDTree

from ..arithmetic.systems import Array
from .network import UnfinishedError

# Pairs are two columns of bead numbers, the first of which is free.
Pairs = Array


@dataclass
class Grains:
    """Discs in a strip with a period in x; lengths in units of r, forces in those of the load.

    ``x``: centres, shape (N, 2), the only thing that changes. ``radii``: (N,). ``period`` is the
    length of the strip. ``load``: the forces on the beads from outside, (N, 2). The first ``fixed``
    beads are the base, which never moves.
    """

    x: Array
    radii: Array
    period: float
    load: Array
    fixed: int

    @property
    def unknowns(self) -> int:
        """How many coordinates may change."""
        return 2 * (len(self.radii) - self.fixed)

    @property
    def weights(self) -> Array:
        """The loads on the free beads, as a vector of the coordinates that may change."""
        return np.asarray(self.load[self.fixed :].ravel())

    def coordinates(self, beads: Array) -> Array:
        """Give the places of beads' coordinates among those that may change; others are below 0."""
        return np.asarray((2 * (beads - self.fixed)[:, None] + [0, 1]).ravel())

    def backbone(self, contacts: Pairs) -> Array:
        """Give the free beads that contacts touch."""
        return np.intersect1d(np.arange(self.fixed, len(self.radii)), contacts)

    def rattlers(self, contacts: Pairs) -> Array:
        """Give the free beads that contacts don't touch."""
        return np.setdiff1d(np.arange(self.fixed, len(self.radii)), contacts)

    def move(self, moves: Array) -> None:
        """Move all coordinates that may change."""
        self.x[self.fixed :] += moves.reshape(-1, 2)

    def energy(self) -> float:
        """Potential energy of the load, which falls while beads move."""
        return -float((self.load * self.x).sum())

    def differences(self, pairs: Pairs) -> Array:
        """Give the vectors from the second to the first bead of each pair, nearest images."""
        d = self.x[pairs[:, 0]] - self.x[pairs[:, 1]]
        d[:, 0] -= self.period * np.round(d[:, 0] / self.period)
        return np.asarray(d)

    def gaps(self, pairs: Pairs) -> Array:
        """Give the distances of the surfaces; negative where beads overlap."""
        d = self.differences(pairs)
        return np.asarray(np.hypot(d[:, 0], d[:, 1]) - self.radii[pairs].sum(axis=1))

    def directions(self, pairs: Pairs) -> Array:
        """Give the unit vectors from the second to the first bead."""
        d = self.differences(pairs)
        return np.asarray(d / np.hypot(d[:, 0], d[:, 1])[:, None])

    def jacobian(self, pairs: Pairs) -> Any:
        """Give the derivatives of the gaps, a sparse matrix of shape (pairs, unknowns)."""
        n = self.directions(pairs)
        rows = np.repeat(np.arange(len(pairs)), 4)
        columns = self.coordinates(pairs.ravel())
        values = np.concatenate([n, -n], axis=1).ravel()
        free = columns >= 0
        entries = values[free], (rows[free], columns[free])
        return sparse.csr_array(entries, shape=(len(pairs), self.unknowns))

    def factors(self, pairs: Pairs, place: Array) -> Any:
        """Factorise the derivatives of as many gaps as there are coordinates at ``place``.

        Raises ``UnfinishedError`` where they are not independent.
        """
        try:
            return splu(self.jacobian(pairs)[:, place].tocsc())
        except RuntimeError:
            raise UnfinishedError(
                "degenerate: the contacts are not independent, their Jacobian is singular"
            ) from None

    def hole_and_smallest(self) -> str:
        """Compare the widest hole of the base with the smallest bead, in words."""
        base, spacing = self.radii[: self.fixed], self.period / self.fixed
        hole = float((spacing - base - np.roll(base, -1)).max()) / 2
        smallest = float(self.radii[self.fixed :].min())
        return (
            f"the widest hole of the base lets radii up to {hole:.3g} r through, and the smallest "
            f"bead has {smallest:.3g} r"
        )

    def near(self, reach: float, *, base: bool = False) -> Pairs:
        """List all pairs with gaps up to ``reach``, and some wider ones.

        Those of two beads of the ``base`` only if asked for.
        """
        low = self.x[:, 1].min()
        tall = float(self.x[:, 1].max() - low) + reach + 4 * float(self.radii.max())
        places = np.stack([self.x[:, 0] % self.period, self.x[:, 1] - low], axis=1)
        places[places[:, 0] >= self.period, 0] = 0.0  # what rounds up to a whole period
        tree = cKDTree(places, boxsize=[self.period, 2 * tall])
        pairs = tree.query_pairs(2 * float(self.radii.max()) + reach, output_type="ndarray")
        pairs = np.sort(pairs.reshape(-1, 2), axis=1)[:, ::-1]
        if not base:
            pairs = pairs[pairs[:, 0] >= self.fixed]
        return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])

    def named(self, pairs: Pairs) -> Array:
        """Give one whole number a pair."""
        return np.asarray(pairs[:, 0].astype(np.int64) * len(self.radii) + pairs[:, 1])
