"""Linear forms in quantities on the lattice: SymPy expressions, read into weights on sites.

A form holds a number, and for each quantity (a radius, a component of a displacement) the weights
of its sites. Forces of single contacts stand for unknown numbers: a form may hold products of
them, and of one quantity. Vectors are two forms, their components n^±·v. Products are those of
dual numbers: what is of first order in both factors is dropped.

Indices across the packing are *straightened* while forms are read: with i = j − 2i′ a bead (i, j)
is i′ steps along n⁻ and j − i′ along n⁺ from the origin, and no condition "i + j is even" is left.
"""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, cached_property, lru_cache
from typing import Any, Self, TypeAlias

import sympy

from . import sets
from . import symbols as sy
from .algebra.bases import LINE_SUM
from .algebra.exact import FIELD, SITE, SOURCE, NotAStatementError, NotExactError, RationalFunction
from .notation import by_name
from .printing.text import text
from .sets import Set
from .signs import never_zero
from .weights import Weights

Factor: TypeAlias = sympy.Expr | str
"""The force of a contact by its place, or the name of a quantity with a weight for each site."""

Key = tuple[tuple[Factor, int], ...]
"""What weights are of: factors with their powers."""

NUMBER: Key = ()
"""What the part of a form that holds no quantity is filed under."""
RADII: Key = ((sy.DeltaR.__name__, 1),)
SHIFT: Key = (("second order", 1),)
"""What the shift of a mean is filed under."""

FORCES = (sy.ForcePlus, sy.ForceMinus)
VERTICAL = {
    sy.VerticalPlus: (sy.ForcePlus, sy.DeltaNPlus),
    sy.VerticalMinus: (sy.ForceMinus, sy.DeltaNMinus),
}
"""The vertical component of a contact's force: the force, and how the contact turns."""

_OF_ORDER_0 = tuple(kind.__name__ for kind in (sy.Position, sy.LoadForce))
_ACROSS = (sy.i, sy.k, sy.site_r, sy.p, sy.q)
"""Indices that lie across the packing, or may."""

_HIGHEST = 4  # power of a quantity

Image = Mapping[sympy.Symbol, sympy.Expr]


@lru_cache(maxsize=4096)
def _product(first: Key, second: Key) -> Key | None:
    """The key of a product; None where it is of second order.

    Raises:
        NotExactError: two quantities of order 0 are multiplied.
    """
    powers = dict(first)
    for factor, power in second:
        powers[factor] = powers.get(factor, 0) + power
    located = [name for key in (first, second) for name, _ in key if isinstance(name, str)]
    if len(located) > 1:
        if any(name.startswith(_OF_ORDER_0) for name in located):
            raise NotExactError("a product of two positions, or loads")
        return None
    return _in_order((f, p) for f, p in powers.items() if p)


def _in_order(factors: Iterable[tuple[Factor, int]]) -> Key:
    return tuple(sorted(factors, key=_written))


_written = cache(str)  # SymPy takes longer to write a place than to read it


@dataclass(frozen=True)
class Straightening:
    """Indices that are put in for others, so that forms that have to be even are.

    Attributes:
        image: what is put in: i = j − 2i for i + j, where the new i is ½(j − i).
        back: what the new indices are in terms of the old ones.
    """

    image: Image = field(default_factory=dict)
    back: Image = field(default_factory=dict)

    @classmethod
    def of(cls, even: Iterable[sympy.Expr]) -> Self:
        """For these forms.

        Raises:
            NotExactError: one of them is not even, and can't be made even.
        """
        image: dict[sympy.Symbol, sympy.Expr] = {}
        back: dict[sympy.Symbol, sympy.Expr] = {}
        for relation in even:
            factors, constant = sets.row(sympy.expand(relation.xreplace(image)))
            odd = [symbol for symbol, number in factors.items() if number % 2]
            free = (s for s in (*_ACROSS, *sy.INDICES) if s not in image and not s.is_positive)
            symbol = next((s for s in free if s in odd), None)
            if symbol is None:
                if odd or constant % 2:
                    raise NotExactError(f"{text(relation)} is not shown to be even")
                continue
            rest = sympy.Add(*(s for s in odd if s != symbol), constant % 2)
            value = {symbol: rest - 2 * symbol}
            image = {s: sympy.expand(old.xreplace(value)) for s, old in image.items()} | value
            back[symbol] = sympy.expand((rest.xreplace(back) - symbol) / 2)
        return cls(image, back)

    def relation(self, relation: sympy.Basic) -> sympy.Basic:
        """A relation with new indices put in."""
        if not isinstance(relation, sympy.core.relational.Relational):
            return relation
        return relation.func(*(side.xreplace(self.image) for side in relation.args), evaluate=False)


