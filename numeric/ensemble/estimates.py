"""Means, variances and their errors from exact sums: rational throughout, each rounded once."""

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from ..arithmetic.systems import Array
from ..statistics.confidence import half_width
from .measure import Measurement
from .sums import Sums


@dataclass(frozen=True)
class Estimates:
    """What sums over N packings of n contacts a group say; arrays have shape (groups,)."""

    measurement: Measurement
    sums: Sums

    @property
    def realisations(self) -> int:
        """N."""
        return self.sums.realisations

    @property
    def samples(self) -> int:
        """N n: contacts of a group in all packings."""
        return self.realisations * self.measurement.members

    @cached_property
    def mean(self) -> list[Fraction]:
        """Mean change, exact."""
        return [total / self.samples for total in self.sums.change.fractions()]

    @cached_property
    def mean_square(self) -> list[Fraction]:
        """Mean squared change, exact: the variance about the ordered force."""
        return [total / self.samples for total in self.sums.square.fractions()]

    @cached_property
    def variance(self) -> list[Fraction]:
        """Mean squared deviation of the change from its mean, exact."""
        pairs = zip(self.mean_square, self.mean, strict=True)
        return [square - mean * mean for square, mean in pairs]

    @cached_property
    def std(self) -> list[float]:
        """Root of the variance; under a surface or bulk load σ_f."""
        return [float(root(v)) for v in self.variance]

    @cached_property
    def _scatter(self) -> list[tuple[Fraction, Fraction]]:
        """Variances over packings of a, and of b − 2 ⟨a⟩ a (to first order that of a variance).

        In units of 4^unit and 16^unit.
        """
        N, G = self.realisations, self.measurement.groups
        means, products = self.sums.means.fractions(), self.sums.products.fractions()
        found = []
        for g in range(G):
            a, b = means[g], means[G + g]
            of_a = products[g] - a * a / N
            both = products[G + g] - a * b / N
            of_b = products[2 * G + g] - b * b / N
            slope = 2 * a / N
            found.append(
                (of_a / (N - 1), (of_b - 2 * slope * both + slope * slope * of_a) / (N - 1))
            )
        return found

    @cached_property
    def mean_error(self) -> list[float | None]:
        """Standard error of the mean change, from the scatter over packings."""
        if self.realisations < 2:
            return [None] * self.measurement.groups
        unit = Fraction(2) ** self.measurement.unit
        return [float(root(a / self.realisations) * unit) for a, _ in self._scatter]

    @cached_property
    def _std_error(self) -> list[tuple[Fraction, Fraction] | None]:
        """(standard error, σ_f) of each group that varies, from the error of the variance."""
        if self.realisations < 2:
            return [None] * self.measurement.groups
        unit = Fraction(4) ** self.measurement.unit
        found: list[tuple[Fraction, Fraction] | None] = []
        for (_, of_variance), variance in zip(self._scatter, self.variance, strict=True):
            sigma = root(variance)
            error = root(of_variance / self.realisations) * unit
            found.append((error / (2 * sigma), sigma) if sigma else None)
        return found

    @property
    def std_error(self) -> list[float | None]:
        """Standard error of the root of the variance; None where nothing varies, or N = 1."""
        return [None if pair is None else float(pair[0]) for pair in self._std_error]

    def relative_errors(self) -> list[float]:
        """Standard errors of σ_f in units of it, of the groups that vary."""
        if self.realisations < 2:
            return [math.inf]
        return [float(pair[0] / pair[1]) for pair in self._std_error if pair is not None]

    def half_width(self, confidence: float, look: int) -> float:
        """Give the half-width of all σ_f together, relative: see ``statistics.confidence``."""
        return half_width(self.relative_errors(), self.realisations, confidence, look)

    def covariance(self) -> Array:
        """Covariance over packings: of the groups' mean squares in a profile, else of changes.

        Shape (groups, groups); that of means over all N packings is this divided by N.
        """
        N, V = self.realisations, self.measurement.variables
        squares = self.measurement.squares
        pairs, low = self.sums.pairs.integers()
        means, low_of_means = self.sums.means.integers()
        x = means[1 if squares else 0]
        upper = np.triu_indices(V)
        crossed = x[upper[0]] * x[upper[1]]
        common = min(low, 2 * low_of_means)
        whole = N * (pairs << (low - common)) - (crossed << (2 * low_of_means - common))
        exponent = common + (4 if squares else 2) * self.measurement.unit
        matrix = np.zeros((V, V))
        matrix[upper] = [_quotient(int(w), N * (N - 1), exponent) for w in whole]
        matrix.T[upper] = matrix[upper]
        return matrix


def _quotient(whole: int, count: int, exponent: int) -> float:
    """whole/count × 2^exponent, rounded once."""
    if exponent >= 0:
        return (whole << exponent) / count
    return whole / (count << -exponent)


def root(value: Fraction) -> Fraction:
    """Square root to 80 bits, so that it can be rounded to a float, however small.

    >>> float(root(Fraction(2))), float(root(Fraction(1, 10**600)))
    (1.4142135623730951, 1e-300)
    """
    if value <= 0:
        return Fraction(0)
    bits = value.numerator.bit_length() - value.denominator.bit_length()
    shift = 82 - bits // 2
    scaled = value * Fraction(4) ** shift
    return Fraction(math.isqrt(scaled.numerator // scaled.denominator)) / Fraction(2) ** shift
