"""Explicit packings in any dimension to first order, and values at which a statement is false.

A bead is named by d whole numbers, whose sum is its layer, and rests on d others. Displacements and
directions are given by their products with the base vectors; forces are balanced bead by bead.
"""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cache
from itertools import islice

import sympy

from .. import symbols as sy
from ..kernel.where import Where
from ..printing.text import text
from . import limits
from .points import Point, points

Bead = tuple[int, ...]
Form = Mapping[Bead, Fraction]
"""Weights of the radii."""

DIMENSIONS = (3, 2, 4)
COSINES = tuple(Fraction(*one) for one in ((1, 5), (-2, 9), (3, 7), (-1, 8)))
_POINTS, _HIGHEST = 24, 9
_OTHERS = {sy.sigma: Fraction(3, 7), sy.r: Fraction(7, 3), sy.t: Fraction(21, 55),
           sy.f_load: Fraction(11, 7), sy.m_g: Fraction(13, 5)}  # fmt: skip
RATIOS = (Fraction(2, 3), Fraction(7, 5), Fraction(3, 4))
"""L^a/L^1 of loads that lean, a = 2, 3, 4."""
Ordered = Callable[[int, Bead], int | Fraction]
"""The ordered force of the contact up along an axis from a bead."""


def _stepped(bead: Bead, axis: int, count: int = 1) -> Bead:
    return (*bead[:axis], bead[axis] + count, *bead[axis + 1 :])


def _sum(*parts: tuple[Fraction | int, Form]) -> Form:
    total: dict[Bead, Fraction] = defaultdict(Fraction)
    for factor, form in parts:
        for bead, weight in form.items():
            total[bead] += factor * weight
    return total


@dataclass
class Packing:
    """Radii 1 + δr on a flat base that does not move, with given ordered forces."""

    dimension: int
    cosine: Fraction
    ordered: Ordered
    _known: dict[tuple[str, int, int, Bead], Form] = field(default_factory=dict)

    def __post_init__(self) -> None:
        size = self.dimension
        gram = sympy.Matrix(size, size, lambda a, b: 1 if a == b else sympy.Rational(self.cosine))
        inverse = gram.inv()
        self._inverse = [
            [Fraction(int(x.p), int(x.q)) for x in inverse.row(a)] for a in range(size)
        ]

    def displacement(self, bead: Bead, along: int) -> Form:
        """n^b·δx: at the contact along b the distance grows as both radii do."""
        if sum(bead) <= 0:
            return {}
        key = ("x", along, 0, bead)
        if key not in self._known:
            below = _stepped(bead, along, -1)
            rests = (1, self.displacement(below, along))
            self._known[key] = _sum(rests, (1, {bead: Fraction(1)}), (1, {below: Fraction(1)}))
        return self._known[key]

    def tilt(self, bead: Bead, up: int, along: int) -> Form:
        """n^b·δn of the contact that leads up: separation over radii, both changed."""
        key = ("n", up, along, bead)
        if key not in self._known:
            above = _stepped(bead, up)
            half, turned = Fraction(1, 2), 1 if up == along else self.cosine
            self._known[key] = _sum(
                (half, self.displacement(above, along)),
                (-half, self.displacement(bead, along)),
                (-half * turned, {above: Fraction(1)}),
                (-half * turned, {bead: Fraction(1)}),
            )
        return self._known[key]

    def turned(self, bead: Bead, up: int, into: int) -> Form:
        """The part of δn along a base vector."""
        shares = self._inverse[into]
        return _sum(*((shares[b], self.tilt(bead, up, b)) for b in range(self.dimension)))

    def force(self, axis: int, bead: Bead, highest: int) -> Form:
        """Change of a contact's force: the bead above it is balanced, along the contact."""
        key = ("f", axis, highest, bead)
        if key not in self._known:
            above = _stepped(bead, axis)
            parts: list[tuple[int | Fraction, Form]] = []
            if sum(above) < highest:
                parts.append((1, self.force(axis, above, highest)))
            for c in range(self.dimension):
                below = _stepped(above, c, -1)
                if sum(above) < highest and (carried := self.ordered(c, above)):
                    parts.append((carried, self.turned(above, c, axis)))
                if carried := self.ordered(c, below):
                    parts.append((-carried, self.turned(below, c, axis)))
            self._known[key] = _sum(*parts)
        return self._known[key]


@cache
def _of_layer(dimension: int, cosine: Fraction, height: int, load: str) -> Packing:
    shares = (1, *RATIOS) if "leaning" in load else (1,) * dimension
    return Packing(
        dimension,
        cosine,
        lambda axis, bead: shares[axis] * (height - sum(bead) if "bulk" in load else 1),
    )


def _sums_of_ratios(dimension: int) -> dict[sympy.Symbol, sympy.Expr]:
    """τ₁ and τ₂."""
    return {
        symbol: sympy.Rational(sum((one**power for one in RATIOS[: dimension - 1]), Fraction(0)))
        for symbol, power in ((sy.tau_1, 1), (sy.tau_2, 2))
    }


@cache
def _below_load(cosine: Fraction, level: int) -> Packing:
    def on_leg(axis: int, bead: Bead) -> int:
        steps = _stepped(bead, 0, -level)
        return int(steps[axis] < 0 and steps.count(0) == 2)

    return Packing(3, cosine, on_leg)


