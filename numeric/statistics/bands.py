"""Confidence bands that hold for all layers together.

The unit is the realisation: contacts of one packing are correlated, packings are independent. Each
realisation gives one number a layer; their mean is taken to be normal over repetitions of the
ensemble (central limit theorem), with the covariance between layers estimated from the same
realisations. Standard deviations are handled as logarithms, which are much less skewed. The
half-width of a band is c standard errors, where c is the quantile of the largest |t| over the
layers, simulated with the estimated correlations (a multivariate t).
"""

from typing import NamedTuple

import numpy as np

from ..arithmetic.systems import Array

# Simulated maxima for a quantile: at 99 % the critical value then scatters by about 0.5 %.
DRAWS = 40_000


def log_relative_std(mean: Array, square: Array) -> tuple[Array, Array]:
    """Give ln(σ/⟨f⟩), shape (L,), and the influence of each realisation on it, shape (n, L).

    ``mean`` and ``square``, shape (n, L), are the averages over the contacts of a realisation of
    g = f/F − 1 and of g², F the ordered force. σ and ⟨f⟩ are those of the pooled ensemble.
    """
    shift, second = mean.mean(axis=0), square.mean(axis=0)
    variance, average = second - shift**2, 1 + shift
    log = np.log(variance) / 2 - np.log(average)
    off = mean - shift
    influence = (square - second - 2 * shift * off) / (2 * variance) - off / average
    return log, influence


def critical_value(covariance: Array, freedom: int, level: float, seed: int) -> float:
    """Give c: all |errors| stay below c standard errors with probability ``level``.

    ``covariance``: of the errors, (L, L), estimated with so many degrees of ``freedom``.
    """
    error = np.sqrt(np.diag(covariance))
    values, vectors = np.linalg.eigh(covariance / np.outer(error, error))
    factor = vectors * np.sqrt(np.maximum(values, 0))
    generator = np.random.default_rng(seed)
    normal = generator.standard_normal((DRAWS, len(values))) @ factor.T
    scale = np.sqrt(generator.chisquare(freedom, DRAWS) / freedom)
    return float(np.quantile(np.abs(normal).max(axis=1) / scale, level))


class Band(NamedTuple):
    """A simultaneous band about what was estimated; ``estimate`` and ``half``-widths are (L,).

    ``logarithmic``: both are those of logarithms; else of plain means.
    """

    estimate: Array
    half: Array
    logarithmic: bool = True

    @property
    def value(self) -> Array:
        """What was estimated (no logarithm), shape (L,)."""
        return self._plain(self.estimate)

    @property
    def limits(self) -> tuple[Array, Array]:
        """Lower and upper edge of what was estimated (no logarithm)."""
        return self._plain(self.estimate - self.half), self._plain(self.estimate + self.half)

    def _plain(self, values: Array) -> Array:
        return np.asarray(np.exp(values) if self.logarithmic else values)

    def deviation(self, curve: Array) -> float:
        """Give the largest deviation of a curve, in units of the half-width: inside is ≤ 1."""
        own = np.log(curve) if self.logarithmic else np.asarray(curve)
        return float((np.abs(own - self.estimate) / self.half).max())


def simultaneous(
    estimate: Array, influence: Array, level: float, seed: int, *, logarithmic: bool = True
) -> Band:
    """Give the band that holds all true values with probability ``level``.

    ``influence``: what each of n realisations adds to the error, (n, L), to first order.
    """
    n = len(influence)
    apart = influence - influence.mean(axis=0)
    covariance = apart.T @ apart / (n - 1) / n
    critical = critical_value(covariance, n - 1, level, seed)
    return Band(estimate, critical * np.sqrt(np.diag(covariance)), logarithmic)
