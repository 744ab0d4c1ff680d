"""A small periodic strip solved bead by bead, for any kind of number; shares no code with ours.

Beads are kept by their site, 0 ≤ i < 2W; centres are found by circle intersection and forces by
Cramer's rule, in plain Cartesian components. With ``Dual`` numbers every quantity comes
with its exact first-order change, as fractions; with mpmath's numbers it is the nonlinear packing.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import flint

Site = tuple[int, int]
Pair = tuple[Any, Any]


def _exact(value: Any) -> flint.fmpq:
    if isinstance(value, Fraction):
        return flint.fmpq(value.numerator, value.denominator)
    return flint.fmpq(value)


@dataclass(frozen=True, eq=False)
class Dual:
    """a + bε with ε² = 0, rational."""

    a: flint.fmpq
    b: flint.fmpq

    @staticmethod
    def of(value: "Dual | Fraction | int") -> "Dual":
        return value if isinstance(value, Dual) else Dual(_exact(value), flint.fmpq(0))

    def __add__(self, other: Any) -> "Dual":
        other = Dual.of(other)
        return Dual(self.a + other.a, self.b + other.b)

    def __neg__(self) -> "Dual":
        return Dual(-self.a, -self.b)

    def __sub__(self, other: Any) -> "Dual":
        return self + -Dual.of(other)

    def __rsub__(self, other: Any) -> "Dual":
        return Dual.of(other) - self

    def __mul__(self, other: Any) -> "Dual":
        other = Dual.of(other)
        return Dual(self.a * other.a, self.a * other.b + self.b * other.a)

    def __truediv__(self, other: Any) -> "Dual":
        other = Dual.of(other)
        ratio = self.a / other.a
        return Dual(ratio, (self.b - ratio * other.b) / other.a)

    __radd__, __rmul__ = __add__, __mul__

    def sqrt(self) -> "Dual":
        """The root, whose value at ε = 0 has to be rational."""
        root = flint.fmpq(flint.fmpz(self.a.p).sqrtrem()[0], flint.fmpz(self.a.q).sqrtrem()[0])
        assert root * root == self.a
        return Dual(root, self.b / (2 * root))

    @property
    def parts(self) -> tuple[Fraction, Fraction]:
        """Value and slope."""
        a, b = (Fraction(int(x.p), int(x.q)) for x in (self.a, self.b))
        return a, b


@dataclass(frozen=True)
class Strip:
    """W beads a layer, layers 0 … M, base vectors (±n_x, n_y), mean radius r, loads on beads.

    ``radius(i, j)`` is for 0 ≤ i < 2W; ``sqrt`` is that of the numbers.
    """

    width: int
    height: int
    n: Pair
    radius: Callable[[int, int], Any]
    loads: Mapping[Site, Pair]
    sqrt: Callable[[Any], Any]
    r: Any = 1

    def sites(self, layer: int) -> range:
        return range(layer % 2, 2 * self.width, 2)

    def centre(self, i: int, j: int) -> Pair:
        """Where a bead is; those beyond the seam are a period away."""
        turns, home = divmod(i, 2 * self.width)
        x, y = self._centres[home, j]
        return x + self._period * turns, y

    @property
    def _period(self) -> Any:
        return 4 * self.width * self.r * self.n[0]

    def size(self, i: int, j: int) -> Any:
        return self.radius(i % (2 * self.width), j)

    def displacement(self, i: int, j: int) -> Pair:
        x, y = self.centre(i, j)
        return x - 2 * i * self.r * self.n[0], y - 2 * j * self.r * self.n[1]

    def direction(self, i: int, j: int, side: int) -> Pair:
        """The unit vector from bead (i, j) to bead (i + side, j + 1)."""
        (x, y), (u, v) = self.centre(i, j), self.centre(i + side, j + 1)
        apart = self.size(i, j) + self.size(i + side, j + 1)
        return (u - x) / apart, (v - y) / apart

    def turned(self, i: int, j: int, side: int) -> Pair:
        """How far the direction is from that of the ordered packing."""
        x, y = self.direction(i, j, side)
        return x - side * self.n[0], y - self.n[1]

    def force(self, i: int, j: int, side: int) -> Any:
        """Compressive force between beads (i, j) and (i + side, j + 1)."""
        return self._forces[i % (2 * self.width), j, side]

    @cached_property
    def _centres(self) -> dict[Site, Pair]:
        # adding 0·radius makes every number one of the radii's kind
        found: dict[Site, Pair] = {}
        for i in self.sites(0):
            none = self.radius(i, 0) * 0
            found[i, 0] = (none + 2 * i * self.r * self.n[0], none)
        for j in range(1, self.height + 1):
            for i in self.sites(j):
                ends = []
                for side in (-1, 1):
                    turns, home = divmod(i + side, 2 * self.width)
                    x, y = found[home, j - 1]
                    ends.append((x + self._period * turns, y))
                (ax, ay), (bx, by) = ends
                a = self.size(i, j) + self.size(i - 1, j - 1)
                b = self.size(i, j) + self.size(i + 1, j - 1)
                dx, dy = bx - ax, by - ay
                square = dx * dx + dy * dy
                along = (a * a - b * b + square) / (2 * square)
                up = self.sqrt(a * a / square - along * along)
                found[i, j] = (ax + along * dx - up * dy, ay + along * dy + up * dx)
        return found

    @cached_property
    def _forces(self) -> dict[tuple[int, int, int], Any]:
        found: dict[tuple[int, int, int], Any] = {}
        carried: dict[Site, Pair] = {}
        for j in range(self.height, 0, -1):
            for i in self.sites(j):
                fx, fy = carried.get((i, j), (0, 0))
                gx, gy = self.loads.get((i, j), (0, 0))
                fx, fy = fx + gx, fy + gy
                (px, py), (mx, my) = (
                    self.direction(i - 1, j - 1, 1),
                    self.direction(i + 1, j - 1, -1),
                )
                det = px * my - py * mx
                forces = ((mx * fy - my * fx) / det, (py * fx - px * fy) / det)
                for side, force, (nx, ny) in zip(
                    (1, -1), forces, ((px, py), (mx, my)), strict=True
                ):
                    below = ((i - side) % (2 * self.width), j - 1)
                    found[*below, side] = force
                    hx, hy = carried.get(below, (0, 0))
                    carried[below] = (hx - force * nx, hy - force * ny)
        return found


def first_order(
    width: int,
    height: int,
    n: tuple[Fraction, Fraction],
    rho: Mapping[Site, Fraction | int],
    loads: Mapping[Site, tuple[Fraction | int, Fraction | int]],
    r: Fraction | int = 1,
) -> Strip:
    """The strip with δr = ε ρ: every value has an exact first-order change."""
    mean = Dual.of(r)
    sizes = {site: Dual(mean.a, _exact(value)) for site, value in rho.items()}
    return Strip(
        width,
        height,
        (Dual.of(n[0]), Dual.of(n[1])),
        lambda i, j: sizes.get((i, j), mean),
        {site: (Dual.of(x), Dual.of(y)) for site, (x, y) in loads.items()},
        Dual.sqrt,
        mean,
    )
