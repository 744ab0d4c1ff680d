"""The force of a contact in three dimensions, slice by slice, and its variance.

Beads are x = (a, b, c), a steps along the contact's own vector 1 and b, c along 2 and 3. The
contact leads up from (0, 0, 0), in layer j, and x_n = (n, 0, 0) are the beads of its path, up to
n = K = M − j on the surface. With r = 1 and b^1·b^a the products of the reciprocal vectors, the
force's change over its mean is to first order

    α = (1/l_1) Σ_{n=1}^{K} b^1·Σ_c [u_n δn^c(x_n) − l_n δn^c(x_n − e_c)],

where l_n is the load that the path's contact below x_n carries, and u_n = l_{n+1}. The beads with
one a are a *slice*: a lattice of two dimensions, on which the normal form of linear forms decides
which weights meet on one bead. The squares of a slice are a polynomial in a; those of all slices
are summed with a certificate.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import sympy
from force_diffusion.symbolic.algebra import affine
from force_diffusion.symbolic.algebra.affine import Affine, Region
from force_diffusion.symbolic.algebra.exact import FIELD, RationalFunction
from force_diffusion.symbolic.algebra.linear_forms import LinearForm, Ray, Site
from force_diffusion.symbolic.symbols import M, j, m, n, phi, r, sigma
from force_diffusion.symbolic.variances.certified_sums import certified_sum
from force_diffusion.symbolic.variances.weights import UndeterminedError, take_apart

At = dict[sympy.Symbol, sympy.Expr]
K = M - j
KAPPA = (1 + phi) / ((1 - phi) * (1 + 2 * phi))
"""b^1·b^1 of the reciprocal vectors."""
CROSS = -phi / ((1 - phi) * (1 + 2 * phi))
"""b^1·b^2."""
_HALF = sympy.Rational(1, 2)
_BEADS = "delta_r"
_SIDES = (1, 0, -1)


@dataclass(frozen=True)
class Carried:
    """What the path's contacts carry: l_n below x_n, as a polynomial in n; then u_n = l_{n+1}."""

    below: sympy.Expr

    def of(self, side: int) -> sympy.Expr:
        """The factor of a line sum from x_n (0), x_n + e_c (1) or x_n − e_c (−1), n < K.

        δn^c of a contact has n^b·δn^c = ½[L_b(upper) − L_b(lower) − φ (δr_upper + δr_lower)].
        """
        above = self.below.xreplace({n: n + 1})
        return {1: above / 2, 0: -(above + self.below) / 2, -1: self.below / 2}[side]

    def at_surface(self, side: int) -> sympy.Expr:
        """The same of x_K, above which nothing carries."""
        last = self.below.xreplace({n: K})
        return {1: sympy.Integer(0), 0: -last / 2, -1: last / 2}[side]

    def of_radius(self, side: int) -> sympy.Expr:
        """The factor of −φ δr there."""
        above = self.below.xreplace({n: n + 1})
        return {1: above / 2, 0: (above - self.below) / 2, -1: -self.below / 2}[side]

    def of_radius_at_surface(self, side: int) -> sympy.Expr:
        """The same of x_K."""
        return -self.of(-1).xreplace({n: K}) * (0 if side == 1 else 1)


SURFACE = Carried(sympy.Integer(1))
BULK = Carried(K - n + 1)