@dataclass(frozen=True)
class Form:
    """Weights by what they are of."""

    parts: Mapping[Key, Weights] = field(default_factory=dict)

    @classmethod
    def number(cls, value: RationalFunction) -> Self:
        """A number."""
        return cls({} if value.is_zero() else {NUMBER: Weights(((sets.EVERYTHING, value),))})

    def __add__(self, other: "Form") -> Self:
        parts = dict(self.parts)
        for key, weights in other.parts.items():
            parts[key] = parts[key] + weights if key in parts else weights
        return type(self)(parts)

    def __sub__(self, other: "Form") -> Self:
        return self + other.scaled(FIELD.constant(-1))

    def scaled(self, factor: RationalFunction) -> Self:
        """The same, times a number."""
        return self.mapped(lambda weights: weights.scaled(factor))

    def times(self, other: "Form") -> Self:
        """The product to first order."""
        parts: dict[Key, Weights] = {}
        for left, weights in self.parts.items():
            for right, others in other.parts.items():
                key = _product(left, right)
                if key is not None:
                    product = weights.times(others)
                    parts[key] = parts[key] + product if key in parts else product
        return type(self)(parts)

    def mapped(self, change: Callable[[Weights], Weights]) -> Self:
        """The same with its weights changed."""
        return type(self)({key: change(weights) for key, weights in self.parts.items()})

    def on(self, points: Set) -> Self:
        """The same on a set of indices, and 0 elsewhere."""
        return self.mapped(lambda weights: weights.on(points))

    def at(self, image: Image) -> Self:
        """The same at other indices."""
        return self.mapped(lambda weights: weights.at(image)).renamed(image)

    def renamed(self, image: Image) -> Self:
        """The same with other indices in the places of its forces."""
        total = type(self)()
        for key, weights in self.parts.items():
            moved = _in_order((_moved(factor, image), power) for factor, power in key)
            total = total + type(self)({moved: weights})
        return total

    def summed(self, index: sympy.Symbol) -> Self:
        """Σ over all values of an index."""
        return self.mapped(lambda weights: weights.summed(index))

    def without(self, *symbols: sympy.Symbol) -> Self:
        """The same in terms of other symbols, which give these."""
        return self.mapped(lambda weights: weights.without(*symbols))

    def merged(self) -> Self:
        """The same in few pieces, without what is 0."""
        merged = ((key, weights.merged()) for key, weights in self.parts.items())
        return type(self)({key: weights for key, weights in merged if weights.pieces})

    def is_zero(self) -> bool:
        """Whether nothing is left of it anywhere."""
        return all(weights.is_zero() for weights in self.parts.values())


def _moved(factor: Factor, image: Image) -> Factor:
    """A force at the place that other indices give."""
    if isinstance(factor, str):
        return factor
    return factor.func(*(sympy.expand(arg.xreplace(dict(image))) for arg in factor.args))


Vector = tuple[Form, Form]
Value = Form | Vector


@dataclass(frozen=True, eq=False)
class Known:
    """What a quantity of a bead is, by the bead's coordinates ``SOURCE``, on a set of beads."""

    points: Set
    value: tuple[Form, ...]


