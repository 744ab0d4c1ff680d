"""A packing of any dimension from first principles alone, in mpmath: no formula of the package.

Beads are vectors; each is placed by Newton's method at its distances from its supports, and the
forces below it follow from the balance of all that acts on it.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from itertools import product
from typing import Any

import mpmath

Bead = tuple[int, ...]


def stepped(bead: Bead, axis: int, count: int) -> Bead:
    """The bead so many steps on along a base vector."""
    return (*bead[:axis], bead[axis] + count, *bead[axis + 1 :])


def _determinant(vectors: list[Any]) -> Any:
    matrix = mpmath.matrix(len(vectors))
    for a, vector in enumerate(vectors):
        matrix[a, :] = vector.T
    return mpmath.det(matrix)


class PlainPacking:
    """Spheres of any dimension, r = 1, periodic in the first d − 1 numbers of a bead."""

    def __init__(
        self, dimension: int, height: int, width: int, phi: Fraction, rho: Mapping[Bead, Fraction]
    ) -> None:
        """``rho``: δr of beads by their first d − 1 numbers modulo W, and their layer."""
        self.d, self.height, self.width, self.rho = dimension, height, width, rho
        gram = mpmath.matrix(dimension)
        for a, c in product(range(dimension), repeat=2):
            gram[a, c] = 1 if a == c else mpmath.mpf(phi.numerator) / phi.denominator
        rows = mpmath.cholesky(gram)
        self.n = [rows[a, :].T for a in range(dimension)]
        self._at: dict[Bead, Any] = {}
        self._below: dict[Bead, list[Any]] = {}

    def home(self, bead: Bead) -> tuple[Bead, Bead]:
        """Name a bead as ``rho`` does, and give the first numbers of the period it lies in."""
        columns = tuple(x % self.width for x in bead[:-1])
        return (*columns, sum(bead)), tuple(x - q for x, q in zip(bead, columns, strict=False))

    def radius(self, bead: Bead) -> Any:
        """Of a bead of the infinite lattice."""
        value = self.rho[self.home(bead)[0]]
        return 1 + mpmath.mpf(value.numerator) / value.denominator

    def at(self, bead: Bead) -> Any:
        """Where a bead lies; that of another period is shifted as in the ordered packing."""
        (*columns, layer), shift = self.home(bead)
        own = (*columns, layer - sum(columns))
        moved = mpmath.matrix(self.d, 1)
        for a, steps in enumerate(shift):
            moved += 2 * steps * (self.n[a] - self.n[-1])
        if own not in self._at:
            here = 2 * sum((self.n[a] * own[a] for a in range(self.d)), mpmath.matrix(self.d, 1))
            self._at[own] = self._rest(own, here) if layer else here
        return self._at[own] + moved

    def _rest(self, bead: Bead, here: Any) -> Any:
        """Of the two places at these distances, the one on the same side as in the ordered packing.

        In a flat packing Newton's method may find the other one, unless it starts higher.
        """
        supports = [stepped(bead, a, -1) for a in range(self.d)]
        side = mpmath.sign(_determinant(self.n))
        for lift in (0, 1, 3):
            found = self._touching(bead, supports, here + lift * sum(self.n, 0 * here))
            if mpmath.sign(_determinant([found - self.at(one) for one in supports])) == side:
                return found
        raise ArithmeticError("the bead comes to rest below its supports")

    def _touching(self, bead: Bead, supports: list[Bead], here: Any) -> Any:
        for _ in range(60):
            jacobian, wrong = mpmath.matrix(self.d), mpmath.matrix(self.d, 1)
            for a, support in enumerate(supports):
                apart = here - self.at(support)
                jacobian[a, :] = 2 * apart.T
                wrong[a] = (apart.T * apart)[0] - (self.radius(bead) + self.radius(support)) ** 2
            here = here - mpmath.lu_solve(jacobian, wrong)
            if mpmath.norm(wrong) < mpmath.mpf(10) ** (8 - mpmath.mp.dps):
                return here
        raise ArithmeticError("the bead does not come to rest")

    def unit(self, bead: Bead, axis: int) -> Any:
        """Direction of the contact below a bead."""
        apart = self.at(bead) - self.at(stepped(bead, axis, -1))
        return apart / mpmath.norm(apart)

    def below(self, bead: Bead, load: Callable[[Bead], list[Any]]) -> list[Any]:
        """Forces of the contacts below a bead; ``load`` gives L^a of F = −Σ L^a n^a on one.

        It is asked for beads by the names that ``rho`` has for them.
        """
        named = self.home(bead)[0]
        *columns, layer = named
        own = (*columns, layer - sum(columns))
        if own not in self._below:
            borne = mpmath.matrix(self.d, 1)
            for a, share in enumerate(load(named)):
                borne += share * self.n[a]
            for a in range(self.d if layer < self.height else 0):
                upper = stepped(own, a, 1)
                borne += self.below(upper, load)[a] * self.unit(upper, a)
            units = mpmath.matrix(self.d)
            for a in range(self.d):
                units[:, a] = self.unit(own, a)
            self._below[own] = list(mpmath.lu_solve(units, borne))
        return self._below[own]
