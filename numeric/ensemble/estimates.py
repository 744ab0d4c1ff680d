"""What sums over packings say: means, standard deviations, and how sure they are."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arithmetic.systems import Array
from ..statistics.confidence import half_width
from ..statistics.ratios import from_products
from .measure import Measurement
from .sums import Sums


@dataclass(frozen=True)
class Estimates:
    """Statistics of G groups, in units of the load; arrays are float64 of shape (G,)."""

    measurement: Measurement
    sums: Sums

    @property
    def realisations(self) -> int:
        """N packings."""
        return self.sums.realisations

    @property
    def samples(self) -> int:
        """Contacts of a group in all packings; where these differ, of all groups."""
        samples = self.sums.samples
        return int(samples.sum() if self.measurement.of_networks else samples[0])

    @cached_property
    def _found(self) -> tuple[Array, Array, Array, Array]:
        """Mean change, standard deviation, and their standard errors, in units of 2^unit."""
        means, products = self.sums.means, self.sums.products
        if len(means) == 2:  # all packings count as much
            ones, zeros = np.ones((1, means.shape[1])), np.zeros((3, means.shape[1]))
            means, products = np.concatenate([ones, means]), np.concatenate([zeros, products])
        return from_products(self.realisations, self.sums.held, means, products)

    def _scaled(self, values: Array) -> Array:
        return np.asarray(np.ldexp(values, self.measurement.unit))

    @property
    def mean(self) -> Array:
        """Mean change; 0 where nothing was sampled."""
        return np.nan_to_num(self._scaled(self._found[0]))

    @property
    def mean_error(self) -> Array:
        """Standard error of the mean change, from the scatter over packings."""
        return self._scaled(self._found[2])

    @property
    def mean_square(self) -> Array:
        """Mean squared change: the variance about the ordered force."""
        means = self.sums.means
        square = means[-1] if len(means) == 2 else np.nan_to_num(means[-1] / means[0])
        return np.asarray(np.ldexp(square, 2 * self.measurement.unit))

    @property
    def std(self) -> Array:
        """Root of the mean squared deviation from the mean; under a surface or bulk load σ_f."""
        return np.nan_to_num(self._scaled(self._found[1]))

    @property
    def std_error(self) -> Array:
        """Standard error of ``std``; NaN where nothing varies, or N = 1."""
        return self._scaled(self._found[3])

    def half_width(self, confidence: float, look: int) -> float:
        """Give the half-width of all σ_f together, relative: see ``statistics.confidence``."""
        _, std, _, error = self._found
        known = np.isfinite(error)
        relative = (error[known] / std[known]).tolist() if self.realisations > 1 else [math.inf]
        return half_width(relative, self.realisations, confidence, look)

    def covariance(self) -> Array:
        """Covariance over packings: of the groups' mean squares in a profile, else of changes.

        Shape (groups, groups); that of means over all N packings is this divided by N.
        """
        exponent = (2 + 2 * self.sums.row) * self.measurement.unit
        return np.asarray(np.ldexp(self.sums.pairs / (self.realisations - 1), exponent))

    def shares(self) -> tuple[Array, Array]:
        """Give the share of all samples that each bin has, and its standard error."""
        N, (counts, squares, products) = self.realisations, self.sums.bins.tolist()
        S, square = sum(counts), sum(products)  # of what packings count, and of its square
        found = [
            math.sqrt((a * S * S - 2 * c * p * S + c * c * square) * N / (N - 1)) / S**2
            for c, a, p in zip(counts, squares, products, strict=True)
        ]
        return np.array(counts) / S, np.array(found)
