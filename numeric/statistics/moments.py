"""Mean and standard deviation in any number system, and their standard errors."""

import math
from fractions import Fraction
from typing import Any

import numpy as np

from ..arithmetic.systems import Array

# Of a variance: no sample is so large that its error is less.
ROUNDING = 1e-9
# Of the terms of which a squared error is the sum: below lies rounding, as of two samples, which
# lie equally far from their mean whatever they are.
CANCELLED = 2.0**-44


def mean_and_std(means: Array, squares: Array) -> tuple[Array, Array]:
    """Give the mean and the standard deviation of all samples, shape (groups,) each.

    ``means``: those of each packing, (packings, groups); ``squares``: mean squares of the
    deviations from them. Nothing large is subtracted: a scatter far below the mean stays accurate.
    """
    mean = means.mean(axis=0)
    apart = means - mean
    return mean, root((squares + apart * apart).mean(axis=0))


def standard_errors(values: Array) -> tuple[Array, Array]:
    """Give the standard errors of the mean and of the standard deviation, shape (groups,) each.

    ``values``: of each packing the means of x and of x², (packings, 2, groups). The unit is the
    packing: the contacts of one are correlated, packings are independent. NaN for a single packing,
    and for the deviation of what does not vary.
    """
    with np.errstate(all="ignore"):  # of numbers beyond floats nothing is known
        means = values.mean(axis=0)
        sums = sums_of_products(values - means)
    _, std, mean_error, log_error = with_errors(len(values), means, sums)
    return mean_error, error_of_std(std, log_error)


def sums_of_products(values: Array) -> Array:
    """Give Σ aa, Σ ab and Σ bb over packings, (3, groups), of a and b, (packings, 2, groups)."""
    a, b = values.swapaxes(0, 1)
    # one after the other: there may be as many groups as contacts
    return np.stack([(left * right).sum(axis=0) for left, right in ((a, a), (a, b), (b, b))])


def error_of_std(std: Array, log_error: Array) -> Array:
    """Give the standard error of σ from that of ln σ, ε: σ (e^2ε − 1)/2.

    Where the squares of a sample happen to be small, σ and its error both are: σ ± 2 σε would miss
    on that side too often. ln σ hardly has that fault, and its interval is good to ln σ ± 2 ε.
    """
    with np.errstate(all="ignore"):
        return np.asarray(std * np.expm1(2 * log_error) / 2)


def with_errors(packings: int, means: Array, products: Array) -> tuple[Array, Array, Array, Array]:
    """Give mean and standard deviation σ of each group, and the standard errors of mean and ln σ.

    ``means`` (2, groups): over packings, of the means of x and of x² of each. ``products`` (3,
    groups): sums over packings of products of deviations from them, of x twice, of x and x², of x²
    twice. Errors are NaN of one packing, and that of ln σ where σ is zero, or its error nothing but
    rounding.

    >>> a = np.array([0.3, 0.7])
    >>> x, xx = a - a.mean(), a * a - (a * a).mean()
    >>> of_two = [[a.mean()], [(a * a).mean()]], [[x @ x], [x @ xx], [xx @ xx]]
    >>> mean, std, mean_error, log_error = with_errors(2, *map(np.array, of_two))
    >>> [round(float(v[0]), 9) for v in (mean, std, mean_error, log_error)]
    [0.5, 0.2, 0.2, nan]
    """

    def error(weights: tuple[Array | float, Array | float]) -> Array:
        """Give the standard error of a sum of both means with these weights."""
        a, b = weights
        terms = np.stack([a * a * products[0], 2 * a * b * products[1], b * b * products[2]])
        square, size = terms.sum(axis=0), abs(terms).sum(axis=0)
        square = np.where(square > CANCELLED * size, square, 0)
        return np.where(packings > 1, np.sqrt(square / packings / (packings - 1)), np.nan)

    with np.errstate(all="ignore"):
        mean, square = means
        variance = np.maximum(square - mean**2, 0)
        of_variance = error((-2 * mean, 1.0))
        known = of_variance > ROUNDING * variance
        of_log = np.where(known, of_variance / (2 * variance), np.nan)
        return mean, np.sqrt(variance), error((1.0, 0.0)), of_log


def unit_near(size: Fraction) -> float:
    """Give the power of two below a positive size, within the range where it can be squared.

    >>> unit_near(Fraction(3, 10)), unit_near(Fraction(1, 10**300)) > 0
    (0.125, True)
    """
    if not size:
        return 1.0
    exponent = size.numerator.bit_length() - size.denominator.bit_length() - 1
    return math.ldexp(1.0, min(max(exponent, -1000), 1000))


def root(values: Array) -> Array:
    """Take the root of what can't be negative: of a ball, only its non-negative part."""
    if values.dtype != object:
        return np.sqrt(values)

    def root_of(value: Any) -> Any:
        ball = hasattr(value, "nonnegative_part")
        return (value.nonnegative_part() if ball else value).sqrt()

    return np.asarray(np.frompyfunc(root_of, 1, 1)(values))
