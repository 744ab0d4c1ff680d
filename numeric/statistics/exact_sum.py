"""Exact sums of float64 numbers and of their products: arrays of fixed-point numbers without end.

A double is an integer times a power of two, and so are sums and products of doubles. They are held
as digits in base 2^22 on one fixed grid, so that adding is exact, associative and commutative: in
whatever order and grouping numbers come, the sum is the same to the bit. Doubles are cut into such
digits as arrays; a digit is small enough for float64 to add thousands of products without rounding.
"""

import math
import struct
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from ..arithmetic.systems import Array

BITS = 22
_HALF = 1 << (BITS - 1)
# 2^11 products of digits (at most 2^21 each) stay within the 2^53 that float64 holds exactly.
_TOGETHER = 1 << (53 - 2 * (BITS - 1))
# Numbers cut at once: few enough for a cache, and for memory that stays at hand.
PIECE = 15_000
# Numbers beyond 2^±400 are cut after a shift by so many digits: nothing then under- or overflows.
_EXTREME, _SHIFT = 400, 34
_HEADER = struct.Struct("<iI")

Digits = list[tuple[int, Array]]


def digits(values: Array) -> Digits:
    """Cut doubles: pairs (k, q), q whole, |q| ≤ 2^21, with values = Σ q 2^(22 k), exactly.

    Raises ``ArithmeticError`` for what is not finite.
    """
    size = np.abs(values)
    largest = float(size.max(initial=0.0))
    if not largest < math.inf:  # a nan is not, either
        raise ArithmeticError("a change is not finite")
    smallest = float(size.min(initial=math.inf))
    if smallest < 2.0**-_EXTREME:  # zeros are no trouble
        smallest = float(size.min(where=size > 0, initial=math.inf))
    if smallest >= 2.0**-_EXTREME and largest < 2.0**_EXTREME:
        return _cut(values, largest)
    found: Digits = []
    small, large = size < 2.0**-_EXTREME, size >= 2.0**_EXTREME
    for where, shift in ((small, -_SHIFT), (large, _SHIFT), (~(small | large), 0)):
        part = np.where(where, values, 0.0) * 2.0 ** (-BITS * shift)
        most = float(np.abs(part).max(initial=0.0))
        found += [(k + shift, q) for k, q in _cut(part, most)]
    return found


