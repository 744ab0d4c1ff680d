"""The weights of a linear form as a list that can be printed, every radius in it once."""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import sympy

from ..algebra import affine
from ..algebra.affine import Affine
from ..algebra.exact import LAYER, RationalFunction
from ..algebra.weights import Order, Pieces, Run
from ..as_printed import power, terms, times
from ..symbols import DeltaR, M, j, m


@dataclass(frozen=True)
class Weight:
    """The weight of a radius; with ``limits`` of each radius of a diagonal, in the layer m."""

    radius: DeltaR
    weight: sympy.Expr
    limits: tuple[sympy.Symbol, sympy.Expr, sympy.Expr] | None = None

    def term(self) -> sympy.Expr:
        """What it adds to the form."""
        return self._over_layers(times(self.weight, self.radius))

    def square(self) -> sympy.Expr:
        """What it adds to the sum of the squared weights."""
        return self._over_layers(power(self.weight, 2))

    def _over_layers(self, body: sympy.Expr) -> sympy.Expr:
        return sympy.Sum(body, self.limits) if self.limits else body


def weights(pieces: Pieces, region: Order, unit: RationalFunction) -> Iterator[Weight]:
    """The weights of a form times ``unit``, taken apart: along the diagonals, then site by site."""
    for run in pieces.runs:
        layers = [site.j for site in pieces.special if run.ray.site(site.j) == site]
        for first, last in _between(run, layers, region):
            across = affine.to_sympy(run.ray.line) + run.ray.slope * m
            weight = _shown(run.weight * unit, LAYER).xreplace({LAYER: m})
            limits = (m, affine.to_sympy(first), affine.to_sympy(last))
            yield Weight(DeltaR(across, m), weight, limits)
    for site, (full, _) in pieces.special.items():
        if not full.is_zero():
            radius = DeltaR(affine.to_sympy(site.i), affine.to_sympy(site.j))
            yield Weight(radius, _shown(full * unit, j))


def _shown(weight: RationalFunction, layer: sympy.Symbol) -> sympy.Expr:
    """A weight for people: long factors by powers of the number of layers up to the surface."""
    above = sympy.Dummy("above")
    factors = []
    for factor in sympy.Mul.make_args(weight.to_sympy()):
        if isinstance(factor, sympy.Add) and len(factor.args) > LONG:
            powers = sympy.Poly(factor.xreplace({M: above + layer}), above).terms()
            factors.append(terms(*(c * (M - layer) ** power for (power,), c in powers)))
        else:
            factors.append(factor)
    return times(*factors) if len(factors) > 1 else factors[0]


LONG = 4
"""Terms of a factor that still reads well as it is."""


def _between(run: Run, layers: list[Affine], region: Order) -> Iterator[tuple[Affine, Affine]]:
    """The layers of a run but for those listed, in stretches."""

    def below(one: Affine, other: Affine) -> bool:
        return region.below(one, other)

    inside = [
        layer for layer in layers if not below(layer, run.first) and not below(run.last, layer)
    ]
    ordered = sorted(inside, key=lambda one: sum(below(other, one) for other in inside))
    ends = [affine.shifted(run.first, -1), *ordered, affine.shifted(run.last, 1)]
    for before, after in pairwise(ends):
        first, last = affine.shifted(before, 1), affine.shifted(after, -1)
        if not below(last, first):
            yield first, last


def listed(found: list[Weight]) -> sympy.Expr:
    """The form again: each radius with its weight."""
    return terms(*(one.term() for one in found))


def squares(found: list[Weight]) -> sympy.Expr:
    """The sum of the squared weights."""
    return terms(*(one.square() for one in found))
