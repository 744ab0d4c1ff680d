"""Means over samples whose number varies from packing to packing, and their standard errors.

The unit is the packing: its samples are correlated, packings are independent. A mean is a ratio of
sums over packings, Σ total/Σ count, whose error follows from the scatter of total − mean × count.
"""

import math

import numpy as np

from ..arithmetic.systems import Array

# Of a variance: no sample is so large that its error is less. Below lies rounding, as of two
# samples, which lie equally far from their mean whatever they are.
ROUNDING = 1e-9


def ratio(counts: Array, totals: Array) -> tuple[Array, Array]:
    """Give Σ total/Σ count of each group, and its standard error; arrays are (packings, groups).

    NaN where nothing was counted, and for the error of what only one packing has.

    >>> mean, error = ratio(np.array([[2], [2]]), np.array([[2.0], [6.0]]))
    >>> float(mean[0]), float(error[0])
    (2.0, 1.0)
    """
    packings, summed = len(counts), counts.sum(axis=0)
    with np.errstate(all="ignore"):
        # one by one, so that the order in which packings came decides no bit
        means = np.array([math.fsum(column) for column in totals.T]) / summed
        off = totals - means * counts
        scatter = np.sqrt((off * off).sum(axis=0) / (packings - 1) * packings)
        return means, np.where((counts > 0).sum(axis=0) > 1, scatter / summed, np.nan)


def moments(counts: Array, totals: Array, squares: Array) -> tuple[Array, Array, Array, Array]:
    """Give mean and standard deviation of each group, and the standard errors of both.

    ``squares``: sums of the samples' squares. The error of a deviation is NaN where it is zero, or
    nothing but rounding.

    >>> a, b = np.array([[0.3], [0.7]]), np.array([[1], [1]])
    >>> _, std, _, error = moments(b, a, a * a)
    >>> round(float(std[0]), 9), float(error[0])
    (0.2, nan)
    """
    mean, of_mean = ratio(counts, totals)
    variance, of_variance = ratio(counts, squares - 2 * mean * totals + mean**2 * counts)
    std = np.sqrt(np.maximum(variance, 0))
    with np.errstate(all="ignore"):
        known = of_variance > ROUNDING * variance
        return mean, std, of_mean, np.where(known, of_variance / (2 * std), np.nan)
