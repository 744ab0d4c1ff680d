"""Where radii come from: drawn from a counter-based generator, or measured and read from a file.

A drawn radius is a pure function of (seed, realisation, i, j): the counter (column, layer) is put
through Philox under the key (seed, realisation), so that any region can be asked for alone, in any
order. A deviate is a double, and δr/r = relative_std × deviate is an exact rational: every number
system solves the very same packing.
"""

import math
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from ..arithmetic.decimals import short
from ..arithmetic.errors import ForceDiffusionError
from ..arithmetic.systems import Array, NumberSystem
from ..lattice.layers import Layer, Rows
from .compiled import OFFSET, drawn
from .normal import normal_deviates

# Rows with a radius below r/1000 are looked through bead by bead.
NEARLY = Fraction(999, 1000)


class RadiusError(ForceDiffusionError, ValueError):
    """A radius is missing or not positive; ``site`` names the bead."""

    def __init__(self, site: tuple[int, ...], reason: str) -> None:
        """Name the bead and what is wrong."""
        super().__init__(f"bead {site}: {reason}")
        self.site, self.reason = site, reason


class Radii(Protocol):
    """A source of δr/r for the beads of a row."""

    def row(self, layer: Layer, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Give δr/r; shape (count,) for one realisation, (realisations, count) for more."""

    def at(self, sites: Sequence[tuple[int, int]], realisation: int, system: NumberSystem) -> Any:
        """Give δr/r of single beads, the same as in their rows; shape (sites,)."""

    def relative_std(self) -> Fraction:
        """σ_δr/r: of the distribution, or as measured."""


class _Streams(threading.local):
    """A generator for each thread, which is set anew for each row: making one takes far longer."""

    def __init__(self) -> None:
        self._generator = np.random.Philox(key=0)
        self._counter, self._key = np.zeros(4, np.uint64), np.zeros(2, np.uint64)
        self._state = self._generator.state
        self._state["state"] = {"counter": self._counter, "key": self._key}

    def words(self, low: int, count: int, high: int, key: tuple[int, int]) -> Array:
        """Give ``philox`` of the counters (low, high) … (low + count − 1, high); (2, count)."""
        self._counter[:2] = low - 1, high  # NumPy steps it before each block of four words
        self._key[:] = key
        self._generator.state = self._state
        return np.asarray(self._generator.random_raw(4 * count).reshape(count, 4)[:, :2].T)


_streams = _Streams()


@dataclass(frozen=True)
class Monodisperse:
    """No disorder: δr = 0 everywhere."""

    def row(self, layer: Layer, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Zeros."""
        shape = (layer.count,) if len(realisations) == 1 else (len(realisations), layer.count)
        return system.zeros(*shape)

    def at(self, sites: Sequence[tuple[int, int]], realisation: int, system: NumberSystem) -> Any:
        """Zeros."""
        return system.zeros(len(sites))

    def relative_std(self) -> Fraction:
        """Zero."""
        return Fraction(0)


@dataclass(frozen=True)
class DrawnRadii:
    """Independent draws: ``kind`` "uniform", "normal" or "two-point", width of the packing."""

    kind: str
    std: Fraction
    seed: int
    width: int | None

    def relative_std(self) -> Fraction:
        """σ_δr/r of the distribution."""
        return self.std

    def deviates(self, layer: Layer, realisation: int) -> Array:
        """Give deviates of zero mean and unit variance; shape (count,), float64."""
        return np.asarray(self._drawn(layer, [realisation])[0])

    def _drawn(self, layer: Layer, realisations: Sequence[int]) -> Array:
        words = np.empty((2, len(realisations), layer.count), dtype=np.uint64)
        column = (layer.first - layer.j % 2) // 2
        at = 0
        while at < layer.count:  # up to where a periodic packing begins anew
            q = column + at if self.width is None else (column + at) % self.width
            n = layer.count - at if self.width is None else min(layer.count - at, self.width - q)
            for row, k in enumerate(realisations):
                key = (self.seed, k)
                words[:, row, at : at + n] = _streams.words(q + OFFSET, n, layer.j, key)
            at += n
        return self._deviates(*words)

    def _deviates(self, first: Array, second: Array) -> Array:
        if self.kind == "two-point":
            return np.asarray(np.where(first >> np.uint64(63), 1.0, -1.0))
        if self.kind == "uniform":
            odd = ((first >> np.uint64(11)) << np.uint64(1)).astype(np.int64) + 1 - 2**53
            return np.asarray(odd.astype(np.float64) * 2.0**-53 * np.sqrt(3.0))
        return normal_deviates(first, second)

    def row(self, layer: Layer, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Scale the deviates; a radius that is not positive raises ``RadiusError``."""
        deviates = self._drawn(layer, realisations)
        if deviates.size and self.std * Fraction(float(deviates.min())) < -NEARLY:
            for row in deviates:
                self._check_sites(row, [(i, layer.j) for i in layer.sites()])
        values = deviates[0] if len(deviates) == 1 else deviates
        return system.from_floats(values) * system.number(self.std)

    def at(self, sites: Sequence[tuple[int, int]], realisation: int, system: NumberSystem) -> Any:
        """Put all counters through Philox at once: a generator for each bead would be slow."""
        columns = ((i - j % 2) // 2 for i, j in sites)
        if self.width is not None:
            columns = (q % self.width for q in columns)
        low = np.fromiter((q + OFFSET for q in columns), np.uint64, len(sites))
        high = np.fromiter((j for _, j in sites), np.uint64, len(sites))
        deviates = self._deviates(*philox(low, high, (self.seed, realisation)))
        if deviates.size and deviates.min() * float(self.std) < -0.999:
            self._check_sites(deviates, sites)
        return system.from_floats(deviates) * system.number(self.std)

    def _check_sites(self, deviates: Array, sites: Sequence[tuple[int, int]]) -> None:
        for site, u in zip(sites, deviates, strict=True):
            if self.std * Fraction(float(u)) <= -1:
                shown = short(1 + self.std * Fraction(float(u)))
                raise RadiusError(site, f"the drawn radius is {shown} r, not positive")


@dataclass(frozen=True)
class MeasuredRadii:
    """Radii read from a file: {(i, j): δr/r}, exact."""

    rho: Mapping[tuple[int, int], Fraction]
    width: int | None

    def relative_std(self) -> Fraction:
        """Give the root of the measured mean square of δr/r, to 15 digits; 0 only if all are 0."""
        return self._relative_std

    @cached_property  # a plan asks for it again and again
    def _relative_std(self) -> Fraction:
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

    @cached_property
    def least(self) -> Fraction:
        """The smallest |δr|/r that is not 0; 0 if all are 0."""
        return min((abs(v) for v in self.rho.values() if v), default=Fraction(0))

    def row(self, layer: Layer, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Look the radii up; a bead that the file lacks raises ``RadiusError``."""
        one = self.at([(i, layer.j) for i in layer.sites()], 0, system)
        return one if len(realisations) == 1 else np.stack([one] * len(realisations))

    def at(self, sites: Sequence[tuple[int, int]], realisation: int, system: NumberSystem) -> Any:
        """Look single beads up."""
        values = []
        for i, j in sites:
            site = (i if self.width is None else i % (2 * self.width), j)
            if site not in self.rho:
                raise RadiusError(site, "the radii file has no line for it")
            values.append(self.rho[site])
        return system.array(values)


@dataclass(frozen=True, eq=False)
class ArrayRadii:
    """Radii in an array, (packings, layers, W), each double taken as the exact number that it is.

    ``origin``: what is subtracted, r where the radii themselves are given, 0 where δr is;
    ``radius``: r, in the same unit.
    """

    values: Array
    origin: Fraction
    radius: Fraction

    def relative_std(self) -> Fraction:
        """Give the root of the mean square of δr/r; 0 only if all are 0."""
        return self._relative_std

    @cached_property
    def _relative_std(self) -> Fraction:
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

    def row(self, layer: Layer, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Look the radii up."""
        rows = self.values[np.asarray(realisations), layer.j]
        columns = (np.arange(layer.first, layer.last + 2, 2) - layer.j % 2) // 2
        picked = rows[:, columns % self.values.shape[-1]]
        return self._deltas(picked[0] if len(realisations) == 1 else picked, system)

    def layers(self, count: int, realisations: Sequence[int], system: NumberSystem) -> Any:
        """Look whole layers up, the lowest ones; shape (realisations, beads)."""
        values = self.values[np.asarray(realisations), :count]
        return self._deltas(values.reshape(len(realisations), -1), system)

    def at(self, sites: Sequence[tuple[int, int]], realisation: int, system: NumberSystem) -> Any:
        """Look single beads up."""
        i, j = np.array(sites, dtype=np.int64).reshape(-1, 2).T
        columns = (i - j % 2) // 2 % self.values.shape[-1]
        return self._deltas(self.values[realisation, j, columns], system)

    def _deltas(self, values: Array, system: NumberSystem) -> Any:
        origin, radius = system.number(self.origin), system.number(self.radius)
        return (system.from_floats(values) - origin) / radius


def philox(low: Array, high: Array, key: tuple[int, int]) -> tuple[Array, Array]:
    """Give the first two words of Philox4x64-10 for each counter (low, high, 0, 0).

    The same words as NumPy's generator, which can only count upwards from one counter.
    """
    a, b = low, high
    c = d = np.zeros(len(low), dtype=np.uint64)
    for k in range(10):
        first, second = (
            np.uint64((word + k * weyl) % 2**64)
            for word, weyl in zip(key, (0x9E3779B97F4A7C15, 0xBB67AE8584CAA73B), strict=True)
        )
        a_high, a_low = _product(0xD2E7470EE14C6C93, a)
        c_high, c_low = _product(0xCA5A826395121157, c)
        a, b, c, d = c_high ^ b ^ first, c_low, a_high ^ d ^ second, a_low
    return a, b


def _product(factor: int, values: Array) -> tuple[Array, Array]:
    """Give the upper and lower 64 bits of products, from halves of 32 bits."""
    half, mask = np.uint64(32), np.uint64(2**32 - 1)
    f1, f0 = np.uint64(factor >> 32), np.uint64(factor & (2**32 - 1))
    v1, v0 = values >> half, values & mask
    middle = f1 * v0 + (f0 * v0 >> half)
    cross = f0 * v1 + (middle & mask)
    return f1 * v1 + (middle >> half) + (cross >> half), values * np.uint64(factor)


def beads_of(radii: Radii, layers: Rows, realisations: Sequence[int], system: NumberSystem) -> Any:
    """Give δr/r of beads that lie row after row, (realisations, beads)."""
    if isinstance(radii, ArrayRadii) and layers.are_whole(radii.values.shape[-1]):
        return radii.layers(len(layers), realisations, system)
    if isinstance(radii, DrawnRadii) and system.dtype is not object:
        deviates = drawn(radii.kind, radii.seed, radii.width, layers, realisations)
        if deviates is not None and float(radii.std) * deviates.min(initial=0) > -NEARLY:
            return system.from_floats(deviates) * system.number(radii.std)
    rows = [radii.row(layer, realisations, system) for layer in layers]
    found: Any = system.zeros(len(realisations), sum(layer.count for layer in layers))
    at = 0
    for layer, row in zip(layers, rows, strict=True):
        found[:, at : at + layer.count] = row
        at += layer.count
    return found
