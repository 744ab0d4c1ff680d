"""Whole equations, both sides, on an exact packing at orders ε⁰ and ε¹.

Every quantity of an equation is taken from the solved nonlinear packing; so this needs to know
nothing of how the equation was derived. It is what witnesses compare, and what refutes an
equation whose left-hand side is not what the derivation speaks of.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import isqrt
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy
from force_diffusion.symbolic.algebra import explicit
from force_diffusion.symbolic.kernel.decisions import (
    Ruling,
    Verdict,
    undecided,
)

from .draws import SmallPacking

Values = Mapping[sympy.Symbol, Fraction | int]


@dataclass(frozen=True)
class Dual:
    """a + bε, to first order."""

    value: Fraction
    slope: Fraction = Fraction(0)

    def __add__(self, other: "Dual") -> "Dual":
        return Dual(self.value + other.value, self.slope + other.slope)

    def __mul__(self, other: "Dual") -> "Dual":
        return Dual(self.value * other.value, self.value * other.slope + self.slope * other.value)

    def __pow__(self, power: int) -> "Dual":
        if power < 0:
            return Dual(1 / self.value, -self.slope / self.value**2) ** -power
        result = Dual(Fraction(1))
        for _ in range(power):
            result = result * self
        return result

    def __str__(self) -> str:
        return f"{self.value} + ({self.slope})ε"


Vector = tuple[Dual, Dual]


class AbsentError(ValueError):
    """The equation speaks of a bead or contact that this packing does not hold."""


class NoSiteError(AbsentError):
    """It speaks of one that no packing holds: i + j is odd, or no whole number."""


class ExactSolution:
    """Every lattice quantity of one packing, solved exactly under one set of loads."""

    def __init__(self, packing: SmallPacking, load: str):
        """Solve a packing; ``load`` is "none", "single" (one bead), "surface" or "tilted"."""
        from force_diffusion.numeric.mechanics import taylor

        self.packing = packing
        self.loads = {
            "none": {},
            "single": {packing.loaded: (Fraction(0), -packing.load)},
            "surface": packing.surface_load(),
            "tilted": packing.tilted_load(),
        }[load]
        self.solved = taylor.solve(
            packing.width, packing.height, n=packing.n, rho=packing.rho, loads=self.loads, order=1
        )
        self.values = explicit.geometry(*packing.n, Fraction(1))
        self.known: dict[frozenset[Any], dict[sympy.Expr, Dual | Vector]] = {}
        """What was evaluated, by the indices it was evaluated at."""

    def force(self, across: int, layer: int, branch: str) -> Dual:
        """Contact force with the lower bead (across, layer)."""
        return Dual(*self.solved.force(across, layer, branch))

    def quantity(self, kind: str, across: int, layer: int) -> Dual | Vector:
        """Value of a site function, named as its class in ``symbolic.symbols``."""
        none = Fraction(0)
        if kind == "DeltaR":
            site = (across % (2 * self.packing.width), layer)
            return Dual(none, self.packing.rho.get(site, none))
        if kind == "DeltaX":
            x, y = self.solved.displacement(across, layer)
        elif kind in ("DeltaNPlus", "DeltaNMinus"):
            x, y = self.solved.direction(across, layer, "+" if kind == "DeltaNPlus" else "-")
        elif kind in ("ForcePlus", "ForceMinus"):
            return self.force(across, layer, "+" if kind == "ForcePlus" else "-")
        elif kind == "Load":
            return Dual(none), Dual(self.loads.get((across, layer), (none, none))[1])
        else:
            assert kind == "Position"
            x, y = ([c, none] for c in self._ordered(across, layer))
        return Dual(x[0], x[1]), Dual(y[0], y[1])

    def _ordered(self, across: int, layer: int) -> tuple[Fraction, Fraction]:
        """Lay equal beads by circle intersection: in the middle of two, as high as both reach."""
        self.solved.displacement(across, layer)  # refuses what is no site
        if not layer:
            return 2 * self.packing.n[0] * across, Fraction(0)
        left, right = (self._ordered(across + side, layer - 1) for side in (-1, 1))
        half = (right[0] - left[0]) / 2
        square = 4 - half * half
        rise = Fraction(isqrt(square.numerator), isqrt(square.denominator))
        assert rise * rise == square
        return left[0] + half, left[1] + rise


def evaluate(expression: sympy.Expr, solution: ExactSolution, at: Values) -> Dual | Vector:
    """Value of a scalar, or Cartesian components of a vector, on a solved packing.

    Raises:
        AbsentError: for a site off the lattice or outside of the packing.
        explicit.AmbiguousError: for what has no single value.
    """
    known = solution.known.setdefault(frozenset(at.items()), {})
    found = known.get(expression)
    if found is None:
        found = known[expression] = _evaluate(expression, solution, at)
    return found


def _evaluate(expression: sympy.Expr, solution: ExactSolution, at: Values) -> Dual | Vector:
    values = {**solution.values, **at}
    if isinstance(expression, sympy.Symbol) and expression in sy.VECTORS:
        components = explicit.vector_weights(expression, values)
        x, y = (Dual(weights.get(("", 0, 0), Fraction(0))) for weights in components)
        return x, y
    if isinstance(expression, sy.SecondDifference):
        return evaluate(expression.doit(), solution, at)
    if isinstance(expression, sy.SiteFunction):
        across, layer = (explicit.number(index, values) for index in expression.args)
        return _quantity(type(expression).__name__, across, layer, solution)
    if isinstance(expression, sympy.Add):
        return _total(*(evaluate(term, solution, at) for term in expression.args))
    if isinstance(expression, sympy.Mul):
        return _product(*(evaluate(factor, solution, at) for factor in expression.args))
    if isinstance(expression, sympy.Pow) and expression.atoms(sy.SiteFunction, sy.Dot):
        base = evaluate(expression.base, solution, at)
        if isinstance(base, tuple) or (base.value == 0 and expression.exp.is_negative):
            raise explicit.DivisionError(f"{expression} has no value")
        return base ** int(expression.exp)
    if isinstance(expression, sympy.Sum):
        *inner, (index, low, high) = expression.limits
        body = sympy.Sum(expression.function, *inner) if inner else expression.function
        bounds = (explicit.number(bound, values) for bound in (low, high))
        terms = [
            evaluate(body, solution, {**at, index: value}) for value in explicit.terms_of(*bounds)
        ]
        return _total(*terms)
    if isinstance(expression, sy.Dot):
        u, v = (evaluate(argument, solution, at) for argument in expression.args)
        assert isinstance(u, tuple)
        assert isinstance(v, tuple)
        return u[0] * v[0] + u[1] * v[1]
    if isinstance(expression, sy.MatrixTimes):
        a, b, c, d = (Dual(explicit.number(entry, values)) for entry in expression.args[:4])
        vector = evaluate(expression.args[4], solution, at)
        assert isinstance(vector, tuple)
        return a * vector[0] + b * vector[1], c * vector[0] + d * vector[1]
    return Dual(explicit.number(expression, values))


def _quantity(kind: str, i: Fraction, j: Fraction, solution: ExactSolution) -> Dual | Vector:
    if i.denominator != 1 or (i + j) % 2:
        raise NoSiteError(f"({i}, {j}) is no site")
    if j < 0:
        raise AbsentError(f"({i}, {j}) is below the base")
    try:
        return solution.quantity(kind, int(i), int(j))
    except (ValueError, IndexError) as reason:
        raise AbsentError(str(reason)) from None


def _total(*parts: Dual | Vector) -> Dual | Vector:
    zero = Dual(Fraction(0))
    if any(isinstance(part, tuple) for part in parts):
        x, y = zero, zero
        for part in parts:
            if isinstance(part, tuple):
                x, y = x + part[0], y + part[1]
            elif part != zero:
                raise explicit.AmbiguousError("a number added to a vector")
        return x, y
    total = zero
    for part in parts:
        assert isinstance(part, Dual)
        total = total + part
    return total


def _product(*parts: Dual | Vector) -> Dual | Vector:
    scale = Dual(Fraction(1))
    vector: Vector | None = None
    for part in parts:
        if isinstance(part, Dual):
            scale = scale * part
        elif vector is not None:
            raise explicit.AmbiguousError("a product of two vectors")
        else:
            vector = part
    return scale if vector is None else (scale * vector[0], scale * vector[1])


Points = Callable[[SmallPacking], Iterator[Values]]
"""Values of an equation's indices on a packing, one mapping for each place to look at."""


