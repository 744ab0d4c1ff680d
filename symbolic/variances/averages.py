"""Averages of a variance over the layers of a packing, in closed form at finite M."""

from dataclasses import dataclass

import sympy

from .. import sets
from ..algebra.exact import FIELD, RationalFunction, sum_polynomial
from ..forms import Straightening
from ..kernel.statistics import ClosedForm
from ..kernel.theorem import NotProvedError
from ..symbols import H_M, M, j, k
from ..weights import Weights


@dataclass(frozen=True)
class LayerAverage:
    """(1/M) Σ over the layers 0 ≤ j < M, for M ≥ 3: ``rational`` + ``harmonic`` · Σ 1/k.

    Attributes:
        rational: the rational part.
        harmonic: the factor of Σ 1/k over 1 ≤ k ≤ M − 2, a number that no rational function of M
            gives and that lies between 0 and M; zero where no variance is divided by M − j.
        exceptions: heights M below 3, with their own average.
    """

    rational: RationalFunction
    harmonic: RationalFunction
    exceptions: tuple[tuple[int, sympy.Expr], ...]

    @property
    def form(self) -> ClosedForm:
        """The average for every height M ≥ 1, with the harmonic number H_M."""
        height, one = FIELD.generator(M), FIELD.one
        between = FIELD.generator(H_M) - one / height - one / (height - one)
        high = self.rational + self.harmonic * between
        pieces = [Weights.of(sympy.Ge(M, 3, evaluate=False), value=high)]
        for size, value in self.exceptions:
            pieces.append(Weights.of(_is(M, size), value=FIELD.from_sympy(value)))
        heights = sets.where(sympy.Ge(M, 1, evaluate=False))
        return ClosedForm(sum(pieces, Weights()), heights, Straightening())

    @property
    def expression(self) -> sympy.Expr:
        """The average as a SymPy expression in M, phi, sigma, r."""
        if self.harmonic.is_zero():
            return self.rational.to_sympy()
        each = self.harmonic.to_sympy() / k
        return self.rational.to_sympy() + sympy.Sum(each, (k, 1, M - 2))


def layer_average(form: ClosedForm) -> LayerAverage:
    """Average the closed form over all layers 0 ≤ j < M.

    Layers from 2 on are summed over k = M − j: powers of k by a telescoping certificate
    (:func:`symbolic.algebra.exact.antidifference`), what stands over k by name. Where the layer
    below the surface has a formula of its own, nothing is divided by k.
    """
    height, above = FIELD.generator(M), FIELD.generator(k)
    edges: tuple[sympy.Expr | int, ...]
    try:
        interior, edges, lowest = form.on(j >= 2), (0, 1), 1
    except NotProvedError:
        interior, edges, lowest = form.on(j >= 2, j <= M - 2), (0, 1, M - 1), 2
    over_k, *powers = (interior.substitute({j: height - above}) * above).coefficients(k)
    polynomial = FIELD.zero
    for power, coefficient in enumerate(powers):
        polynomial = polynomial + coefficient * above**power
    total = sum_polynomial(polynomial, k, FIELD.constant(lowest), height - FIELD.constant(2))
    high = sympy.Ge(M, 3, evaluate=False)
    for layer in edges:
        total = total + form.on(_is(j, layer), high)
    small = [[form.on(_is(M, size), _is(j, layer)) for layer in range(size)] for size in (1, 2)]
    means = (sum(one, FIELD.zero) / FIELD.constant(len(one)) for one in small)
    exceptions = tuple((size, mean.to_sympy()) for size, mean in enumerate(means, start=1))
    return LayerAverage(total / height, over_k / height, exceptions)


def _is(symbol: sympy.Symbol, value: sympy.Expr | int) -> sympy.Basic:
    return sympy.Eq(symbol, value, evaluate=False)