@lru_cache(maxsize=4096)
def _at(known: Known, site: tuple[sympy.Expr, ...]) -> tuple[Set, tuple[Form, ...]]:
    """What is known of the quantity at a bead with other coordinates."""
    image = dict(zip(SOURCE, site, strict=False))
    return sets.at(known.points, image), tuple(form.at(image) for form in known.value)


@dataclass(frozen=True, eq=False)
class Reader:
    """Reads expressions on a domain, and refuses what has no value, or no single one, there.

    Attributes:
        points: the domain, straightened.
        straight: which indices are put in for others.
        known: what quantities are, by their kind; the others stay as they are.
        kind: of the forms that are read.
        linear: whether a product of two quantities that depend on the radii is refused.
        summed: the indices of the sums around what is read.
        fixed: indices that stand for one value: no sum or mean is over them.
        acting: contact forces that are not zero.
    """

    points: Set
    straight: Straightening = Straightening()
    known: Mapping[type, Any] = field(default_factory=dict)
    kind: type[Form] = Form
    linear: bool = False
    summed: frozenset[sympy.Symbol] = frozenset()
    fixed: frozenset[sympy.Symbol] = frozenset()
    acting: tuple[sympy.Expr, ...] = ()

    def read(self, expression: sympy.Expr) -> Value:
        """A number as one form, a vector as two.

        Raises:
            NotAStatementError: it has no value, or no single one, somewhere on the domain.
            NotExactError: it is neither, is not linear, or holds what is not read.
        """
        if expression in LINE_SUM.vectors:
            first, second = LINE_SUM.vectors[expression]
            return self.kind.number(first), self.kind.number(second)
        if isinstance(expression, sy.SecondDifference):
            return self.read(expression.doit())
        if isinstance(expression, sy.SiteFunction):
            return self._quantity(expression)
        if isinstance(expression, sy.ForceAlong):
            return self._along(expression)
        if isinstance(expression, sympy.Add):
            return self._sum(expression.args)
        if isinstance(expression, sympy.Mul):
            return self._product(expression.args)
        if isinstance(expression, sympy.Sum):
            return self._series(expression)
        if isinstance(expression, sy.MeanOver):
            return self._average(*expression.args)
        if isinstance(expression, sympy.Pow) and expression.has(sy.SiteFunction, sympy.Sum):
            return self._power(*expression.args)
        if isinstance(expression, sy.Dot):
            return self._dot(*map(self.vector, expression.args))
        if isinstance(expression, sy.MatrixTimes):
            return self._matrix_times(*expression.args)
        if isinstance(expression, sy.Braces):
            return self._cases(*expression.args)
        return self.kind.number(self.scalar(expression))

    def number(self, expression: sympy.Expr) -> Form:
        """A number as a form."""
        value = self.read(expression)
        if isinstance(value, tuple):
            raise NotExactError(f"{text(expression)} is a vector")
        return value

    def vector(self, expression: sympy.Expr) -> Vector:
        """The components of a vector; the number 0 is the zero vector."""
        value = self.read(expression)
        if isinstance(value, tuple):
            return value
        if not value.parts:
            return self.kind(), self.kind()
        raise NotExactError(f"{text(expression)} is not a vector")

    def within(self, *relations: sympy.Basic) -> Self:
        """On the part of the domain where relations hold."""
        inside = sets.where(*map(self.straight.relation, relations))
        return replace(self, points=self.points & inside)

    def site(self, across: sympy.Expr, layer: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
        """The coordinates of a bead.

        Raises:
            NotAStatementError: none is there.
        """
        for coordinate in (across, layer):
            sets.check_written(coordinate)
        x, y = (
            sympy.expand(coordinate.xreplace(self.straight.image)) for coordinate in (across, layer)
        )
        beside = sympy.expand((y - x) / 2)
        if not is_whole(beside):
            beside = sympy.expand(beside.xreplace(self._fixed))
        if not is_whole(beside) or not is_whole(y):
            raise NotAStatementError(f"there may be no bead at ({text(across)}, {text(layer)})")
        above = sets.where(sympy.Ge(y, 0, evaluate=False))
        if not self.points.is_subset(above):
            raise NotAStatementError(f"({text(across)}, {text(layer)}) may lie below the base")
        return sympy.expand(y - beside), beside

    def scalar(self, expression: sympy.Expr) -> RationalFunction:
        """A number without quantities, whose divisors vanish nowhere."""
        for atom in expression.atoms(sympy.Pow):
            if atom.exp.is_negative and not atom.base.is_positive:
                base = FIELD.from_sympy(atom.base.xreplace(self.straight.image))
                if not never_zero(base, self.points):
                    raise NotAStatementError(f"the divisor {text(atom.base)} may be zero")
        return FIELD.from_sympy(expression.xreplace(self.straight.image))

    @cached_property
    def _fixed(self) -> Image:
        """Indices that equations of the domain fix."""
        values = sets.fixed(self.points).items()
        return {symbol: value.to_sympy() for symbol, value in values if symbol not in self.summed}

    def _quantity(self, quantity: sy.SiteFunction) -> Value:
        kind, site = type(quantity), self.site(*quantity.args)
        if getattr(sy, kind.__name__, None) is not kind:
            raise NotExactError(f"{text(quantity)} is not a quantity of a packing")
        if kind in VERTICAL:
            return self._vertical(kind, quantity)
        left, total = self.points, None
        for known in self.known.get(kind, ()):
            points, value = _at(known, site)
            inside = left & points
            if not inside.is_empty():
                there = tuple(part.on(inside).renamed(self._fixed) for part in value)
                total = there if total is None else tuple(map(Form.__add__, total, there))
                left = left - points
        if total is None:
            total = self._unknown(quantity, site)
        elif not left.is_empty():
            rest = (part.on(left) for part in self._unknown(quantity, site))
            total = tuple(map(Form.__add__, total, rest))
        return (total[0], total[1]) if quantity.is_vector else total[0]

    def _unknown(
        self, quantity: sy.SiteFunction, site: tuple[sympy.Expr, sympy.Expr]
    ) -> tuple[Form, ...]:
        """A quantity as it stands.

        Raises:
            NotExactError: it stands in a sum, or is needed to second order.
        """
        kind = type(quantity)
        if self.kind is not Form and kind is not sy.DeltaR:
            raise NotExactError(f"{text(quantity)} is not determined by the radii")
        if kind in FORCES:
            place = kind(*(sympy.expand(coordinate.xreplace(self._fixed)) for coordinate in site))
            if self.summed & place.free_symbols:
                raise NotExactError(f"{text(quantity)} in a sum is not known")
            one = Weights(((sets.EVERYTHING, FIELD.one),))
            return (self.kind({((place, 1),): one}),)
        here = (sympy.Eq(axis, at, evaluate=False) for axis, at in zip(SITE, site, strict=False))
        weights = Weights.of(*here)

        def named(axis: str) -> Form:
            return self.kind({((kind.__name__ + axis, 1),): weights})

        return (named("+"), named("-")) if quantity.is_vector else (named(""),)

    def _along(self, quantity: sy.ForceAlong) -> Form:
        """A contact's force in three dimensions."""
        axis, *place = quantity.args
        if type(quantity) not in self.known or axis not in (1, 2, 3):
            raise NotExactError(f"{text(quantity)} is not known")
        site = tuple(sympy.expand(coordinate.xreplace(self.straight.image)) for coordinate in place)
        above = sets.where(sympy.Ge(sympy.Add(*site), 0, evaluate=False))
        if not self.points.is_subset(above):
            raise NotAStatementError(f"the bead of {text(quantity)} may lie below the base")
        form: Form = _at(self.known[type(quantity)](int(axis) - 1), site)[1][0]
        return form

    def _vertical(self, kind: type[sy.SiteFunction], quantity: sy.SiteFunction) -> Form:
        """Force times vertical component of the contact's direction, n_y + e_y·δn."""
        force, turn = VERTICAL[kind]
        inside = replace(self, linear=False)
        tilted = inside.number(sy.n_y + sy.Dot(sy.e_y, turn(*quantity.args)))
        return tilted.times(inside.number(force(*quantity.args)))

    def _sum(self, terms: Iterable[sympy.Expr]) -> Value:
        values = [self.read(term) for term in terms]
        if not any(isinstance(value, tuple) for value in values):
            return sum(values, self.kind())
        total = self.kind(), self.kind()
        for value in values:
            if not isinstance(value, tuple):
                if value.parts:
                    raise NotAStatementError("a number is added to a vector")
                continue
            total = total[0] + value[0], total[1] + value[1]
        return total

    def _product(self, factors: Iterable[sympy.Expr]) -> Value:
        product, vector = self.kind.number(FIELD.one), None
        for value in map(self.read, factors):
            if not isinstance(value, tuple):
                self._refuse_squares(product, value)
                product = product.times(value)
            elif vector is None:
                vector = value
            else:
                raise NotExactError("a product of two vectors")
        if vector is None:
            return product
        for component in vector:
            self._refuse_squares(component, product)
        return vector[0].times(product), vector[1].times(product)

    def _refuse_squares(self, first: Form, second: Form) -> None:
        if self.linear and all({*form.parts} - {NUMBER} for form in (first, second)):
            raise NotExactError(
                "a product of two quantities that depend on the radii is not linear"
            )

    def _dot(self, left: Vector, right: Vector) -> Form:
        total = self.kind()
        for a, form in enumerate(left):
            for b, other in enumerate(right):
                self._refuse_squares(form, other)
                total = total + form.times(other).scaled(LINE_SUM.metric[0 if a == b else 1])
        return total

    def _matrix_times(self, *arguments: sympy.Expr) -> Vector:
        """A matrix of Cartesian components times a vector."""
        *entries, vector = arguments
        along = [self._dot(self.vector(axis), self.vector(vector)) for axis in (sy.e_x, sy.e_y)]
        factors = [self.number(entry) for entry in entries]
        for place, factor in enumerate(factors):
            self._refuse_squares(factor, along[place % 2])
        x, y = (factors[row].times(along[0]) + factors[row + 1].times(along[1]) for row in (0, 2))
        n_x, n_y = map(FIELD.generator, (sy.n_x, sy.n_y))
        return y.scaled(n_y) + x.scaled(n_x), y.scaled(n_y) - x.scaled(n_x)

    def _cases(self, *arguments: sympy.Expr) -> Form:
        first, second, index, last = arguments
        total = self.kind()
        for part, relation in ((first, sympy.Le(index, last)), (second, sympy.Gt(index, last))):
            inner = self.within(relation)
            if not inner.points.is_empty():
                total = total + inner.number(part).on(inner.points)
        return total

    def _power(self, base: sympy.Expr, exponent: sympy.Expr) -> Form:
        if not isinstance(exponent, sympy.Integer) or abs(exponent) > _HIGHEST:
            raise NotExactError(
                f"the power {text(exponent)} of {text(base)} is not a whole number up to {_HIGHEST}"
            )
        if exponent > 0:
            power = self._product([base] * int(exponent))
        elif isinstance(base, FORCES):  # one that others are compared with is one that acts
            (power,) = self._unknown(base, self.site(*base.args))
            if not self._acts(self.number(base)):
                raise NotExactError(f"the divisor {text(base)} may be zero")
            (((key, weights),)) = power.parts.items()
            power = self.kind({((key[0][0], int(exponent)),): weights})
        else:
            raise NotExactError(f"the divisor {text(base)} depends on the radii, or is a sum")
        if isinstance(power, tuple):
            raise NotExactError("a power of a vector")
        return power

    def _acts(self, force: Form) -> bool:
        """Whether a force is at order 0 a number that is not zero, or times one that acts."""
        acting = (self._unknown(other, self.site(*other.args))[0] for other in self.acting)
        known = {NUMBER}.union(*(other.parts for other in acting))
        ordered = [
            (key, weights.on(self.points).formulas())
            for key, weights in force.parts.items()
            if not any(isinstance(factor, str) for factor, _ in key)
        ]
        if len(ordered) != 1 or ordered[0][0] not in known or len(ordered[0][1]) != 1:
            return False
        ((where, value),) = ordered[0][1]
        return bool(self.points.is_subset(where)) and never_zero(value, self.points)

    def _average(self, expression: sympy.Expr, count: sympy.Expr, *indices: sympy.Symbol) -> Form:
        """Over neighbours two columns apart."""
        step = sy.m if expression.has(sy.MeanOver) else sy.n
        if step in (expression.free_symbols | count.free_symbols) or not self._is_free(step):
            raise NotExactError(
                f"a mean over neighbours can't be combined with the index {text(step)}"
            )
        if both := by_name({*indices, step} & self.fixed):
            raise NotExactError(f"a mean over {text(both[0])}, which stands for one value")
        at_least_one = self.straight.relation(sympy.Ge(count, 1, evaluate=False))
        if not {*indices} <= {*sy.INDICES} or not self.points.is_subset(sets.where(at_least_one)):
            raise NotAStatementError(f"a mean over {text(count)} neighbours has no value")
        inner = self.within(step >= 0, sympy.Le(step, count - 1, evaluate=False))
        there, back = (self._shifted(indices, sign * 2 * step) for sign in (1, -1))
        wide = replace(self, points=sets.without(sets.at(inner.points, back), step))
        total = wide.number(expression).merged().at(there).on(inner.points).summed(step)
        if any(
            step in f.free_symbols for key in total.parts for f, _ in key if not isinstance(f, str)
        ):
            raise NotExactError(f"{text(expression)} in a mean is not known")
        return total.times(self.number(1 / count))

    def _shifted(self, indices: Iterable[sympy.Symbol], by: sympy.Expr) -> Image:
        """Straightened indices, all of which go on by as many columns."""
        old, further = self.straight, {index: index + by for index in indices}
        return {
            index: sympy.expand(old.back.get(index, index).xreplace(further).xreplace(old.image))
            for index in dict.fromkeys((*old.back, *further))
        }

    def _series(self, series: sympy.Sum) -> Value:
        *others, (index, low, high) = series.limits
        taken = self.summed | self.fixed
        if index not in SUMMATION or index in taken or not self._is_free(index):
            raise NotAStatementError(f"a sum over {text(index)}, which has another meaning")
        if not self.within(sympy.Lt(high, low - 1, evaluate=False)).points.is_empty():
            raise NotAStatementError(
                f"the sum over {text(index)} from {text(low)} to {text(high)} may end more than "
                "one below its start, where it has no agreed value"
            )
        bounds = (sympy.Ge(index, low, evaluate=False), sympy.Le(index, high, evaluate=False))
        inner = replace(self.within(*bounds), summed=self.summed | {index})
        body = sympy.Sum(series.function, *others) if others else series.function
        value = inner.read(body)
        if isinstance(value, tuple):
            first, second = (component.on(inner.points).summed(index) for component in value)
            return first, second
        return value.on(inner.points).summed(index)

    def _is_free(self, index: sympy.Symbol) -> bool:
        """Whether an index does not matter to the domain, nor to where its beads are."""
        at_beads = (form.free_symbols for form in self.straight.back.values())
        return index not in set().union(*at_beads) and bool(
            sets.without(self.points, index).is_subset(self.points)
        )


def is_whole(form: sympy.Expr) -> bool:
    """Whether a form in indices has whole factors."""
    try:
        sets.row(form)
    except NotExactError:
        return False
    return True


SUMMATION = (sy.m, sy.n, sy.l)
"""The indices that a statement may sum over."""