def each_bead(packing: SmallPacking) -> Iterator[Values]:
    """Yield beads (i, j), j ≥ 1: the ones above the chosen contacts."""
    for across, layer in packing.contacts:
        yield {sy.i: across + 1, sy.j: layer + 1}


def each_contact(packing: SmallPacking) -> Iterator[Values]:
    """Yield lower beads (i, j) of the chosen contacts, with M and the load."""
    for across, layer in packing.contacts:
        yield {sy.i: across, sy.j: layer, sy.M: packing.height, sy.f_load: packing.load}


def each_tilted(packing: SmallPacking) -> Iterator[Values]:
    """Yield the same, with the components of the load that is not vertical."""
    plus, minus = packing.components
    for at in each_contact(packing):
        yield {**at, sy.L_plus: plus, sy.L_minus: minus, sy.t: minus / plus}


def loaded_bead(packing: SmallPacking) -> Iterator[Values]:
    """Yield the loaded bead (k, l)."""
    yield {sy.k: packing.loaded[0], sy.l: packing.loaded[1], sy.f_load: packing.load}


def left_edge(packing: SmallPacking) -> Iterator[Values]:
    """Yield beads (r, s) straight below the loaded one, which f⁺ alone enters."""
    across, layer = packing.loaded
    for depth in range(1, layer):
        yield {sy.site_r: across - depth, sy.site_s: layer - depth}


