"""Moments of exact packings: expressions in means, variances and covariances, read at numbers.

One bead after the other is enlarged in a packing that is nothing but contacts and balances. What a
force, a direction or a displacement does at orders ε¹ and ε² gives its weights and the shift of its
mean, as fractions. Expressions are read as on packings of mpmath's numbers.
"""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache, reduce
from itertools import product
from operator import add, mul
from typing import Any

import sympy
from flint import fmpq
from force_diffusion.numeric.lattice.layers import whole
from force_diffusion.numeric.mechanics.sweep import deposit, sweep_down
from force_diffusion.symbolic import symbols as sy

from tests.numeric.mechanics import taylor
from tests.numeric.mechanics.taylor import exact
from tests.properties.reading import AbsentError, Reading
from tests.soundness.witnesses import dimensions

Direction = tuple[Fraction, Fraction]

DIRECTIONS = tuple(
    (Fraction(a, c), Fraction(b, c))
    for a, b, c in ((3, 4, 5), (4, 3, 5), (20, 21, 29), (21, 20, 29), (33, 56, 65), (48, 55, 73))
)
"""Rational base vectors (n_x, n_y) with ½ < n_x < √3/2, φ of either sign."""

Site = tuple[int, ...]
"""A bead: (i, j), or three numbers of steps."""

ZERO, ONE = fmpq(0), fmpq(1)


@dataclass(frozen=True)
class Value:
    """A number of a packing.

    Attributes:
        ordered: in the ordered packing.
        weights: how it changes with the radius of each bead, r = 1.
        shift: of its mean at order σ², σ = 1.
    """

    ordered: fmpq = ZERO
    weights: Mapping[Site, fmpq] = field(default_factory=dict)
    shift: fmpq = ZERO

    def __add__(self, other: "Value | fmpq | int") -> "Value":
        if not isinstance(other, Value):
            return replace(self, ordered=self.ordered + other)
        total = dict(self.weights)
        for site, weight in other.weights.items():
            total[site] = total.get(site, ZERO) + weight
        return Value(self.ordered + other.ordered, total, self.shift + other.shift)

    def __mul__(self, other: "Value | fmpq | int") -> "Value":
        if not isinstance(other, Value):
            return self.scaled(fmpq(other))
        shift = self.ordered * other.shift + other.ordered * self.shift + covariance(self, other)
        first = self.scaled(other.ordered) + other.scaled(self.ordered)
        return Value(self.ordered * other.ordered, first.weights, shift)

    __radd__, __rmul__ = __add__, __mul__

    def __truediv__(self, number: int) -> "Value":
        return self.scaled(fmpq(1, number))

    def __pow__(self, exponent: int) -> "Value":
        assert exponent > 0
        return reduce(mul, [self] * exponent)

    def scaled(self, factor: fmpq) -> "Value":
        """The same, times a number."""
        if not factor:
            return Value()
        weights = {site: weight * factor for site, weight in self.weights.items()}
        return Value(self.ordered * factor, weights, self.shift * factor)

    def at(self, *by: int) -> "Value":
        """The same of another place."""
        weights = {tuple(map(add, site, by)): w for site, w in self.weights.items()}
        return Value(self.ordered, weights, self.shift)


def covariance(first: Value, second: Value) -> fmpq:
    """Σ w w′ over all beads."""
    few, many = sorted((first.weights, second.weights), key=len)
    return sum((w * many[site] for site, w in few.items() if site in many), ZERO)


class Sums:
    """Quantities of a packing, added up from packings in which one bead is enlarged."""

    def __init__(self) -> None:
        self._ordered: dict[Any, fmpq] = {}
        self._weights: dict[Any, dict[Site, fmpq]] = defaultdict(dict)
        self._shift: dict[Any, fmpq] = defaultdict(fmpq)

    def add(self, key: Any, bead: Site, coefficients: Sequence[fmpq]) -> None:
        """What a quantity is with this bead enlarged: its coefficients of ε⁰, ε¹ and perhaps ε²."""
        self._ordered[key], slope, *curves = coefficients
        if slope:
            self._weights[key][bead] = slope
        for curve in curves:
            self._shift[key] += curve

    @property
    def values(self) -> dict[Any, Value]:
        return {
            key: Value(ordered, self._weights[key], self._shift[key])
            for key, ordered in self._ordered.items()
        }


