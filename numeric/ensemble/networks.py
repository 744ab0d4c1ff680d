"""Sums of packings whose contacts are unilateral: kept packing by packing, since each takes long.

The samples of a group, the contacts of a layer for instance, differ in number from packing to
packing. Kept of each are their number, their sum and that of their squares, as float64.
"""

import struct
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..arithmetic.errors import UndecidedError
from ..arithmetic.systems import Array, Balls
from ..mechanics.work import Work
from ..unilateral.network import Network, Relaxed
from .measure import Measurement

_COUNTS = struct.Struct("<2q")
# Bits with which a packing is proved, one after the other until it is.
BITS = (64, 128, 256)


@dataclass(frozen=True, eq=False)
class NetworkSums:
    """Sums over N packings of G groups, in the order of the packings' numbers.

    ``numbers`` (N,); ``samples`` (N, 3, G): how many, their sum less that of ordered forces, and
    the sum of its squares; ``bins`` (N, B + 2): counts below, in and above the bins. ``unfinished``
    are the numbers of packings more, whose beads did not come to rest, or can't.
    """

    numbers: Array
    samples: Array
    bins: Array
    unfinished: Array

    @property
    def realisations(self) -> int:
        """N."""
        return len(self.numbers)

    @property
    def unbuildable(self) -> int:
        """How many were left out."""
        return len(self.unfinished)

    @property
    def first_unbuildable(self) -> int:
        """The lowest number of one that was left out, −1 where there is none."""
        return int(self.unfinished[0]) if len(self.unfinished) else -1

    @property
    def tried(self) -> int:
        """Packings that were summed up or left out."""
        return self.realisations + self.unbuildable

    def __add__(self, other: "NetworkSums") -> "NetworkSums":
        """Merge the sums of other realisations."""
        numbers = np.concatenate([self.numbers, other.numbers])
        order = np.argsort(numbers)
        return NetworkSums(
            numbers[order],
            np.concatenate([self.samples, other.samples])[order],
            np.concatenate([self.bins, other.bins])[order],
            np.sort(np.concatenate([self.unfinished, other.unfinished])),
        )

    def to_bytes(self) -> bytes:
        """Write as bytes; equal sums give equal bytes."""
        whole = (self.numbers, self.bins, self.unfinished)
        parts = [one.astype("<i8").tobytes() for one in whole]
        head = _COUNTS.pack(self.realisations, self.unbuildable)
        return b"".join([head, *parts, self.samples.astype("<f8").tobytes()])


def none(m: Measurement) -> NetworkSums:
    """Give the sums of no realisation."""
    nothing = np.zeros(0, np.int64)
    bins = np.zeros((0, _bins(m)), np.int64)
    return NetworkSums(nothing, np.zeros((0, 3, m.groups)), bins, nothing)


def _bins(m: Measurement) -> int:
    return len(m.edges) + 1 if m.edges else 0


def from_bytes(content: bytes, m: Measurement) -> NetworkSums:
    """Read what ``to_bytes`` wrote. Raises ``ValueError`` where it is nothing of the kind."""
    if len(content) < _COUNTS.size:
        raise ValueError("sums end early")
    N, left_out = _COUNTS.unpack_from(content)
    whole = N * (1 + _bins(m)) + left_out
    if N < 0 or left_out < 0 or len(content) != _COUNTS.size + 8 * (whole + 3 * N * m.groups):
        raise ValueError("sums are shorter or longer than they say")
    counts = np.frombuffer(content, "<i8", whole, _COUNTS.size).astype(np.int64)
    samples = np.frombuffer(content, "<f8", offset=_COUNTS.size + 8 * whole).astype(np.float64)
    numbers, unfinished = counts[:N], counts[N * (1 + _bins(m)) :]
    ordered = all(a < b for part in (numbers, unfinished) for a, b in pairwise(part.tolist()))
    if (counts < 0).any() or not ordered or not np.isfinite(samples).all():
        raise ValueError("sums are no numbers, or not of packings one after the other")
    bins = counts[N : N * (1 + _bins(m))].reshape(N, _bins(m))
    return NetworkSums(numbers, samples.reshape(N, 3, m.groups), bins, unfinished)


def left_out(m: Measurement, number: int) -> NetworkSums:
    """Give the sums of a realisation whose beads don't come to rest."""
    return replace(none(m), unfinished=np.array([number]))


def measured(m: Measurement, number: int) -> NetworkSums:
    """Solve one realisation; what the protocol raises is passed on."""
    from ..unilateral.relaxation import packings  # SciPy's solvers take 35 MB

    quantity, work = m.network, Work()
    for bits in BITS:
        system = Balls(bits)
        try:
            with system.active():
                ((solved, _),) = packings(m.problem, [number], system, work)
                assert isinstance(solved, Relaxed)
                samples = quantity.sums(m.problem, solved.network)
                return NetworkSums(
                    np.array([number]),
                    samples[None],
                    _counted(m, solved.network)[None],
                    np.zeros(0, np.int64),
                )
        except UndecidedError:
            if bits == BITS[-1]:
                raise
    raise AssertionError


def _counted(m: Measurement, network: Network) -> Array:
    if not m.edges:
        return np.zeros(0, np.int64)
    _, forces = m.network.samples(m.problem, network)
    places = np.searchsorted(np.array(m.edges), forces, side="right")
    return np.bincount(places, minlength=_bins(m))
