"""Printed equations read on a solved packing: every symbol is replaced by its number.

Sums are loops, braces are looked up, vectors are Cartesian. Of the package this takes only what the
nodes of an expression are called.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce
from operator import mul
from typing import Any

import sympy
from force_diffusion.symbolic import symbols as sy

from tests.properties.packing import (
    Contact, Number, Packing, Site, Vector, dot, minus, mp, plus, times,
)  # fmt: skip

Value = Any
"""A whole number, a number of mpmath's, or a vector of these."""


class AbsentError(LookupError):
    """The equation speaks of a bead or contact that the packing does not have."""


class NonsenseError(ValueError):
    """It adds a number to a vector, or divides by zero."""


SIDES = {"Plus": 0, "Minus": 1}
"""Base vectors n⁺ and n⁻, by how the names of a contact's quantities end."""


def steps_to(i: int, j: int) -> Site:
    """Whole steps along n⁺ and n⁻ that lead to the paper's bead (i, j)."""
    if (i + j) % 2:
        raise AbsentError(f"no bead is at ({i}, {j})")
    return (j + i) // 2, (j - i) // 2


def place(site: Site) -> tuple[int, int]:
    """The paper's (i, j) of a bead."""
    return site[0] - site[1], site[0] + site[1]


@dataclass(frozen=True, eq=False)
class Plane:
    """A packing of discs in the paper's symbols, with the forces that some loads bring.

    ``entering``: contact forces that are given in place of loads, by their contacts. ``given``:
    what the symbols of the loads stand for.
    """

    packing: Packing
    loads: Mapping[Site, Vector] = field(default_factory=dict)
    entering: Mapping[Contact, Number] = field(default_factory=dict)
    given: Mapping[sympy.Symbol, Value] = field(default_factory=dict)

    @cached_property
    def forces(self) -> dict[Contact, Number]:
        """Every contact force; a given one pushes the bead below it along the contact."""
        pushes = {
            contact[0]: times(-force, self.packing.direction(contact))
            for contact, force in self.entering.items()
        }
        return {**self.packing.forces({**self.loads, **pushes}), **self.entering}

    @cached_property
    def symbols(self) -> dict[sympy.Symbol, Value]:
        """Numbers of the symbols that say which packing this is."""
        base = self.packing.base
        general = {sy.phi: dot(base[0], base[1]), sy.r: self.packing.r, sy.M: self.packing.height}
        if len(base) > 2:
            return {**self.given, **general}
        n_plus, n_minus = base
        n_x, n_y = n_plus
        lengths = {sy.n_x: n_x, sy.n_y: n_y, sy.spacing: 4 * self.packing.r * n_x}
        units = {sy.n_plus: n_plus, sy.n_minus: n_minus, sy.e_y: (mp.mpf(0), mp.mpf(1))}
        right, rise = 1 / (2 * n_x), 1 / (2 * n_y)
        reciprocal = {sy.b_plus: (right, rise), sy.b_minus: (-right, rise)}
        return {**self.given, **general, **lengths, **units, **reciprocal}

    def quantity(self, name: str, i: int, j: int, origin: Site = (0, 0)) -> Value:
        """The value of δr_ij, f⁺_ij and so on, by the name of its function."""
        site = plus(steps_to(i, j), origin)
        kind = name.removesuffix("Plus").removesuffix("Minus")
        top = self.packing.height - (kind != name)  # contacts start below the surface
        if not 0 <= j <= top:
            raise AbsentError(f"{name} at ({i}, {j}) is outside of the packing")
        contact = self.packing.home(site), SIDES.get(name.removeprefix(kind), 0)
        match kind:
            case "DeltaR":
                return self.packing.radius(site) - self.packing.r
            case "Position":
                return self.packing.centre(site)
            case "DeltaX":
                return minus(self.packing.centre(site), self.packing.ordered(site))
            case "DeltaN":
                return minus(self.packing.direction(contact), self.packing.base[contact[1]])
            case "Force":
                return self.forces.get(contact, mp.mpf(0))
            case "Vertical":
                return self.packing.direction(contact)[-1] * self.forces.get(contact, mp.mpf(0))
            case "LoadForce":
                return self.loads.get(contact[0], (mp.mpf(0), mp.mpf(0)))
        raise NonsenseError(f"{name} is not a quantity of a packing")

    def along(self, axis: int, bead: Site, *, vertical: bool) -> Value:
        """The force that leads up along a base vector, counted from 1; or its share straight up."""
        if not 0 <= sum(bead) < self.packing.height:
            raise AbsentError(f"no contact leads up from {bead}")
        contact = self.packing.home(bead), axis - 1
        force = self.forces.get(contact, mp.mpf(0))
        if not vertical:
            return force
        return force * self.packing.direction(contact)[-1] / self.packing.base[0][-1]

    def read(
        self, expression: sympy.Basic, at: Mapping[sympy.Symbol, Value], origin: Site = (0, 0)
    ) -> Value:
        """The value of an expression, for these values of its indices and other symbols.

        Places are counted from the bead ``origin``, in steps.

        Raises:
            AbsentError: it speaks of a bead or contact that is not there.
            NonsenseError: it has no value.
        """
        return Reading(self, {**self.symbols, **at}, origin).value(expression)

    def rest(self, equation: sympy.Eq, at: Mapping[sympy.Symbol, Value]) -> Value:
        """The left-hand side less the right-hand side."""
        left, right = (self.read(side, at) for side in equation.args)
        return _sum([left, _product([-1, right])])