_NAMES = {"+": "Plus", "-": "Minus"}


@cache
def below_many(
    height: int, n: Direction, load: str, ratio: Fraction, order: int
) -> Mapping[tuple[str, int], Value]:
    """Quantities by name and layer, of the bead or contact in column 0 (counted from there).

    Under a load −(n⁺ + ratio n⁻) on each bead of the surface, or on each above the base. One bead
    of each layer in turn is enlarged; by translation its effect on all contacts of a layer is that
    of all beads on one. The packing is so wide that nothing sees an image of itself.
    """
    width = 2 * height + 3
    loads = {
        (i, j): ((ratio - 1) * n[0], -(1 + ratio) * n[1])
        for j in (range(1, height + 1) if load == "bulk" else (height,))
        for i in range(j % 2, 2 * width, 2)
    }
    sums = Sums()
    for source in range(height + 1):
        rho = {(source % 2, source): Fraction(1)}
        solved = taylor.solve(width, height, n=n, rho=rho, loads=loads, order=order)
        for j in range(height + 1):
            for i in range(j % 2, 2 * width, 2):
                bead = (source % 2 - i + width) % (2 * width) - width, source
                for name, coefficients in _quantities(solved, i, j):
                    sums.add((name, j), bead, coefficients)
    return sums.values


def _quantities(solved: taylor.TaylorPacking, i: int, j: int) -> Iterator[tuple[str, list[fmpq]]]:
    for axis, coefficients in enumerate(solved.displacement(i, j)):
        yield f"DeltaX{axis}", coefficients
    if j < solved.height:
        for branch, name in _NAMES.items():
            yield f"Force{name}", solved.force(i, j, branch)
            for axis, coefficients in enumerate(solved.direction(i, j, branch)):
                yield f"DeltaN{name}{axis}", coefficients


@cache
def below_one(level: int, n: Direction, order: int) -> Mapping[tuple[str, Site], Value]:
    """Forces below a load −(n⁺ + n⁻) on bead (0, level), by name and place.

    Many equal loads share one packing, so far apart that none feels the bead that is enlarged below
    another; below each, it is another bead. At ``order`` 1 shifts of means are left out.
    """
    sums, apart = Sums(), 2 * level + 6
    for source in range(level + 1):
        reach = level - source + 2  # two more than how far a bead below the load can be felt
        offsets = [o for o in range(-reach, reach + 1) if (o + level - source) % 2 == 0]
        tops = [level % 2 + apart * place for place in range(len(offsets))]
        width = apart * len(offsets) // 2
        beads = {
            ((top + o) % (2 * width), source): Fraction(1)
            for top, o in zip(tops, offsets, strict=True)
        }
        loads = {(top, level): (Fraction(0), -2 * n[1]) for top in tops}
        solved = taylor.solve(width, level, n=n, rho=beads, loads=loads, order=order)
        for top, offset in zip(tops, offsets, strict=True):
            for j in range(level):
                for i in range(-(level - j), level - j + 1, 2):
                    for branch, name in _NAMES.items():
                        place = (top + i) % (2 * width), j, branch
                        sums.add((f"Force{name}", (i, j)), (offset, source), solved.force(*place))
    return sums.values


Numbers = Mapping[sympy.Symbol, Any]


