"""Weights of radii in the forces below one loaded bead in three dimensions, the radii being r = 1.

A bead is named by its steps down from the loaded bead O along the three base vectors: O − u. The
ordered load goes straight down three legs, as a force of 1 in each of their contacts. To first
order what enters a bead leaves it along the same vector, and b^a·Σ_c (F^c δn^c − F^c δn^c below) is
added, F being ordered forces. So a force is the sum of what turns into it on legs, up its own path.
A form is a few single beads and a few line sums, which run down along one vector to the base. Which
of them meet, and where, is decided on a domain. Factors are written with b^a·b^a and b^a·b^c times
(1−φ)(1+2φ).
"""

from collections.abc import Iterator
from itertools import combinations

import sympy

from ..algebra import affine
from ..algebra.affine import Affine
from ..algebra.exact import FIELD, RationalFunction
from ..algebra.weights import UndeterminedError
from ..symbols import phi
from .where import Where

Bead = tuple[Affine, Affine, Affine]
AXES = (0, 1, 2)
OWN, CROSS = 1 + phi, -phi
"""b^a·b^a and b^a·b^c of the reciprocal vectors, times ``BELOW``."""
BELOW = (1 - phi) * (1 + 2 * phi)


class Weights:
    """A linear form in δr on the beads below O, which lies in layer ``top``."""

    def __init__(self, where: Where, top: Affine) -> None:
        self.where, self.top = where, top
        self._sites: dict[Bead, sympy.Expr] = {}
        self._lines: dict[tuple[Bead, int], sympy.Expr] = {}

    def add_force(self, axis: int, bead: Bead, factor: sympy.Expr = sympy.S.One) -> int:
        """Add the force up along an axis from a bead; return what it is in the ordered packing."""
        others = [one for one in AXES if one != axis and not self._equal(bead[one], affine.ZERO)]
        if len(others) > 1 or self._equal(bead[axis], affine.ZERO):
            return 0  # its path meets no leg: nothing enters the cone from outside
        if others:
            self._turn(_down(bead, axis, affine.times(bead[axis], -1)), others[0], axis, factor)
            return 0
        # on a leg all turns telescope but the first, at O, and the last
        self._tilt(bead, axis, axis, -factor)
        for other in AXES:
            if other != axis:
                self._tilt(_down(_TOP, other), other, axis, -factor)
        return 1

    def add_push(self, axis: int, bead: Bead, factor: sympy.Expr = sympy.S.One) -> int:
        """The same of its vertical component, over that of an ordered leg."""
        ordered = self.add_force(axis, bead, factor)
        if ordered:
            for along in AXES:
                if along != axis:
                    self._add_tilt(bead, axis, along, (1 - phi) * factor)
        return ordered

    def squares(self) -> RationalFunction:
        """Σ weight²."""
        special = self._special()
        total, doubled = FIELD.zero, {line: 2 * w for line, w in self._lines.items()}
        passed = dict.fromkeys(self._lines, 0)
        for bead in special:
            weight = sum((w for at, w in self._sites.items() if self._same(at, bead)), sympy.S.Zero)
            for line, each in doubled.items():
                if self._on(line, bead):
                    weight += each
                    passed[line] += 1
            total = total + FIELD.from_sympy(weight) ** 2
        for (start, axis), each in doubled.items():
            left = affine.shifted(self._layer(start), 1 - passed[start, axis])
            total = total + FIELD.from_sympy(each) ** 2 * affine.to_field(left)
        return (total / FIELD.from_sympy(BELOW) ** 2).reduced()

    def _turn(self, bead: Bead, leg: int, into: int, factor: sympy.Expr) -> None:
        """b^a·(δn^c − δn^c below) at a bead of a leg c; below O and above the base."""
        self._tilt(bead, leg, into, factor)
        self._tilt(_down(bead, leg), leg, into, -factor)

    def _tilt(self, bead: Bead, upward: int, into: int, factor: sympy.Expr) -> None:
        """A factor times b^a·δn^c of the contact that leads up along c from a bead."""
        for along in AXES:
            if along != upward:
                self._add_tilt(bead, upward, along, factor * (OWN if along == into else CROSS))

    def _add_tilt(self, bead: Bead, upward: int, along: int, factor: sympy.Expr) -> None:
        """A factor times n^b·δn^c of the contact that leads up along c from a bead; b is another.

        It is half of what the line sums down b from both ends differ by, less φ times both δr.
        """
        upper = _down(bead, upward, affine.constant(-1))
        self._add_line_sum(upper, along, factor / 2)
        self._add_line_sum(bead, along, -factor / 2)
        for end in (upper, bead):
            self._add_site(end, -phi * factor / 2)

    def _add_site(self, bead: Bead, weight: sympy.Expr) -> None:
        self._sites[bead] = self._sites.get(bead, sympy.S.Zero) + weight

    def _add_line_sum(self, bead: Bead, along: int, weight: sympy.Expr) -> None:
        """2 Σ δr down a line to the base, less δr at both ends; nothing from the base itself."""
        layer = self._layer(bead)
        if not self._holds(affine.shifted(layer, -1)):
            return
        self._lines[bead, along] = self._lines.get((bead, along), sympy.S.Zero) + weight
        for end in (bead, _down(bead, along, layer)):
            self._add_site(end, -weight)

    def _layer(self, bead: Bead) -> Affine:
        layer = self.top
        for steps in bead:
            layer = affine.add(layer, steps, -1)
        return layer

    def _holds(self, value: Affine) -> bool:
        """Whether value ≥ 0 everywhere; or nowhere.

        Raises:
            UndeterminedError: here and there.
        """
        if self.where.nonnegative(value):
            return True
        if self.where.below(value, affine.ZERO):
            return False
        raise UndeterminedError(f"whether {affine.to_sympy(value)} ≥ 0", value)

    def _equal(self, one: Affine, other: Affine) -> bool:
        apart = affine.add(one, other, -1)
        if apart == affine.ZERO:
            return True
        if self.where.differ(one, other):
            return False
        above = self._holds(apart)
        number = affine.shifted(apart, -1 if above else 1)
        raise UndeterminedError(f"whether {affine.to_sympy(apart)} = 0", number)

    def _same(self, one: Bead, other: Bead) -> bool:
        return all(self._equal(a, b) for a, b in zip(one, other, strict=True))

    def _on(self, line: tuple[Bead, int], bead: Bead) -> bool:
        start, axis = line
        if not all(self._equal(start[a], bead[a]) for a in AXES if a != axis):
            return False
        below = self._holds(affine.add(bead[axis], start[axis], -1))
        return below and self._holds(self._layer(bead))

    def _special(self) -> list[Bead]:
        """Beads with a weight of their own, and where lines meet, each once."""
        found: list[Bead] = []
        for bead in (*self._sites, *self._crossings()):
            if not any(self._same(bead, other) for other in found):
                found.append(bead)
        return found

    def _crossings(self) -> Iterator[Bead]:
        for one, other in combinations(self._lines, 2):
            (start, axis), (begin, along) = one, other
            if axis == along:
                if self._on(one, begin) or self._on(other, start):
                    raise UndeterminedError("two lines overlap")
                continue
            third = 3 - axis - along
            if self._equal(start[third], begin[third]):
                place = list(start)
                place[axis] = begin[axis]
                bead = (place[0], place[1], place[2])
                if self._on(one, bead) and self._on(other, bead):
                    yield bead


_TOP: Bead = (affine.ZERO, affine.ZERO, affine.ZERO)


def _down(bead: Bead, axis: int, steps: Affine | None = None) -> Bead:
    """The bead so many steps down along a base vector, or one."""
    moved = list(bead)
    moved[axis] = affine.add(bead[axis], affine.constant(1) if steps is None else steps)
    return moved[0], moved[1], moved[2]