def _cut(values: Array, largest: float) -> Digits:
    found: Digits = []
    if not largest:
        return found
    k = -((BITS - 1 - math.frexp(largest)[1]) // BITS)  # largest < 2^(22 k + 21)
    rest, part = values.astype(np.float64), np.empty(values.shape)
    while True:
        weight = math.ldexp(1.0, BITS * k)
        q = np.rint(np.multiply(rest, 1 / weight, out=part))
        found.append((k, q))
        rest -= np.multiply(q, weight, out=part)
        if not rest.any():
            return found
        k -= 1


@dataclass(frozen=True, eq=False)
class ExactSum:
    """An array of exact numbers Σ_k limbs[k] 2^(22 (low + k)); limbs int64, (digits, *shape).

    Digits lie in [−2^21, 2^21) and no outer plane is all zero: equal numbers have equal bytes.
    """

    low: int
    limbs: Array

    @classmethod
    def zero(cls, *shape: int) -> "ExactSum":
        """Zeros."""
        return cls(0, np.zeros((0, *shape), dtype=np.int64))

    @classmethod
    def of(cls, planes: Iterable[tuple[int, Array]], shape: tuple[int, ...]) -> "ExactSum":
        """Add planes (k, whole numbers): their sum at any k must stay below 2^62."""
        gathered: dict[int, Array] = {}
        for k, plane in planes:
            whole = plane.astype(np.int64)
            gathered[k] = gathered[k] + whole if k in gathered else whole
        if not gathered:
            return cls.zero(*shape)
        low, high = min(gathered), max(gathered)
        limbs = np.zeros((high - low + 4, *shape), dtype=np.int64)  # three take any carry
        for k, plane in gathered.items():
            limbs[k - low] = plane
        return cls._canonical(low, limbs)

    @classmethod
    def _canonical(cls, low: int, limbs: Array) -> "ExactSum":
        lower = limbs[:-1]
        while (carry := (lower + _HALF) >> BITS).any():  # by all digits at once, twice or so
            lower -= carry << BITS
            limbs[1:] += carry
        used = np.flatnonzero(limbs.any(axis=tuple(range(1, limbs.ndim))))
        if not len(used):
            return cls(0, limbs[:0])
        return cls(low + int(used[0]), limbs[used[0] : used[-1] + 1])

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the array of numbers."""
        return self.limbs.shape[1:]

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, ExactSum)
            and self.low == other.low
            and np.array_equal(self.limbs, other.limbs)
        )

    __hash__ = None  # type: ignore[assignment]

    def __add__(self, other: "ExactSum") -> "ExactSum":
        """Add, number by number."""
        both = [one for one in (self, other) if len(one.limbs)]
        if len(both) < 2:
            return both[0] if both else self
        low = min(one.low for one in both)
        high = max(one.low + len(one.limbs) for one in both)
        limbs = np.zeros((high - low + 1, *self.shape), dtype=np.int64)  # one takes the carry
        for one in both:
            limbs[one.low - low : one.low - low + len(one.limbs)] += one.limbs
        return ExactSum._canonical(low, limbs)

    def reshaped(self, *shape: int) -> "ExactSum":
        """Give the same numbers in another shape."""
        return ExactSum(self.low, self.limbs.reshape(len(self.limbs), *shape))

    def over(self, axis: int) -> "ExactSum":
        """Add all numbers along an axis."""
        summed = self.limbs.sum(axis=axis + 1)
        return ExactSum.of(
            [(self.low + k, limb) for k, limb in enumerate(summed)], summed.shape[1:]
        )

    def rounded(self, shift: int = 0) -> Array:
        """Give float64 numbers times 2^shift, within one unit in the last place.

        The same for the same exact number, wherever it comes from.
        """
        total = np.zeros(self.shape)
        for k, limb in enumerate(self.limbs):
            total += np.ldexp(limb.astype(np.float64), BITS * (self.low + k) + shift)
        return total

    def integers(self) -> tuple[Array, int]:
        """Give whole numbers (Python's) and the power of two that they are times."""
        whole = np.zeros(self.shape, dtype=object)
        for limb in self.limbs[::-1]:
            whole = (whole << BITS) + limb.astype(object)
        return np.asarray(whole, dtype=object), BITS * self.low

    def fractions(self) -> list[Fraction]:
        """Give the exact numbers, flattened."""
        whole, exponent = self.integers()
        unit = Fraction(2) ** exponent
        return [int(number) * unit for number in whole.reshape(-1)]

    def to_bytes(self) -> bytes:
        """Write as bytes: low, number of digits, digits (int32, little-endian)."""
        return _HEADER.pack(self.low, len(self.limbs)) + self.limbs.astype("<i4").tobytes()

    @classmethod
    def from_bytes(cls, content: memoryview, shape: tuple[int, ...]) -> tuple["ExactSum", int]:
        """Read what ``to_bytes`` wrote; give also how many bytes it took. Raises ``ValueError``."""
        if len(content) < _HEADER.size:
            raise ValueError("a sum ends early")
        low, count = _HEADER.unpack_from(content)
        numbers = count * math.prod(shape)
        end = _HEADER.size + 4 * numbers
        if abs(low) > 1000 or count > 1000 or len(content) < end:
            raise ValueError("a sum ends early")
        read = np.frombuffer(content[_HEADER.size : end], dtype="<i4").astype(np.int64)
        limbs = read.reshape((count, *shape))
        if ((limbs < -_HALF) | (limbs >= _HALF)).any():
            raise ValueError("a sum has digits that are none")
        return cls(low, limbs), end


def total(cut: Digits, shape: tuple[int, ...]) -> ExactSum:
    """Sum numbers along their last axis; ``shape`` is that of the result."""
    return ExactSum.of([(k, q.sum(axis=-1)) for k, q in cut], shape)


def _products(a: Digits, b: Digits, part: slice) -> Iterator[tuple[int, Array]]:
    """Sum products over a part of the last axis, of at most 2^11 numbers: pairs (k, sums)."""
    same = a is b
    for m, (k, p) in enumerate(a):
        for other, q in b[m if same else 0 :]:
            product = np.vecdot(p[..., part], q[..., part]).astype(np.int64)
            yield k + other, product if q is p or not same else 2 * product


def total_products(a: Digits, b: Digits, shape: tuple[int, ...]) -> ExactSum:
    """Sum products of two arrays along their last axis; ``shape`` is that of the result."""
    summed = ExactSum.zero(*shape)
    for at in range(0, a[0][1].shape[-1] if a and b else 0, _TOGETHER):
        summed = summed + ExactSum.of(_products(a, b, slice(at, at + _TOGETHER)), shape)
    return summed


def rows_and_squares(values: Array) -> tuple[ExactSum, ExactSum]:
    """Sum the numbers of each row, and their squares: (rows, numbers) → twice (rows,)."""
    rows, numbers = values.shape
    first = second = ExactSum.zero(rows)
    for at in range(0, numbers, _TOGETHER):
        sums: dict[int, Array] = {}
        squares: dict[int, Array] = {}
        step = max(1, PIECE // min(numbers, _TOGETHER))
        for row in range(0, rows, step):
            part = slice(row, row + step)
            cut = digits(values[part, at : at + _TOGETHER])
            for k, q in cut:
                _put(sums, k, rows, part, q.sum(axis=-1).astype(np.int64))
            for k, plane in _products(cut, cut, slice(None)):
                _put(squares, k, rows, part, plane)
        first = first + ExactSum.of(sums.items(), (rows,))
        second = second + ExactSum.of(squares.items(), (rows,))
    return first, second


def _put(planes: dict[int, Array], k: int, rows: int, part: slice, plane: Array) -> None:
    if k not in planes:
        planes[k] = np.zeros(rows, dtype=np.int64)
    planes[k][part] += plane


def total_matrix(cut: Digits, size: int) -> ExactSum:
    """Sum x_a x_b over the last axis of an array (size, …), for all a ≤ b, row after row."""
    row, column = np.triu_indices(size)
    here, there = row * size + column, column * size + row
    summed = ExactSum.zero(len(here))
    for at in range(0, cut[0][1].shape[-1] if cut else 0, _TOGETHER):
        part = slice(at, at + _TOGETHER)
        planes = []
        for m, (k, p) in enumerate(cut):
            for other, q in cut[m:]:
                product = (p[:, part] @ q[:, part].T).reshape(-1)
                plane = product[here].astype(np.int64)
                if q is not p:
                    plane += product[there].astype(np.int64)
                planes.append((k + other, plane))
        summed = summed + ExactSum.of(planes, summed.shape)
    return summed