def contact(
    one: sympy.Expr, at: Point, dimension: int, cosine: Fraction, load: str
) -> tuple[int, Form]:
    """A force over that with which it is compared: ordered, and its change."""
    numbers = [int(argument.xreplace(at)) for argument in one.args]
    if isinstance(one, sy.ForceOfLayer):
        (layer,), height = numbers, at[sy.M]
        if not 0 <= layer < height or "point" in load:
            raise ValueError("no such contact")
        packing = _of_layer(dimension, cosine, int(height), load)
        bead = (layer, *(0,) * (dimension - 1))
        carried = int(packing.ordered(0, bead))
        return 1, _sum((Fraction(1, carried), packing.force(0, bead, int(height))))
    level, axis = int(at[sy.l]), numbers[0] - 1
    if min(numbers[1:]) < 0 or sum(numbers[1:]) > level or "point" not in load:
        raise ValueError("no such contact")
    bead = (level - numbers[1], -numbers[2], -numbers[3])
    packing = _below_load(cosine, level)
    ordered, change = packing.ordered(axis, bead), packing.force(axis, bead, level)
    if isinstance(one, sy.PushBelow) and ordered:
        # upwards is along the sum of the base vectors, with which each has the product 1 + 2φ
        up = [(1 / (1 + 2 * cosine), packing.tilt(bead, axis, b)) for b in range(3)]
        change = _sum((1, change), *up)
    return int(ordered), change


def counterexample(statement: sympy.Eq, where: Where, at_most: int | None = None) -> str | None:
    """Words for values at which a statement is false; None where none is found."""
    if where.limit is not None:
        return _in_the_limit(statement, where)
    symbolic = where.dimension == sy.d
    for number, at in enumerate(islice(points(where), at_most or _POINTS)):
        if max(map(abs, at.values())) > _HIGHEST:
            continue
        dimension = DIMENSIONS[number % len(DIMENSIONS)] if symbolic else int(where.dimension)
        cosine = next(one for one in _turned(number) if one * dimension > -1)
        others = {s: sympy.Integer(7 + 2 * n) for n, s in enumerate(sy.INDICES) if s not in at}
        values = {**others, **{s: sympy.Rational(c) for s, c in _OTHERS.items()}}
        values |= {s: sympy.Integer(c) for s, c in at.items()}
        values |= {sy.phi: sympy.Rational(cosine), sy.d: sympy.Integer(dimension)}
        values |= _sums_of_ratios(dimension)
        sides = [_number(side, values, dimension, cosine, where) for side in statement.args]
        if not all(side.is_Rational for side in sides):
            if any(side.has(sympy.zoo, sympy.nan) for side in sides):
                return f"it has no value at {_words(at, dimension, cosine)}"
            return None
        if sides[0] != sides[1]:
            return f"at {_words(at, dimension, cosine)}: {sides[0]} and {sides[1]}"
    return None


def _turned(number: int) -> Iterator[Fraction]:
    yield from (COSINES[(number + one) % len(COSINES)] for one in range(len(COSINES)))


def _words(at: Point, dimension: int, cosine: Fraction) -> str:
    named = [f"{text(symbol)} = {value}" for symbol, value in at.items()]
    return ", ".join([f"d = {dimension}", *named, f"{text(sy.phi)} = {cosine}"])


def _number(
    side: sympy.Expr,
    values: Mapping[sympy.Symbol, sympy.Expr],
    dimension: int,
    cosine: Fraction,
    where: Where,
) -> sympy.Expr:
    load = where.loading.name if where.loading else ""

    def moment(one: sympy.Expr) -> sympy.Expr:
        forms, means = [], []
        for argument in one.args:
            held = list(argument.atoms(*sy.CONTACTS))
            names = {force: sympy.Dummy() for force in held}
            inside = argument.xreplace(names)
            known = [contact(force, dict(values), dimension, cosine, load) for force in held]
            image = {
                name: sympy.Integer(ordered)
                for name, (ordered, _) in zip(names.values(), known, strict=True)
            }
            means.append(inside.xreplace({**image, **values}))
            slopes = (
                sympy.diff(inside, name).xreplace({**image, **values}) for name in names.values()
            )
            forms.append(
                _sum(
                    *(
                        (Fraction(int(s.p), int(s.q)), form)
                        for s, (_, form) in zip(slopes, known, strict=True)
                    )
                )
            )
        if isinstance(one, sy.Mean):
            return means[0]
        total = sum((w * forms[-1].get(bead, 0) for bead, w in forms[0].items()), Fraction(0))
        return sympy.Rational(total) * (values[sy.sigma] / values[sy.r]) ** 2

    image = {one: moment(one) for one in side.atoms(sy.Moment)}
    if any(one.has(sympy.Sum) for one in (side, *image.values())):
        raise ValueError("sums are not evaluated")
    return side.xreplace(image).xreplace(dict(values))


def _in_the_limit(statement: sympy.Eq, where: Where) -> str | None:
    for one in (2, 3, 5) if where.dimension == sy.d else (int(where.dimension),):
        sides = (side.xreplace({sy.d: sympy.Integer(one)}) for side in statement.args)
        there = replace(where, dimension=one)
        if found := limits.counterexample(sympy.Eq(*sides, evaluate=False), there):
            return f"d = {one}, {found}"
    return None