@dataclass(frozen=True)
class Packing:
    """A packing of discs under a load, and what expressions are in it.

    Attributes:
        height: M, or l of a point load.
        n: rational (n_x, n_y); r = σ = 1.
        load: "surface", "bulk" or "point".
        ratio: t = L⁻/L⁺ of the load; L⁺ = 1 on each bead, so that f_load = m_g = 2n_y for t = 1.
        at: numbers of indices and of other symbols.
        order: 2 where shifts of means are asked for.
    """

    height: int
    n: Direction
    load: str
    ratio: Fraction = Fraction(1)
    at: Numbers = field(default_factory=dict)
    order: int = 2

    def symbols(self) -> dict[sympy.Symbol, Any]:
        """Numbers of the paper's symbols, and vectors."""
        n_x, n_y = map(exact, self.n)
        return {
            sy.n_x: n_x, sy.n_y: n_y, sy.phi: n_y**2 - n_x**2, sy.r: ONE, sy.sigma: ONE,
            sy.n_plus: (n_x, n_y), sy.n_minus: (-n_x, n_y), sy.e_y: (ZERO, ONE),
            sy.b_plus: (1 / (2 * n_x), 1 / (2 * n_y)), sy.b_minus: (-1 / (2 * n_x), 1 / (2 * n_y)),
            sy.f_load: 2 * n_y, sy.m_g: 2 * n_y, sy.L_plus: ONE, sy.t: exact(self.ratio),
            sy.M: self.height, sy.l: self.height, **self.at,
        }  # fmt: skip

    def moment(self, expression: sympy.Expr) -> fmpq:
        """The number that an expression in moments is.

        Raises:
            AbsentError: it names a bead or a contact that is not there.
        """
        return _Reading(self, exactly(self.symbols())).moment(expression)

    def quantity(self, name: str, i: int, j: int, axis: str = "") -> Value:
        """A force, a displacement or a direction by the name of its function, or a component."""
        if (i + j) % 2:
            raise AbsentError(f"no bead is at ({i}, {j})")
        if not 0 <= j <= self.height - (name not in ("DeltaX", "DeltaR")):
            raise AbsentError(f"{name} at ({i}, {j}) is outside of the packing")
        if name == "DeltaR":
            return Value(ZERO, {(i, j): ONE})
        if name.startswith("Force") and self.load == "point":
            across = int(self.symbols()[sy.k])
            value = below_one(self.height, self.n, self.order).get((name, (i - across, j)), Value())
            return value.at(across, 0)
        load = "surface" if self.load == "point" else self.load
        values = below_many(self.height, self.n, load, self.ratio, self.order)
        return values[name + axis, j].at(i, 0)


def exactly(symbols: Numbers) -> Numbers:
    """The same, with fractions for whole numbers."""
    return {symbol: n if isinstance(n, tuple) else fmpq(n) for symbol, n in symbols.items()}


class _Reading(Reading):
    """What expressions are in a packing, as ``Value`` or as a fraction."""

    def moment(self, expression: sympy.Basic) -> fmpq:
        match expression:
            case sy.Mean():
                return self._number(expression.args[0]).ordered
            case sy.Shift():
                return self._number(expression.args[0]).shift
            case sy.Variance() | sy.Covariance():
                numbers = [*map(self._number, expression.args)]
                return covariance(numbers[0], numbers[-1])
            case sympy.Add():
                return sum(map(self.moment, expression.args), ZERO)
            case sympy.Mul():
                return reduce(mul, map(self.moment, expression.args), ONE)
            case sympy.Pow():
                return self.moment(expression.base) ** int(expression.exp)
        return self._number(expression).ordered

    def _number(self, expression: sympy.Basic) -> Value:
        return Value() + self.value(expression)

    def fraction(self, value: sympy.Rational) -> fmpq:
        return exact(value)

    def quantity(self, name: str, i: int, j: int) -> Value | tuple[Value, Value]:
        packing = replace(self.plane, at=self.symbols)
        if name in ("DeltaX", "DeltaNPlus", "DeltaNMinus"):
            return packing.quantity(name, i, j, "0"), packing.quantity(name, i, j, "1")
        if name.startswith("Vertical"):
            branch = name.removeprefix("Vertical")
            turn = packing.quantity(f"DeltaN{branch}", i, j, "1")
            return (turn + exact(packing.n[1])) * packing.quantity(f"Force{branch}", i, j)
        return packing.quantity(name, i, j)


