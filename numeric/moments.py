"""Mean and variance that merge exactly, in any number system."""

from dataclasses import dataclass
from typing import Any

import flint
import numpy as np

from numeric.lattice import Array
from numeric.systems import NumberSystem


@dataclass
class Moments:
    """Count, mean and sum of squared deviations from it, elementwise over an array of variables.

    Deviations from the ordered value come in, so nothing large is ever subtracted: the variance
    stays accurate however small it is beside the mean force.
    """

    count: int = 0
    mean: Any = None
    square: Any = None

    def add(self, samples: Array) -> None:
        """Merge samples along the first axis (pairwise update of two groups)."""
        n = len(samples)
        mean = samples.sum(axis=0) / n
        deviation = samples - mean
        square = (deviation * deviation).sum(axis=0)
        if not self.count:
            self.count, self.mean, self.square = n, mean, square
            return
        total = self.count + n
        step = mean - self.mean
        self.square = self.square + square + step * step * (self.count * n) / total
        self.mean = self.mean + step * n / total
        self.count = total

    def std(self, system: NumberSystem) -> Any:
        """Root of the mean squared deviation (divided by the count)."""
        return root(np.asarray(self.square / self.count), system)


def root(values: Array, system: NumberSystem) -> Array:
    """Take the root of what can't be negative: of a ball, only its non-negative part."""
    if values.dtype != object:
        return system.sqrt(values)

    def one(value: Any) -> Any:
        return value.nonnegative_part().sqrt() if isinstance(value, flint.arb) else value.sqrt()

    return np.asarray(np.frompyfunc(one, 1, 1)(values))
