"""Σ weight² of a contact's force in any dimension, in closed form, the radii being r = 1.

Every bead rests on d others, along d base vectors of equal mutual dot product φ; loads along their
sum, or leaning. The contact leads up along vector 1 from bead x_0 of layer J; x_n are the beads of
its path, up to n = K = M − J on the surface. To first order (balance of each bead of the path,
along b^1) its force over its ordered value is 1 + α,

    α = (1/l_1) Σ_{n=1}^{K} b^1·Σ_c t_c [u_n δn^c(x_n) − l_n δn^c(x_n − e_c)],

l_n being the load that the path's contact below x_n carries, u_n = l_{n+1} the one above, and t_c
what contacts along c carry for each unit of those along 1: 1 for loads along the sum. Which way a
load leans enters by the two sums τ_1 and τ_2 of the t_c and of their squares, c ≠ 1. By
the contact constraint, δn^c of the contact from y to y + e_c has

    n^b·δn^c = ½[L_b(y + e_c) − L_b(y) − φ (δr(y + e_c) + δr(y))],  b ≠ c,  and n^c·δn^c = 0,

with the line sum L_b(y) = 2 Σ δr down b from y to the base, less δr at both ends. So a radius has
a weight if its bead is x_a + v, with v of one of a few kinds; beads of a kind differ in *which* of
the other d − 1 vectors they hold, which says how many they are. Factors are written with b^1·b^1
and b^1·b^c times (1−φ)(1+(d−1)φ), sums over a slice of one a are polynomials in a.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import sympy

from .. import symbols as sy
from ..algebra import affine
from ..algebra.exact import FIELD, RationalFunction, sum_polynomial
from ..algebra.weights import UndeterminedError
from .where import Where

OWN = 1 + (sy.d - 2) * sy.phi
"""b^a·b^a of the reciprocal vectors, times ``BELOW``."""
CROSS = -sy.phi
"""b^a·b^c, times ``BELOW``."""
BELOW = (1 - sy.phi) * (1 + (sy.d - 1) * sy.phi)

_field = FIELD.from_sympy
_OWN, _CROSS, _PHI, _BELOW = map(_field, (OWN, CROSS, sy.phi, BELOW))
_OTHERS, _THIRD = _field(sy.d - 1), _field(sy.d - 2)
_HALF, _TWO = _field(sympy.S.Half), FIELD.constant(2)
_RADIUS = -_PHI * (_OWN + _THIRD * _CROSS)
_SIDES = (0, 1, -1)


@lru_cache(maxsize=64)
def squares(
    layer: sympy.Expr, height: sympy.Expr, bulk: bool, where: Where, leaning: bool = False
) -> RationalFunction:
    """Σ weight² of α for r = 1, for a contact from a bead of a layer, in τ_1 and τ_2 if loads lean.

    Raises:
        UndeterminedError: the domain doesn't say which beads are one, or where the base is.
    """
    ratios = (_field(sy.tau_1), _field(sy.tau_2)) if leaning else (_OTHERS, _OTHERS)
    path = _Path(layer, sympy.expand(height - layer), bulk, where, ratios)
    total = FIELD.zero
    for one in path.slices():
        total = total + one
    first = _field(path.below(sympy.S.One))
    return (total / (first * _BELOW) ** 2).reduced()


@dataclass(frozen=True)
class _Path:
    """The path of a contact from a layer, ``steps`` steps long."""

    layer: sympy.Expr
    steps: sympy.Expr
    bulk: bool
    where: Where
    ratios: tuple[RationalFunction, RationalFunction]

    def below(self, place: sympy.Expr) -> sympy.Expr:
        """l_n, a polynomial in n."""
        return self.steps - place + 1 if self.bulk else sympy.S.One

    def halves(self, place: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
        """u_n/2 and l_n/2; nothing is carried above the surface."""
        above = sympy.S.Zero if place == self.steps else self.below(place + 1)
        return above / 2, self.below(place) / 2

    def slices(self) -> Iterator[RationalFunction]:
        """Squares of all beads x_a + v with one a: those a that stand alone, and sums between."""
        ends = [*(side - self.layer for side in (-1, 0, 1)), sympy.S.Zero, sympy.S.One, self.steps]
        if self.layer == 0 and self.steps != 1:  # a line from x_2 − e_c ends one step below
            ends.append(sympy.Integer(2))
        alone = self._in_order(map(sympy.expand, ends))
        for place in alone:
            yield self._slice(place, self.where)
        for low, high in pairwise(alone):
            if sympy.expand(high - low) != 1:
                inside = self.where.within(sy.m, low + 1, high - 1)
                first, last = _field(low + 1), _field(high - 1)
                yield sum_polynomial(self._slice(sy.m, inside), sy.m, first, last)

    def _in_order(self, places: Iterator[sympy.Expr]) -> list[sympy.Expr]:
        found: list[sympy.Expr] = []
        for place in dict.fromkeys(places):
            after = [one for one in found if _reaches(one, place, self.where)]
            if not all(_reaches(one, place + 1, self.where) for one in after):
                raise UndeterminedError(f"{place} may stand for another slice, too")
            found.insert(len(found) - len(after), place)
        return found

    def _slice(self, a: sympy.Expr, where: Where) -> RationalFunction:
        """Σ weight² of the beads x_a + v of one a.

        v is 0, e_c or −e_c; −e_b − e_c, where two lines cross; or further down a line along b,
        −s e_b, s > 1, e_c − s e_b, s > 0, or −e_c − s e_b, s > 1; b ≠ c, both of 2, …, d.
        """
        at_path = _reaches(a, sympy.S.One, where)  # where lines start
        layer = sympy.expand(self.layer + a)
        first, second = self.ratios
        here, up, down = (self._along(a, at_path, layer, side, where) for side in _SIDES)
        lines = [FIELD.zero] * 3  # factors of line sums along b from each, for each t_c, c ≠ b
        own = tilt = FIELD.zero  # and of x_a and of lines from it, whatever t_c
        if at_path:
            upper, lower = map(_field, self.halves(a))
            here = here + _RADIUS * (upper - lower)
            up, down = up + _RADIUS * upper, down - _RADIUS * lower
            lines = [-_CROSS * (upper + lower), _CROSS * upper, _CROSS * lower]
        if a in (0, 1):  # the tilt of the contact itself
            tilt = _field(self.below(sympy.S.One)) * _CROSS * _HALF
            own = tilt * _PHI * _OTHERS
            tilt = -tilt if a == 1 else tilt
        total, sizes = FIELD.zero, [0, 0, 0]
        for place, (side, line) in enumerate(zip(_SIDES, lines, strict=True)):
            if line.numerator != 0 or (side == 0 and tilt.numerator != 0):
                sizes[place] = _height(layer + side, where, 1 if side == 1 else 2)
        met = FIELD.zero  # what the line from x_a puts on x_a − e_c, whatever t_c
        if sizes[0] > 0:
            line, count = lines[0], _second(sizes[0])
            here, own = here + line * _THIRD, own + tilt * _OTHERS
            down, met = down - line * count, (line * first + tilt) * count
            each = line**2 * (_field(sy.d - 3) * first**2 + second)
            each = each + _TWO * line * tilt * _THIRD * first + tilt**2 * _OTHERS
            total = total + each * _further(FIELD.one, layer, sizes[0])
        if sizes[1] > 0:
            up = up + lines[1] * _THIRD
            further = lines[1] ** 2 + (_TWO * lines[1]) ** 2 * _field(layer)
            total = total + _THIRD * second * further
        if sizes[2] > 0:
            down = down + lines[2] * _THIRD
            crossing = (lines[2] * _second(sizes[2])) ** 2 * (_field(sy.d - 3) * second + first**2)
            further = _further(lines[2], layer - 1, sizes[2])
            total = total + crossing + _THIRD * second * further
        below = second * down**2 + _TWO * first * down * met + _OTHERS * met**2
        return total + (here * first + own) ** 2 + second * up**2 + below

    def _along(
        self, a: sympy.Expr, at_path: bool, layer: sympy.Expr, side: int, where: Where
    ) -> RationalFunction:
        """What line sums along vector 1 from x_n + side e_c put on x_a + side e_c, of one c."""
        size = _height(layer + side, where, 1)
        if size < 0:
            return FIELD.zero

        def share(place: sympy.Expr) -> RationalFunction:
            upper, lower = self.halves(place)
            return _field({0: -upper - lower, 1: upper, -1: lower}[side])

        through = share(self.steps)
        if a != self.steps:
            lowest = _field(a if at_path else sympy.S.One)
            last = _field(self.steps - 1)
            through = through + sum_polynomial(share(sy.n), sy.n, lowest, last)
        starting = share(a) if at_path else FIELD.zero
        ending = through if size == 0 else FIELD.zero
        return _OWN * (_TWO * through - starting - ending)


def _second(size: int) -> RationalFunction:
    """How often a line sum counts the second bead from its start: once on the base, or twice."""
    return _TWO if size == 2 else FIELD.one


def _further(line: RationalFunction, layer: sympy.Expr, size: int) -> RationalFunction:
    """Σ weight² on a line from a layer down, all but its first two beads."""
    if size < 2:
        return FIELD.zero
    return line**2 + (_TWO * line) ** 2 * _field(layer - 2)


def _reaches(value: sympy.Expr, least: sympy.Expr, where: Where) -> bool:
    """Whether a number is at least another; or below it, everywhere."""
    apart = affine.from_sympy(sympy.expand(value - least))
    if where.nonnegative(apart):
        return True
    if where.below(apart, affine.ZERO):
        return False
    raise UndeterminedError(f"whether {value} ≥ {least}", apart)


def _height(layer: sympy.Expr, where: Where, most: int) -> int:
    """A height above the base: −1 for below it, 0, …, or ``most`` for that and more."""
    for number in range(most + 1):
        if not _reaches(layer, sympy.Integer(number), where):
            return number - 1
    return most