def straight_below(packing: SmallPacking) -> Iterator[Values]:
    """Yield contacts (i, j) straight below the loaded bead (k, l)."""
    across, layer = packing.loaded
    for depth in range(1, layer + 1):
        yield {sy.i: across - depth, sy.j: layer - depth, sy.k: across, sy.l: layer}


def inside_cone(packing: SmallPacking) -> Iterator[Values]:
    """Yield contacts (i, j) that a force entering along n⁺ reaches with one branch."""
    across, layer = packing.loaded
    for below in range(layer - 1):
        for count in range(1, layer - below):
            at = across - (layer - below) + 2 * count
            yield {sy.i: at, sy.j: below, sy.k: across, sy.l: layer, sy.n: count}


def compare(equation: sympy.Eq, packing: SmallPacking, load: str, points: Points) -> Ruling:
    """Agree when both sides are equal at every place, as fractions, at orders ε⁰ and ε¹."""
    solution = ExactSolution(packing, load)
    count = 0
    for at in points(packing):
        try:
            left, right = (evaluate(side, solution, at) for side in equation.args)
        except explicit.ReversedError:
            continue  # the equation has no one meaning there
        left, right = _beside(left, right), _beside(right, left)
        if left != right:
            where = ", ".join(f"{symbol} = {value}" for symbol, value in at.items())
            sides = " but ".join(
                ", ".join(map(str, side)) if isinstance(side, tuple) else str(side)
                for side in (left, right)
            )
            return Ruling(Verdict.DISAGREES, f"at {where}: {sides}")
        count += 1
    if not count:
        return undecided("there was nothing to compare")
    return Ruling(Verdict.AGREES, f"equal as fractions, {count} compared")


def _beside(side: Dual | Vector, other: Dual | Vector) -> Dual | Vector:
    """The number 0 beside a vector is the zero vector."""
    zero = Dual(Fraction(0))
    return (zero, zero) if side == zero and isinstance(other, tuple) else side
