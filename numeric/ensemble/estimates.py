"""What sums over packings say: means, standard deviations, and how sure they are."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import Array
from ..lattice.branch import ORDER
from ..statistics.confidence import half_width
from ..statistics.moments import with_errors
from .measure import Measurement
from .sums import Sums

LEAST = 1e-300  # floats that are smaller have fewer digits


@dataclass(frozen=True)
class Estimates:
    """Statistics over N packings of G groups, in the unit in which the load's magnitude is written.

    Arrays are float64 of shape (G,), in the order of the rows: by j, i (or p, q), branch and
    component.
    """

    measurement: Measurement
    sums: Sums

    @property
    def realisations(self) -> int:
        """N packings."""
        return self.sums.realisations

    @property
    def samples(self) -> int:
        """Contacts of a group in all N packings; those of one packing are correlated."""
        return self.realisations * self.measurement.members

    @cached_property
    def _order(self) -> Array:
        """Where the rows stand among the groups."""
        labels = self.measurement.labels
        names = ("component", *ORDER)
        keys = [labels[name] for name in names if name in labels]
        return np.lexsort(keys) if keys else np.arange(self.measurement.groups)

    @property
    def _unit(self) -> float:
        """The load's magnitude."""
        return float(self.measurement.plan.scene.load.magnitude)

    @cached_property
    def _found(self) -> tuple[Array, Array, Array, Array]:
        """Mean change, standard deviation, and their standard errors, as they were summed up."""
        return with_errors(self.realisations, self.sums.means, self.sums.products)

    def _rows(self, values: Array, power: int = 1) -> Array:
        """Give what was summed up row by row, in the unit of force to that power.

        Raises ``ForceDiffusionError`` where floats don't hold squares in that unit.
        """
        scaled = np.ldexp(values[self._order], power * self.measurement.unit)
        with np.errstate(all="ignore"):
            found = np.asarray(scaled * np.float64(self._unit) ** power)
        lost = (scaled != 0) & ~((np.abs(found) > LEAST) & np.isfinite(found))
        if power > 1 and lost.any():
            raise ForceDiffusionError(
                f"squares of forces are beyond what floats hold where load.magnitude is "
                f"{self._unit:g}: choose another unit"
            )
        return found

    @cached_property
    def mean(self) -> Array:
        """Mean force."""
        change = np.ldexp(self._found[0], self.measurement.unit)
        return np.asarray((self.measurement.ordered() + change)[self._order] * self._unit)

    @cached_property
    def mean_change(self) -> Array:
        """Mean of the change g = f − F from the ordered force F."""
        return self._rows(self._found[0])

    @cached_property
    def mean_change_error(self) -> Array:
        """Standard error of ``mean_change``."""
        return self._rows(self._found[2])

    @cached_property
    def mean_square(self) -> Array:
        """Mean of g², the variance about the ordered force: Eqs. 13 and 14 are its theory."""
        return self._rows(self.sums.means[1], 2)

    @cached_property
    def std(self) -> Array:
        """σ_f, the standard deviation of g about its mean."""
        return self._rows(self._found[1])

    @cached_property
    def std_error(self) -> Array:
        """Standard error of ``std``; NaN where nothing varies."""
        return self._rows(self._found[3])

    def width(self, confidence: float, look: int) -> float:
        """Give the half-width of all σ_f together, relative: see ``statistics.confidence``."""
        _, std, _, error = self._found
        known = np.isfinite(error)
        relative = (error[known] / std[known]).tolist()
        if self.realisations < 2 or (self.realisations == 2 and (std[~known] > 0).any()):
            relative = [math.inf]  # of single contacts two packings don't tell it
        return half_width(relative, self.realisations, confidence, look)

    def _shares(self) -> tuple[Array, Array]:
        """Give the share of all samples that each bin has, and its standard error."""
        N, (counts, squares, products) = self.realisations, self.sums.bins.tolist()
        S, square = sum(counts), sum(products)  # of what packings count, and of its square
        found = [
            math.sqrt((a * S * S - 2 * c * p * S + c * c * square) * N / (N - 1)) / S**2
            for c, a, p in zip(counts, squares, products, strict=True)
        ]
        return np.array(counts) / S, np.array(found)