# packings of spheres


@cache
def spheres(
    height: int, phi: Fraction, load: str, ratios: tuple[Fraction, Fraction]
) -> Mapping[tuple[int, int], Value]:
    """Forces by base vector and layer, of the contact at bead (0, 0, 0) (counted from there).

    Under a load −(n¹ + ratios n² + … n³) on each sphere of the surface, or on each above the base;
    one sphere of each layer in turn is enlarged.
    """
    system, width = taylor.Series(1), 2 * height + 3
    sums = Sums()
    with system.active():
        region = whole(width**2, height, dimension=3)
        F = system.zeros(3, region.beads - width**2)
        for a, ratio in enumerate((Fraction(1), *ratios)):
            for j in range(1, height + 1):
                times = height - j + 1 if load == "bulk" else 1
                layer = slice((j - 1) * width**2, j * width**2)
                F[a, layer] = F[a, layer] + system.number(ratio * times)
        for source in range(height + 1):
            rho = system.zeros(1, region.beads)
            rho[0, source * width**2] = system.series([Fraction(0), Fraction(1)])
            packing = deposit(phi, region, rho, system)
            forces = sweep_down(packing, region.rows, F)
            for axis, upper in product(range(3), range(1, height + 1)):
                series = forces.ordered(axis, upper) + forces.change(axis, upper)[0]
                for place, force in enumerate(series):
                    x, y = divmod(place, width)  # of the upper one; the enlarged one is at (0, 0)
                    lower = [x, y, upper - x - y]
                    lower[axis] -= 1
                    there = (0, 0, source)
                    bead = tuple(a - b for a, b in zip(there, lower, strict=True))
                    steps = tuple((step + height + 1) % width - height - 1 for step in bead[:2])
                    enlarged = (*steps, source - (upper - 1) - sum(steps))
                    sums.add((axis + 1, upper - 1), enlarged, [force[0], force[1]])
    return sums.values


@dataclass(frozen=True)
class Spheres:
    """A packing of spheres under a load, and what expressions are in it.

    Attributes:
        height: M, or l of a point load on bead (0, 0, l).
        phi: of each two base vectors; r = σ = 1.
        load: "surface", "bulk" or "point".
        ratios: L²/L¹ and L³/L¹ of the load, L¹ = 1.
        at: numbers of indices and of other symbols.
    """

    height: int
    phi: Fraction
    load: str
    ratios: tuple[Fraction, Fraction] = (Fraction(1), Fraction(1))
    at: Numbers = field(default_factory=dict)

    def symbols(self) -> dict[sympy.Symbol, Any]:
        """Numbers of the paper's symbols."""
        second, third = map(exact, self.ratios)
        return {
            sy.phi: exact(self.phi), sy.r: ONE, sy.sigma: ONE, sy.t_2: second, sy.t_3: third,
            sy.M: self.height, sy.l: self.height, **self.at,
        }  # fmt: skip

    def moment(self, expression: sympy.Expr) -> fmpq:
        """The number that an expression in moments is.

        Raises:
            AbsentError: it names a contact that is not there.
        """
        return _Reading(self, exactly(self.symbols()), (0, 0, 0)).moment(expression)

    def along(self, axis: int, bead: Site, *, vertical: bool) -> Value:
        """A force along a base vector; with a point load over that of the ordered legs."""
        layer = sum(bead)
        if not 0 <= layer < self.height:
            raise AbsentError(f"no contact leads up from {bead}")
        if self.load != "point":
            assert not vertical
            return spheres(self.height, self.phi, self.load, self.ratios)[axis, layer].at(*bead)
        down = tuple(a - b for a, b in zip((0, 0, self.height), bead, strict=True))
        weights = dimensions.response_weights(
            3, self.height, self.phi, down, axis - 1, vertical=vertical
        )
        on_leg = min(down) >= 0 and sum(down) == down[axis - 1]
        return Value(fmpq(int(on_leg)), {at: exact(w) for at, w in weights.items() if w})
