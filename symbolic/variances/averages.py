"""Averages of a variance over the layers of a packing, in closed form at finite M."""

from dataclasses import dataclass

import sympy

from ..algebra.exact import FIELD, RationalFunction, sum_polynomial
from ..symbols import M, j, k
from .variance import ClosedForm, value_at


@dataclass(frozen=True)
class LayerAverage:
    """(1/M) Σ over the layers 0 ≤ j < M, for M ≥ 3: ``rational`` + ``harmonic`` · Σ 1/k.

    Attributes:
        rational: the rational part.
        harmonic: the factor of Σ 1/k over 2 ≤ k ≤ M − 2, a number that no rational function of M
            gives and that lies between 0 and M; zero where no variance is divided by M − j.
        exceptions: heights M below 3, with their own average.
    """

    rational: RationalFunction
    harmonic: RationalFunction
    exceptions: tuple[tuple[int, sympy.Expr], ...]

    @property
    def expression(self) -> sympy.Expr:
        """The average as a SymPy expression in M, phi, sigma, r."""
        if self.harmonic.is_zero():
            return self.rational.to_sympy()
        each = self.harmonic.to_sympy() / k
        return self.rational.to_sympy() + sympy.Sum(each, (k, 2, M - 2))


def layer_average(forms: dict[str, ClosedForm]) -> LayerAverage:
    """Average the closed forms of all layers 0 ≤ j < M, those at the edges included.

    The interior, 2 ≤ j ≤ M − 2, is summed over k = M − j: powers of k by a telescoping
    certificate (:func:`symbolic.algebra.exact.antidifference`), what stands over k by name.
    """
    height, above = FIELD.generator(M), FIELD.generator(k)
    interior = forms["interior"].value.substitute({j: height - above})
    over_k, *powers = (interior * above).coefficients(k)
    polynomial = FIELD.zero
    for power, coefficient in enumerate(powers):
        polynomial = polynomial + coefficient * above**power
    total = sum_polynomial(polynomial, k, FIELD.constant(2), height - FIELD.constant(2))
    for edge in ("base", "base+1", "surface"):
        total = total + forms[edge].value
    lowest, upper = (FIELD.from_sympy(value_at(forms, 2, at, case)) for at, case in _HEIGHT_TWO)
    two = (lowest + upper) / FIELD.constant(2)
    return LayerAverage(
        total / height,
        over_k / height,
        ((1, value_at(forms, 1, 0, "base")), (2, two.to_sympy())),
    )


_HEIGHT_TWO = ((0, "base"), (1, "surface"))
