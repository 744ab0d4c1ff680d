"""Weights on the beads below a loaded one, in three dimensions, and the sum of their squares.

A bead is named by its steps down from the loaded bead O along the three base vectors: O − u. A form
is a few single beads and a few line sums, which run down along one vector to the base. Which of
them meet, and where, is decided for all values of the indices in a region; where it is not, the
region is split, so that the cases cover all of it.
"""

from collections.abc import Callable, Iterator
from itertools import combinations

import sympy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Affine, Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.symbols import phi
from force_diffusion.symbolic.variances.cases import DEEPEST, Case
from force_diffusion.symbolic.variances.weights import UndeterminedError

Bead = tuple[Affine, Affine, Affine]
TOP: Bead = (affine.ZERO, affine.ZERO, affine.ZERO)
"""The loaded bead O."""


def up(bead: Bead, axis: int, steps: int = 1) -> Bead:
    """The bead so many steps up along a base vector."""
    moved = list(bead)
    moved[axis] = affine.shifted(bead[axis], -steps)
    return moved[0], moved[1], moved[2]


def down(axis: int, steps: Affine, bead: Bead = TOP) -> Bead:
    """The bead so many steps down."""
    moved = list(bead)
    moved[axis] = affine.add(bead[axis], steps)
    return moved[0], moved[1], moved[2]


class Weights:
    """A linear form in δr/r on the beads below O, which lies in layer ``top``."""

    def __init__(self, region: Region, top: Affine) -> None:
        self.region, self.top = region, top
        self._sites: dict[Bead, sympy.Expr] = {}
        self._lines: dict[tuple[Bead, int], sympy.Expr] = {}

    def add_tilt(self, bead: Bead, upward: int, along: int, factor: sympy.Expr) -> None:
        """A factor times n^b·δn^c of the contact that leads up along c from a bead; b is another.

        It is half of what the line sums down b from both ends differ by, less φ times both δr.
        """
        upper = up(bead, upward)
        self._add_line_sum(upper, along, factor / 2)
        self._add_line_sum(bead, along, -factor / 2)
        for end in (upper, bead):
            self._add_site(end, -phi * factor / 2)

    def beads(self) -> dict[tuple[int, ...], sympy.Expr]:
        """The weight of every bead, by its steps down, where the indices are whole numbers."""
        found: dict[tuple[int, ...], sympy.Expr] = {}
        each = list(self._sites.items())
        for (start, axis), w in self._lines.items():
            count = self._layer(start)[-1]
            each += [(up(start, axis, -steps), 2 * w) for steps in range(count + 1)]
        for bead, w in each:
            place = tuple(steps[-1] for steps in bead)
            found[place] = found.get(place, sympy.S.Zero) + w
        return found

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
        return total.reduced()

    def _add_site(self, bead: Bead, weight: sympy.Expr) -> None:
        self._sites[bead] = self._sites.get(bead, sympy.S.Zero) + weight

    def _add_line_sum(self, bead: Bead, along: int, weight: sympy.Expr) -> None:
        """2 Σ δr down a line to the base, less δr at both ends; nothing from the base itself."""
        layer = self._layer(bead)
        if not self._holds(affine.shifted(layer, -1)):
            return
        self._lines[bead, along] = self._lines.get((bead, along), sympy.S.Zero) + weight
        for end in (bead, down(along, layer, bead)):
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
        if self.region.nonnegative(value):
            return True
        if self.region.below(value, affine.ZERO):
            return False
        raise UndeterminedError(f"{affine.to_sympy(value)} ≥ 0")

    def _equal(self, one: Affine, other: Affine) -> bool:
        if one == other:
            return True
        if self.region.differ(one, other):
            return False
        raise UndeterminedError(f"{affine.to_sympy(one)} = {affine.to_sympy(other)}")

    def _same(self, one: Bead, other: Bead) -> bool:
        return all(self._equal(a, b) for a, b in zip(one, other, strict=True))

    def _on(self, line: tuple[Bead, int], bead: Bead) -> bool:
        start, axis = line
        if not all(self._equal(start[a], bead[a]) for a in range(3) if a != axis):
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


Build = Callable[[dict[sympy.Symbol, Affine], Region], Weights]


def cases(
    build: Build, lower: dict[sympy.Symbol, int], at: dict[sympy.Symbol, int] | None = None
) -> Iterator[Case]:
    """Σ weight² for all values of the indices from their lower bounds on, as many cases as needed.

    ``build`` makes the form for indices given as whole numbers or as themselves.
    """
    at = at or {}
    region = Region(lower)
    indices = {symbol: affine.constant(value) for symbol, value in at.items()}
    indices |= {symbol: affine.from_sympy(symbol) for symbol in lower}
    try:
        yield Case(at, lower, build(indices, region).squares())
        return
    except UndeterminedError:
        symbol = min(lower, key=lambda index: lower[index], default=None)
        if symbol is None or lower[symbol] >= DEEPEST:
            raise
    others = {index: least for index, least in lower.items() if index != symbol}
    yield from cases(build, others, {**at, symbol: lower[symbol]})
    yield from cases(build, {**lower, symbol: lower[symbol] + 1}, at)