class Slice:
    """The weights on the beads of slice ``a``, where ``at`` and ``region`` say what j and M are.

    ``on_path``: "below" (a ≤ 0), "path" (0 < a < K) or "top" (a = K).
    """

    def __init__(
        self, carried: Carried, a: sympy.Expr, on_path: str, at: At, region: Region
    ) -> None:
        self.carried, self.a, self.on_path, self.at, self.region = carried, a, on_path, at, region
        self.form = LinearForm()
        for side in _SIDES:
            self._along_path(side)
        if on_path != "below":
            for side in _SIDES:
                self._across(side)
        if a in (0, 1):
            self._tilt()

    def squares(self) -> RationalFunction:
        """Σ weight² of the slice, times l_1²."""
        if self.form.is_zero():
            return FIELD.zero
        return take_apart(self.form, self.region).sum_of_squares()

    def _layer(self, side: int = 0) -> Affine:
        return affine.from_sympy(sympy.expand((j + self.a + side).xreplace(self.at)))

    def _field(self, value: sympy.Expr) -> RationalFunction:
        return FIELD.from_sympy(value.xreplace(self.at))

    def _put(self, across: int, layer: Affine, weight: sympy.Expr) -> None:
        self.form.add_site(Site(_BEADS, affine.constant(across), layer), self._field(weight))

    def _line_sum(self, across: int, layer: Affine, slope: int, weight: sympy.Expr) -> None:
        """2 Σ δr down a line of the slice, less δr at both ends: nothing from the base itself."""
        line, factor = affine.add(affine.constant(across), layer, -slope), self._field(weight)
        twice = factor + factor
        self.form.add_ray(Ray(_BEADS, slope, line, affine.ZERO), twice)
        self.form.add_ray(Ray(_BEADS, slope, line, affine.shifted(layer, 1)), -twice)
        self.form.add_site(Site(_BEADS, affine.constant(across), layer), -factor)
        self.form.add_site(Site(_BEADS, line, affine.ZERO), -factor)

    def _along_path(self, side: int) -> None:
        """Line sums along 1, from x_n and from x_n ± e_c: one bead of each in every slice."""
        layer = self._layer(side)
        if self.region.below(layer, affine.ZERO):
            return
        on_base = layer == affine.ZERO
        if not on_base and not self.region.below(affine.ZERO, layer):
            raise UndeterminedError(f"layer {affine.to_sympy(layer)}")
        factor, last = self.carried.of(side), self.carried.at_surface(side)
        lowest = {"below": sympy.Integer(1), "path": self.a, "top": K}[self.on_path]
        once = certified_sum(factor, n, lowest, K - 1) + last  # lines through this bead
        ends = sympy.Integer(0)  # those that begin here
        if self.on_path == "path":
            ends = factor.xreplace({n: self.a})
        elif self.on_path == "top":
            ends = last
        weight = 2 * once - ends - (once if on_base else 0)
        for sign in (1, -1):  # c = 2 and c = 3; both pass through the path itself
            self._put(sign * side, layer, KAPPA * weight)

    def _across(self, side: int) -> None:
        """What begins in this slice: radii of all lines, and line sums along 3 and along 2."""
        top = self.on_path == "top"
        factor = self.carried.at_surface(side) if top else self.carried.of(side)
        radius = (
            self.carried.of_radius_at_surface(side) if top else self.carried.of_radius(side)
        ).xreplace({n: self.a})
        factor, layer = factor.xreplace({n: self.a}), self._layer(side)
        for sign in (1, -1):
            self._put(sign * side, layer, -phi * (KAPPA + CROSS) * radius)
            if factor:
                self._line_sum(sign * side, layer, -sign, CROSS * factor)

    def _tilt(self) -> None:
        """Tilts of contacts along the path, which telescope: −l_1 ν of the contact itself."""
        first = self.carried.below.xreplace({n: sympy.Integer(1)})
        upper, layer = self.a == 1, self._layer()
        for slope in (1, -1):
            self._put(0, layer, CROSS * first * phi / 2)
            self._line_sum(0, layer, slope, CROSS * first * (-_HALF if upper else _HALF))


def variance(carried: Carried, at: At, region: Region) -> RationalFunction:
    """σ_f²/⟨f⟩² of a layer: ``at`` says what j and M are, ``region`` what is left of them.

    Where its lowest M is a case of its own, the form of those above it is taken, if it gives that.
    """
    try:
        total = FIELD.zero
        for part in _slices(carried, at, region):
            total = total + part
    except UndeterminedError:
        lowest = region.lower_bounds.get(M)
        if not isinstance(lowest, sympy.Integer):
            raise
        higher = variance(carried, at, Region({M: lowest + 1}))
        one = {name: value.xreplace({M: lowest}) for name, value in at.items()} | {M: lowest}
        there = higher.substitute({M: FIELD.from_sympy(lowest)})
        if not (there - variance(carried, one, Region({}))).is_zero():
            raise
        return higher
    first = carried.below.xreplace({n: sympy.Integer(1)}).xreplace(at)
    return (total * FIELD.from_sympy((sigma / r / first) ** 2)).reduced()


def _slices(carried: Carried, at: At, region: Region) -> Iterator[RationalFunction]:
    """Squares slice by slice: those that stand alone, and the sums over all between."""
    ends = [-j - 1, -j, -j + 1, sympy.Integer(0), sympy.Integer(1), K]
    if at.get(j) == 0 and at.get(M) != 1:  # lines along 2 and 3 cross on the base
        ends.append(sympy.Integer(2))
    alone = sorted_places(ends, at, region)
    for place in alone:
        yield Slice(carried, place, _where(place, at, region), at, region).squares()
    for low, high in pairwise(alone):
        if affine.shifted(affine.from_sympy(high - low), -1) == affine.ZERO:
            continue
        bounds = {**region.lower_bounds, m: low + 1}
        where = "below" if _where(high, at, region) == "below" else "path"
        square = Slice(carried, m, where, at, Region(bounds)).squares().to_sympy()
        yield FIELD.from_sympy(certified_sum(square, m, low + 1, high - 1))


def _where(place: sympy.Expr, at: At, region: Region) -> str:
    if affine.from_sympy(sympy.expand(K.xreplace(at) - place)) == affine.ZERO:
        return "top"
    return "path" if region.below(affine.ZERO, affine.from_sympy(place)) else "below"


def sorted_places(places: list[sympy.Expr], at: At, region: Region) -> list[sympy.Expr]:
    """Distinct places in their order, as the region decides it."""
    found: list[sympy.Expr] = []
    for place in (sympy.expand(one.xreplace(at)) for one in places):
        if place in found:
            continue
        before = [
            one for one in found if region.below(affine.from_sympy(one), affine.from_sympy(place))
        ]
        for one in found[len(before) :]:
            if not region.below(affine.from_sympy(place), affine.from_sympy(one)):
                raise UndeterminedError(f"{place} against {one}")
        found.insert(len(before), place)
    return found
