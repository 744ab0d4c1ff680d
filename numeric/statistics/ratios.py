"""Means over samples whose number varies from packing to packing, and their standard errors.

The unit is the packing: its samples are correlated, packings are independent. A mean is a ratio of
sums over packings, Σ total/Σ count, whose error follows from the scatter of total − mean × count;
that of a variance from the scatter of the squared deviations from the mean, likewise. Both are
found from means and products of deviations, and not of the numbers themselves.
"""

import numpy as np

from ..arithmetic.systems import Array

# Of a variance: no sample is so large that its error is less.
ROUNDING = 1e-9
# Of the terms of which a squared error is the sum: below lies rounding, as of two samples, which
# lie equally far from their mean whatever they are.
CANCELLED = 2.0**-44


def moments(counts: Array, totals: Array, squares: Array) -> tuple[Array, Array, Array, Array]:
    """Give mean and standard deviation of each group, and the standard errors of both.

    Arrays are (packings, groups): how many samples, their sum, and that of their squares. NaN where
    nothing was counted; the errors are also NaN of what only one packing has, and that of a
    deviation where it is zero, or its error nothing but rounding.

    >>> mean, std, error, _ = moments(*np.array([[[2], [2]], [[2], [6]], [[4], [20]]]))
    >>> float(mean[0]), round(float(std[0]), 9), float(error[0])
    (2.0, 1.414213562, 1.0)
    >>> a, b = np.array([[0.3], [0.7]]), np.array([[1], [1]])
    >>> _, std, _, error = moments(b, a, a * a)
    >>> round(float(std[0]), 9), float(error[0])
    (0.2, nan)
    """
    values = np.stack([counts, totals, squares]).astype(np.float64)
    with np.errstate(all="ignore"):  # of numbers beyond floats nothing is known
        means = values.mean(axis=1)
        values -= means[:, None]
        pairs = zip(*np.triu_indices(3), strict=True)  # one after the other: there may be many
        products = np.stack([(values[a] * values[b]).sum(axis=0) for a, b in pairs])
        return from_products(len(counts), (counts > 0).sum(axis=0), means, products)


def from_products(
    packings: int, held: Array, means: Array, products: Array
) -> tuple[Array, Array, Array, Array]:
    """Give the same from means over packings of count, total and square, (3, groups).

    ``products`` (6, groups) are the sums of products of two deviations from them, those of a row
    with itself and the later ones, row by row; ``held`` (groups,) packings have samples.
    """
    rows, columns = np.triu_indices(3)
    twice = np.where(rows == columns, 1, 2)[:, None]

    def error(*weights: Array | float) -> Array:
        """Give the standard error of a ratio from the scatter of a sum with these weights."""
        w = np.stack(np.broadcast_arrays(*weights, counts)[:3])
        terms = twice * w[rows] * w[columns] * products
        square, size = terms.sum(axis=0), abs(terms).sum(axis=0)
        square = np.where(square > CANCELLED * size, square, 0)
        found = np.sqrt(square / packings / (packings - 1)) / counts
        return np.where(held > 1, found, np.nan)

    with np.errstate(all="ignore"):
        counts, totals, squares = means
        mean = totals / counts
        variance = np.maximum(squares / counts - mean**2, 0)
        of_variance = error(mean**2 - variance, -2 * mean, 1.0)
        std = np.sqrt(variance)
        of_std = np.where(of_variance > ROUNDING * variance, of_variance / (2 * std), np.nan)
        return mean, std, error(-mean, 1.0, 0.0), of_std