@dataclass(frozen=True)
class Reading:
    """What expressions are in a packing.

    Attributes:
        plane: a ``Plane``, or what has ``quantity`` or ``along``, too.
        symbols: what they stand for.
        origin: where places are counted from, in steps.
    """

    plane: Any
    symbols: Mapping[sympy.Symbol, Value]
    origin: Site = (0, 0)

    def value(self, expression: sympy.Basic) -> Value:
        match expression:
            case sympy.Integer():
                return int(expression)
            case sympy.Rational():
                return self.fraction(expression)
            case sympy.Symbol():
                return self.symbols[expression]
            case sympy.Add():
                return _sum([self.value(term) for term in expression.args])
            case sympy.Mul():
                return _product([self.value(factor) for factor in expression.args])
            case sympy.Pow():
                return _power(*map(self.value, expression.args))
            case sympy.Sum():
                (index, low, high) = expression.limits[0]
                layers = range(self.index(low), self.index(high) + 1)
                return _sum([self.having({index: m}).value(expression.function) for m in layers])
            case sy.SecondDifference():
                r, s = map(self.index, expression.args)
                before, here, after = (self.quantity("DeltaR", r + by, s) for by in (-2, 0, 2))
                return 2 * here - before - after
            case sy.SiteFunction():
                i, j = map(self.index, expression.args)
                return self.quantity(type(expression).__name__, i, j)
            case sy.ForceAlong():
                axis, *steps = map(self.index, expression.args)
                bead = plus(tuple(steps), self.origin)
                vertical = isinstance(expression, sy.VerticalAlong)
                return self.plane.along(axis, bead, vertical=vertical)
            case sy.MeanOver():
                quantity, count, *indices = expression.args
                moved = [
                    self.having({index: self.symbols[index] + 2 * n for index in indices})
                    for n in range(self.index(count))
                ]
                return _sum([neighbour.value(quantity) for neighbour in moved]) / len(moved)
            case sy.Braces():
                first, second, index, last = expression.args
                return self.value(first if self.index(index) <= self.index(last) else second)
            case sympy.Piecewise():
                return self.value(self.case(expression))
            case sy.Dot():
                u, v = map(self.value, expression.args)
                return dot(u, v)
            case sy.MatrixTimes():
                a, b, c, d, (x, y) = map(self.value, expression.args)
                return a * x + b * y, c * x + d * y
        raise NonsenseError(f"{expression} is not read here")

    def index(self, expression: sympy.Basic) -> int:
        value = self.value(expression)
        if value != int(value):
            raise AbsentError(f"{expression} is {value}, no whole number")
        return int(value)

    def case(self, cases: sympy.Piecewise) -> sympy.Expr:
        """The formula whose condition these indices meet."""
        whole = {symbol: value for symbol, value in self.symbols.items() if isinstance(value, int)}
        for formula, condition in cases.args:
            if condition.xreplace(whole) == sympy.true:
                return formula
        raise AbsentError("there is no formula for these indices")

    def quantity(self, name: str, i: int, j: int) -> Value:
        return self.plane.quantity(name, i, j, self.origin)

    def fraction(self, value: sympy.Rational) -> Value:
        return mp.mpf(value.p) / value.q

    def having(self, symbols: Mapping[sympy.Symbol, Value]) -> "Reading":
        return replace(self, symbols={**self.symbols, **symbols})


def _sum(parts: list[Value]) -> Value:
    """Numbers or vectors; the number zero goes with both."""
    vectors = [part for part in parts if isinstance(part, tuple)]
    if not vectors:
        return sum(parts)
    if any(part != 0 for part in parts if not isinstance(part, tuple)):
        raise NonsenseError("a number is added to a vector")
    return reduce(plus, vectors)


def _product(parts: list[Value]) -> Value:
    vectors = [part for part in parts if isinstance(part, tuple)]
    factor = reduce(mul, (part for part in parts if not isinstance(part, tuple)), 1)
    if len(vectors) > 1:
        raise NonsenseError("a product of two vectors")
    return times(factor, vectors[0]) if vectors else factor


def _power(base: Value, exponent: Value) -> Value:
    if base == 0 and exponent < 0:
        raise NonsenseError("a division by zero")
    return (mp.mpf(base) if isinstance(base, int) else base) ** exponent
