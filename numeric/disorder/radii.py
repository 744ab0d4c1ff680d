"""Where radii come from: drawn from a counter-based generator, or measured and read from a file.

A drawn radius is a pure function of (seed, realisation, i, j): the counter (column, layer) is put
through Philox under the key (seed, realisation), so that any region can be asked for alone, in any
order. A deviate is a double, and δr/r = relative_std × deviate is an exact rational: every number
system solves the very same packing.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, Protocol

import numpy as np

from ..arithmetic.decimals import short
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import Array, NumberSystem
from ..lattice.layers import Rows
from .drawing import deviates

# Columns of a slab may be negative; counters must not be.
OFFSET = np.uint64(2**62)
# Beads whose δr are worked out at once, in a near cache.
AT_ONCE = 8192


class BeadError(ForceDiffusionError, ValueError):
    """A packing can't be built; the message names the bead, as does ``site``, and says why.

    ``place``: which packing it is, of those that are solved together.
    """

    def __init__(self, site: tuple[int, ...], reason: str, place: int = 0) -> None:
        """Name the bead and what is wrong."""
        super().__init__(f"bead {site}: {reason}")
        self.site, self.reason, self.place = site, reason, place


class RadiusError(BeadError):
    """A radius is missing or not positive; ``site`` names the bead."""


class Radii(Protocol):
    """A source of δr/r."""

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Give δr/r of beads that lie row after row, (realisations, beads)."""

    @property
    def relative_std(self) -> Fraction:
        """σ_δr/r: of the distribution, or as measured."""


@lru_cache(maxsize=4)
def counters(rows: Rows, width: int | None) -> tuple[Array, Array]:
    """Give the counters of beads that lie row after row."""
    i, j = rows.sites
    columns = (i - j % 2) // 2
    if width is not None:
        columns %= width
    return columns.astype(np.uint64) + OFFSET, j.astype(np.uint64)


class DrawnRadii(NamedTuple):
    """Independent draws: ``kind`` "uniform", "normal" or "two-point", width of the packing."""

    kind: str
    relative_std: Fraction
    seed: int
    width: int | None

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Scale deviates; a radius that is not positive raises ``RadiusError``."""
        low, high = counters(rows, self.width)
        drawn = deviates(self.kind, self.seed, realisations, low, high)
        least = Fraction(float(drawn.min(initial=0)))
        if self.relative_std * least <= -1:
            place, bead = np.argwhere(drawn == float(least))[0].tolist()
            i, j = (int(site[bead]) for site in rows.sites)
            shown = short(1 + self.relative_std * least)
            raise RadiusError((i, j), f"the drawn radius is {shown} r, not positive", place)
        return system.from_floats(drawn) * system.number(self.relative_std)


@dataclass(frozen=True)
class MeasuredRadii:
    """Radii read from a file: {(i, j): δr/r}, exact."""

    rho: Mapping[tuple[int, int], Fraction]
    width: int | None

    @cached_property  # a plan asks for it again and again
    def relative_std(self) -> Fraction:
        """The root of the measured mean square of δr/r, to 15 digits; 0 only if all are 0."""
        values = [v for v in self.rho.values() if v]
        if not values:
            return Fraction(0)
        largest = max(map(abs, values))
        square = math.fsum(float(v / largest) ** 2 for v in values) / len(self.rho)
        return largest * Fraction(math.sqrt(square))

    @cached_property
    def mean(self) -> float:
        """Mean of δr/r."""
        return math.fsum(map(float, self.rho.values())) / max(len(self.rho), 1)

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Look the radii up; a bead that the file lacks raises ``RadiusError``."""
        values = []
        for i, j in zip(*(site.tolist() for site in rows.sites), strict=True):
            site = (i if self.width is None else i % (2 * self.width), j)
            if site not in self.rho:
                raise RadiusError(site, "the radii file has no line for it")
            values.append(self.rho[site])
        return system.array(values)[None][[0] * len(realisations)]


@dataclass(frozen=True, eq=False)
class ArrayRadii:
    """Radii in an array, (packings, layers, W), each double taken as the exact number that it is.

    ``origin``: what is subtracted, r where the radii themselves are given, 0 where δr is;
    ``radius``: r, in the same unit.
    """

    values: Array
    origin: Fraction
    radius: Fraction

    @cached_property
    def relative_std(self) -> Fraction:
        """The root of the mean square of δr/r; 0 only if all are 0."""
        deltas = self.values - float(self.origin)
        deltas /= float(self.radius)
        largest = float(max(deltas.max(initial=0), -deltas.min(initial=0)))
        if not largest:
            return Fraction(0)
        deltas /= largest
        deltas *= deltas
        return Fraction(largest) * Fraction(float(np.sqrt(deltas.mean())))

    @cached_property
    def mean(self) -> float:
        """Mean of δr/r."""
        return float(self.values.mean() - float(self.origin)) / float(self.radius)

    def of(self, rows: Rows, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Look the radii up."""
        values = self.values[np.asarray(realisations)]
        if rows.alike == self.values.shape[-1]:
            layers = slice(rows.lowest, rows.lowest + len(rows))
            values = values[:, layers].reshape(len(values), -1)
        else:
            i, j = rows.sites
            values = values[:, j, (i - j % 2) // 2 % values.shape[-1]]
        origin, radius = system.number(self.origin), system.number(self.radius)
        deltas = system.zeros(*values.shape)
        for at in range(0, values.shape[-1], AT_ONCE):
            part = (..., slice(at, at + AT_ONCE))
            deltas[part] = (system.from_floats(values[part]) - origin) / radius
        return deltas
